"""Steady flow through ground that is held, between faces of given head, and what of it is known exactly.  SI."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipk

from continuum_sph.build.sheet_pile import reach, steepness
from continuum_sph.seepage import Drain, Frame, PoreFlow, Resistance, Seepage
from continuum_sph.seepage.overlap import Overlap
from continuum_sph.seepage.sheet_pile import PartedList, Pile
from continuum_sph.validation.soil_trials import RATIO, SKIN
from continuum_sph.water.density import LINEAR
from continuum_sph.water.eos import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import Smoothing
from continuum_sph.water.state import VX, VY, Layer
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import PairList, square_lattice

Floats = NDArray[np.float64]

WATER = 1000.0  # kg/m³
POROSITY = 0.4
WALLS = 3  # layers


@dataclass(frozen=True)
class Face:
    """A stretch of a rectangle's boundary with a head, m above that of the water at rest, between two places along it.

    side : "left", "right", "floor" or "lid";  head m;  start, end: m along the side.
    """

    side: str
    head: float
    start: float = -np.inf
    end: float = np.inf


def held_ground(
    size: tuple[float, float],
    spacing: float,
    faces: list[Face],
    permeability: float,
    pace: float = 0.3,
    pile: Pile | None = None,
) -> Seepage:
    """A rectangle (width, height), m, of saturated ground that is held, its water at rest but for the ``faces``.

    Pressures are those above water at rest, so gravity plays no part.  pace : sound speed of the water times k, m²/s²:
    pressure spreads by c² k/(n g), so what is steady is so after the same number of steps for any k.  pile : what cuts
    the ground from above, if anything does.
    """
    width, height = size
    smoothing, at = Smoothing("wendland", RATIO * spacing), square_lattice((0.0, 0.0), size, spacing)
    walls, side = tank_walls(width, height, spacing, WALLS, lid=True), np.zeros(0, np.int64)
    if pile:
        at = at[~pile.holds(at)]
        piled, _, side = pile.particles(WALLS, height)
        walls = np.concatenate((walls, piled))
    n = len(at)
    frame = Frame(at.copy(), spacing**2, POROSITY, permeability)
    fluid = Fluid(Tait(WATER, pace / permeability))
    rules = Law(smoothing, spacing, (fluid,), (0.0, 0.0), diffusion=0.02, noise=LINEAR, cut=False, corrected=True)
    margin, skin = WALLS * spacing, SKIN * smoothing.length
    box = (-margin, -margin), (width + margin, height + margin)
    mass = np.full(n + len(walls), WATER * spacing**2)
    layer = Layer(n, np.concatenate((at, walls)), np.zeros((len(mass), 2)), mass, np.full(n, WATER))
    pairs, overlap = PairList(layer.count, skin, *box, full=True), Overlap(n, n, smoothing.length, skin, *box)
    if pile:
        pairs, overlap.pairs = PartedList(pairs, pile, n, side, layer.v), PartedList(overlap.pairs, pile)
    flow = PoreFlow(
        layer, rules, pairs, skeleton=frame.skeleton, overlap=overlap, resistance=Resistance(POROSITY)
    )  # fmt: skip
    beside = walls[: len(walls) - len(side)]
    for face in faces:
        flow.drains.append(_drain(face, beside, n, size))
    both = Seepage(flow, frame)
    both.start()
    mass[:n] = flow.porosity * WATER * spacing**2
    both.start()
    return both


def _drain(face: Face, walls: Floats, first: int, size: tuple[float, float]) -> Drain:
    """The face's wall particles, those in corners left out;  first: number of the first wall particle."""
    width, height = size
    x, y = walls.T
    beside = (y > 0.0) & (y < height)
    upright = (x > 0.0) & (x < width)
    mask, point, normal, along = {
        "left": (beside & (x < 0.0), (0.0, 0.0), (1.0, 0.0), y),
        "right": (beside & (x > width), (width, 0.0), (-1.0, 0.0), y),
        "floor": (upright & (y < 0.0), (0.0, 0.0), (0.0, 1.0), x),
        "lid": (upright & (y > height), (0.0, height), (0.0, -1.0), x),
    }[face.side]
    rows = first + np.flatnonzero(mask & (along > face.start) & (along < face.end))
    return Drain(rows, point, normal, np.full(len(rows), WATER * GRAVITY * face.head))


def flux(both: Seepage) -> tuple[Floats, Floats, Floats]:
    """Places (n, 2) m, flux q of the water (n, 2) m/s and whole volumes (n,) m² of the water's particles."""
    layer = both.water.layer
    n = layer.fluid
    volume = layer.mass[:n] / (both.water.porosity * layer.density)
    return layer.x[:n], layer.record[:n, VX : VY + 1], volume


@dataclass(frozen=True)
class SheetPile:
    """Ground of depth T before an impervious base, cut by a sheet pile to the depth s T; the half on one side of it.

    The head below the pile is half that across it, by antisymmetry, so a sheet without thickness is a wall of the half.
    share : s/T;  rows : particles over T;  reach : width of the half over T.
    Exact: q/(k h) = K'(m)/(2 K(m)), m = sin(πs/2T), exit gradient at the pile πh/(4 K m T) (Harr 1962, from Muskat).
    """

    share: float
    rows: int = 24
    reach: float = 2.5
    permeability: float = 1e-3

    @property
    def discharge(self) -> float:
        """q/(k h)."""
        m = np.sin(0.5 * np.pi * self.share)
        return float(ellipk(1.0 - m * m) / (2.0 * ellipk(m * m)))

    @property
    def exit_gradient(self) -> float:
        """i_E T/h."""
        m = np.sin(0.5 * np.pi * self.share)
        return float(np.pi / (4.0 * ellipk(m * m) * m))

    def run(self, steps: int) -> tuple[float, float, Seepage]:
        """(q/(k h), i_E T/h, the ground) after ``steps``, for T = h = 1 m."""
        spacing = 1.0 / self.rows
        faces = [Face("left", 0.5, end=1.0 - self.share), Face("lid", 0.0)]
        both = held_ground((self.reach, 1.0), spacing, faces, self.permeability)
        for _ in range(steps):
            both.advance()
        x, q, volume = flux(both)
        band = (x[:, 1] > 1.0 - 6.0 * spacing) & (x[:, 1] < 1.0 - 2.0 * spacing)
        through = float((volume * q[:, 1])[band].sum()) / (4.0 * spacing)
        column = (x[:, 0] < spacing) & (x[:, 1] > 1.0 - reach(self.share, spacing))
        head = both.water.layer.pressure[: len(x)][column] / (WATER * GRAVITY)
        return through / self.permeability, steepness(1.0 - x[column, 1], head), both
