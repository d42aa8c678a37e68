"""Runs side by side share no core, where there are enough."""

import os
import subprocess
import sys

import pytest

from porescale.common.studies.schedulers import cores
from tests.reference.waiting import running


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """A machine of so many cores with twins: 0 and 4 are one, 1 and 5 ...; no other campaign."""

    def of(count: int) -> None:
        for core in range(count):
            place = tmp_path / "cpu" / f"cpu{core}" / "topology"
            place.mkdir(parents=True)
            half = count // 2
            (place / "thread_siblings_list").write_text(f"{core % half},{core % half + half}\n")
        monkeypatch.setattr(cores, "TOPOLOGY", tmp_path / "cpu")
        monkeypatch.setattr(os, "sched_getaffinity", lambda process: set(range(count)), raising=False)

    monkeypatch.setattr(cores.tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(cores, "busy", lambda: 0.4)
    return of


def test_each_run_has_cores_of_its_own_twins_last(machine):
    machine(8)
    assert cores.usable() == [0, 1, 2, 3, 4, 5, 6, 7]
    with cores.taken(2, 2) as given:
        assert given == [[0, 1], [2, 3]]
        with cores.taken(2, 1) as others:  # another campaign: what is left
            assert others == [[4], [5]]
            with cores.taken(3, 1) as late:
                assert late == [[], [], []]
    with cores.taken(2, 1) as again:
        assert again == [[0], [1]]


def test_neighbours_that_are_one_core_are_not_taken_for_two(machine, tmp_path):
    machine(4)
    for core in range(4):
        file = tmp_path / "cpu" / f"cpu{core}" / "topology" / "thread_siblings_list"
        file.write_text(f"{core // 2 * 2}-{core // 2 * 2 + 1}\n")
    with cores.taken(2, 1) as given:
        assert given == [[0], [2]]


def test_one_run_and_too_many_runs_are_left_to_the_system(machine):
    machine(4)
    for jobs, threads in ((1, 2), (5, 1), (2, 3)):
        with cores.taken(jobs, threads) as given:
            assert given == [[]] * jobs


def test_beside_other_work_all_is_left_to_the_system(machine, monkeypatch):
    machine(4)
    for load, expected in ((2.2, [[0], [1]]), (2.6, [[], []])):
        monkeypatch.setattr(cores, "busy", lambda load=load: load)
        with cores.taken(2, 1) as given:
            assert given == expected


def test_where_the_system_places_nothing_nothing_is_done(monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.delattr(os, "sched_setaffinity")
    with cores.taken(2, 1) as given:
        assert given == [[], []]
    cores.pin(os.getpid(), [0])


def test_a_process_is_placed_and_one_without_cores_is_not():
    mine = sorted(os.sched_getaffinity(0))
    with running([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as process:
        cores.pin(process.pid, [])
        assert sorted(os.sched_getaffinity(process.pid)) == mine
        cores.pin(process.pid, mine[-1:])
        assert sorted(os.sched_getaffinity(process.pid)) == mine[-1:]
