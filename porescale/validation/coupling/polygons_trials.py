"""Polygons in fluid with known answers: what ``verify_polygons`` measures and tests vary.  Lattice units."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.coverage.rows import make_patches
from porescale.coupling.psm import Saturated
from porescale.coupling.step import Coupled
from porescale.dem.bodies.frames import framed, polygon
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box
from porescale.lbm.boundary.sides import Kind, Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.lbm.scales import Scales
from porescale.validation.coupling.grains_trials import DEFAULT, LAW, TAU, Method
from porescale.validation.lbm.channels import one_thread

Array = NDArray[np.float64]
NO_DISCS = np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0)
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
THICKNESS = 0.25
"""Half of the film, cells, that polygons keep between them."""


def regular(corners: int, area: float, degrees: float = 0.0) -> Array:
    """Corners (k, 2) of a regular polygon of this area about 0, the first one ``degrees`` from the x axis."""
    radius = math.sqrt(2.0 * area / (corners * math.sin(2.0 * math.pi / corners)))
    angle = math.radians(degrees) + 2.0 * np.pi * np.arange(corners) / corners
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def plate(length: float, thickness: float, degrees: float = 0.0) -> Array:
    """Corners (4, 2) of a plate about 0, its length ``degrees`` from the x axis."""
    a, b = 0.5 * length, 0.5 * thickness
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = np.array([-a, a, a, -a]), np.array([-b, -b, b, b])
    return np.column_stack((cosine * x - sine * y, sine * x + cosine * y))


def ellipse(a: float, b: float, corners: int = 48) -> Array:
    """Corners (k, 2) of a polygon with the area and, but for its corners, the shape of an ellipse about 0."""
    angle = 2.0 * np.pi * (np.arange(corners) + 0.5) / corners
    wider = math.sqrt(2.0 * math.pi / (corners * math.sin(2.0 * math.pi / corners)))
    return wider * np.column_stack((a * np.cos(angle), b * np.sin(angle)))


def array_drag(
    corners: ArrayLike,
    cells: int,
    *,
    relaxation_time: float = TAU,
    places: Sequence[tuple[float, float]] = ((0.125, 0.125), (0.125, 0.375), (0.375, 0.125), (0.375, 0.375)),
    method: Method = DEFAULT,
    change: float = 1e-5,
) -> list[float]:
    """Drag F/(mu U) of a square array of a polygon (k, 2), in parts of the period, for each place in a cell.

    Driven by a body force G along x: the drag is G times the box, U the conserved flux.
    """
    nu, found = viscosity(relaxation_time), []
    force = 1e-6 * nu
    for place in places:
        fluid = Fluid(
            cells, cells, relaxation_time, operator=method.operator, magic=method.magic, force=(force, 0.0),
            sides=PERIODIC,
        )  # fmt: skip
        body = Polygons([cells * np.asarray(corners, float)])
        body.centre[0] = 0.5 * cells + place[0], 0.5 * cells + place[1]
        wet = Saturated(
            fluid, np.zeros(0), solid_operator=method.solid_operator, weighting=method.weighting, polygons=body
        )  # fmt: skip
        flux, before = 0.0, math.nan
        with one_thread():
            while not abs(flux - before) <= change * abs(flux):
                for _ in range(max(50, math.ceil(cells**2 / (25.0 * nu)))):
                    wet.advance(fluid, *NO_DISCS)
                flux, before = fluid.momentum()[0] / cells**2, flux
        found.append(force * cells**2 / (nu * flux))
    return found


def array_torque(
    corners: ArrayLike, cells: int, *, relaxation_time: float = TAU, place: tuple[float, float] = (0.3, 0.1),
    method: Method = DEFAULT,
) -> float:  # fmt: skip
    """Torque over mu w and the box's area of a square array of a polygon, in parts of the period, that all turn with w
    and have not got anywhere."""
    nu, spin = viscosity(relaxation_time), 1e-9
    fluid = Fluid(cells, cells, relaxation_time, operator=method.operator, magic=method.magic, sides=PERIODIC)
    body = Polygons([cells * np.asarray(corners, float)])
    body.centre[0], body.spin[0] = (0.5 * cells + place[0], 0.5 * cells + place[1]), spin
    wet = Saturated(
        fluid, np.zeros(0), solid_operator=method.solid_operator, weighting=method.weighting, polygons=body
    )  # fmt: skip
    with one_thread():
        for _ in range(math.ceil(cells**2 / nu)):
            wet.advance(fluid, *NO_DISCS)
    return -float(wet.polygon_load[0, 2]) / (nu * spin * cells**2)


def immersed_polygons(
    cells: tuple[int, int],
    corners: Sequence[ArrayLike],
    density: float = 2.0,
    *,
    velocity: Sequence[tuple[float, float]] | None = None,
    spin: Sequence[float] | None = None,
    discs: Discs | None = None,
    relaxation_time: float = TAU,
    sides: tuple[Kind, Kind] = ("wall", "wall"),
    acceleration: tuple[float, float] = (0.0, 0.0),
    scales: Scales | None = None,
    method: Method = DEFAULT,
    thickness: float = THICKNESS,
    contact_steps: int = 4,
) -> Coupled:
    """Polygons with these corners (cells, in the box) and discs in fluid at rest; units of ``scales``, by default 1.

    sides: left and right, bottom and top;  thickness: cells.
    """
    scales = scales or Scales(1.0, 1.0, relaxation_time, 1.0)
    across, along = sides
    fluid = Fluid(
        *cells, scales.relaxation_time, operator=method.operator, magic=method.magic,
        sides=Sides(across, across, along, along),
    )  # fmt: skip
    h = scales.spacing
    frames = [
        polygon(
            h * np.asarray(each, float), h * thickness, density,
            velocity=velocity[n] if velocity else (0.0, 0.0), spin=spin[n] if spin else 0.0,
        )
        for n, each in enumerate(corners)
    ]  # fmt: skip
    kinds = ["periodic" if kind == "periodic" else "solid" for kind in (across, across, along, along)]
    grains = framed(discs, frames, LAW, Box((0.0, 0.0), (h * cells[0], h * cells[1]), *kinds))
    return Coupled(
        fluid, grains, scales, hydraulic_ratio=1.0, contact_steps=contact_steps, acceleration=acceleration,
        solid_operator=method.solid_operator, weighting=method.weighting,
    )  # fmt: skip


def area_errors(shapes: Sequence[Array], angles: int) -> list[float]:
    """Largest errors of the sum of solid fractions over angles and places, cells², of each polygon (k, 2)."""
    fluid, found = Fluid(64, 64, TAU), []
    for corners in shapes:
        body = Polygons([corners])
        cells = body.fit(fluid, 0.0, 0)
        patches = make_patches(cells, cells, np.dtype(np.float64))
        worst = 0.0
        for k in range(angles):
            body.angle[0], body.centre[0] = math.pi * k / angles, (20.0 + 0.618 * k % 1.0, 30.0 + 0.414 * k % 1.0)
            body.cover(patches, 0)
            covered = patches.fraction[: patches.height[0] * patches.stride[0]]
            worst = max(worst, abs(float(covered.sum()) - float(body.area[0])))
        found.append(worst)
    return found


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


def momentum_error(steps: int, ratio: float = 2.0, g: float = -1e-5, *, inside: bool = True) -> float:
    """Largest error of the momentum book over sum m |v| at the start: polygons and discs that meet in a periodic box.

    inside: or else the fluid inside the polygons, and their virtual masses, are left out of the book.
    """
    coupled = three(ratio, [(0.04, 0.01), (-0.04, 0.0), (0.0, -0.04)], [0.002, -0.004, 0.01], g)
    polygons = coupled.polygons
    assert polygons
    discs = coupled.grains.discs
    size = float(np.sum(discs.mass[:, None] * np.abs(discs.velocity)))

    def book() -> Array:
        """Momentum of all (2,), lattice units; unless ``inside`` without what fills polygons and moves with them."""
        return np.array(coupled.momentum() - (0.0 if inside else polygons.momentum(coupled.scales.step)))

    first, per_step, worst = book(), coupled.weight.sum(axis=0), 0.0
    with one_thread():
        for step in range(1, steps + 1):
            coupled.advance()
            worst = max(worst, float(np.abs(book() - first - step * per_step).max()))
    return worst / size


def level_plate(degrees: float, steps: int = 300) -> tuple[float, float]:
    """Sideways speed, and speed of the tips, over the speed down of a plate that sinks from rest in a closed box."""
    body = plate(16.0, 4.0, degrees) + np.array((24.0, 40.0))
    coupled = immersed_polygons((48, 64), [body], acceleration=(0.0, -1e-5))
    with one_thread():
        for _ in range(steps):
            coupled.advance()
    assert coupled.polygons
    (x, y), spin = coupled.polygons.velocity[0], float(coupled.polygons.spin[0])
    return float(x / y), float(8.0 * spin / y)


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
        fluid, framed(None, [body], LAW, box), Scales(1.0, 1.0, relaxation_time, 1.0), hydraulic_ratio=1.0,
        contact_steps=1, acceleration=(0.0, 0.0),
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
