"""A cylinder towed fast from rest, in lattice units: near tau = 1/2, where the viscous layer is thinner than a cell."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from porescale.coupling.psm import Saturated
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time

STARTED = {50: 1.80894, 100: 1.50316, 200: 1.32127, 500: 1.20376}
"""Mean drag coefficient over 1 <= t U/D <= 3 of a cylinder started impulsively in unbounded fluid, by Reynolds number
U D/nu: tests/reference/cylinder_start.py, a body-fitted solution that shares nothing with the lattice; sums over 0.25,
good to 1e-4."""
WIDE = 40
"""Diameters across the periodic box: sound does not come round within the time looked at."""


def potential_start(fluid: Fluid, x: float, y: float, radius: float, u: float, v: float) -> None:
    """Set the flow of a cylinder that has just been set moving: potential outside, its own velocity inside."""
    at_y, at_x = np.mgrid[: fluid.ny, : fluid.nx] + 0.5
    dx, dy = at_x - x, at_y - y
    far = np.maximum(dx**2 + dy**2, radius**2)
    along = 2 * (dx * u + dy * v) / far
    inside = dx**2 + dy**2 < radius**2
    share = radius**2 / far
    fluid.set_flow(np.where(inside, u, share * (along * dx - u)), np.where(inside, v, share * (along * dy - v)))


def started(
    reynolds: float,
    diameter: float = 15.0,
    speed: float = 0.05,
    *,
    degrees: float = 11.0,
    operator: str = "central",
    soft_rim: bool = True,
    solid_operator: str = "exact-wall",
    held: bool = False,
    wide: int = WIDE,
) -> tuple[float, float]:
    """Mean drag coefficient over 1 <= t U/D <= 3, and the noise: rms about a smooth curve over the mean.

    degrees: between the direction and the lattice;  held: the cylinder stays and the fluid comes.
    """
    across, along = round(wide * diameter), round(0.75 * wide * diameter)
    periodic = Sides("periodic", "periodic", "periodic", "periodic")
    fluid = Fluid(across, along, relaxation_time(speed * diameter / reynolds), operator=operator, sides=periodic)
    wet = Saturated(fluid, np.array([diameter / 2]), solid_operator=solid_operator, soft_rim=soft_rim)
    direction = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    motion = speed * direction[None]
    place = np.array([[across / 2 + 0.3, along / 2 + 0.1]]) - (0 if held else 1.5 * diameter * direction)
    (x, y), (u, v) = place[0], motion[0]
    potential_start(fluid, x, y, diameter / 2, u, v)
    if held:
        _, ux, uy = fluid.fields()
        fluid.set_flow(ux - motion[0, 0], uy - motion[0, 1])
    own, none = (0 * motion if held else motion), np.zeros(1)
    steps = round(3 * diameter / speed)
    force: NDArray[np.floating] = np.zeros(steps)
    for step in range(steps):
        wet.advance(fluid, place, own, none)
        place += own
        force[step] = -wet.force[0] @ direction
    time = (np.arange(steps) + 0.5) * speed / diameter
    late = time >= 1
    drag = force[late] / (0.5 * speed**2 * diameter)
    curve = np.polyval(np.polyfit(time[late], drag, 4), time[late])
    return float(drag.mean()), float(np.std(drag - curve) / drag.mean())
