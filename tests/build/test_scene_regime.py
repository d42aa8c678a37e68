"""The speed to expect: fall along gravity, rise of what is lighter, and what drives the fluid."""

import math

import pytest

from porescale.builders.checks.regime import column_height, fall, terminal_speed
from porescale.builders.derive import derive
from tests.reference.scenes import column, dry, grain, water

ONE = {"grains": {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.003, 0.002)]}, "gate": None}
DRY = {"grains": {"density": 2500, "grain": [grain(0.003, 0.002)]}, "gate": None}


@pytest.mark.parametrize(
    ("gravity", "reach"),
    [([0, -9.81], 0.002), ([0, 9.81], 0.006), ([-9.81, 0], 0.003), ([9.81, 0], 0.009), ([0, 0], 0.0)],
)
def test_a_dry_grain_falls_along_gravity_to_the_end_of_the_box(gravity, reach):
    # In a box of 12 x 8 mm from (3, 2) mm: v = sqrt(2 g s).
    assert derive(dry(**DRY, gravity=gravity)).speed == pytest.approx(math.sqrt(2 * 9.81 * reach), rel=1e-12)


def test_oblique_gravity_falls_to_the_far_corner():
    # Down and right by 3-4-5: from (3, 2) mm to (12, 0) mm, 9 * 0.6 + 2 * 0.8 = 7 mm along gravity.
    scene = dry(**DRY, gravity=[6.0, -8.0])
    assert fall(scene, 1.0) == (pytest.approx(0.007, rel=1e-12), False)


def test_a_periodic_side_has_no_end_but_the_run_has():
    sides = {"domain__bottom": "periodic", "domain__top": "periodic"}
    assert derive(dry(**DRY, **sides, time__end=0.5)).speed == pytest.approx(9.81 * 0.5, rel=1e-12)
    across = {"domain__left": "periodic", "domain__right": "periodic"}  # across gravity it matters nothing
    assert derive(dry(**DRY, **across)).speed == pytest.approx(math.sqrt(2 * 9.81 * 0.002), rel=1e-12)


def test_a_light_grain_rises():
    # Before, it would have been said to fall by 2 mm; it rises by 6 mm, in water so thin that drag is no matter.
    light = {**ONE["grains"], "density": 900}
    scene = column(grains=light, gate=None, fluid__viscosity=2e-6)
    assert fall(scene, -1.0) == (pytest.approx(0.006, rel=1e-12), False)
    drag = terminal_speed(0.001, 0.1 * 9.81, 2e-6)
    assert derive(scene).speed == pytest.approx(min(math.sqrt(2 * (1000 / 900 - 1) * 9.81 * 0.006), drag), rel=1e-12)


def test_the_height_of_a_packing_is_along_gravity():
    packing = column().grains.packing
    assert column_height(packing, (0.0, -9.81)) == pytest.approx(0.0055, rel=1e-12)
    assert column_height(packing, (-9.81, 0.0)) == pytest.approx(0.004, rel=1e-12)


def test_a_body_force_is_reckoned_with_grains_in_its_way_too():
    # The empty channel, 8 mm between walls: f H^2/(8 rho nu).
    pushed = {"fluid__body_force": [10.0, 0.0], "domain__left": "periodic", "domain__right": "periodic"}
    still = column(**ONE, gravity=[0, 0], **pushed)
    assert derive(still).speed == derive(water()).speed == pytest.approx(10 * 0.008**2 / 0.16, rel=1e-12)
