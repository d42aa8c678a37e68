"""Soil beside a waterline: at rest nothing goes to the air over the water, and a seepage face above it still leaks."""

import numpy as np
import pytest

from continuum_sph.builders.parts.suction import moist_soil
from continuum_sph.unsaturated.richards import CONTENT, FROM_WATER, HEAD, TO_AIR, Y
from continuum_sph.validation.tanks import tank_scene

PERMEABILITY = 1e-3
SPACING = 0.05


def flow(left, right, crest, seconds=20.0, table=None):
    """(heights, what came from water, what went to air over k ρ t, m), each (s,): of the particles of a held dam 0.5 m
    wide and ``crest`` (m) high between two levels (m)."""
    corners = [[0.5, 0], [1.0, 0], [1.0, crest], [0.5, crest]]
    suction = {"alpha": 15.0, "n": 4.0, "water_table": left if table is None else table}
    soil = {"stiffness": 1e6, "permeability": PERMEABILITY, "body": [{"outline": corners}], "suction": suction}
    pools = [{"left": 0, "right": 0.5, "level": left}, {"left": 1.0, "right": 1.5, "level": right}]
    made = moist_soil(tank_scene(1.5, 1.0, SPACING, water={"sound_speed": 40.0}, soil=soil, reservoir=pools))
    before = made.water.content[:, CONTENT].sum()
    made.water.advance(seconds, made.ground.near, made.outside.outer)
    content = made.water.content
    balance = before + content[:, FROM_WATER].sum() - content[:, TO_AIR].sum()
    assert content[:, CONTENT].sum() == pytest.approx(balance, rel=1e-12)
    scale = 1000.0 * PERMEABILITY * seconds
    return made.water.state[:, Y], content[:, FROM_WATER] / scale, content[:, TO_AIR] / scale


@pytest.mark.parametrize("crest", [0.8, 0.55])  # over a waterline at 0.6 m, under a pond one spacing deep
def test_a_dam_between_equal_levels_loses_nothing(crest):
    """It lost 2 to 13 % of k H, which came in below, round and round."""
    _, taken, given = flow(0.6, 0.6, crest)
    assert given.sum() == 0.0  # no pair of soil and air conducts: not even round-off
    # H is the level but for rounding of p, 2e-16 of c²/g = 160 m, which 100 pieces pass on with a few k each
    assert np.abs(taken).sum() < 1e-10


def test_a_face_above_the_lower_level_still_leaks():
    """The check that must fail: from a dam whose pores stand higher than the water beside it water goes into the air,
    above that water and not below it."""
    y, _, given = flow(0.6, 0.2, 0.8, table=0.5)
    assert given[y > 0.2].sum() > 0.05
    assert given[y < 0.2].sum() == 0.0


def test_a_dry_side_leaks_to_its_foot():
    y, _, given = flow(0.6, 0.0, 0.8, table=0.5)
    assert given[y < SPACING].sum() > 0.0


@pytest.mark.parametrize("head", [0.6, 0.57, 0.63])  # at the surface; under it; above, with no open water on it
def test_full_soil_under_a_level_surface_drains_to_the_surface_and_no_farther(head):
    """It drained by one and a half spacings, till the second row under the surface was at 0."""
    corners = [[0, 0], [0.3, 0], [0.3, 0.6], [0, 0.6]]
    suction = {"alpha": 15.0, "n": 4.0, "water_table": head}
    soil = {"stiffness": 1e6, "permeability": PERMEABILITY, "body": [{"outline": corners}], "suction": suction}
    made = moist_soil(tank_scene(0.3, 0.8, SPACING, water={"sound_speed": 40.0}, soil=soil))
    made.water.advance(10.0, made.ground.near, made.outside.outer)
    # S H²/k = 0.9 s is the time of full pores, n ρ g/K_w = 0.0025/m: e^-10 of 0.03 m is left of what flows, and a step
    # in time passes the end of the outflow, a kink, by 1e-5 m; a hundredth of half a row is far above both
    np.testing.assert_allclose(made.water.state[:, HEAD], min(head, 0.6), atol=0.005 * SPACING)
    given = made.water.content[:, TO_AIR].sum()
    # rounding of p, 2e-16 of c²/g = 160 m, over half a row for 10 s: 1000 k 1e-13 0.3/0.025 10 = 1e-11 kg/m, some times
    assert given > 1e-3 if head > 0.6 else given < 1e-9
