"""Containers that turn about a point that lies not amid their own, as a door about its hinge."""

import math

import numpy as np
import pytest

import porescale as ps
from porescale.builders.initial.frames import placed_frames
from porescale.common.core.errors import InputError
from tests.reference.scenes import dry

LEFT, RIGHT, Y = 5e-3, 25e-3, 10e-3  # m, ends of the door and its height
G, DENSITY, RADIUS = 9.81, 2500.0, 1e-3
HINGES = ([LEFT, Y], [2e-3, 20e-3])
"""Its own end, and a point beside it."""


def scene(pivot, **moves):
    """A door with a grain on it, 5 mm right of its middle."""
    door = {"chain": [[LEFT, Y], [RIGHT, Y]], "thickness": 5e-4, "name": "door", "record": True}
    return ps.Scene(
        domain={"width": 40e-3, "height": 40e-3}, gravity=(0.0, -G), time={"end": 0.3},
        output={"snapshot_interval": 0.1, "series_interval": 0.01, "energy": True},
        grains={"density": DENSITY, "grain": [{"x": 20e-3, "y": Y + RADIUS + 5e-4, "diameter": 2 * RADIUS}]},
        contact={"stiffness": 1e4, "restitution": 0.3}, container=[door | {"pivot": pivot} | moves],
    )  # fmt: skip


def taken(simulation):
    """The row of control.csv, without the name of the body."""
    return {key.removeprefix("door "): value for key, value in simulation.tables()["control"].items()}


@pytest.mark.parametrize("pivot", HINGES)
def test_a_hinge_bears_the_moment_of_what_lies_on_the_door_and_of_the_door(pivot):
    """Weight times arm.  The grain is at rest to a millionth after 0.3 s: it bounces twenty times a period of
    2 π √(m/k), 5.6 ms, and a restitution of 0.3 leaves e^-60 of it."""
    simulation = ps.build(scene(pivot))
    simulation.run(until=0.3)
    row = taken(simulation)
    grain = DENSITY * math.pi * RADIUS**2 * G
    (placed,) = placed_frames(simulation.scene)
    own = placed.frame.mass_properties()
    assert row["contact force y (N/m)"] == pytest.approx(-grain, rel=1e-6)
    assert row["contact moment (N m/m)"] == pytest.approx(-grain * (20e-3 - pivot[0]), rel=1e-6)
    middle = 0.5 * (LEFT + RIGHT)
    held = grain * (20e-3 - pivot[0]) + own.mass * G * (middle - pivot[0])
    assert row["control moment (N m/m)"] == pytest.approx(held, rel=1e-6)
    # the check that fails: a door whose mass is about its hinge
    assert row["control moment (N m/m)"] != pytest.approx(grain * (20e-3 - pivot[0]), rel=0.1)


@pytest.mark.parametrize("pivot", HINGES)
def test_a_door_turns_about_its_hinge_with_its_inertia_there(pivot):
    """Positions are turned to round-off of some 10^4 steps, 1e-12 of the box; m (L²/12 + w²/12 + d²) ω²/2."""
    simulation = ps.build(scene(pivot, rotation={"velocity": 1.0}))
    before = simulation.grains.discs.position[-2:] - pivot
    simulation.run(until=0.2)
    bodies, discs, turn = simulation.grains.steering.clumps, simulation.grains.discs, simulation.time
    assert bodies.position[0] == pytest.approx(pivot, rel=1e-12)
    c, s = math.cos(turn), math.sin(turn)
    assert discs.position[-2:] - pivot == pytest.approx(before @ np.array([[c, s], [-s, c]]), abs=1e-12)
    long, wide, away = RIGHT - LEFT, 1e-3, math.dist(pivot, (0.5 * (LEFT + RIGHT), Y))
    inertia = DENSITY * long * wide * ((long**2 + wide**2) / 12.0 + away**2)
    assert bodies.inertia[0] == pytest.approx(inertia, rel=1e-9)
    corners = slice(-2, None)
    moving = 0.5 * discs.mass[corners] @ np.sum(discs.velocity[corners] ** 2, axis=1)
    moving += 0.5 * discs.inertia[corners] @ discs.spin[corners] ** 2
    assert moving == pytest.approx(0.5 * inertia, rel=1e-9)


def test_what_a_force_moves_needs_a_pivot_amid_its_points():
    ps.build(scene([15e-3, Y], rotation={"velocity": 1.0}, y={"force": 1.0}))
    for pivot in HINGES:
        for read in (ps.check, ps.build):
            with pytest.raises(InputError) as caught:
                read(scene(pivot, rotation={"velocity": 1.0}, y={"force": 1.0}))
            assert str(caught.value) == ("container[0].pivot: must lie amid the points of its segments, as a force "
                                         "moves it; take a point between them")  # fmt: skip


def test_a_pivot_amid_the_points_is_taken_as_before():
    """Its mass is about the pivot, as of any container, with the inertia of its own centre."""
    bodies = ps.build(scene([12e-3, Y])).grains.steering.clumps
    (placed,) = placed_frames(scene([15e-3, Y]))
    assert bodies.inertia[0] == placed.frame.mass_properties().inertia


def test_a_door_that_is_turned_by_its_angle_hangs_from_any_point_and_one_that_a_moment_turns_does_not():
    turned = ps.build(scene(HINGES[0], rotation={"displacement": {"amplitude": 0.01, "frequency": 10.0}}))
    turned.advance(100)
    angle = 0.01 * math.sin(2 * math.pi * 10.0 * turned.time)
    assert taken(turned)["displacement rotation (rad)"] == pytest.approx(angle, rel=1e-9)
    with pytest.raises(InputError, match="must lie amid the points of its segments, as a force moves it"):
        ps.build(scene(HINGES[0], rotation={"force": 1e-3}))  # the check that must fail


@pytest.mark.parametrize(("way", "free"), [("velocity", False), ("displacement", False), ("force", True)])
def test_a_held_polygon_is_no_grain_unless_a_force_moves_it(way, free):
    corners = [[4e-3, 4e-3], [6e-3, 4e-3], [6e-3, 6e-3], [4e-3, 6e-3]]
    control = {"polygon": 0, **{axis: {way: 0.0} for axis in ("x", "y", "rotation")}}
    square = {"corners": corners, "thickness": 1e-4, "held": True}
    found = placed_frames(dry(grains={"density": DENSITY}, polygon=[square], control=[control]))
    assert [it.free for it in found] == [free]
