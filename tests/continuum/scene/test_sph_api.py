"""The API of the package: what its docstring says, and no more."""

from pathlib import Path

import pytest

import continuum_sph
from continuum_sph.program import SEEPAGE, SOIL
from porescale.common.core.errors import InputError
from porescale.common.record.model import Model
from porescale.common.record.record import Record

CASE = Path(__file__).resolve().parents[3] / "cases" / "collapsing_water_column"


def test_the_api_does_what_the_package_says(tmp_path):
    from continuum_sph import Simulation, build, load, open_run

    assert "from continuum_sph import build, load, open_run" in (continuum_sph.__doc__ or "")
    simulation = build(load(CASE, quality="draft", settings=["numerics.gradient=plain", "numerics.shifting=0"]))
    assert isinstance(simulation, Simulation)
    assert isinstance(simulation, Model)
    assert isinstance(simulation.scene, continuum_sph.Scene)
    simulation.advance(3)
    assert simulation.step == 3
    assert simulation.time > 0.0
    with pytest.raises(InputError, match="no run here"):
        open_run(tmp_path)


def test_no_picture_of_an_older_run_stays_beside_a_new_one(tmp_path):
    Record.fresh(tmp_path, {})
    made = {tmp_path / f"{name}.png" for name in (*SOIL, *SEEPAGE)}
    for path in (*made, tmp_path / "mine.png"):
        path.touch()
    Record.fresh(tmp_path, {}, overwrite=True)
    assert set(tmp_path.glob("*.png")) == {tmp_path / "mine.png"}


def test_every_name_of_the_api_is_there_and_no_other():
    for name in continuum_sph.__all__:
        assert getattr(continuum_sph, name) is not None
    with pytest.raises(AttributeError, match="No continuum_sph attribute sails"):
        continuum_sph.sails  # noqa: B018
