"""What a body force can drive is held back by all that stays where it is: turning discs and held polygons, too."""

import math
from typing import Any

import pytest

from porescale import Scene
from porescale.builders.checks.flows import forced_speed
from porescale.builders.derive import derive
from porescale.common.schema.sections import validate

SIDE, DIAMETER, FORCE, END = 0.03, 0.012, 0.5, 1e4
PLACE = {"x": 0.0151, "y": 0.0147}
SIDES = 200


def speed(**bodies: Any) -> float:
    """The speed (m/s) that a force along x can drive in a box that is periodic both ways."""
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
    scene = validate(Scene, {
        "gravity": [0, 0],
        "domain": {"width": SIDE, "height": SIDE, **sides},
        "time": {"end": END},
        "output": {"snapshot_interval": 1, "series_interval": 1},
        "fluid": {"viscosity": 1e-4, "spacing": 1e-3, "relaxation_time": 0.8, "body_force": [FORCE, 0]},
        **bodies,
    })  # fmt: skip
    scales = derive(validate(Scene, scene.to_dict() | {"time": {"end": 1}})).scales
    assert scales
    return forced_speed(scene, scales)


def disc(**motion: Any) -> dict[str, Any]:
    """A disc whose motion is prescribed."""
    return {"disc": [{**PLACE, "diameter": DIAMETER, **motion}]}


def test_a_disc_that_turns_on_the_spot_holds_back_what_one_at_rest_does():
    stands = speed(**disc())
    assert stands < 1e-3 * FORCE * END / 1000
    assert speed(**disc(spin=0.2)) == speed(**disc(turning={"amplitude": 1, "frequency": 2})) == stands
    # The check that must fail: one that goes along holds nothing back.
    assert speed(**disc(velocity=[1e-5, 0])) == speed() == FORCE * END / 1000


def test_a_held_polygon_holds_back_what_its_disc_does():
    # A regular polygon of n corners lacks 2/3 (pi/n)^2 of its circle's area, and 1/2 (pi/n)^2 of its width.
    one = {"sides": SIDES, "diameter": DIAMETER, "thickness": 1e-9, "at": [[PLACE["x"], PLACE["y"]]], "angle": [0.3]}
    grains = {
        "grains": {"density": 2000, "hydraulic_radius_ratio": 1},
        "contact": {"stiffness": 1e4, "restitution": 0.5},
    }
    held = speed(polygon=[one | {"held": True}], **grains)
    assert held == pytest.approx(speed(**disc()), rel=10 * (math.pi / SIDES) ** 2)
    assert speed(polygon=[one], **grains) > 10 * held  # the check that must fail: a free one is carried along


def test_what_a_control_keeps_where_it_is_holds_back_too():
    grains = {
        "grains": {"density": 2000, "hydraulic_radius_ratio": 1, "grain": [{**PLACE, "diameter": DIAMETER}]},
        "contact": {"stiffness": 1e4, "restitution": 0.5},
    }
    still = {"x": {"velocity": 0}, "y": {"velocity": 0}}
    assert speed(control=[{"grain": 0, **still, "rotation": {"velocity": 0.2}}], **grains) == speed(**disc())
    one = {"sides": SIDES, "diameter": DIAMETER, "thickness": 1e-9, "at": [[PLACE["x"], PLACE["y"]]], "angle": [0.3]}
    grains["grains"] = {"density": 2000, "hydraulic_radius_ratio": 1}
    held = speed(polygon=[one | {"held": True}], **grains)
    assert speed(polygon=[one], control=[{"polygon": 0, **still}], **grains) == held
    # The check that must fail: one that is free along y, or moves, may go out of the way.
    assert speed(polygon=[one], control=[{"polygon": 0, "x": {"velocity": 0}}], **grains) > 10 * held
    moves = {"x": {"velocity": 1e-5}, "y": {"velocity": 0}}
    assert speed(polygon=[one], control=[{"polygon": 0, **moves}], **grains) > 10 * held
