"""What both programs promise of a run: bits that hang on nothing else, stops that save, folders that may be lost."""

import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from porescale import open_run
from porescale.common.core.constants import GRAVITY
from porescale.common.record.checkpoint import read_checkpoint
from tests.reference.faults.failing_disk import whole
from tests.reference.programs import KINDS, Program, program
from tests.reference.same_run import differences, state_of

QUICK = "tank"
"""What has few kernels, which other tests compile anyway."""
NAMES = [QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in KINDS if name != QUICK)]
"""With the scope of a module pytest runs all tests of one after the other."""


@pytest.fixture(scope="module")
def untouched(tmp_path_factory) -> Callable[[str], tuple[Program, Path]]:
    """Gives a program and the folder of its run from start to end, made once."""
    known: dict[str, tuple[Program, Path]] = {}

    def make(name: str) -> tuple[Program, Path]:
        if name not in known:
            one = program(name, tmp_path_factory.mktemp(name))
            assert one.run(one.place / "untouched") == 0
            known[name] = one, one.place / "untouched"
        return known[name]

    return make


def output(values: dict[str, Any], finer: float) -> list[str]:
    """Settings for intervals of rows, snapshots and checkpoints a ``finer``-th as long."""
    found = values["output"]
    words = [f"output.{name}={found[name] / finer!r}" for name in ("series_interval", "snapshot_interval")]
    return [part for word in (*words, "output.checkpoint_seconds=0.01") for part in ("--set", word)]


@pytest.mark.parametrize("name", NAMES, scope="module")
@pytest.mark.parametrize("finer", [3.0, pytest.param(0.3, marks=pytest.mark.slow)])
def test_output_of_any_cadence_leaves_the_same_state(tmp_path, untouched, name, finer):
    one, folder = untouched(name)
    out = tmp_path / "run"
    assert one.run(out, *output(one.values, finer)) == 0
    assert (len(open_run(out)) > len(open_run(folder))) == (finer > 1.0)
    assert state_of(out) == state_of(folder)


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_runs_repeat_to_the_bit_at_one_thread_and_at_all(tmp_path, untouched, name):
    one, folder = untouched(name)
    for threads in (1, max(2, os.cpu_count() or 1)):
        out = tmp_path / str(threads)
        assert one.run(out, "--threads", threads) == 0
        assert open_run(out).card["threads"] == threads
        assert differences(out, folder) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS, scope="module")
def test_another_scene_is_another_run(tmp_path, untouched, name):  # the twin that must fail
    one, folder = untouched(name)
    package, values = KINDS[name]
    key, was = ("fluid.viscosity", 2e-5) if "fluid" in values else ("contact.stiffness", 2e5)
    if package == "continuum_sph":
        key, was = "gravity", GRAVITY
    assert one.run(tmp_path / "run", "--set", f"{key}={was * (1 + 1e-6)!r}") == 0
    assert differences(tmp_path / "run", folder) != []


@pytest.mark.parametrize("number", [signal.SIGTERM, pytest.param(signal.SIGINT, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_run_asked_to_stop_saves_the_step_says_so_and_goes_on(tmp_path, complaints, untouched, name, number):
    one, folder = untouched(name)
    out = tmp_path / "run"
    assert one.run(out, happens=lambda: signal.raise_signal(number)) == 130
    (line,) = complaints()
    card = open_run(out).card
    assert line.startswith(f"interrupted at step {card['step']} ")
    assert "resume to continue" in line
    assert card["outcome"] == "interrupted"
    assert read_checkpoint(out / "checkpoint.h5")["step"] == card["step"]
    assert one.run(out, "--resume") == 0
    assert differences(out, folder) == []


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_folder_that_goes_ends_its_run_in_a_line_and_is_not_made_again(tmp_path, complaints, untouched, name):
    one, folder = untouched(name)
    out, elsewhere = tmp_path / "run", tmp_path / "elsewhere"
    assert one.run(out, happens=lambda: shutil.rmtree(out)) == 1
    (line,) = complaints()
    assert "the run folder was moved or removed" in line
    assert not out.exists()
    assert one.run(out, *output(one.values, 1.0), happens=lambda: out.rename(elsewhere)) == 1
    (line,) = complaints()
    assert not out.exists()
    whole(elsewhere)
    assert one.run(elsewhere, "--resume") == 0  # where it lies now
    assert differences(elsewhere, folder) == []


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_second_run_in_the_folder_is_refused_and_the_first_does_not_notice(tmp_path, complaints, untouched, name):
    one, folder = untouched(name)
    out, codes = tmp_path / "run", []

    def second() -> None:
        codes.extend(one.run(out, *how) for how in ([], ["--resume"], ["--overwrite"]))

    assert one.run(out, happens=second) == 0
    assert codes == [2, 2, 2]
    first, *others = complaints()
    assert "already holds a run" in first
    assert len(others) == 2
    assert all("another run is writing here" in line for line in others)
    assert differences(out, folder) == []


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_folder_below_a_file_is_refused_before_anything_is_built(tmp_path, complaints, untouched, name):
    one, _ = untouched(name)
    (tmp_path / "file").write_text("mine")
    assert one.run(tmp_path / "file" / "run", happens=lambda: pytest.fail("it ran")) == 2
    assert len(complaints()) == 1
    assert (tmp_path / "file").read_text() == "mine"
