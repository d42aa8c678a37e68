"""Arrays of discs in slow flow with exactly known loads, beside the square ones of experiments_towed; lattice units."""

from __future__ import annotations

import math

import numpy as np

from porescale.coupling.step import Coupled
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.grains_trials import DEFAULT, TAU, Method
from porescale.validation.coupling.towed_trials import PERIODIC, SLOW, steady, towed
from porescale.validation.lbm.channels_flows import one_thread


def places(count: int) -> list[tuple[float, float]]:
    """``count``² places in a quarter of a cell, of which all others are mirror images, at the middles of equal parts.

    Their mean is that over the cell of whatever has less than 2 ``count`` waves in it.
    """
    at = (np.arange(count) + 0.5) / (2 * count)
    return [(float(x), float(y)) for x in at for y in at]


def _flux_through(coupled: Coupled, force: float, drag: float) -> float:
    """Superficial velocity along x under a body force, steady;  drag: F/(mu U) expected, for the flow's memory."""
    cells = coupled.fluid.nx * coupled.fluid.ny
    memory = cells / (viscosity(coupled.fluid.relaxation_time) * drag)
    return steady(coupled, lambda: coupled.fluid.momentum()[0] / cells, memory)


def hexagonal_drag(
    cells: tuple[int, int],
    solid_fraction: float,
    *,
    relaxation_time: float = TAU,
    place: tuple[float, float] = (0.3, 0.1),
    method: Method = DEFAULT,
) -> float:
    """Drag F/(mu U) of a disc of an array with a disc at the corners and in the middle of a box of ``cells``.

    Flow along x;  place: of the first within its cell, the second is half a box away.
    """
    across, along = cells
    radius = math.sqrt(solid_fraction * across * along / (2 * math.pi))
    nu = viscosity(relaxation_time)
    force = 1e-6 * nu
    first = across / 4 + place[0], along / 4 + place[1]
    second = first[0] + across / 2, first[1] + along / 2
    coupled = towed(
        cells, [first, second], radius, relaxation_time=relaxation_time, sides=PERIODIC, force=(force, 0.0),
        method=method,
    )  # fmt: skip
    area = across * along / 2
    return force * area / (nu * _flux_through(coupled, force, 40.0))


def pair_drags(
    cells: int = 50,
    *,
    relaxation_time: float = TAU,
    method: Method = DEFAULT,
) -> tuple[float, float, float]:
    """Drags Fx/(mu Ux) on discs of radius 0.2 and 0.12 at (0.3, 0.35) and (0.72, 0.7) of a periodic box of side 1.

    And the flow Uy/Ux that they turn aside: driven by a body force G along x.  The force on a disc is its load and G
    times the area it takes.
    """
    nu = viscosity(relaxation_time)
    force = 1e-8 * nu  # inertia turns the flow by a share of its Reynolds number
    place = np.array([(0.3, 0.35), (0.72, 0.7)]) * cells
    coupled = towed(
        (cells, cells), place, np.array([0.2, 0.12]) * cells, relaxation_time=relaxation_time, sides=PERIODIC,
        force=(force, 0.0), method=method,
    )  # fmt: skip
    flux = _flux_through(coupled, force, 60.0)
    taken = math.pi * coupled.saturated.covering_radius**2
    first, second = (coupled.fluid_force[:, 0] + force * taken) / (nu * flux)
    return float(first), float(second), coupled.fluid.momentum()[1] / (cells**2 * flux)


def array_torque(
    cells: int,
    solid_fraction: float,
    *,
    relaxation_time: float = TAU,
    place: tuple[float, float] = (0.3, 0.1),
    method: Method = DEFAULT,
) -> float:
    """Torque T/(mu w) over the box, on discs of a square array that all turn at w; ``cells``² a disc."""
    nu = viscosity(relaxation_time)
    radius = cells * math.sqrt(solid_fraction / math.pi)
    spin = SLOW / radius
    coupled = towed(
        (cells, cells), [(cells / 2 + place[0], cells / 2 + place[1])], radius, 0.0, spin,
        relaxation_time=relaxation_time, sides=PERIODIC, method=method,
    )  # fmt: skip
    torque = steady(coupled, lambda: float(coupled.fluid_torque[0]), (cells / (2 * math.pi)) ** 2 / nu)
    return -torque / (nu * spin * cells**2)


def moving_drag(
    diameter: float = 10.0,
    *,
    relaxation_time: float = TAU,
    reynolds: float = 0.2,
    degrees: float = 11.0,
    drag: float = 15.4,
    method: Method = DEFAULT,
) -> float:
    """Drag F/(mu U) of a disc that moves through a periodic box of four diameters, mean over ten cells of way.

    U: velocity against the mean flow of box and disc, which a body force of ``drag``, F/(mu U) expected, holds back.
    """
    cells, nu = round(4 * diameter), viscosity(relaxation_time)
    speed = reynolds * nu / diameter
    along = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    against = -drag * nu * speed / cells**2
    coupled = towed(
        (cells, cells), [(cells / 2, cells / 2)], diameter / 2, speed * along, relaxation_time=relaxation_time,
        sides=PERIODIC, force=(against * along[0], against * along[1]), method=method,
    )  # fmt: skip
    taken = math.pi * float(coupled.saturated.covering_radius[0]) ** 2
    found = []
    with one_thread():
        for _ in range(math.ceil(cells**2 / nu)):
            coupled.advance()
        for _ in range(round(10 / speed)):
            coupled.advance()
            mean = np.array(coupled.fluid.momentum()) @ along / cells**2
            found.append((-coupled.fluid_force[0] @ along - against * taken) / (nu * (speed - mean)))
    return float(np.mean(found))
