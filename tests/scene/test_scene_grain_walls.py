"""Walls of dry scenes that move or are pressed on, and free walls: in the grains, in forces.csv, or refused."""

import math
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.report import report
from porescale.common.core.constants import GRAVITY
from porescale.common.schema.sections import scene_as_dict, validate
from tests.reference.scenes import column, grain, warned
from tests.reference.scenes_of_grains import assert_same_bits, lines, loose, resumed

ROWS = [grain(0.0005 + 0.001 * i, 0.0005 + 0.001 * j) for i in range(4) for j in range(2)]
"""Two rows of four grains, as wide as the box of ``boxed``."""
LID = {"kind": "wall", "stress": 100.0, "fastest": 0.01}


def boxed(**changes: Any) -> Scene:
    """The rows in a box of their width."""
    return loose(*ROWS, **{"domain": {"width": 0.004, "height": 0.0021}, "output__forces": True, **changes})


def test_walls_that_stand_leave_the_grains_without_steering():
    simulation = build(boxed())
    assert not simulation.grains.steered
    assert simulation.grains.wall_names == ["left", "right", "bottom", "top"]


def test_a_lid_holds_its_stress_on_what_lies_below():
    simulation = build(boxed(domain__top=LID))
    simulation.advance(round(0.05 / simulation.step_seconds))
    row = simulation.tables()["forces"]
    weight = sum(simulation.grains.discs.mass) * GRAVITY
    # The servo closes on its load in some tens of steps; 50 ms later waves in the grains, which lose a tenth in each
    # half millisecond, are below 0.9^100 = 3e-5 of the load.
    assert row["top wall force y (N/m)"] == pytest.approx(100 * 0.004, rel=1e-4)
    assert row["bottom wall force y (N/m)"] == pytest.approx(-(100 * 0.004 + weight), rel=1e-4)
    lid = row["top wall y (m)"]
    assert 0.00199 < lid < 0.002  # two rows less their overlaps, 100 Pa * 1 mm/2e5 N/m a contact
    assert abs(row["top wall moment (N m/m)"]) < 1e-4 * 0.4 * 0.004


def test_a_stress_between_moving_sides_acts_over_their_distance():
    sides = {"domain__top": LID, "domain__right": {"kind": "wall", "force": 0.2, "fastest": 0.01}}
    simulation = build(boxed(gravity=[0.0, 0.0], contact__friction=0.0, **sides))
    simulation.advance(round(0.05 / simulation.step_seconds))
    row = simulation.tables()["forces"]
    assert row["right wall force x (N/m)"] == pytest.approx(0.2, rel=1e-4)
    assert row["top wall force y (N/m)"] == pytest.approx(100 * row["right wall x (m)"], rel=1e-4)


def test_a_side_moves_as_told():
    moving = {"domain__right": {"kind": "wall", "velocity": ["1 mm/s", 0.0]}}
    simulation = build(boxed(gravity=[0.0, 0.0], **moving))
    simulation.advance(100)
    assert simulation.tables()["forces"]["right wall x (m)"] == pytest.approx(0.004 + 1e-3 * simulation.time, rel=1e-12)
    (said,) = [line for line in str(report(boxed(**moving))).splitlines() if "wall moving at (0.001, 0) m/s" in line]
    assert said


def test_a_grain_rests_on_a_slanted_wall_as_on_a_slope():
    # Without friction it slides at g sin 30 along the wall; the force on the wall is m g cos 30.
    slope = {"name": "slope", "x": 0.002, "y": 0.0, "normal": [-1.0, 3**0.5], "friction": 0.0}
    at = np.array([0.002, 0.0]) + 0.002 * np.array([3**0.5, 1.0]) / 2 + 0.0005 * np.array([-1.0, 3**0.5]) / 2
    simulation = build(loose(grain(*at.tolist()), wall=[slope], output__forces=True, contact__restitution=0.2))
    mass = simulation.grains.discs.mass[0]
    simulation.advance(round(0.015 / simulation.step_seconds))
    row, speed = simulation.tables()["forces"], float(np.hypot(*simulation.grains.discs.velocity[0]))
    # It starts without overlap: the bounce has died down by 0.2 a contact of 0.4 ms, 0.2^30.
    assert math.hypot(row["slope force x (N/m)"], row["slope force y (N/m)"]) == pytest.approx(
        mass * GRAVITY * 3**0.5 / 2, rel=1e-6
    )
    # Half a step of lag: 1e-3 of 15 ms at a step of 2e-5 s.
    assert speed == pytest.approx(0.5 * GRAVITY * simulation.time, rel=2e-3)


