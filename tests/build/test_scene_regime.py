"""The speed to expect: fall along gravity, rise of what is lighter, and what drives the fluid."""

import math

import pytest

from porescale.builders.build import build
from porescale.builders.checks.regime import column_height, fall, terminal_speed
from porescale.builders.derive import derive
from porescale.builders.report import report
from porescale.common.core.errors import InputError
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


def warned(scene, word):
    """The warnings with a word in them."""
    return [line for line in derive(scene).warnings if word in line]


INLET = {"domain__left": {"kind": "velocity", "velocity": [0.01, 0.0]}, "fluid__body_force": None, "time__end": 0.06}


def test_a_box_that_is_filled_and_has_no_outlet_is_warned_of_and_refused():
    # 0.01 m/s for 0.06 s into 12 mm: a twentieth of its fluid, and so much denser does it get.
    (line,) = warned(water(**INLET, domain__right="wall"), "let 0.05 of the fluid in")
    simulation = build(water(**INLET, domain__right="wall"))
    simulation.run()
    assert simulation.series()["fluid mass change ()"] == pytest.approx(0.05, rel=0.01)
    assert line.endswith('make one { kind = "pressure", pressure = 0 }')
    with pytest.raises(InputError, match=r"^domain: the sides let 0\.5 of the fluid in until time\.end, and none"):
        derive(water(**{**INLET, "time__end": 0.6}, domain__right="wall"))


@pytest.mark.parametrize("right", ["pressure", {"kind": "velocity", "velocity": [0.01, 0.0]}])
def test_what_is_let_out_again_is_not_warned_of(right):
    assert not warned(water(**INLET, domain__right=right), "let ")


def test_gravity_down_a_periodic_channel_is_said_to_drive_no_fluid():
    down = {"gravity": [1.0, -9.81], "domain__left": "periodic", "domain__right": "periodic"}
    (line,) = warned(water(**down, fluid__body_force=None), "gravity along x")
    assert line.endswith("fluid.body_force = [1000, 0] drives it")
    simulation = build(water(**down, fluid__body_force=None))
    simulation.advance(20)
    assert simulation.series()["largest fluid speed (m/s)"] == 0.0
    assert not warned(water(**down, fluid__body_force=[10.0, 0.0]), "gravity along x")
    assert not warned(water(**{**down, "gravity": [0.0, -9.81]}, fluid__body_force=None), "gravity along x")
    sinking = {"domain__bottom": "periodic", "domain__top": "periodic"}
    assert not warned(column(**ONE, **sinking), "gravity along y")


def test_a_relaxation_time_at_which_no_flow_begins_right_is_warned_of():
    channel = {"domain__left": "periodic", "domain__right": "periodic", "gravity": [0, 0], "fluid__body_force": None}
    (line,) = warned(water(**channel, fluid__step=1e-2), "relaxation time")
    step = float(line.partition("a step of ")[2].partition(" s")[0])
    assert not warned(water(**channel, fluid__step=step), "relaxation time")


def test_check_says_how_high_a_grain_bounces_from_a_wall():
    # The dashpot is that of two mean grains, whose reduced mass is half of one: a grain bounces higher from a wall.
    contact = {"stiffness": 1e6, "restitution": 0.6, "friction": 0.0, "step": 1e-7}  # a thousandth of a contact
    one = {"density": 2500, "grain": [{**grain(0.003, 0.002), "velocity": [0.0, -0.1]}]}
    scene = dry(grains=one, gravity=[0, 0], contact=contact)
    rows = {row["name"]: row["value"] for group in report(scene).as_dict()["groups"].values() for row in group}
    assert rows["restitution of a pair"] == pytest.approx(0.6, rel=1e-9)
    simulation = build(scene)
    simulation.run(until=0.02)
    assert simulation.velocities[0, 1] / 0.1 == pytest.approx(rows["restitution at a wall"], abs=3e-3)
    assert rows["restitution at a wall"] > 0.65
