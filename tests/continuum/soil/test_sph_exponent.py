"""A column that settles under its weight from no stress, of soil whose stiffness grows with stress."""

import numpy as np
import pytest

from continuum_sph import Scene
from continuum_sph.builders.parts.soil import material_of
from continuum_sph.builders.simulation import Simulation
from porescale.common.core.constants import GRAVITY
from porescale.common.schema.sections import validate

HEIGHT, END = 0.5, 0.8


def settlement(rows: int, **numerics: float) -> float:
    """That of the upmost row over the exact one: of strains, the integral of 1/M up to the stress at each height."""
    spacing = HEIGHT / rows
    width = 8 * spacing
    scene = validate(Scene, {
        "tank": {"width": width, "height": 2 * HEIGHT}, "time": {"end": END},
        "output": {"snapshot_interval": END, "series_interval": END}, "numerics": {"spacing": spacing},
        "soil": {
            "stiffness": 2e6, "exponent": 0.5, "elastic": True, "stress": "none",
            "numerics": {"settle": 0.6, **numerics},
            "body": [{"outline": [[0, 0], [width, 0], [width, HEIGHT], [0, HEIGHT]]}],
        },
    })  # fmt: skip
    simulation, material = Simulation(scene), material_of(scene.soil)
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


def test_few_rows_settle_too_little_while_stress_diffuses_and_fully_without():
    # As the section of soil says: 25 % of 12 rows, 15 % of 24 and 9 % of 48.
    coarse, fine = (1.0 - settlement(rows) for rows in (12, 24))
    assert 0.2 < coarse < 0.3
    assert 0.5 < fine / coarse < 0.66
    # A strain of the lowest and upmost half row, which gradients at a floor and a surface have to a fifth: 0.4 of 12.
    assert settlement(12, stress_diffusion=0.0) == pytest.approx(1.0, abs=0.4 / 12)
