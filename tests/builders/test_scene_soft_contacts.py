"""Contacts that are too soft for a fall: warned of with the stiffness that suffices, where a run would stop."""

import math
from typing import Any

import pytest

from porescale.builders.build import build
from porescale.common.core.errors import Unstable
from porescale.dem.measures.survey import max_overlap
from porescale.scene.scene import Scene
from tests.reference.scenes import column, dry, grain, warned

FALL = math.sqrt(2 * 9.81 * 0.0055)
"""Speed (m/s) of the grain below as it comes to the floor: from 6 mm, with a radius of 0.5 mm."""
UNDAMPED = math.pi * 2500 * (FALL / 0.3) ** 2
"""Stiffness (N/m) of which the overlap v sqrt(m/k) is 0.3 of the radius, with m = pi R² rho."""
SPRING: dict[str, Any] = {"restitution": 1.0, "friction": 0.0}
HERTZ: dict[str, Any] = {"law": "hertz", "poisson": 0.3, "restitution": 1.0, "friction": 0.0}


def falling(contact: dict[str, Any], **changes: Any) -> Scene:
    """One dry grain that falls onto the floor."""
    grains = {"density": 2500, "grain": [grain(0.006, 0.006)]}
    return dry(**{"grains": grains, "contact": contact, "time__end": 0.1, **changes})


def soft(scene: Scene) -> list[str]:
    """The warnings of contacts that are too soft."""
    return warned(scene, "too soft")


def deepest(scene: Scene) -> float:
    """Largest overlap over the radius during the first impact, looked at in each step."""
    model, most = build(scene), 0.0
    while model.time < 0.05 and not (most and max_overlap(model.grains).share == 0.0):
        model.advance(1)
        most = max(most, max_overlap(model.grains).share)
    return most


@pytest.mark.parametrize(
    ("contact", "key", "enough"),
    [
        (SPRING, "stiffness", UNDAMPED),
        # Half the restitution, h = 0.235 where a contact ends without force: exp(-h arccos(h)/sqrt(1 - h²)) = 0.727.
        ({**SPRING, "restitution": 0.5}, "stiffness", None),
        (HERTZ, "young", None),
    ],
)
def test_the_stiffness_that_suffices_is_that_of_the_impact(contact, key, enough):
    (line,) = soft(falling({**contact, key: 1e3}))
    said = float(line.partition(f"contact.{key} = ")[2].split()[0])
    assert line.startswith("contacts are too soft: a grain at 0.33 m/s, which is to be expected, presses one by ")
    if enough:
        assert enough <= said < 1.12 * enough
    assert not soft(falling({**contact, key: said}))
    # And the impact is as deep: 6 % and the rounding of two digits, to the power of 1/2, above 0.3 of the radius.
    assert 0.275 < deepest(falling({**contact, key: said})) < 0.3


def test_a_run_with_contacts_that_are_too_soft_stops():
    with pytest.raises(Unstable, match=r"(overlap with|distance to) the bottom wall"):
        build(falling({**SPRING, "stiffness": 1e2})).run()


def test_what_lies_or_falls_without_an_end_or_in_water_is_not_warned_of():
    contact = {**SPRING, "stiffness": 0.9 * UNDAMPED}
    assert soft(falling(contact))
    assert not soft(falling(contact, gravity=[0, 0]))
    sides = {"domain__bottom": "periodic", "domain__top": "periodic"}
    assert not soft(falling(contact, **sides))
    held = [{"grain": 0, "x": {"velocity": 0}, "y": {"velocity": 0}}]
    assert not soft(falling(contact, control=held))
    one = {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.006, 0.006)]}
    assert not soft(column(gate=None, grains=one, contact=contact))  # sinks with a tenth of the speed
    between = {"domain__width": 0.004, "grains__packing__left": 0.0}
    slides = {**contact, "friction": 0.5, "tangential_stiffness": 0.5 * UNDAMPED}
    assert not soft(dry(contact=slides, grains__packing__settle=True, **between))
    assert soft(dry(contact=slides))  # the same packing left where it is placed: it falls


def test_a_grain_that_is_given_a_speed_is_warned_of_too():
    thrown = {"density": 2500, "grain": [{**grain(0.006, 0.004), "velocity": [1.0, 0.0]}]}
    (line,) = soft(falling({**SPRING, "stiffness": UNDAMPED}, grains=thrown))
    assert "a grain at 1 m/s" in line


def test_materials_are_told_how_many_times_as_stiff():
    material = [{"name": "soft", "stiffness": 0.25 * UNDAMPED}]
    (line,) = soft(falling({"restitution": 1.0, "friction": 0.0}, material=material))
    assert line.endswith("; 4.2 times as stiff ones suffice")
