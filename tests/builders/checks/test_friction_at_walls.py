"""Friction at walls holds at sides, walls and rectangles; bodies that stand have another, which is said."""

import pytest

from porescale import Scene, build
from tests.reference.scenes import warned

GRAVITY, FRICTION, AT_WALLS = 9.81, 0.2, 0.05
FLOOR = {"chain": [[0.1, 0.095], [3.9, 0.095]], "thickness": 0.005}


def slides(height, **parts):
    """A disc that slides at 1 m/s on something at ``height`` (m), and does not turn."""
    contact = {"stiffness": 1e5, "tangential_stiffness": 5e4, "restitution": 0.3, "friction": FRICTION}
    return Scene(
        domain={"width": 4, "height": 1}, time={"end": 0.1},
        output={"snapshot_interval": 0.1, "series_interval": 0.1},
        grains={"density": 1000, "grain": [{"x": 1, "y": height + 0.01, "diameter": 0.02, "velocity": [1, 0]}]},
        control=[{"grain": 0, "rotation": {"velocity": 0}}],
        contact=contact | {"wall_friction": AT_WALLS} | parts.pop("contact", {}), **parts,
    )  # fmt: skip


def said(scene):
    """Warnings of a scene that name friction at walls."""
    return warned(scene, "wall_friction")


@pytest.mark.parametrize(
    ("height", "parts", "friction"),
    [(0.0, {}, AT_WALLS), (0.1, {"container": [FLOOR]}, FRICTION)],
)
def test_what_is_said_of_friction_is_what_a_disc_slides_under(height, parts, friction):
    scene = slides(height, **parts)
    assert bool(said(scene)) == (friction != AT_WALLS)
    simulation = build(scene)
    simulation.run(until=0.1)
    # What the floor bears over 0.1 s is the weight, less what is left of the speed with which the disc sinks in:
    # at most g/w = 9.81/564 = 0.017 m/s of the 0.98 m/s that gravity would give, 1.8 %.
    slowed = (1.0 - simulation.velocities[0, 0]) / (GRAVITY * 0.1)
    assert slowed == pytest.approx(friction, rel=0.02)


@pytest.mark.parametrize(
    "parts",
    [
        {"disc": [{"x": 2, "y": 0.5, "diameter": 0.02}]},
        {"polygon": [{"sides": 4, "diameter": 0.1, "at": [[2, 0.5]], "thickness": 0.002, "held": True}]},
        {"segment": [{"chain": [[2, 0.5], [3, 0.5]], "thickness": 0.002, "held": True}]},
    ],
)
def test_bodies_that_stand_are_named(parts):
    (line,) = said(slides(0.0, **parts))
    assert f"{next(iter(parts))}[0]" in line


def test_nothing_is_said_where_both_are_the_same_or_nothing_stands():
    assert not said(slides(0.1, container=[FLOOR], contact={"wall_friction": FRICTION}))
    free = {"sides": 4, "diameter": 0.1, "at": [[2, 0.5]], "thickness": 0.002}
    assert not said(slides(0.0, polygon=[free]))
