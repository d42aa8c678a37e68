"""The time left of many runs, against runs whose whole course is known."""

import json
from types import SimpleNamespace

import pytest

from porescale.common.studies.schedulers.local import Local
from porescale.common.studies.schedulers.progress import Progress, share_done
from porescale.common.studies.schedulers.task import Done, Task


@pytest.fixture
def run(tmp_path):
    """Writes a run that is so far; its folder."""

    def at(name: str, share: float):
        folder = tmp_path / name
        folder.mkdir(exist_ok=True)
        (folder / "card.json").write_text(json.dumps({"scene": {"time": {"end": 8.0}}}))
        (folder / "series.csv").write_text(f"time (s),x (m)\n0.0,1\n{8 * share},1\n9.0,")
        return folder

    return at


def test_the_share_of_a_run_is_that_of_its_last_whole_row(run, tmp_path):
    assert share_done(run("a", 0.25)) == 0.25
    assert share_done(tmp_path / "none") is None
    (tmp_path / "a" / "card.json").write_text('{"scene": {}}')
    assert share_done(tmp_path / "a") is None


def test_runs_at_a_steady_pace_take_what_is_left_of_them(run, tmp_path):
    # Two run, each of 100 s; one has 60 s to go, the other 80 s; two more wait: 340 s of work on two machines.
    now = 0.0
    left = Progress(print, {"a": run("a", 0.2), "b": run("b", 0.0), "c": tmp_path / "c", "d": tmp_path / "d"}, 2,
                    lambda: now)  # fmt: skip
    assert left.seconds() is None
    assert left.words() == "time left not known yet"
    now = 20.0
    run("a", 0.4), run("b", 0.2)
    assert left.seconds() == pytest.approx((60 + 80 + 200) / 2)
    assert left.words() == "about 2 min 50 s left"
    left.at_a_time = 4
    assert left.seconds() == pytest.approx(100)  # none ends before the longest
    for name in "abc":
        left.ended(name, 100.0)
    left.at_a_time = 1
    assert left.seconds() == pytest.approx(100)
    left.ended("d", 100.0)
    assert left.seconds() == 0.0


def test_a_run_here_counts_from_the_start_of_its_process(tmp_path):
    now = [0.0]

    def run():
        now[0] += 7.0
        return 0, ""

    rest = Progress(print, {"a": tmp_path / "a", "b": tmp_path / "b"}, now=lambda: now[0])
    task = Task("a", "toy", (), tmp_path / "a")
    (done,) = Local(lambda *_: SimpleNamespace(run=run, stop=lambda: None)).run([task], 1, rest)
    rest.ended("a", done.seconds)
    assert rest.seconds() == 7.0  # as much for the other
    assert Done(task, 0, "").seconds == 0.0  # the twin: of a process elsewhere it is not known


def test_a_pace_is_seen_not_read_from_clocks(run):
    now = 1e6
    left = Progress(print, {"a": run("a", 0.5)}, 1, lambda: now)
    left.seconds()
    now += 10
    run("a", 0.75)
    assert left.seconds() == pytest.approx(10)
    run("a", 0.1)  # begun anew: nothing is known of its new pace
    assert left.seconds() is None
    now += 10
    run("a", 0.2)
    assert left.seconds() == pytest.approx(80)
    assert left.seconds() != pytest.approx(40)  # the check that must fail: of the old pace
