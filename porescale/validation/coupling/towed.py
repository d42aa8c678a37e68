"""Discs that are held or towed in slow flow, with known drag and torque: arrays, channels, walls; lattice units.

A disc towed so slowly that it stays in its place while the flow becomes steady gives the quasi-steady load.
"""

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.step import Coupled
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.setups import DEFAULT, LAW, PERIODIC, TAU, Method, lattice_units
from porescale.validation.lbm.channels import one_thread, run

VALIDATIONS = Validations()


def faxen(k: float) -> float:
    """Drag F/(mu U) of a cylinder towed midway between walls, k radius over half width (Faxen 1946)."""
    return 4 * math.pi / (-math.log(k) - 0.9157 + 1.7244 * k**2 - 1.7302 * k**4 + 2.4056 * k**6 - 4.5913 * k**8)


def weighing(
    relaxation_time: float, cells: int = 40, radius: float = 5.0, steps: int = 5000, method: Method = DEFAULT
) -> tuple[float, float]:
    """Load over F of a disc held in a closed box under a downward body force F on the fluid, and the area it covers."""
    force = 1e-6
    fluid = Fluid(cells, cells, relaxation_time, force=(0.0, -force))
    wet = SaturatedCells(fluid, np.array([radius]), solid_operator=method.solid_operator, weighting=method.weighting)
    place, rest, no_spin = np.array([[0.3, 0.1]]) + cells / 2, np.zeros((1, 2)), np.zeros(1)
    run(lambda: wet.advance(fluid, place, rest, no_spin), steps)
    return float(wet.force[0, 1]) / force, math.pi * float(wet.covering_radius[0]) ** 2


def spinning_disc(
    steps: Sequence[int], *, relaxation_time: float = 1.5, spin: float = 0.02, method: Method = DEFAULT
) -> tuple[list[float], list[float]]:
    """Density at the centre, and torque, of a disc kept spinning (radius 5 in 30 x 30 cells) after ``steps``."""
    fluid = Fluid(30, 30, relaxation_time)
    wet = SaturatedCells(
        fluid, np.array([5.0]), solid_operator=method.solid_operator, weighting=method.weighting
    )  # fmt: skip
    place, rest, turning = np.array([[15.3, 15.1]]), np.zeros((1, 2)), np.array([spin])
    density, torque = [], []
    with one_thread():
        for step in range(1, max(steps) + 1):
            wet.advance(fluid, place, rest, turning)
            if step in steps:
                density.append(float(fluid.fields()[0][15, 15]))
                torque.append(float(wet.torque[0]))
    return density, torque


SLOW = 1e-9
"""Speed of a disc that is towed in its place: less than a ten-thousandth of a cell until the flow is steady."""

PLACES = ((0.0, 0.0), (0.3, 0.1), (0.5, 0.25), (0.4, 0.45))
"""Places of a centre within a cell, of which the mean is taken."""


def towed(
    cells: tuple[int, int],
    position: ArrayLike,
    radius: ArrayLike,
    velocity: ArrayLike = 0.0,
    spin: ArrayLike = 0.0,
    *,
    relaxation_time: float = TAU,
    sides: Sides | None = None,
    force: tuple[float, float] = (0.0, 0.0),
    density: ArrayLike = 1.0,
    lubrication: bool = False,
    solid_walls: bool = False,
    method: Method = DEFAULT,
) -> Coupled:
    """Held discs in fluid at rest under a body force; they touch neither each other's images nor, by default, walls."""
    fluid = Fluid(
        *cells, relaxation_time, operator=method.operator, magic=method.magic, force=force, sides=sides or Sides()
    )
    kind = "solid" if solid_walls else "open"
    box = Box((0.0, 0.0), (float(cells[0]), float(cells[1])), kind, kind, kind, kind)
    grains = Grains(make_discs(position, radius, density, velocity, spin), LAW, box)
    coupled = Coupled(
        fluid, grains, lattice_units(relaxation_time), hydraulic_ratio=1.0, contact_steps=4, acceleration=(0.0, 0.0),
        solid_operator=method.solid_operator, weighting=method.weighting, lubrication=lubrication,
    )  # fmt: skip
    grains.hold(slice(None))
    return coupled


def steady(coupled: Coupled, value: Callable[[], float], memory: float, change: float = 1e-5) -> float:
    """``value`` once it changes by less than ``change`` of itself over a ``memory`` (steps, at least 50)."""
    before = math.nan
    with one_thread():
        while True:
            for _ in range(max(50, math.ceil(memory))):
                coupled.advance()
            now = value()
            if abs(now - before) <= change * abs(now):
                return now
            before = now


