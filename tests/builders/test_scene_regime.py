"""The speed to expect: fall along gravity, rise of what is lighter, and what drives the fluid."""

import math

import pytest

from porescale.builders.build import build
from porescale.builders.checks.regime import column_height, fall, terminal_speed
from porescale.builders.derive import derive
from porescale.builders.initial.frames import placed_frames
from porescale.builders.initial.placed import controls_by_hand
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from tests.reference.scenes import column, dry, grain, warned, water

ONE = {"grains": {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.003, 0.002)]}, "gate": None}
DRY = {"grains": {"density": 2500, "grain": [grain(0.003, 0.002)]}, "gate": None}
LONG = {"time__end": 100.0}
PERIODIC = {"domain__bottom": "periodic", "domain__top": "periodic"}
PACKING = {"left": 0.0, "width": 0.012, "height": 0.008, "diameter": 0.0008}
FORCES = """import math

import porescale as ps


@ps.body_force
def steady(x, y):
    return 10.0, 0.0


@ps.body_force
def kolmogorov(x, y):
    return 10.0 * math.sin(2.0 * math.pi * y / 0.008), 0.0
"""


def pushed(force=(10.0, 0.0), along="x", **changes):
    """A long channel between walls, periodic along x or y, under a body force."""
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "wall")
    ends = ("left", "right") if along == "x" else ("bottom", "top")
    sides = {f"domain__{name}": "periodic" if name in ends else kind for name, kind in sides.items()}
    given = {f"domain__{key}": changes.pop(key) for key in ("width", "height") if key in changes}
    return water(**{**LONG, **sides, "gravity": [0, 0], "fluid__body_force": force, **given, **changes})


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


STILL = {"x": {"velocity": 0}, "y": {"displacement": 0}, "rotation": {"velocity": 0}}


def test_what_is_prescribed_along_gravity_does_not_fall():
    # Said to fall with 0.2 m/s before, in water and dry; across gravity alone, or pushed, it falls.
    still = [{"grain": 0, **STILL}]
    assert derive(dry(**DRY, control=still)).speed == derive(column(**ONE, control=still)).speed == 0.0
    for free in ({"x": {"velocity": 0}}, {"y": {"force": 0.1}}, {}):
        falls = derive(dry(**DRY, control=[{"grain": 0, **free}])).speed
        assert falls == pytest.approx(math.sqrt(2 * 9.81 * 0.002), rel=1e-12)
    two = {"density": 2500, "grain": [grain(0.003, 0.002), grain(0.009, 0.004)]}
    assert derive(dry(grains=two, control=still)).speed == pytest.approx(math.sqrt(2 * 9.81 * 0.004), rel=1e-12)
    sides = {"domain__bottom": "periodic", "domain__top": "periodic"}  # nor for ever
    assert derive(dry(**DRY, **sides, control=still)).speed == 0.0


def test_a_prescribed_clump_or_polygon_does_not_fall():
    # Numbers count bodies, not discs.
    clump = {"discs": [[-0.0003, 0, 0.0004], [0.0003, 0, 0.0004]], "at": [[0.003, 0.002], [0.003, 0.006]]}
    polygon = {"corners": [[0, 0], [0.001, 0], [0.001, 0.001]], "at": [[0.008, 0.003]], "thickness": 1e-4}
    bodies = {"grains": {"density": 2500}, "clump": [clump], "polygon": [polygon]}
    upper = dry(**bodies, control=[{"clump": 1, **STILL}, {"polygon": 0, **STILL}])
    assert fall(upper, 1.0, placed_frames(upper))[0] == pytest.approx(0.002, rel=1e-12)
    assert fall(dry(**bodies), 1.0)[0] == pytest.approx(0.006, rel=1e-12)
    every = dry(**bodies, control=[{"clump": k, **STILL} for k in range(2)] + [{"polygon": 0, **STILL}])
    assert fall(every, 1.0, placed_frames(every)) == (0.0, False)


def test_a_held_body_that_its_control_leaves_free_is_as_one_that_is_not_held():
    # A rod 6 mm up was not reckoned with: it went half of its thickness in a step, and the run stopped.
    rod = {"chain": [[0.002, 0.006], [0.004, 0.006]], "thickness": 1e-4}
    grains, pushed = {"density": 2500}, [{"segment": 0, "x": {"force": 1e-3}}]
    held, loose = (dry(grains=grains, segment=[rod | more], control=pushed) for more in ({"held": True}, {}))
    assert fall(held, 1.0, placed_frames(held)) == fall(loose, 1.0, placed_frames(loose)) == (0.006, False)
    assert derive(held).contact_step == derive(loose).contact_step
    still = dry(grains=grains, segment=[rod | {"held": True}], control=[{"segment": 0, **STILL}])
    assert fall(still, 1.0, placed_frames(still)) == (0.0, False)  # the check that must fail


