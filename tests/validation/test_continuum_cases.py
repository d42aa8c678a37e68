"""The continuum's cases do what their expected.toml says, at their default quality."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from continuum_sph.scene.model import Simulation
from continuum_sph.scene.sections import Scene
from porescale.workbench.sections import load

CASES = Path(__file__).resolve().parents[2] / "cases"


def series(case, *settings):
    """Columns of a case's series, a row every 20 steps and at the end."""
    scene = load(CASES / case, Scene, overrides=settings)
    model = Simulation(scene)
    rows = [model.series()]
    while model.time < scene.time.end:
        model.advance(20)
        model.check()
        rows.append(model.series())
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def missed(case, columns):
    """Names of the expectations of ``case`` that ``columns`` do not meet."""
    names = []
    for row in tomllib.loads((CASES / case / "expected.toml").read_text(encoding="utf-8"))["expected"]:
        values, at = columns[row["column"]], row["at"]
        value = {"end": values[-1], "max": values.max()}.get(at) if isinstance(at, str) else None
        value = np.interp(at, columns["time (s)"], values) if value is None else value
        if not abs(value - row["value"]) <= row["tolerance"]:
            names.append(row["name"])
    return names


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
    # Figures 6 and 7 of the paper as printed: the face starts at √(2g(H-y)); a viscosity that shows in 0.2 s.
    short = ("time.end=0.2", "numerics.spacing=0.1", "water.push=face")
    thin, thick = (series("collapsing_water_column", *short, f"water.viscosity={mu}") for mu in (1e-3, 30.0))
    assert thick["front (m)"][-1] < thin["front (m)"][-1]
    released = series("collapsing_water_column", *short[:2])
    assert thin["front (m)"][-1] > released["front (m)"][-1] + 0.05  # half a spacing
