"""A run folder is read while it grows, without a trace in it."""

import os
import shutil
import time

import h5py
import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.record import snapshots
from porescale.common.watch.growing import Growing, last_value
from tests.reference.watched import PROGRAM, toy_run


def files_of(folder):
    return {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in sorted(folder.rglob("*"))}


def test_every_snapshot_is_seen_and_read_once_it_is_on_disk_and_nothing_is_touched(tmp_path):
    growing, seen = Growing(tmp_path / "run", PROGRAM), []

    def meanwhile(folder):
        before = files_of(folder)
        state = growing.state()
        read = growing.ask(lambda run: run.snapshot(-1))
        seen.append((state["steps"], state["outcome"], read.step, state["epoch"], state["end"]))
        assert files_of(folder) == before

    toy_run(tmp_path / "run", meanwhile=meanwhile)
    steps = [0, 10, 20, 30]
    assert seen == [(steps[: k + 1], "running", steps[k], 0, 0.03) for k in range(4)]
    state = growing.state()  # the parts are joined now: other files, the same frames
    assert (state["steps"], state["outcome"], state["epoch"], state["time"]) == (steps, "finished", 0, 0.03)
    toy_run(tmp_path / "alone")
    with h5py.File(tmp_path / "run" / "grains.vtkhdf") as one, h5py.File(tmp_path / "alone" / "grains.vtkhdf") as other:
        assert np.array_equal(one["VTKHDF/Points"][...], other["VTKHDF/Points"][...])


def test_a_snapshot_that_is_joined_while_it_is_read_is_read_from_where_it_went(tmp_path):
    toy_run(tmp_path)
    part = snapshots.write_part(tmp_path, Growing(tmp_path, PROGRAM).run().snapshot(1))
    growing, tries = Growing(tmp_path, PROGRAM), []

    def question(run):
        tries.append(run)
        if len(tries) == 1:
            shutil.rmtree(part.parent)
            run._frames[1] = (10, parted)
        return run.snapshot(1).step

    parted = {name: frames[0] for name, frames in snapshots.joined(part).items()}
    assert growing.ask(question) == 10
    assert len(tries) == 2


def test_what_was_written_and_taken_back_begins_another_epoch(tmp_path):
    toy_run(tmp_path)
    growing = Growing(tmp_path, PROGRAM)
    assert growing.state()["epoch"] == 0
    snapshots.trim(tmp_path, 10)
    assert [growing.state()["epoch"], growing.state()["steps"]] == [1, [0, 10]]
    series = tmp_path / "series.csv"
    series.write_bytes(series.read_bytes()[:-10])
    assert growing.state()["epoch"] == 2


def test_a_torn_last_row_and_an_empty_table_are_read_up_to_what_is_whole(tmp_path):
    path = tmp_path / "series.csv"
    for content, expected in (
        (b"", None), (b"time (s),a (m)", None), (b"time (s),a (m)\n", None), (b"time (s),a (m)\n0.5,1\n", 0.5),
        (b"time (s),a (m)\n0.5,1\n0.75", 0.5), (b"time (s),a (m)\n0.5,1\n0.75,2\n", 0.75), (b"a,b\n1,2\n", None),
        (b"time (s),a (m)\n0.5,1.5", None),
    ):  # fmt: skip
        path.write_bytes(content)
        assert last_value(path) == expected, content
    assert last_value(tmp_path / "none.csv") is None


def test_a_killed_run_says_how_long_nothing_was_written(tmp_path):
    toy_run(tmp_path)
    for path in tmp_path.rglob("*"):
        os.utime(path, (1e9, 1e9))
    assert Growing(tmp_path, PROGRAM).state()["age"] > 1e6


def test_a_writer_whose_clock_is_hours_behind_is_seen_to_write(tmp_path):
    toy_run(tmp_path)
    behind = time.time() - 2e4
    growing, ages = Growing(tmp_path, PROGRAM), []
    for later in (0, 0, 1):
        for path in tmp_path.rglob("*"):
            os.utime(path, (behind + later, behind + later))
        ages.append(growing.state()["age"])
    assert min(ages[:2]) > 1e4  # nothing has changed yet: the check that must fail
    assert ages[2] < 1e3


@pytest.mark.parametrize("name", ["card.json", "fields.vtkhdf", "parts/000000000010"])
def test_what_a_link_leads_out_to_is_not_read(tmp_path, name):
    toy_run(tmp_path / "run")
    if name.startswith("parts"):
        snapshots.write_part(tmp_path / "run", Growing(tmp_path / "run", PROGRAM).run().snapshot(1))
    path = tmp_path / "run" / name
    shutil.move(path, tmp_path / "outside")
    path.symlink_to(tmp_path / "outside")
    with pytest.raises(InputError, match="lies elsewhere, behind a link"):
        Growing(tmp_path / "run", PROGRAM).state()