def test_grains_placed_by_hand_are_numbered_after_those_of_the_packing():
    scene = column(grains__grain=[grain(0.003, 0.002)], control=[{"grain": 31, **STILL}])
    assert build(scene).grains.discs.position[31] == pytest.approx([0.003, 0.002], abs=1e-15)
    assert controls_by_hand(scene) == list(scene.control)
    packed = column(grains__grain=[grain(0.003, 0.002)], control=[{"grain": 30, **STILL}])
    assert controls_by_hand(packed) == [None]


def test_the_height_of_a_packing_is_along_gravity():
    packing = column().grains.packing
    assert column_height(packing, (0.0, -9.81)) == pytest.approx(0.0055, rel=1e-12)
    assert column_height(packing, (-9.81, 0.0)) == pytest.approx(0.004, rel=1e-12)


def test_a_body_force_is_reckoned_with_grains_in_its_way_too():
    # The empty channel, 8 mm from a wall to a top without friction: f H^2/(2 rho nu).
    pushed = {"fluid__body_force": [10.0, 0.0], "domain__left": "periodic", "domain__right": "periodic", **LONG}
    still = column(**ONE, gravity=[0, 0], **pushed)
    assert derive(still).speed == derive(water(**LONG)).speed == pytest.approx(10 * 0.008**2 / 0.04, rel=1e-12)


def test_the_speed_under_a_body_force_is_that_between_the_walls_across_it():
    # Channels of 12 mm, and of 8 mm: with the shorter side of the box instead, the first would be 2.25 times too slow.
    along_x, along_y = pushed(force=[10.0, 0.0], width=0.004), pushed(force=[0.0, 10.0], along="y", height=0.004)
    assert derive(along_x).speed == pytest.approx(10 * 0.008**2 / 0.16, rel=1e-12)
    assert derive(along_y).speed == pytest.approx(10 * 0.012**2 / 0.16, rel=1e-12)
    # Soon after the start nothing has slowed the fluid down: f t/rho.
    assert derive(pushed(time__end=0.01)).speed == pytest.approx(10 * 0.01 / 1000, rel=1e-12)


def test_nothing_slows_down_what_a_body_force_drives_through_a_periodic_box():
    simulation = build(free := pushed(**PERIODIC, fluid__velocity=[0.001, 0.0], time__end=0.2))
    simulation.run()
    # Velocities hold half of the next step's force.
    speed = simulation.series()["largest fluid speed (m/s)"]
    assert derive(free).speed == pytest.approx(0.001 + 10 * 0.2 / 1000, rel=1e-12)
    assert speed == pytest.approx(0.003 + 0.5 * 4e-5 * 10 / 1000, rel=1e-9)
    with pytest.raises(InputError, match=r"a speed of 2 m/s is to be expected, Mach 0\.69"):
        derive(pushed(**PERIODIC, time__end=200.0))
    # Between closed ends pressure balances it.
    still = pushed(force=[10.0, 0.0], domain__left="wall", domain__right="wall")
    assert derive(still).speed == 0.0


@pytest.mark.parametrize("diameter", [0.0016, 0.004])
def test_held_discs_in_a_periodic_box_slow_the_fluid_down(diameter):
    # Of a square array; the estimate is an upper one, of the right size: it takes the sum of two flows.
    held = {"disc": [{"x": 0.004, "y": 0.004, "diameter": diameter}], "fluid__body_force": [1.0, 0.0]}
    scene = pushed(**PERIODIC, **held, domain__width=0.008, time__end=1.0)
    simulation = build(scene)
    simulation.run()
    assert 1.0 < derive(scene).speed / simulation.series()["largest fluid speed (m/s)"] < 3.0


def test_a_plate_that_stands_in_a_periodic_box_is_a_wall():
    plate = {"lower": [0.0, 0.003], "upper": [0.012, 0.005]}
    assert derive(pushed(**PERIODIC, rectangle=[plate])).speed == pytest.approx(10 * 0.006**2 / 0.16, rel=1e-12)


def test_a_force_that_bears_free_grains_drives_only_what_goes_past_them():
    # Sedimentation in a periodic box: the force takes the buoyant weight of all grains, 40 % of the box: phi G (s - 1).
    packing = {**PACKING, "packing_fraction": 0.4, "settle": False}
    grains = {"density": 2500, "hydraulic_radius_ratio": 1.0, "packing": packing}
    force = [0.0, 0.4 * 1500 * 9.81]
    sides = {f"domain__{name}": "periodic" for name in ("left", "right", "bottom", "top")}
    scene = column(gate=None, grains=grains, **sides, fluid__body_force=force, fluid__step=1e-5)
    alone = column(gate=None, grains=grains, **sides, fluid__step=1e-5)
    assert derive(scene).speed < 2 * derive(alone).speed


