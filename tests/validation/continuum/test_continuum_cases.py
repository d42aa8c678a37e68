"""The continuum's cases do what their expected.toml says, at their default quality."""

from functools import partial

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from porescale.common.schema.sections import load
from tests.reference.continuum import continuum_cases
from tests.reference.continuum.continuum_cases import missed
from tests.reference.folders import CASES

series = partial(continuum_cases.series, Simulation, 20)


def test_water_at_rest_stays():
    assert missed("hydrostatic_column", series("hydrostatic_column")) == []


def test_water_let_go_does_not_stay():  # the twin that must fail
    columns = series("hydrostatic_column", "tank.width=1.0", "time.end=0.5", "numerics.spacing=0.1")
    assert {"the centre of mass stays", "nothing moves"} <= set(missed("hydrostatic_column", columns))


@pytest.mark.slow
def test_a_column_collapses_as_published():
    assert missed("collapsing_water_column", series("collapsing_water_column", "time.end=1.2")) == []


@pytest.mark.slow
def test_a_column_on_the_moon_is_late():  # the twin that must fail
    columns = series("collapsing_water_column", "gravity=1.62", "time.end=0.7")
    assert len(missed("collapsing_water_column", columns)) == 2


def test_pushed_and_viscous_columns_run():
    # Figures 6 and 7 of Maeda & Sakai 2004: the face starts at √(2g(H-y)); a viscosity that shows in 0.2 s.
    short = ("time.end=0.2", "numerics.spacing=0.1", "water.push=face")
    thin, thick = (series("collapsing_water_column", *short, f"water.viscosity={mu}") for mu in (1e-3, 30.0))
    assert thick["front (m)"][-1] < thin["front (m)"][-1]
    released = series("collapsing_water_column", *short[:2])
    assert thin["front (m)"][-1] > released["front (m)"][-1] + 0.05  # half a spacing


def lines(*settings):
    """Columns of series.csv and phreatic.csv of the dry levee, changed by ``settings``."""
    model = Simulation(load(CASES / "dry_levee", Scene, overrides=settings))
    rows = []
    while model.time < 7.0:
        model.advance(100)
        rows.append(model.series() | model.tables()["phreatic"])
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


@pytest.mark.slow
def test_a_line_sags_in_a_dry_levee_as_long_as_the_river_rises():
    assert missed("dry_levee", lines()) == []


@pytest.mark.slow
def test_after_a_sudden_rise_the_line_does_not_sag():  # the twin that must fail
    columns = lines("reservoir.0.rise=[[0, 0.12], [0.5, 0.28]]")
    assert "the line sags while its foot is under the slope" in missed("dry_levee", columns)
