"""Cases that film a run and measure the film do what their expected.toml says, and would say so if they did not."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from porescale.piv.synth import Camera
from porescale.scene.case import expected, missed

CASES = Path(__file__).resolve().parents[2] / "cases"


def script(case, name=None):
    """The script of a case as a module."""
    path = CASES / case / f"{name or case}.py"
    spec = importlib.util.spec_from_file_location(f"case_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def cavity(tmp_path_factory):
    """The script and a run on 64² cells: what the measurement misses of a field does not depend on the field's own."""
    module = script("piv_cavity")
    return module, module.cavity(tmp_path_factory.mktemp("cavity") / "run", "draft")


@pytest.mark.slow
def test_the_measured_cavity_is_that_of_the_lattice(cavity):
    module, run = cavity
    numbers, _, _ = module.judged(run, pairs=3)
    assert set(numbers) == {row["name"] for row in expected(CASES / "piv_cavity")}
    assert missed(CASES / "piv_cavity", numbers) == []


@pytest.mark.slow
def test_wide_windows_miss_the_corners_and_noisy_pictures_the_rest(cavity):  # the twins that must fail
    module, run = cavity
    wide, _, _ = module.judged(run, pairs=1, window=64)
    corners = {row["name"] for row in expected(CASES / "piv_cavity") if row["name"].startswith("lower")}
    assert set(missed(CASES / "piv_cavity", wide)) >= corners
    noisy, _, _ = module.judged(run, pairs=1, camera=Camera(noise=60.0))
    assert {"all", "inside", "inside, px"} <= set(missed(CASES / "piv_cavity", noisy))
