"""The wetting line of a levee of dry soil whose river rises, figure 16 of Maeda & Sakai 2004, beside Darcy's law.  SI.

Soil of `cases/dry_levee`, held.  Darcy's law is solved on a grid, in a few slow lines (`lines`).
"""

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from continuum_sph.builders.parts.instruments import MeasuredWater
from continuum_sph.builders.parts.phreatic import END, FIRST, NAME, SAG, phreatic_row
from continuum_sph.builders.parts.pore_water import REACH
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.types import Floats
from porescale.common.evidence.convergence import Ladders
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS, LADDERS = Validations(), Ladders()

MODULUS = 2.0  # M, m: a river of 0.28 m squeezes water by 14 % at its bottom, in the mean of a levee 4 %
GRID = 0.01  # m: with 0.005 m the mean distance from a line of particles 0.03 m apart changes by 3 %


@dataclass(frozen=True)
class DryLevee:
    """A levee of dry soil with an ``outline`` from foot to foot, m; the river beside it rises from ``low`` to ``high``
    (m) within ``rising`` (s);  wet : soil left of it is full up to the river at the start, m;  permeability m/s."""

    outline: tuple[tuple[float, float], ...] = ((0.3, 0.0), (0.98, 0.34), (1.18, 0.34), (1.86, 0.0))
    low: float = 0.12
    high: float = 0.28
    rising: float = 5.0
    wet: float = 0.54
    permeability: float = 0.1
    porosity: float = 0.4

    def level(self, time: float) -> float:
        """Of the river at ``time`` (s), m."""
        return self.low + (self.high - self.low) * min(1.0, time / self.rising)

    def ground(self, x: Floats) -> Floats:
        """Height (k,) m of its surface at ``x`` (k,) m."""
        corners = np.array(self.outline)
        height: Floats = np.interp(x, corners[:, 0], corners[:, 1])
        return height

    def scene(self, spacing: float) -> Scene:
        """The levee on an impervious floor, held, of particles ``spacing`` (m) apart."""
        foot, end = self.outline[0][0], self.outline[-1][0]
        top = max(y for _, y in self.outline)
        return tank_scene(
            end + foot, top + 0.08, spacing, lid=False,
            water={"column": [{"width": self.wet, "height": self.low}]},
            soil={
                "held": True, "porosity": self.porosity, "permeability": self.permeability,
                "body": [{"outline": [list(corner) for corner in self.outline]}],
            },
            reservoir=[
                {"left": 0, "right": 0.8 * foot, "rise": [[0, self.low], [self.rising, self.high]]},
                {"left": end + 0.2 * foot, "right": end + foot, "level": 0},
            ],
        )  # fmt: skip


@functools.cache
def lines(given: DryLevee, times: tuple[float, ...], step: float = GRID) -> tuple[Floats, Floats]:
    """(places x (k,) m, heights (len(times), k) m of the water in the levee ``given`` at ``times``, s, by Darcy's law):
    0 where cells are less than half full.  step : of the grid, m.

    Cells are full, or hold what has come so far; water leaves a cell as its filling lets it, k min(f, 1) ∇H, from the
    cell of the higher head (upwind).  A full cell has the pressure ρ g M (f - 1), M a column that squeezes it by 1/M of
    a metre.  Neither suction, nor inertia, nor air; a river at rest.
    """
    corners = np.array(given.outline)
    x = np.arange(0.5 * step, corners[-1, 0] + 2.0 * step, step)
    y = np.arange(0.5 * step, corners[:, 1].max() + 2.0 * step, step)
    inside = y[None, :] < given.ground(x)[:, None]
    river = ~inside & (x[:, None] < corners[:, 0].mean())
    high = np.broadcast_to(y, inside.shape)
    full = inside & (x[:, None] < given.wet) & (high < given.low)
    filling = np.where(full, 1.0 + (given.low - high) / MODULUS, 0.0)
    dt = 0.2 * step**2 * given.porosity / (given.permeability * MODULUS)
    rate, time, found = given.permeability * dt / (given.porosity * step**2), 0.0, []
    for due in times:
        while time < due:
            now = given.level(time)
            under = river & (high < now)
            head = np.where(under, now, high + MODULUS * np.maximum(filling - 1.0, 0.0))
            open_ = np.where(inside, np.minimum(filling, 1.0), under)
            for axis in range(2):
                a, b = (slice(None, -1), slice(1, None)) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
                fall = head[a] - head[b]
                flux = rate * fall * np.where(fall > 0.0, open_[a], open_[b]) * (inside[a] | inside[b])
                filling[a] -= flux
                filling[b] += flux
            filling[~inside] = 0.0
            time += dt
        half = inside & (filling > 0.5)
        found.append(np.where(half, high + 0.5 * step, 0.0).max(axis=1))
    return x, np.array(found)


