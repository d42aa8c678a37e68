"""Polygons in fluid with known answers: what ``verify_polygons`` measures and tests vary.  Lattice units."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.coupling.experiments import DEFAULT, LAW, TAU, Method
from porescale.coupling.saturated import Saturated
from porescale.coupling.shapes.polygon import Polygons
from porescale.coupling.step import Coupled
from porescale.dem.discs import Discs
from porescale.dem.frames import framed, polygon
from porescale.dem.walls import Box
from porescale.lbm.experiments import one_thread
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.lbm.scales import Scales
from porescale.lbm.sides import Kind, Sides

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
