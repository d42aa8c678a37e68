"""Progress: silent when asked, a line now and then where there is no terminal, a bar where there is one."""

import io
import threading

import pytest
from rich.console import Console

from porescale.common.compiled.turns import TURNS
from porescale.common.duration import quiet
from porescale.common.duration.doing import doing
from porescale.common.record import progress
from porescale.common.record.cost import UNCOUNTED
from porescale.common.record.progress import STARTING, Watch, duration
from tests.reference.waiting import awaited


@pytest.fixture(autouse=True)
def alone(monkeypatch):
    """No load that the tests do not make."""
    monkeypatch.setattr(quiet, "scheduled", lambda: (1.0, 0.0))


def watched(monkeypatch, terminal=False) -> str:
    """What a run says that goes on until it was heard, first while it compiles, then while it runs."""
    monkeypatch.setattr(progress, "PATIENCE", 0.02)
    monkeypatch.setattr(progress, "LINE_EVERY", 0.04)
    monkeypatch.setattr(TURNS, "name", "sweep")
    monkeypatch.setattr(TURNS, "count", 3)
    watch = Watch("dam", 0.0, 2.0)
    said = io.StringIO()
    watch.console = Console(file=said, force_terminal=terminal, width=200)
    with watch:
        awaited(lambda: f"{STARTING}, compiling kernel 3, sweep" in said.getvalue())
        monkeypatch.setattr(TURNS, "name", "")
        watch.update(15, 0.75)
        watch.update(16, 0.80)
        awaited(lambda: "running" in said.getvalue() and ("%" if terminal else " left\n") in said.getvalue())
    return said.getvalue()


def test_where_there_is_no_terminal_lines_tell_how_far_it_is(monkeypatch):
    lines = watched(monkeypatch).splitlines()
    assert "dam: starting, compiling kernel 3, sweep, t = " in lines[0]
    assert "dam: running, t = " in lines[-1]
    assert " of 2 s (" in lines[-1]
    assert lines[-1].endswith(" left")


def test_a_notebook_gets_one_line_that_is_written_over(monkeypatch, capsys):
    monkeypatch.setattr(progress, "PATIENCE", 0.02)
    watch, said = Watch("dam", 0.0, 2.0), ""

    def heard(word: str) -> bool:
        nonlocal said
        said += capsys.readouterr().out
        return word in said

    watch.console = Console(file=io.StringIO(), force_jupyter=True)
    with watch:
        awaited(lambda: heard(STARTING))
        watch.update(15, 0.75)
        watch.update(16, 0.80)
        awaited(lambda: heard(" left"))
        watch.update(40, 2.0)
    heard("")
    assert said.count("\n") == 1
    assert said.endswith("\n")
    assert "t = 2 of 2 s (100 %), step 40" in said.split("\r")[-1]
    quiet = Watch("dam", 0.0, 2.0, quiet=True)
    quiet.console = watch.console
    with quiet:
        quiet.update(1, 1.0)
    assert not capsys.readouterr().out


def test_a_terminal_gets_a_bar_that_names_the_compiling(monkeypatch):
    said = watched(monkeypatch, terminal=True)
    assert "compiling kernel 3, sweep" in said
    assert "running" in said
    assert "%" in said
    assert " left" in said


def test_quiet_is_quiet(capsys):
    before = threading.active_count()
    with Watch("dam", 0.0, 2.0, quiet=True) as watch:
        assert threading.active_count() == before  # nobody is there who could speak later
        watch.update(15, 0.75)
        watch.say("done")
    assert capsys.readouterr().err == ""


def test_a_short_run_says_nothing(capsys):
    with Watch("dam", 0.0, 1.0) as watch:
        watch.update(1, 1.0)
    assert capsys.readouterr().err == ""