def test_a_free_wall_turns_and_moves():
    wall = {"x": 0.0, "y": 0.0, "normal": [0.0, 2.0], "turning": [[0, 0], [0.01, 10.0]], "velocity_y": -0.1}
    simulation = build(loose(grain(0.006, 0.006), gravity=[0.0, 0.0], wall=[wall], output__forces=True))
    steps = round(0.01 / simulation.step_seconds)
    simulation.advance(steps)
    row = simulation.tables()["forces"]
    # The middle of each step of a straight line: exact, 1/2 * 1000 t^2, but for what lies past the table's end.
    assert row["wall 0 direction of normal (rad)"] == pytest.approx(math.pi / 2 + 500 * simulation.time**2, rel=1e-3)
    assert row["wall 0 y (m)"] == pytest.approx(-0.1 * simulation.time, rel=1e-12)


def test_walls_are_taken_up_again_to_the_bit():
    wall = {"x": 0.0, "y": 0.0, "normal": [1.0, 5.0], "turning": {"amplitude": 0.5, "frequency": 100}}
    scene = boxed(domain={"width": 0.004, "height": 0.004, "top": LID}, output__energy=True, gravity=[0.0, 0.0],
                  grains__grain=[{**it, "y": it["y"] + 0.001} for it in ROWS], wall=[wall])  # fmt: skip
    assert_same_bits(*resumed(scene, 300, 300))
    assert validate(Scene, scene_as_dict(scene)) == scene


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"domain__top": {"kind": "wall", "stress": 100}}, "domain.top.fastest: is missing"),
        ({"domain__top": {"kind": "wall", "fastest": 1}}, "domain.top.fastest = 1.0 m/s: belongs"),
        ({"domain__top": {**LID, "force": 1.0}}, "domain.top.force: a wall has one of velocity, stress and force"),
        ({"domain__top": {**LID, "kind": "slip"}}, 'domain.top.stress: belongs to a side of kind "wall"'),
        ({"domain__top": {**LID, "stress": "1 m"}}, "domain.top.stress = '1 m': 'm' does not measure"),
        ({"wall": [{"x": 0, "y": 0, "normal": [0, 0]}]}, "wall[0].normal = '(0, 0)': has no length"),
        ({"wall": [{"x": 0, "y": 0, "normal": [0, 1], "stress": 1, "fastest": 1}]}, "wall[0].length: is needed"),
        ({"wall": [{"x": 0, "y": 0, "normal": [0, 1], "name": "top"}]}, "wall[0].name = 'top': is taken"),
        (
            {"gate": {"x": 0.005}, "wall": [{"x": 0, "y": 0, "normal": [0, 1], "name": "gate"}]},
            "wall[0].name = 'gate': is taken",
        ),
        (
            {
                "rectangle": [{"lower": [0, 0], "upper": [0.001, 0.001]}],
                "wall": [{"x": 0, "y": 0, "normal": [0, 1], "name": "rectangle 0"}],
            },
            "wall[0].name = 'rectangle 0': is taken",
        ),
        ({"wall": [{"x": 0.002, "y": 0, "normal": [1, 0]}]}, "grains.grain[0] = '(0.002, 0.002)': stands across or"),
        (
            {"wall": [{"x": 0, "y": 0, "normal": [0, 1], "velocity_x": "1 s"}]},
            "wall[0].velocity_x = '1 s': 's' does not measure",
        ),
    ],
)
def test_walls_that_make_no_sense_are_refused(changes, line):
    assert lines(**changes)[0].startswith(line), lines(**changes)


def test_walls_that_move_are_not_for_wet_scenes():
    said = lines(fluid={"viscosity": 2e-5, "spacing": 0.0002, "step": 4e-5}, grains__hydraulic_radius_ratio=1.0,
                 domain__top=LID, wall=[{"x": 0, "y": 0, "normal": [0, 1]}])  # fmt: skip
    assert [line.partition(";")[0] for line in said] == ["domain.top: is for dry grains", "wall[0]: is for dry grains"]


@pytest.mark.parametrize("kind", ["velocity", "pressure"])
def test_a_side_that_lets_fluid_pass_is_not_for_dry_scenes(kind):
    # It stood still as a wall, and its numbers had no effect, without a word.
    numbers = {"velocity": [0.01, 0.0]} if kind == "velocity" else {"pressure": 10.0}
    (line,) = lines(domain__left={"kind": kind, **numbers})
    assert line.startswith(f"domain.left = '{kind}': is for a fluid, and there is none; write \"wall\"")


def test_a_side_that_slides_for_the_fluid_is_said_to_stand_for_grains():
    # Grains lay still on it, dry, and were held back by it under water, without a word.
    belt = {"kind": "wall", "speed": 0.1}
    (line,) = lines(domain__bottom=belt)
    assert line.startswith("domain.bottom.speed = 0.1 m/s: is felt by a fluid alone, and there is none; write velocity")
    said = "domain.bottom is felt by the fluid alone: grains do not feel it move"
    assert warned(column(domain__bottom=belt, fluid__step=1e-5), said)
    assert not warned(column(), said)  # the check that must fail
