"""Polygons that move with fluid: conservation, symmetry, and an ellipse that turns in shear flow.  Lattice units."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.step import Coupled
from porescale.dem.bodies.frames import framed, polygon
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box
from porescale.lbm.boundary.sides import Kind, Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling import setups
from porescale.validation.coupling.polygons import ellipse, plate, regular
from porescale.validation.coupling.setups import LAW, TAU, in_box, lattice_units
from porescale.validation.lbm.channels import one_thread, run

EPS = float(np.finfo(float).eps)
VALIDATIONS = Validations()


THICKNESS = 0.25
"""Half of the film, cells, that polygons keep between them."""


def immersed_polygons(
    cells: tuple[int, int],
    corners: Sequence[ArrayLike],
    density: float = 2.0,
    *,
    velocity: Sequence[tuple[float, float]] | None = None,
    spin: Sequence[float] | None = None,
    discs: Discs | None = None,
    sides: tuple[Kind, Kind] = ("wall", "wall"),
    acceleration: tuple[float, float] = (0.0, 0.0),
) -> Coupled:
    """Polygons with these corners (cells, in the box) and discs in fluid at rest; lattice units.

    sides: left and right, bottom and top.
    """
    scales = lattice_units(TAU)
    frames = [
        polygon(
            np.asarray(each, float), THICKNESS, density,
            velocity=velocity[n] if velocity else (0.0, 0.0), spin=spin[n] if spin else 0.0,
        )
        for n, each in enumerate(corners)
    ]  # fmt: skip
    return in_box(cells, lambda box: framed(discs, frames, LAW, box), scales, sides, acceleration=acceleration)


def three(ratio: float, velocity: Sequence[tuple[float, float]], spin: Sequence[float], g: float) -> Coupled:
    """A square, a triangle and a plate, and two discs, in a periodic box of 52 x 52 cells."""
    bodies = [
        regular(4, 80.0, 20.0) + np.array((12.3, 15.2)), regular(3, 60.0, 77.0) + np.array((28.0, 17.0)),
        plate(18.0, 4.0, 30.0) + np.array((25.0, 34.0)),
    ]  # fmt: skip
    discs = make_discs([(8.0, 30.0), (40.0, 8.0)], [4.0, 4.0], ratio, [velocity[0], velocity[1]])
    return immersed_polygons(
        (52, 52), bodies, ratio, velocity=velocity, spin=spin, discs=discs, sides=("periodic", "periodic"),
        acceleration=(0.0, g),
    )  # fmt: skip


def loads_on_neutral(steps: int, extra: float = 0.0) -> list[float]:
    """Largest force, and torque over five cells, on polygons of density 1 that a uniform flow of 0.036 carries.

    extra: what they are faster by.
    """
    coupled = three(1.0, [(0.03 + extra, 0.02)] * 3, [0.0] * 3, 0.0)
    coupled.fluid.set_flow(0.03, 0.02)
    force = torque = 0.0
    with one_thread():
        for _ in range(steps):
            coupled.advance()
            load = np.abs(coupled.saturated.polygon_load)
            force, torque = max(force, float(load[:, :2].max())), max(torque, float(load[:, 2].max()) / 5.0)
    return [force, torque]


@VALIDATIONS.row(
    "coupling.neutral_polygons_feel_no_force",
    source="Galilean invariance: b rho (u - v) = 0 in every cell",
    because="round-off: four roundings of 0.036 in each of the 110 cells of the largest, all one way",
    tolerance=4 * 110 * 0.036 * EPS,
    slow=True,
)
def neutral() -> Measured:
    """Largest load, and torque over the size, on three polygons of density 1 that uniform flow carries, 300 steps."""
    return Measured.absolute(0.0, loads_on_neutral(300))


def momentum_error(steps: int, ratio: float = 2.0, g: float = -1e-5, *, inside: bool = True) -> float:
    """`setups.momentum_error` of colliding polygons and discs in a periodic box.

    inside: or else the fluid inside the polygons, and their virtual masses, are left out of the budget.
    """
    coupled = three(ratio, [(0.04, 0.01), (-0.04, 0.0), (0.0, -0.04)], [0.002, -0.004, 0.01], g)
    polygons = coupled.polygons
    assert polygons
    outside = lambda: np.array(coupled.momentum() - polygons.momentum(coupled._units, coupled.scales.step))  # noqa: E731
    return setups.momentum_error(coupled, steps, None if inside else outside)


@VALIDATIONS.row(
    "coupling.momentum_of_polygons",
    source="Newton: momentum of polygons, discs and fluid, less that of the fluid inside and with virtual masses",
    because="round-off: each of 400 fluid and 1600 contact steps rounds every velocity, all one way: 2000 eps",
    tolerance=2000 * EPS,
)
def momentum() -> Measured:
    """Error of the momentum budget over sum m |v| at the start: polygons and discs in a periodic box under gravity."""
    return Measured.absolute([0.0, 0.0], [momentum_error(400, ratio) for ratio in (2.0, 0.5)])


def level_plate(degrees: float, steps: int = 300) -> tuple[float, float]:
    """Sideways speed, and speed of the tips, over the speed down of a plate that sinks from rest in a closed box."""
    body = plate(16.0, 4.0, degrees) + np.array((24.0, 40.0))
    coupled = immersed_polygons((48, 64), [body], acceleration=(0.0, -1e-5))
    run(coupled.advance, steps)
    assert coupled.polygons
    (x, y), spin = coupled.polygons.velocity[0], float(coupled.polygons.spin[0])
    return float(x / y), float(8.0 * spin / y)


@VALIDATIONS.row(
    "coupling.level_plate_sinks_straight",
    source="mirror symmetry",
    because="round-off: sums over 3e3 cells of populations less those at rest, as large as the speed: 3e3 eps",
    tolerance=3000 * EPS,
)
def mirror() -> Measured:
    """Sideways speed and tip speed of a level plate that sinks, over the speed down."""
    aside, tip = level_plate(0.0)
    return Measured.absolute([0.0, 0.0], [aside, tip])


def half_turn(
    cells: int = 64, a: float = 10.0, b: float = 5.0, reynolds: float = 0.5, *, relaxation_time: float = 1.0
) -> float:  # fmt: skip
    """Time of half a turn times the shear rate g: an ellipse of half axes a and b, as heavy as the fluid, free in the
    middle of a channel ``cells`` wide and twice as long, whose walls slide;  reynolds: g a²/nu.

    It starts along the flow, turning as it would there, and counts from 20 degrees on, for half a turn.
    """
    rate = reynolds * viscosity(relaxation_time) / a**2
    speed = 0.5 * rate * cells
    fluid = Fluid(
        2 * cells, cells, relaxation_time,
        sides=Sides("periodic", "periodic", "wall", "wall", bottom_speed=-speed, top_speed=speed),
    )  # fmt: skip
    y = (np.arange(cells) + 0.5)[:, None] - 0.5 * cells
    fluid.set_flow(rate * y * np.ones((1, 2 * cells)), np.zeros((cells, 2 * cells)))
    body = polygon(
        ellipse(a, b) + np.array((cells, 0.5 * cells)), THICKNESS, 1.0, spin=-rate * b**2 / (a**2 + b**2)
    )  # fmt: skip
    box = Box((0.0, 0.0), (2.0 * cells, float(cells)), "periodic", "periodic", "solid", "solid")
    coupled = Coupled(
        fluid, framed(None, [body], LAW, box), lattice_units(relaxation_time), hydraulic_ratio=1.0, contact_steps=1,
        acceleration=(0.0, 0.0),
    )  # fmt: skip
    assert coupled.polygons
    begun = 0.0
    with one_thread():
        while True:
            before = -float(coupled.polygons.angle[0])
            coupled.advance()
            now = -float(coupled.polygons.angle[0])
            for mark in (math.radians(20.0), math.radians(200.0)):
                if before < mark <= now:
                    at = coupled.fluid.step - (now - mark) / (now - before)
                    if begun:
                        return (at - begun) * rate
                    begun = at
            if coupled.fluid.step * rate > 40.0:
                return math.inf


@VALIDATIONS.row(
    "coupling.jeffery_period",
    source="Jeffery 1922, in two dimensions: half a turn of an ellipse, free in shear g, takes pi (r + 1/r)/g",
    because="walls 4.3 half lengths off slow it by the order of (2 a/H)², 5.5 % (2.9 % at half as much again), inertia"
    " at g a²/nu = 0.15 by less than 1 %",
    tolerance=(2 * 7.5 / 64) ** 2,
    slow=True,
)
def jeffery() -> Measured:
    """Time of half a turn over Jeffery's: ellipse of 48 corners, axes 15 and 7.5 cells, between walls that slide."""
    return Measured.absolute(1.0, half_turn(64, 7.5, 3.75, 0.15) / (math.pi * 2.5))
