"""Channels and vortices with exact answers.  Lattice units."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from porescale.common.compiled.jit import set_threads, threads
from porescale.common.core.types import Reals
from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.collision.trt import antisymmetric_rate
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time

MEMORY = 40.0
"""e-folds after which a start has been forgotten: exp(-40) = 4e-18 is below round-off."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Within this, kernels run on one thread: in a box of a few cells waiting for a second one is all that is done."""
    before = threads()
    set_threads(1)
    try:
        yield
    finally:
        set_threads(before)


def run(advance: Callable[[], object], steps: int) -> None:
    """Call ``advance`` so many times, on one thread."""
    with one_thread():
        for _ in range(steps):
            advance()


def steady_steps(height: int, viscosity: float, magic: float) -> int:
    """Steps until a channel is steady to round-off: slowest viscous mode, and the memory of both halves.

    Between walls one cell apart the halves' transient decays three times more slowly (measured: e in 9 steps, tau 3.5).
    """
    tau = relaxation_time(viscosity)
    return math.ceil(MEMORY * (height**2 / (math.pi**2 * viscosity) + 3 * (tau + 1 / antisymmetric_rate(tau, magic))))


def poiseuille(
    height: int, viscosity: float, magic: float = MAGIC_MIDWAY_WALL, peak: float = 1e-3
) -> tuple[Reals, Reals]:
    """Velocity of each row over the exact peak, measured and exact, (height,); started from rest.

    Two walls at rest, half a cell outside the first and last row, and a body force.  The exact parabola is that of
    walls midway; u = 4 y (H - y)/H².
    """
    force = 8 * viscosity * peak / height**2
    sides = Sides(left="periodic", right="periodic")
    fluid = Fluid(3, height, relaxation_time(viscosity), magic=magic, force=(force, 0.0), sides=sides)
    run(fluid.advance, steady_steps(height, viscosity, magic))
    y = np.arange(height) + 0.5
    return fluid.fields()[1][:, 1] / peak, 4 * y * (height - y) / height**2


def couette(
    height: int, viscosity: float, magic: float = MAGIC_MIDWAY_WALL, speed: float = 1e-3
) -> tuple[Reals, Reals]:
    """Velocity of each row over the lid's, measured and exact, y/H, (height,); started from rest."""
    sides = Sides(left="periodic", right="periodic", top_speed=speed)
    fluid = Fluid(3, height, relaxation_time(viscosity), magic=magic, sides=sides)
    run(fluid.advance, steady_steps(height, viscosity, magic))
    return fluid.fields()[1][:, 1] / speed, (np.arange(height) + 0.5) / height


def begun_couette(relaxation_time: float, height: int = 30) -> tuple[Reals, Reals]:
    """Velocity of each row over the lid's after a tenth of H²/nu, measured and exact, (height,); started from rest.

    Exact: y/H + sum over k of 2 (-1)^k/(k pi) exp(-k² pi² nu t/H²) sin(k pi y/H).
    """
    viscosity, speed = (relaxation_time - 0.5) / 3, 1e-3
    fluid = Fluid(3, height, relaxation_time, sides=Sides(left="periodic", right="periodic", top_speed=speed))
    steps = round(0.1 * height**2 / viscosity)
    run(fluid.advance, steps)
    k = np.arange(1, 20)[:, None]
    y = (np.arange(height) + 0.5) / height
    decay = np.exp(-((k * math.pi) ** 2) * viscosity * steps / height**2)
    exact = y + (2 * (-1.0) ** k / (k * math.pi) * decay * np.sin(k * math.pi * y)).sum(axis=0)
    return fluid.fields()[1][:, 1] / speed, exact


def taylor_green(
    cells: int,
    *,
    viscosity: float = 0.05,
    speed: float = 1.6,
    drift: float = 0.8,
    lasts: float = 1.0,
    operator: str = "trt",
) -> float:
    """Error (root mean square over that of the exact field) of decaying vortices that a uniform flow carries along.

    Diffusive scaling: velocities are ``speed``/cells and ``drift``/cells, the time is such that the vortices decay
    by exp(-lasts).  cells: of the square periodic box, which holds one wave along x and y.
    """  # fmt: skip
    k = 2 * math.pi / cells
    decay = 2 * viscosity * k**2
    steps = round(lasts / decay)
    top, carried = speed / cells, drift / cells
    periodic = Sides("periodic", "periodic", "periodic", "periodic")
    fluid = Fluid(cells, cells, relaxation_time(viscosity), operator=operator, sides=periodic)

    def exact(time: float) -> tuple[Reals, Reals, Reals]:
        """The vortices where they have been carried, faded by then."""
        x, y = np.meshgrid(np.arange(cells) - carried * time, np.arange(cells) - 0.5 * carried * time)
        a = top * math.exp(-decay * time)
        ux, uy = -a * np.cos(k * x) * np.sin(k * y), a * np.sin(k * x) * np.cos(k * y)
        pressure = -0.25 * a**2 * (np.cos(2 * k * x) + np.cos(2 * k * y))
        return 1 + 3 * pressure, ux + carried, uy + 0.5 * carried

    rho, ux, uy = exact(0.0)
    fluid.set_flow(ux, uy, rho)
    for _ in range(steps):
        fluid.advance()
    _, ux, uy = fluid.fields()
    _, vx, vy = exact(steps)
    size = np.mean((vx - carried) ** 2 + (vy - 0.5 * carried) ** 2)
    return float(np.sqrt(np.mean((ux - vx) ** 2 + (uy - vy) ** 2) / size))


