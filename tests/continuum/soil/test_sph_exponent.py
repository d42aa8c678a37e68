"""A column that settles under its weight from no stress, of soil whose stiffness grows with stress."""

import numpy as np
import pytest

from continuum_sph import Scene
from continuum_sph.builders.parts.soil import material_of, soil_law
from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from porescale.common.core.constants import GRAVITY
from porescale.common.schema.sections import validate

HEIGHT, END = 0.5, 0.8


def scene(rows: int, **numerics: float) -> Scene:
    """A column of so many rows without stress, and with ``numerics``."""
    spacing = HEIGHT / rows
    width = 8 * spacing
    return validate(Scene, {
        "tank": {"width": width, "height": 2 * HEIGHT}, "time": {"end": END},
        "output": {"snapshot_interval": END, "series_interval": END}, "numerics": {"spacing": spacing},
        "soil": {
            "stiffness": 2e6, "exponent": 0.5, "elastic": True, "stress": "none",
            "numerics": {"settle": 0.6, **numerics},
            "body": [{"outline": [[0, 0], [width, 0], [width, HEIGHT], [0, HEIGHT]]}],
        },
    })  # fmt: skip


def settlement(rows: int, **numerics: float) -> float:
    """That of the upmost row over the exact one: of strains, the integral of 1/M up to the stress at each height."""
    given, spacing = scene(rows, **numerics), HEIGHT / rows
    assert given.soil is not None
    simulation, material = Simulation(given), material_of(given.soil)
    start = simulation.positions[:, 1]
    top = start > start.max() - 0.1 * spacing
    simulation.run(until=END)
    depth = np.linspace(HEIGHT, 0.5 * spacing, 400)
    strain = []
    for stress in material.density * GRAVITY * depth:
        mean = 0.5 * (1 + material.rest) * np.linspace(0.0, stress, 200)
        softness = [material.stiffness / (material.column_modulus * material.stiffness_at(it)) for it in mean]
        strain.append(np.trapezoid(softness, dx=stress / 199))
    exact = np.trapezoid(strain, dx=depth[0] - depth[1])
    return float((start - simulation.positions[:, 1])[top].mean() / exact)


def test_stress_diffuses_only_when_the_weight_is_on():
    """It diffused from the start: 25 % of 12 rows and 15 % of 24 were missing."""
    # A strain of the lowest and upmost half row, which gradients at a floor and a surface have to a fifth: 0.4 of 12.
    assert settlement(12) == pytest.approx(1.0, abs=0.4 / 12)
    for rows in (12, 24):  # what diffuses after that changes nothing: a tenth of it
        assert settlement(rows) == pytest.approx(settlement(rows, stress_diffusion=0.0), abs=0.04 / rows)
    assert settlement(12, settle=0.3) < 1.0 - 0.08  # the check that must fail: it is half on, and then diffuses


def test_without_settling_check_warns_and_a_given_diffusion_is_kept():
    assert [it for it in report(scene(12, settle=0.0)).warnings if "comes on" in it]
    assert not [it for it in report(scene(12)).warnings if "comes on" in it]
    assert soil_law(scene(12)).level_from == 0.6
    assert soil_law(scene(12, stress_diffusion=100.0)).level_from == 0.0