def in_strips(given: DryLevee, time: float, x: Floats, line: Floats, spacing: float) -> tuple[float, float]:
    """(end m, sag) that phreatic.csv would say of water up to a ``line`` (k,) m at places ``x`` (k,) m in the levee,
    and beside it up to the river at ``time`` (s): strips of 4 ``spacing`` (m) blunt the corner at the slope."""
    foot, width = given.outline[0][0], given.outline[-1][0] + given.outline[0][0]
    step, top = 0.25 * spacing, max(y for _, y in given.outline)
    places, level = np.arange(0.5 * step, width, step), given.level(time)
    river = (places < 0.5 * width) & (given.ground(places) < level)
    surface = np.where(river | (places < foot), level, np.interp(places, x, line))
    points = np.stack(np.meshgrid(places, np.arange(0.5 * step, top, step), indexing="ij"), axis=2)
    points = points[points[:, :, 1] < surface[:, None]]
    length, at_rest = REACH * spacing * given.porosity**-0.5, np.zeros_like(points)  # as `pore_law` has it
    volume = np.full(len(points), step**2)
    cloud = MeasuredWater(points, volume, at_rest[:, 0], at_rest, length, spacing, width)
    dense = np.arange(foot, width - foot, step)
    row = phreatic_row(cloud, np.column_stack((dense, given.ground(dense) - 0.5 * spacing)))
    return row[END], row[SAG]


LEVEE = DryLevee()
TIMES = (3.0, 4.0)  # s: the foot under the slope, and under the crest
SPACINGS = (0.03, 0.02, 0.015)  # m


def heights(given: DryLevee, spacing: float, times: Sequence[float]) -> tuple[Floats, Floats]:
    """(places (k,) m of the strips of phreatic.csv, heights (len(times), k) m of the water there at ``times``, s)."""
    model, found = Simulation(given.scene(spacing)), []
    x: list[float] = []
    for time in times:
        while model.time < time:
            model.advance(1)
        row = {name: value for name, value in model.tables()[NAME].items() if name.startswith(FIRST)}
        x = [float(name.removeprefix(FIRST).split()[0]) for name in row]
        found.append(list(row.values()))
    return np.array(x), np.array(found)


@functools.cache
def apart(spacing: float, given: DryLevee = LEVEE, times: tuple[float, ...] = TIMES) -> float:
    """Mean distance in height (m), at ``times`` (s), of the wetting line of particles ``spacing`` (m) apart from that
    of Darcy's law: the area between them in the ground over the length on which there is water."""
    x, exact = lines(given, times)
    at, found = heights(given, spacing, times)
    ground = given.ground(x)
    distances = []
    for darcy, line in zip(exact, found, strict=True):
        here = np.minimum(np.interp(x, at, line), ground)
        wet = (ground > 0.0) & np.maximum(darcy, here).astype(bool)
        distances.append(np.abs(here - np.minimum(darcy, ground))[wet].mean())
    return float(np.mean(distances))


@VALIDATIONS.row(
    "continuum.wetting_line_of_a_levee",
    source="derived: Darcy's law in a levee that a rising river wets, on a grid (`lines`); Maeda & Sakai 2004, fig. 16",
    because="rows of water in pores are 1/√n spacings apart, and a surface is known to half a row, 0.79 spacings",
    tolerance=0.5 * LEVEE.porosity**-0.5,
    slow=True,
)
def line_row() -> Measured:
    """Mean distance of the wetting line from Darcy's, spacings, at three spacings."""
    return Measured.absolute([0.0] * len(SPACINGS), [apart(spacing) / spacing for spacing in SPACINGS])


@LADDERS.ladder(
    "seepage.wetting_line",
    title="Mean distance (m) in height of the wetting line of a levee from that of Darcy's law",
    along="particles over 0.3 m",
    levels=tuple(0.3 / spacing for spacing in SPACINGS),
    expected=1.0,
    within=0.25,
    because="a surface in pores is known to half a row, and grains are smeared over a smoothing length: first order",
)
def line_error(across: float) -> float:
    """As the row of its name."""
    return apart(0.3 / across)
