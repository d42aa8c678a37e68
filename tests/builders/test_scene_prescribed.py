"""Where prescribed motions lead: into a side or each other is refused before the run, which would stop there."""

from typing import Any

import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.common.core.errors import Unstable
from porescale.scene.scene import Scene
from tests.reference.scenes import dry, grain, refusals, water

R = 0.001
"""Radius, m, of what moves in a box of 12 x 8 mm."""
INTO, MEET = "goes more than 0.3 of its radius into the", "run into each other after"
STILL: dict[str, Any] = {"rotation": {"velocity": 0}}
ONE: dict[str, Any] = {"density": 2500, "grain": [grain(0.006, 0.004, 2 * R)]}


def disc(x: float, y: float, velocity: tuple[float, float] = (0.0, 0.0), **more: Any) -> dict[str, Any]:
    """A held disc."""
    return {"x": x, "y": y, "diameter": 2 * R, "velocity": velocity, **more}


def held(*discs: dict[str, Any], **changes: Any) -> Scene:
    """Held discs in a closed box of water, for 0.1 s."""
    walls = {f"domain__{name}": "wall" for name in ("left", "right", "bottom", "top")}
    given = {**walls, "fluid__body_force": None, "gravity": [0, 0], "time__end": 0.1}
    return water(**{**given, "disc": list(discs), **changes})


def controlled(**components: Any) -> Scene:
    """One dry grain in the middle of the box, controlled, without gravity, for 0.1 s."""
    return dry(grains=ONE, gravity=[0, 0], time__end=0.1, control=[{"grain": 0, **STILL, **components}])


def said(scene: Scene) -> list[str]:
    """The lines of the refusal."""
    return refusals(lambda: derive(scene))


@pytest.mark.parametrize(
    ("scene", "line"),
    [
        # Touch after 4 mm and 3 mm, and 0.3 mm on: 0.043 and 0.033 s; places of looks are R/20 apart.
        (held(disc(0.002, 0.004, (0.1, 0)), disc(0.008, 0.004)), f"disc[0]: and disc 1 {MEET} 0.043"),
        (held(disc(0.008, 0.004), disc(0.002, 0.004, (0.1, 0))), f"disc[0]: and disc 1 {MEET} 0.043"),
        (held(disc(0.004, 0.004, (-0.1, 0))), f"disc[0]: {INTO} left side after 0.03"),
        (held(disc(0.006, 0.004, velocity_y=[[0, 0.1], [1, 0.1]])), f"disc[0]: {INTO} top side after 0.033"),
        (controlled(x={"velocity": 0.1}), f"control[0]: {INTO} right side after 0.053"),
        (controlled(y={"displacement": [[0, 0.001], [0.05, -0.005]]}), f"control[0]: {INTO} bottom side after 0.02"),
    ],
)  # fmt: skip
def test_what_is_moved_into_something_is_refused_with_one_line(scene, line):
    (only,) = said(scene)
    assert only.startswith(line)
    assert "; end " in only


def test_a_controlled_grain_and_a_disc_run_into_each_other():
    walk = [{"grain": 0, **STILL, "x": {"velocity": 0.1}, "y": {"velocity": 0}}]
    (only,) = said(dry(grains=ONE, gravity=[0, 0], time__end=0.03, control=walk, disc=[disc(0.009, 0.004)]))
    assert only.startswith("disc[0]: and grain 0 run into each other after 0.013")
    # Pushed instead, it is stopped by the contact.
    pushed = [{"grain": 0, **STILL, "x": {"force": 0.1}, "y": {"velocity": 0}}]
    derive(dry(grains=ONE, gravity=[0, 0], time__end=0.03, control=pushed, disc=[disc(0.009, 0.004)]))


@pytest.mark.parametrize(
    "scene",
    [
        held(disc(0.002, 0.004, (0.1, 0)), disc(0.008, 0.004), time__end=0.042),  # 0.2 of a radius: pressed, no more
        held(disc(0.002, 0.002, (0.08, 0)), disc(0.008, 0.0041)),  # passes by
        held(disc(0.002, 0.004, (0.06, 0)), disc(0.0045, 0.004, (0.06, 0))),  # in line
        held(disc(0.006, 0.004, velocity_x={"amplitude": 0.1, "frequency": 10.0})),  # swings by 3.2 mm, and back
        held(disc(0.006, 0.004, (0.5, 0)), domain__left="periodic", domain__right="periodic"),
        held(disc(0.006, 0.004), disc(0.004, 0.002)),
        controlled(x={"velocity": 0.05}),
        controlled(x={"displacement": 0.5}),  # changes alone count
    ],
)
def test_what_keeps_clear_is_accepted(scene):
    derive(scene)


def test_discs_meet_through_a_periodic_side():
    sides = {"domain__left": "periodic", "domain__right": "periodic", "time__end": 0.04}
    (only,) = said(held(disc(0.010, 0.004, (0.1, 0)), disc(0.002, 0.004), **sides))
    assert only.startswith("disc[0]: and disc 1 run into each other after 0.023")


def test_a_wall_that_moves_is_not_looked_at():
    # It goes with the grain.
    walls = {"domain__right": {"kind": "wall", "velocity": [0.1, 0]}, "domain__left": {"kind": "wall"}}
    moved = [{"grain": 0, **STILL, "x": {"velocity": 0.1}, "y": {"velocity": 0}}]
    derive(dry(grains=ONE, gravity=[0, 0], time__end=0.06, control=moved, **walls))


def test_the_run_stops_where_check_says(monkeypatch):
    monkeypatch.setattr("porescale.builders.derive.check_motions", lambda scene, faults: None)
    model = build(held(disc(0.002, 0.004, (0.1, 0)), disc(0.008, 0.004)))
    with pytest.raises(
        Unstable, match=r"overlap with held disc 1 .* at held disc 0; its motion is prescribed"
    ) as found:
        model.run()
    assert found.value.time > 0.043
