"""What is expected of a run: learnt from runs of the same scene, then of its kind, with the load taken out."""

import json

import pytest

from porescale.common.duration import expected as module
from porescale.common.duration.expected import (
    BEGIN,
    BUILDING,
    COMPILING,
    FINISHING,
    GUESS,
    KEPT,
    NAME,
    RECORDING,
    STEPS,
    Work,
    besides,
    expected,
    remember,
)
from porescale.common.duration.quiet import Moment

NOMINAL = {COMPILING: 50.0, BUILDING: 1.0, STEPS: 10.0, RECORDING: 2.0, FINISHING: 4.0}
BEGAN = Moment(0.0, 0.0, 0.0)


@pytest.fixture(autouse=True)
def machine(tmp_path, monkeypatch):
    """A machine that has run nothing; gives the folder of its kernels."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(module, "cache_folder", lambda: tmp_path)
    return tmp_path


def work(scene="dam", kind="water", times=1.0):
    return Work(scene, kind, {phase: times * seconds for phase, seconds in NOMINAL.items()})


def ran(monkeypatch, of=None, slower=1.0, kernels=(), compiled=0, compiling=0.0, load=1.0):
    """A run that took ``slower`` times the nominal seconds on a quiet machine, and ``load`` times as long."""
    of = of or work()
    now = Moment(load, 1.0, load - 1.0, load * compiling, compiled)
    monkeypatch.setattr(module, "moment", lambda: now)
    half = len(kernels) // 2  # some are compiled, some were there
    monkeypatch.setattr(module.TURNS, "kept", list(kernels[:half]))
    monkeypatch.setattr(module, "USED", ["kernels-py", *(f"{name}.nbc" for name in kernels[half:])])
    remember(of, {phase: slower * seconds for phase, seconds in of.seconds.items()}, BEGAN)


def test_before_a_run_it_is_a_guess():
    told = expected(work())
    assert (told.measured, told.known) == (False, GUESS)
    assert told.total == BEGIN + sum(NOMINAL.values())


def test_a_run_teaches_what_the_next_one_takes(monkeypatch):
    ran(monkeypatch, slower=3.0)
    told = expected(work(times=2.0))
    assert told.measured
    assert told.known != GUESS
    assert besides(work(times=2.0)) == pytest.approx(3.0 * 2.0 * (2.0 + 4.0), rel=1e-12)
    assert besides(None) is None
    assert told.total == pytest.approx(BEGIN + 3.0 * 2.0 * (sum(NOMINAL.values()) - 50.0), rel=1e-12)


def test_a_phase_that_has_nothing_to_do_teaches_nothing():
    nothing = Work("dam", "water", {**NOMINAL, STEPS: 0.0})
    remember(nothing, dict.fromkeys((BUILDING, STEPS, RECORDING, FINISHING), 2.0), BEGAN)
    told = expected(work())
    assert told.seconds[BUILDING] == pytest.approx(2.0, rel=1e-12)  # 2 of 1 s: the others were learnt
    assert told.seconds[STEPS] == NOMINAL[STEPS]


def test_the_median_of_five_counts_so_that_one_slow_run_has_no_say(monkeypatch):
    for slower in (9.0, 9.0, 2.0, 3.0, 50.0, 2.5, 3.5):
        ran(monkeypatch, slower=slower)
    assert expected(work()).seconds[STEPS] == pytest.approx(30.0, rel=1e-12)  # the median of the last five is 3


def test_a_run_of_the_same_scene_says_more_than_one_of_its_kind_and_another_kind_says_nothing(monkeypatch):
    ran(monkeypatch, work("tank"), slower=7.0)
    ran(monkeypatch, work(), slower=2.0)
    for of, slower in ((work(), 2.0), (work("tank"), 7.0), (work("other"), 4.5)):
        assert expected(of).seconds[STEPS] == pytest.approx(10.0 * slower, rel=1e-12)
    assert not expected(work(kind="soil")).measured


def test_a_run_on_as_many_threads_says_more_than_one_on_others(monkeypatch):
    for threads, slower in ((1, 8.0), (2, 5.0)):
        monkeypatch.setattr(module, "threads_of_run", lambda threads=threads: threads)
        ran(monkeypatch, slower=slower)
    for threads, slower in ((1, 8.0), (2, 5.0), (4, 6.5)):
        monkeypatch.setattr(module, "threads_of_run", lambda threads=threads: threads)
        assert expected(work()).seconds[STEPS] == pytest.approx(10.0 * slower, rel=1e-12)


def test_kernels_count_where_they_are_not_on_disk(monkeypatch, machine):
    ran(monkeypatch, kernels=("cover-1", "sweep-2", "sweep-2"), compiled=2, compiling=30.0, load=4.0)
    ran(monkeypatch, kernels=("cover-1", "sweep-2"))
    assert expected(work()).seconds[COMPILING] == pytest.approx(30.0, rel=1e-12)  # the load of 4 is not in them
    (machine / "cover-1.nbc").touch()
    assert expected(work()).seconds[COMPILING] == pytest.approx(15.0, rel=1e-12)
    (machine / "sweep-2.nbc").touch()
    assert expected(work()).seconds[COMPILING] == 0.0


def test_a_few_kernels_that_changed_do_not_stand_for_all(monkeypatch):
    ran(monkeypatch, kernels=("a", "b", "c"), compiled=3, compiling=30.0)
    ran(monkeypatch, kernels=("a", "b", "d"), compiled=1, compiling=9.0)
    assert expected(work()).seconds[COMPILING] == pytest.approx(30.0, rel=1e-12)  # of a, b and d, none is on disk


def test_of_kernels_that_no_run_compiled_nothing_is_known_but_that_they_are_there(monkeypatch, machine):
    (machine / "a.nbc").touch()
    ran(monkeypatch, kernels=("a",))
    assert expected(work()).seconds[COMPILING] == 0.0
    (machine / "a.nbc").unlink()
    assert expected(work()).seconds[COMPILING] == NOMINAL[COMPILING]


def test_what_a_run_did_not_do_it_says_nothing_of(monkeypatch):
    ran(monkeypatch, slower=2.0)
    monkeypatch.setattr(module, "moment", lambda: BEGAN)
    remember(work(), {STEPS: 0.0, BUILDING: 3.0}, BEGAN)
    told = expected(work()).seconds
    assert told[STEPS] == pytest.approx(20.0, rel=1e-12)
    assert told[BUILDING] == pytest.approx(2.5, rel=1e-12)  # the median of two and three


def test_no_more_runs_are_kept_than_count(monkeypatch, machine):
    for _ in range(KEPT + 3):
        ran(monkeypatch)
    assert len(json.loads((machine / "porescale" / NAME).read_text())) == KEPT


def test_a_run_that_cannot_be_noted_fails_nothing(monkeypatch, machine):
    (machine / "file").write_text("no folder")
    monkeypatch.setenv("XDG_CACHE_HOME", str(machine / "file"))
    ran(monkeypatch)
    assert not expected(work()).measured


WHOLE = {"scene": "dam", "kind": "water", "threads": 2, "slower": {}, "kernels": [], "compiled": 0, "compiling": 0}


@pytest.mark.parametrize(
    "spoiled",
    [
        "nonsense", "3", "[3]", "[[]]", '[{"scene": "dam", "kind": "water"}]', *(
            json.dumps([{**WHOLE, key: value}]) for key, value in {
                "scene": None, "threads": "2", "slower": {STEPS: -1}, "kernels": [3], "compiled": "x",
                "compiling": float("nan")}.items()
        ),
    ],
)  # fmt: skip
def test_a_spoiled_note_is_a_guess(monkeypatch, machine, spoiled):
    guess = expected(work())
    ran(monkeypatch, slower=3.0)
    file = machine / "porescale" / NAME
    whole = file.read_text()
    file.write_text(spoiled)
    assert expected(work()) == guess
    for sound in (whole, json.dumps([WHOLE])):  # the twin
        file.write_text(sound)
        assert expected(work()).measured
