"""What damping bears of a slip: as `check` says, from sums over a lattice whose halves slide past each other."""

import numpy as np
import pytest

from continuum_sph.builders.report import report
from continuum_sph.soil import Material
from continuum_sph.soil.momentum import BRAKED_BY, HELD_BACK
from continuum_sph.validation.soil.setups import body
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.neighbors import square_lattice


def test_the_stress_of_damping_across_a_slip_is_what_check_takes_for_it():
    """All damping of the upper half, in columns amid a block, over the breadth of these; two digits are stated."""
    spacing, speed, damping = 0.1, 1e-3, 0.2
    x = square_lattice((-2.0, -0.5), (2.0, 0.5), spacing)
    material = Material(1e6, 1600.0, yields=False)
    flow = body(x, spacing, material, (0.0, 0.0, 0.0, 0.0), damping=damping)
    flow.soil.v[: len(x), 0] = np.where(x[:, 1] > 0.0, 0.5 * speed, -0.5 * speed)
    flow.begin(0.0)
    flow.strain(0.0)
    flow.push()
    soil = flow.soil
    amid = (x[:, 1] > 0.0) & (np.abs(x[:, 0]) < 1.0)
    stress = -float((soil.mass[: len(x)] * soil.acceleration[:, 0])[amid].sum()) / 2.0
    sound = (material.column_modulus / material.density) ** 0.5
    unit = material.density * damping * sound * flow.law.smoothing.length * speed / spacing
    assert stress / unit == pytest.approx(BRAKED_BY, abs=5e-4)


@pytest.mark.parametrize(
    ("choice", "words"), [("zig-zags", "slip held back by a tenth"), ("bounded", "slip held back by damping")]
)
def test_check_says_what_damping_bears_of_a_slip(choice, words):
    ground = {"body": [level_ground(0.4, 0.3)], "numerics": {"damping_of": choice}}
    groups = report(tank_scene(1.0, 0.5, 0.02, lid=False, soil=ground)).groups
    rows = [row for group in groups.values() for row in group if row.name == words]
    assert len(rows) == 1
    # a tenth of ½ ρ g H sin φ, over 0.055 ρ H √(g H)/Δx
    fast = 0.1 * 0.5 * 9.8 * 0.5 * 0.02 / (BRAKED_BY * (9.8 * 0.3) ** 0.5)
    assert rows[0].value == pytest.approx(HELD_BACK if choice == "bounded" else fast, rel=2e-3)
