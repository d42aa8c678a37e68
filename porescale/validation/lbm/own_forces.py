"""Flows under a body force of every cell, as a user's function gives it, with exact answers.  Lattice units."""

import math

import numpy as np

from porescale.common.core.types import Reals
from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time
from porescale.validation.lbm.channels import MEMORY, one_thread, order, run

VALIDATIONS = Validations()

NU = 1 / 6
PEAK = 1e-3
"""Speed (lattice units) of the coarsest flows; it falls with the cells, as the step of a finer lattice does."""
STEADY = (8, 16, 32)
"""Cells along a wave of a steady flow."""
SWINGING = (16, 32, 64)
"""Cells across a channel that swings."""
WOMERSLEY = 4.5
"""Half width of the channel times sqrt(omega/nu)."""
PERIODS = 16
"""After which the start has faded, to e^(-pi² 2 pi PERIODS/(4 WOMERSLEY²))."""


def kolmogorov(cells: int, magic: float = MAGIC_MIDWAY_WALL) -> float:
    """Amplitude of the steady flow under a force a sin(k y), over a/(nu k²), less 1.  One wave in a periodic box."""
    k = 2 * math.pi / cells
    peak = PEAK * STEADY[0] / cells
    fluid = Fluid(3, cells, relaxation_time(NU), magic=magic, sides=Sides(*4 * ("periodic",)))
    wave = np.sin(k * (np.arange(cells) + 0.5))
    field = np.zeros((2, cells, 3))
    field[0] = (peak * NU * k**2 * wave)[:, None]
    fluid.set_force_field(field)
    run(fluid.advance, math.ceil(MEMORY / (NU * k**2)))
    return float(2 * np.mean(fluid.fields()[1][:, 1] * wave) / peak - 1)


def womersley(y: Reals, height: float, omega: float, force: float, time: float) -> Reals:
    """Velocity at ``y`` of a channel whose fluid is accelerated by force cos(omega t) (Womersley 1955, plane)."""
    root = np.sqrt(1j * omega / NU)
    shape = 1 - np.cosh(root * (y - height / 2)) / np.cosh(root * height / 2)
    return np.asarray((force / (1j * omega) * shape * np.exp(1j * omega * time)).real)


def swinging(cells: int, *, late: float = 0.0) -> float:
    """Largest error of a channel between walls under a force that oscillates, over its largest speed.

    The force of a step is the mean of that at its begin and its end.  late : radians by which the exact flow is late.
    """
    omega = NU * (2 * WOMERSLEY / cells) ** 2
    force = PEAK * SWINGING[0] / cells * omega
    fluid = Fluid(3, cells, relaxation_time(NU), sides=Sides(left="periodic", right="periodic"))
    field = np.zeros((2, cells, 3))
    field[0] = force
    fluid.set_force_field(field)
    steps = round(2 * math.pi * PERIODS / omega)
    with one_thread():
        for step in range(1, steps + 1):
            fluid.advance()
            field[0] = force * math.cos(omega * step)
    y = np.arange(cells) + 0.5
    exact = womersley(y, cells, omega, force, steps - late / omega)
    return float(np.abs(fluid.fields()[1][:, 1] - exact).max() / np.abs(exact).max())


BOUND = (2 * math.pi / STEADY[-1]) ** 2 / 24
NARROW = (2 * WOMERSLEY / SWINGING[-1]) ** 2 / 24


@VALIDATIONS.row(
    "lbm.kolmogorov_flow",
    source="exact: amplitude a/(nu k²) under a force a sin(k y) of every cell, 32 cells a wave",
    because="second order: 2/3 (1/4 - magic) (k h)² with magic 3/16, (k h)²/24; the next term takes away from it",
    tolerance=BOUND,
)
def kolmogorov_row() -> Measured:
    """Amplitude over the exact one."""
    return Measured.absolute(1.0, 1 + kolmogorov(STEADY[-1]))


@VALIDATIONS.row(
    "lbm.kolmogorov_flow_order",
    source="as for the amplitude, 8, 16 and 32 cells a wave",
    because="the next term of the error is fourth order: 0.1 (k h)² of it, 0.06 at 8 cells, so 0.1 in the order",
    tolerance=0.1,
)
def kolmogorov_order() -> Measured:
    """Order of convergence of the amplitude."""
    return Measured.absolute(2.0, order([abs(kolmogorov(cells)) for cells in STEADY]))


@VALIDATIONS.row(
    "lbm.womersley_channel",
    source="Womersley 1955, plane: a channel under a force of every cell a cos(omega t), Womersley number 4.5",
    because="second order: (h/d)²/24 as for a wave under a force, d = sqrt(nu/omega), 64 cells",
    tolerance=NARROW,
)
def womersley_row() -> Measured:
    """Largest error of the profile over the largest speed, after sixteen periods."""
    return Measured.absolute(0.0, swinging(SWINGING[-1]))


@VALIDATIONS.row(
    "lbm.womersley_channel_order",
    source="as for the profile, 16, 32 and 64 cells",
    because="the next term is fourth order: (h/d)²/3 of it at 16 cells, 0.1, so 0.1 in the order over two doublings",
    tolerance=0.1,
)
def womersley_order() -> Measured:
    """Order of convergence of the profile."""
    return Measured.absolute(2.0, order([swinging(cells) for cells in SWINGING]))