@pytest.mark.parametrize(("law", "speed"), [("kolmogorov", 10 * 0.008**2 / 0.16), ("steady", 10 * 0.2 / 1000)])
def test_a_force_of_ones_own_without_a_mean_has_the_parabola(law, speed, tmp_path):
    (tmp_path / "laws.py").write_text(FORCES, encoding="utf-8")
    scene = pushed(force=f"{tmp_path / 'laws.py'}:{law}", **PERIODIC, time__end=2e-1 if law == "steady" else 1e3)
    assert derive(scene).speed == pytest.approx(speed, rel=0.02)  # places of looks miss the peak by 1/32 of a period


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


def test_what_is_filled_before_a_shut_gate_is_warned_of_and_refused():
    # 0.01 m/s for 0.03 s into 6 mm, though beyond the gate there is an outlet; an inflow beyond it lets nothing out.
    def gated(opens_at, **more):
        return water(**{**INLET, **more}, gate={"x": 0.006, "opens_at": opens_at})

    (line,) = warned(gated(0.03, domain__right="pressure"), "let 0.05 of the fluid in left of the gate while it is")
    assert line.endswith('make one { kind = "pressure", pressure = 0 }')
    sucked = {"domain__left": "pressure", "domain__right": {"kind": "velocity", "velocity": [0.1, 0.0]}}
    with pytest.raises(InputError, match=r"^domain: the sides let 0\.5 of the fluid out right of the gate"):
        derive(gated(0.03, **sucked))
    # The twins: open from the start on, and open on its own side.
    assert not warned(gated(0.0, domain__right="pressure"), "let ")
    assert not warned(gated(0.03, domain__right="pressure", domain__left="pressure"), "let ")


@pytest.mark.parametrize("right", ["pressure", {"kind": "velocity", "velocity": [0.01, 0.0]}])
def test_what_is_let_out_again_is_not_warned_of(right):
    assert not warned(water(**INLET, domain__right=right), "let ")


def test_gravity_down_a_periodic_channel_is_said_to_drive_no_fluid():
    down = {"gravity": [1.0, -9.81], "domain__left": "periodic", "domain__right": "periodic"}
    (line,) = warned(water(**down, fluid__body_force=None), "gravity along x")
    assert line.endswith("fluid.body_force = [1000, 0] drives it, [0, 0] leaves it still")
    simulation = build(water(**down, fluid__body_force=None))
    simulation.advance(20)
    assert simulation.series()["largest fluid speed (m/s)"] == 0.0
    for given in ([10.0, 0.0], [0.0, 0.0]):
        assert not warned(water(**down, fluid__body_force=given), "gravity along x")
    assert not warned(water(**{**down, "gravity": [0.0, -9.81]}, fluid__body_force=None), "gravity along x")
    sinking = {"domain__bottom": "periodic", "domain__top": "periodic"}
    assert not warned(column(**ONE, **sinking), "gravity along y")


def test_grains_that_sink_for_ever_in_fluid_that_nothing_holds_are_warned_of():
    """In a box that is periodic both ways grains take the fluid along, and both fall faster and faster."""
    sides = dict.fromkeys((f"domain__{name}" for name in ("left", "right", "bottom", "top")), "periodic")
    (line,) = warned(column(**ONE, **sides), "nothing holds the fluid along y")
    force = [float(value) for value in line.partition(" = [")[2].partition("]")[0].split(", ")]
    gained = float(line.partition("both gain ")[2].partition(" m/s")[0])

    def speeds(**changes):
        """Momentum over mass (m/s) of fluid and grain, and the time (s), after 400 steps."""
        scene = column(**ONE, **sides, **changes)
        simulation = build(scene)
        simulation.advance(400)
        area, fluid = scene.domain.width * scene.domain.height, scene.fluid.density
        (mass,), (radius,) = simulation.masses, simulation.radii
        rest = mass - fluid * math.pi * radius**2  # the fluid's field holds what moves inside the grain
        pushed = fluid * area * simulation.field("velocity_y").mean() + rest * simulation.velocities[0, 1]
        return pushed / (fluid * area + rest), simulation.time

    free, time = speeds()
    assert -free == pytest.approx(gained * time, rel=0.05)  # printed with two digits; covered cells differ by a part
    balanced, _ = speeds(fluid__body_force=force)
    assert abs(balanced) < 0.05 * abs(free)
    assert not warned(column(**ONE, **sides, fluid__body_force=force), "nothing holds")
    for held in ({"domain__left": "wall", "domain__right": "slip"}, {"disc": [grain(0.009, 0.002)]}):
        assert not warned(column(**ONE, **(sides | held)), "nothing holds")


def test_a_held_disc_of_too_few_cells_is_warned_of_beside_free_grains_too():
    """Free grains alone were judged where there are any."""
    tiny = {"disc": [{"x": 0.009, "y": 0.004, "diameter": 1e-4}]}
    (line,) = warned(column(**ONE, **tiny), "the smallest held disc has")
    assert line.partition("has ")[2] in warned(water(**tiny), "cells per diameter")  # as it is said of one alone
    assert not warned(column(**ONE, disc=[{"x": 0.009, "y": 0.004, "diameter": 2e-3}]), "held disc")


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