def test_time_left_counts_from_the_first_step_not_from_the_compiling(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    watch = Watch("dam", 0.0, 10.0, quiet=True)
    now[0] = 20.0
    watch.update(1, 0.1)
    assert watch.left() is None
    now[0] = 25.0
    watch.update(51, 5.1)
    # 5 s of wall clock for 5 s of the run; 4.9 s remain.
    assert watch.left() == pytest.approx(4.9)


def test_what_is_compiled_later_is_no_pace_of_steps(monkeypatch):
    # Blocks of 0.1 s; the kernels of the first row, at the tenth block, take 20 s.
    now = [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    monkeypatch.setattr(TURNS, "seconds", 0.0)
    watch = Watch("dam", 0.0, 10.0, quiet=True)
    for k in range(1, 101):
        now[0] += 0.1
        if k == 10:
            now[0] += 20.0
            monkeypatch.setattr(TURNS, "seconds", 20.0)
        watch.update(k, 0.1 * k)
        if k > UNCOUNTED:
            assert watch.left() == pytest.approx(10.0 - 0.1 * k, abs=1e-9)
    # The twin that must fail: they count.
    monkeypatch.setattr(TURNS, "seconds", 0.0)
    watch.time = 5.0
    assert watch.left() > 10.0


@pytest.mark.parametrize(("share", "stopped"), [(0.0, 5.0), (0.5, 0.0)])  # the second is the twin: a busy machine
def test_a_wait_that_lasts_too_long_without_the_processor_is_one_in_which_the_process_was_stopped(
    monkeypatch, share, stopped
):
    now, busy = [0.0], [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    monkeypatch.setattr(progress.clock, "process_time", lambda: busy[0])
    watch = Watch("dam", 0.0, 2.0, quiet=True)

    def wait(seconds):
        now[0] += seconds + 5.0
        busy[0] += share * 5.0
        return False

    monkeypatch.setattr(watch._stop, "wait", wait)
    assert not watch._wait(0.25)
    assert watch.stopped == stopped


def test_a_last_step_beyond_the_end_is_no_more_than_all():
    watch = Watch("dam", 0.0, 0.4, quiet=True)
    watch.update(20, 0.3)
    assert "(75 %)" in watch.line()  # the twin
    watch.update(26, 0.4024)
    assert "t = 0.4024 of 0.4 s (100 %)" in watch.line()


def test_time_left_is_right_within_a_tenth_from_a_tenth_of_the_run_on(monkeypatch):
    # Ten blocks a second but for the first three, which compile for 9 s each; rows take a tenth of each block; all
    # that follows takes 8 s.  The mean speed is then exact; the tenth is for what a real run does besides.
    now = [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    blocks, finish = 300, 8.0
    ends = [9.0 * min(k, UNCOUNTED) + 0.11 * max(k - UNCOUNTED, 0) for k in range(blocks + 1)]
    told, without = worst(Watch("dam", 0.0, 3.0, quiet=True, finish=finish), now, ends, finish)
    assert told < 0.1
    # The twin that must fail: a watch that knows nothing of what follows.
    told, without = worst(Watch("dam", 0.0, 3.0, quiet=True), now, ends, finish)
    assert told > 0.1
    assert without is None


def test_what_follows_the_steps_takes_as_much_longer_beside_others_as_they_did(monkeypatch):
    # A third of a core: a block of 0.1 s takes 0.3 s, and the 8 s that follow take 24 s.
    now = [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    monkeypatch.setattr(quiet, "scheduled", lambda: (now[0] / 3.0, 2.0 * now[0] / 3.0))
    ends = [0.3 * k for k in range(301)]
    assert worst(Watch("dam", 0.0, 3.0, quiet=True, finish=8.0), now, ends, 24.0)[0] < 0.01
    # The twin that must fail: what is left is said as of a quiet machine.
    monkeypatch.setattr(quiet, "scheduled", lambda: (1.0, 0.0))
    now[0] = 0.0
    assert worst(Watch("dam", 0.0, 3.0, quiet=True, finish=8.0), now, ends, 24.0)[0] > 0.5


def test_what_takes_longer_than_expected_after_the_steps_is_not_said_to_be_over(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    watch = Watch("dam", 0.0, 3.0, quiet=True, finish=8.0)
    watch.update(1, 0.1)
    watch.enter("writing pictures and film")
    now[0] = 7.0
    assert watch.line().endswith(", 1 s left")  # the twin
    now[0] = 8.0
    assert watch.left() is None
    now[0] = 100.0
    assert not watch.line().endswith(" left")


def worst(watch, now, ends, finish):
    """Largest relative error of the time left from a tenth of a run on, and what is said of it half-way through what
    follows the steps."""
    errors = []
    for k in range(1, len(ends)):
        now[0] = ends[k]
        watch.update(k, watch.end * k / (len(ends) - 1))
        if k >= len(ends) / 10:
            true = ends[-1] + finish - now[0]
            errors.append(abs(watch.left() / true - 1.0))
    watch.enter("writing pictures and film")
    now[0] += finish / 2
    left = watch.left()
    if left is not None:
        errors.append(abs(left / (finish / 2) - 1.0))
    return max(errors), left


def test_what_takes_long_before_the_first_step_is_named_with_the_time_left(monkeypatch):
    now = [0.0]
    monkeypatch.setattr("time.perf_counter", lambda: now[0])
    monkeypatch.setattr("porescale.common.duration.doing.load_now", lambda: 2.0)  # beside another process
    watch = Watch("dam", 0.0, 0.0)
    assert watch.line() == "dam: starting, 0 s so far"
    with doing("settling the packing", 30.0):
        now[0] = 12.0
        assert watch.line() == "dam: settling the packing, 12 s so far, 48 s left"
        now[0] = 70.0
        assert watch.line() == "dam: settling the packing, 1 min 10 s so far"  # longer than was expected
    assert watch.left() is None
    run = Watch("dam", 0.0, 2.0)
    with doing("settling the packing", 30.0):
        assert run.line() == "dam: settling the packing, t = 0 of 2 s (0 %), step 0, 1 min 00 s left"


@pytest.mark.parametrize(("seconds", "said"), [(8.2, "8 s"), (200, "3 min 20 s"), (7500, "2 h 05 min")])
def test_durations_are_said_as_people_do(seconds, said):
    assert duration(seconds) == said