def square_array_drag(
    diameter: float,
    solid_fraction: float,
    *,
    relaxation_time: float = TAU,
    places: Sequence[tuple[float, float]] = PLACES,
    method: Method = DEFAULT,
) -> list[float]:
    """Drag F/(mu U) of a square array of fixed discs about ``diameter`` wide, for each place of the centre in a cell.

    The period is rounded to whole cells, the diameter follows.  Driven by a body force G: the drag is G times the box,
    U the conserved flux sum f c/N, without half the force (Stokes flow).
    """  # fmt: skip
    cells = round(diameter * math.sqrt(math.pi / (4 * solid_fraction)))
    radius = cells * math.sqrt(solid_fraction / math.pi)
    nu = viscosity(relaxation_time)
    force = 1e-6 * nu
    found = []
    for place in places:
        coupled = towed(
            (cells, cells), [(cells / 2 + place[0], cells / 2 + place[1])], radius, relaxation_time=relaxation_time,
            sides=PERIODIC, force=(force, 0.0), method=method,
        )  # fmt: skip
        # what relaxes last is the mean flow, against the drag K mu on it
        memory = cells**2 / (nu * (4 * math.pi / max(0.1, -0.5 * math.log(solid_fraction) - 0.7)))
        flux = steady(coupled, lambda c=coupled: c.fluid.momentum()[0] / cells**2, memory)  # type: ignore[misc]
        found.append(force * cells**2 / (nu * flux))
    return found


def channel_drag(
    blockage: float, diameter: float = 10.0, *, place: tuple[float, float] = (0.3, 0.0)
) -> tuple[float, float]:
    """Drag F/(mu U) of a disc towed midway between walls at rest, and the blockage k = a/h that whole cells allow.

    The channel is closed two heights off, where the disturbance has decayed by exp(-4.2 * 2 * 2): no net flux.
    """  # fmt: skip
    height = round(diameter / blockage)
    cells = 4 * height, height
    coupled = towed(cells, [(cells[0] / 2 + place[0], height / 2 + place[1])], diameter / 2, (SLOW, 0.0))
    nu = viscosity(TAU)
    force = steady(coupled, lambda: float(coupled.fluid_force[0, 0]), (height / (2 * math.pi)) ** 2 / nu)
    return -force / (nu * SLOW), diameter / height


def near_wall(
    motion: str,
    gap: float = 0.2,
    radius: float = 10.0,
    *,
    across: float = 12.0,
    relaxation_time: float = TAU,
    lubrication: bool = False,
) -> float:
    """F/(mu U) along or towards the floor, or T/(mu a² w), of a disc with its rim ``gap`` radii above the floor.

    motion: "along", "towards", "turning";  across: width of the closed box in radii, its height is half of it.
    """  # fmt: skip
    cells = round(across * radius), round(across * radius / 2)
    ways = {"along": (SLOW, 0.0, 0.0), "towards": (0.0, -SLOW, 0.0), "turning": (0.0, 0.0, SLOW / radius)}
    *velocity, spin = ways[motion]
    coupled = towed(
        cells, [(cells[0] / 2 + 0.3, radius * (1 + gap))], radius, velocity, spin, density=2.0,
        relaxation_time=relaxation_time, lubrication=lubrication, solid_walls=True,
    )  # fmt: skip
    nu = viscosity(relaxation_time)
    unit = nu * SLOW * (radius if motion == "turning" else 1.0)

    def load() -> float:
        """Drag, lift or torque over its unit, films included."""
        if motion == "turning":
            return -float(coupled.fluid_torque[0]) / unit
        film = coupled.lubrication.force[0] if coupled.lubrication else np.zeros(2)
        force = coupled.fluid_force[0] + film
        return float(-force[0] if motion == "along" else force[1]) / unit

    return steady(coupled, load, (cells[1] / (2 * math.pi)) ** 2 / nu)


def jeffrey_onishi(gap: float) -> float:
    """The exact answer of ``near_wall`` "towards" a plane wall and nothing else (Jeffrey & Onishi 1981)."""
    alpha = math.acosh(1 + gap)
    return 4 * math.pi / (alpha - math.tanh(alpha))


def under_way(
    diameter: float, speed: float, degrees: float, drag: float, *, relaxation_time: float, method: Method = DEFAULT
) -> Iterator[tuple[Coupled, Floats, float]]:
    """A disc towed through a periodic box of four diameters, at an angle to the grid, after each step over ten cells.

    Once the flow is steady: (the box, direction (2,), body force against ``drag``, F/(mu U) expected).
    """
    cells, nu = round(4 * diameter), viscosity(relaxation_time)
    along = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    against = -drag * nu * speed / cells**2
    coupled = towed(
        (cells, cells), [(cells / 2, cells / 2)], diameter / 2, speed * along, relaxation_time=relaxation_time,
        sides=PERIODIC, force=(against * along[0], against * along[1]), method=method,
    )  # fmt: skip
    run(coupled.advance, math.ceil(cells**2 / nu))
    for _ in range(round(10 / speed)):
        run(coupled.advance, 1)
        yield coupled, along, against


def towed_noise(
    diameter: float = 10.0,
    *,
    relaxation_time: float = TAU,
    speed: float = 0.01,
    degrees: float = 11.0,
) -> float:
    """Rms of the drag over its mean: a disc towed through a periodic box of four diameters, at an angle to the grid.

    A body force keeps the fluid from being carried along: the drag of the array, so that the mean flow is all but 0.
    Over ten cells, once the flow is steady; a slow trend (parabola) is taken out.
    """  # fmt: skip
    held_back = sangani_acrivos(math.pi / 4 * (diameter / round(4 * diameter)) ** 2)
    way = under_way(diameter, speed, degrees, held_back, relaxation_time=relaxation_time)
    drag = np.array([-coupled.fluid_force[0] @ along for coupled, along, _ in way])
    x = np.linspace(-1, 1, len(drag))
    smooth = np.polyval(np.polyfit(x, drag, 2), x)
    return float(np.sqrt(np.mean((drag - smooth) ** 2)) / abs(drag.mean()))