def order(errors: list[float], ratio: float = 2.0) -> float:
    """Slope of log(error) against log(resolution), least squares; each resolution is ``ratio`` times the last."""
    return -float(np.polyfit(np.arange(len(errors)) * math.log(ratio), np.log(errors), 1)[0])


VALIDATIONS = Validations()

HEIGHT = 10  # cells between the walls
VISCOSITIES = (1 / 30, 1 / 6, 1.0)  # tau 0.6, 1, 3.5
OTHER_MAGIC = 1.0
ROUND_OFF = float(np.finfo(float).eps)
FORGETTING = (
    "round-off: nine roundings of a step, all one way, remembered for H²/(pi² nu) steps, are eps H²/nu of the peak;"
    " the error is given in units of H²/nu"
)


@VALIDATIONS.row(
    "lbm.poiseuille_walls_midway_at_magic_3_16",
    source="exact parabola; Ginzburg, Verhaeghe & d'Humieres 2008",
    because=FORGETTING,
    tolerance=ROUND_OFF,
)
def poiseuille_row() -> Measured:
    """Largest deviation of the profile from the parabola, tau 0.6, 1 and 3.5."""
    return _profiles([poiseuille(HEIGHT, viscosity) for viscosity in VISCOSITIES], HEIGHT // 2)


def _profiles(pairs: list[tuple[Reals, Reals]], row: int) -> Measured:
    """Velocities found and exact at all `VISCOSITIES` in one ``row``; the error is of all rows, in units of H²/nu."""
    errors = [
        float(np.abs(found - exact).max()) * nu / HEIGHT**2
        for (found, exact), nu in zip(pairs, VISCOSITIES, strict=True)
    ]
    return Measured([float(exact[row]) for _, exact in pairs], [float(found[row]) for found, _ in pairs], max(errors))


@VALIDATIONS.row(
    "lbm.poiseuille_slip_at_another_magic",
    source="slip of half-way bounce-back, (16 L/3 - 1)/H² of the peak (Ginzburg & d'Humieres 2003)",
    because="relative; round-off of the profile, eps H²/nu, over the slip, (16/3 - 1)/H²: eps H^4/(4 nu)",
    tolerance=ROUND_OFF * HEIGHT**4 / (4 * VISCOSITIES[1]),
)
def slip() -> Measured:
    """How far magic 1 lifts the whole profile, over its peak."""
    found, parabola = poiseuille(HEIGHT, VISCOSITIES[1], OTHER_MAGIC)
    exact = (OTHER_MAGIC / MAGIC_MIDWAY_WALL - 1) / HEIGHT**2
    lifted = found - parabola
    return Measured(exact, float(lifted.mean()), float(np.abs(lifted / exact - 1).max()))


@VALIDATIONS.row(
    "lbm.couette",
    source="exact: linear between the walls, at any magic parameter",
    because=FORGETTING,
    tolerance=ROUND_OFF,
)
def couette_row() -> Measured:
    """Largest deviation of the profile from the straight line, tau 0.6, 1 and 3.5, magic 1."""
    return _profiles([couette(HEIGHT, viscosity, OTHER_MAGIC) for viscosity in VISCOSITIES], -1)


@VALIDATIONS.row(
    "lbm.begun_couette",
    source="exact series of a wall that starts to move between two walls 30 cells apart, after 0.1 H²/nu",
    because="of the lid's speed; populations forget in tau = 3 steps of the 1080 of H²/nu, and half as fast as the wall"
    " moves the profile follows: 3/1080 of a start that is late; as much is allowed from there",
    tolerance=3e-3,
)
def begun_couette_row() -> Measured:
    """Largest deviation of the profile at a relaxation time of 3, beyond which `check` warns."""
    found, exact = begun_couette(3.0)
    return Measured(float(exact[-1]), float(found[-1]), float(np.abs(found - exact).max()))


@VALIDATIONS.row(
    "lbm.taylor_green_order",
    source="Taylor & Green 1937, vortices that a uniform flow carries; diffusive scaling",
    because="the next term of the error is fourth order: (16/32)² of 1.5 % of 16's own error, 0.01; 0.1 required",
    tolerance=0.1,
)
def taylor_green_row() -> Measured:
    """Order of convergence over 16, 32 and 64 cells."""
    return Measured.absolute(2.0, order([taylor_green(cells) for cells in (16, 32, 64)]))