def sangani_acrivos(solid_fraction: float) -> float:
    """Drag F/(mu U) of a dilute square array, F per length, U superficial (Sangani & Acrivos 1982)."""
    c = solid_fraction
    return 4 * math.pi / (-0.5 * math.log(c) - 0.738 + c - 0.887 * c**2 + 2.038 * c**3)


NEAR_WALL = {"along": 31.593, "towards": 181.712, "turning": 24.006}
"""Rim 0.2 radii above the floor of a closed box of 12 by 6 radii: tests/reference/coupling/stokes_box.py, to five
digits."""

RADIUS = 7.3e-3
"""How much of its radius a disc 10 cells wide may look too big or small in one place: 2 % of a drag that goes as its
power 2.75, as on arrays of solid fraction 0.2 (arrays.py)."""


@VALIDATIONS.row(
    "coupling.towed_in_a_channel",
    source="Faxen 1946: cylinder towed midway between walls through fluid at rest, k 0.2 and 0.3",
    because="0.73 % of the radius, as on arrays; the drag goes as its power d ln F/d ln k = 1.15 and 1.7: 1.24 %",
    tolerance=1.7 * RADIUS,
)
def channel() -> Measured:
    """Drag F/(mu U) at 10 cells per diameter."""
    drags = [channel_drag(k) for k in (0.2, 0.3)]
    return Measured.relative([faxen(k) for _, k in drags], [drag for drag, _ in drags])


@VALIDATIONS.row(
    "coupling.towed_in_a_wide_channel",
    source="Faxen 1946, k 0.1",
    because="as in the narrower channels, the drag going as the power 0.69: 0.5 %",
    tolerance=0.69 * RADIUS,
    slow=True,
)
def wide_channel() -> Measured:
    """Drag F/(mu U) at 10 cells per diameter."""
    drag, k = channel_drag(0.1)
    return Measured.relative(faxen(k), drag)


@VALIDATIONS.row(
    "coupling.cylinder_near_a_wall",
    source="Jeffrey & Onishi 1981, h_c/a 1.2: 20.19, 180.6, 22.73; with the other walls of the box: point forces",
    because="4.6 %: dense arrays are allowed 5 % where the force goes as the gap of 2.9 cells to the power -5/2: 0.03"
    " cells a rim, and (2.9/2)² times that at a gap of 2; towards the wall the force goes as its power -3/2",
    tolerance=0.046,
    slow=True,
)
def near_wall_row() -> Measured:
    """F/(mu U) along and towards the wall, T/(mu a² w), radius 10 cells, tau 0.6."""
    return Measured.relative(list(NEAR_WALL.values()), [near_wall(motion, relaxation_time=0.6) for motion in NEAR_WALL])


@VALIDATIONS.row(
    "coupling.towed_noise",
    source="steady drag, whatever the place in the cell",
    because="required: 0.35 % at 10 cells per diameter, tau 0.8",
    tolerance=3.5e-3,
)
def noise() -> Measured:
    """Rms of the drag over its mean, at 0.01 and 11 degrees to the grid in a periodic box of 4 diameters."""
    return Measured.absolute(0.0, towed_noise())


@VALIDATIONS.row(
    "coupling.disc_at_rest_in_a_body_force",
    source="Archimedes: water at rest bears F times the area that a disc takes of it",
    because="1e-5: sound from the start, damped by nu (pi/L)² + sqrt(2 nu w)/L a step in the box and at its walls, is"
    " down to 3e-7 after 5000 steps, and what covered cells exchange among themselves to 2e-6 after 2000",
    tolerance=1e-5,
)
def body_force() -> Measured:
    """Load over F of a disc (5 cells in a closed box of 40) in water under a body force, tau 0.8 and 1.5."""
    pairs = [weighing(tau) for tau in (0.8, 1.5)]
    found, expected = [pair[0] for pair in pairs], [pair[1] for pair in pairs]
    return Measured.relative(expected, found)


@VALIDATIONS.row(
    "coupling.spinning_disc_does_not_drift",
    source="steady state",
    because="density and torque hold to four digits once the fluid inside has come to rest in the turning disc, which"
    " at a rim speed of 0.1 takes some 8000 steps: the change that is left then is 2e-5 and falls",
    tolerance=1e-4,
)
def drift() -> Measured:
    """Density inside, and torque, of a disc kept spinning (R 5 in a box of 30, tau 1.5) at 15 000 and 30 000 steps."""
    density, torque = spinning_disc([15_000, 30_000])
    error = max(abs(density[1] - density[0]), abs(torque[1] / torque[0] - 1))
    return Measured([density[0], torque[0]], [density[1], torque[1]], error)
