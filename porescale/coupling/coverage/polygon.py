"""Convex polygons, at any angle: what they cover of each cell, exactly.

An edge has, in every cell, an area to its right, as far as its own height goes; going down it counts with plus, up with
minus, and the sum over the edges of a polygon (counterclockwise) is what lies within (Green's theorem in a cell).  Of
the part of an edge in one row, ``tall`` high, from column ``left`` to ``right``, w = right - left:

    cells beyond it                  tall
    the one where it ends, i         tall (1 - (right - i)²/(2 w))
    those that it crosses            tall (i + 1/2 - left)/w
    the one where it begins          tall (i + 1 - left)²/(2 w)
    and where all is in one cell     tall (i + 1 - (left + right)/2)

No term is a small difference of large ones: a fraction is good to a few roundings of the corners' places.  Derived
here; rasterisers of outline fonts add up edges alike.

Exact walls hold plane faces where they are, but a disc looks too small by A/R (solid/exact_wall.py): where the outline
turns by dφ an area A dφ is missing.  So it is given back where the outline turns: each corner is drawn out to a tip, a
cell long, of that area.  Of many corners the polygon then becomes the disc with its shift, and a square keeps its drag:
the same area put evenly on the sides leaves 4 % missing at 10 cells a side, as the stress at a corner goes to infinity.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Integers, Reals
from porescale.coupling.coverage.discs import FAR, NOWHERE
from porescale.coupling.coverage.rows import BLOCK, Patches, whole_blocks
from porescale.lbm.fluid import Fluid

STRAIGHT = 1e-9
"""Sine of the turn at a corner down to which, the other way, the outline still counts as convex."""
TIP = 1.0
"""Cells from a corner at which its tip begins."""
SPARE = 3
"""Cells of a patch beyond the polygon's largest extent: two that it touches at its ends, and one for rounding."""


@inline
def add_edge(x0, y0, x1, y1, y, row):
    """Add to every cell of a row what lies to the right of an edge: plus if the edge goes down, minus if up.

    x0, y0, x1, y1: its ends, cells, x within the row;  y: the row's lower side;  row (stride,): overwritten.
    """
    bottom, top = max(min(y0, y1), y), min(max(y0, y1), y + 1.0)
    if not bottom < top:
        return
    tall = top - bottom if y0 > y1 else bottom - top
    slope = (x1 - x0) / (y1 - y0)
    a, b = x0 + (bottom - y0) * slope, x0 + (top - y0) * slope
    left = max(min(a, b), min(x0, x1))
    right = min(max(a, b), max(x0, x1))
    first, last = int(left), int(right)
    if first == last:
        row[first] += tall * (first + 1.0 - 0.5 * (left + right))
    else:
        steep = tall / (right - left)
        row[first] += 0.5 * steep * (first + 1.0 - left) ** 2
        for i in range(first + 1, last):
            row[i] += steep * (i + 0.5 - left)
        row[last] += tall - 0.5 * steep * (right - last) ** 2
    for i in range(last + 1, row.shape[0]):
        row[i] += tall


@inline
def turn_corners(outline, x, y, angle, at):
    """Corners of one polygon from its outline (k, 2) about (x, y); overwrites at (k, 2).

    Returns the smallest and largest x, and y.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    left, right, low, high = math.inf, -math.inf, math.inf, -math.inf
    for k in range(outline.shape[0]):
        ax = x + (cosine * outline[k, 0] - sine * outline[k, 1])
        ay = y + (sine * outline[k, 0] + cosine * outline[k, 1])
        at[k, 0], at[k, 1] = ax, ay
        left, right = min(left, ax), max(right, ax)
        low, high = min(low, ay), max(high, ay)
    return left, right, low, high


@parallel_kernel
def cover_polygons(before, outline, begin, centre, angle, at, line, patches):
    """Exact solid fractions of the cells around every polygon.

    before: bodies whose patches come first;  outline (k, 2): corners from the centre at angle 0, cells,
    counterclockwise, those of polygon n from begin[n] to begin[n + 1] - 1;  centre (m, 2) cells, angle (m,) rad;
    at (k, 2), line (m, widest stride): scratch.  Overwrites the polygons' patches, cut to the cells that they touch:
    corner, height, stride and fraction.  The patch of a centre or angle that is no number, or beyond ``FAR``, lies
    outside of every box with walls.
    """
    # By name: what a loop over threads writes into a member of a tuple is lost.
    corner, height, stride, start, fraction = (
        patches.corner,
        patches.height,
        patches.stride,
        patches.start,
        patches.fraction,
    )
    for n in prange(angle.shape[0]):
        p = before + n
        if not (abs(centre[n, 0]) < FAR and abs(centre[n, 1]) < FAR and abs(angle[n]) < FAR):
            corner[p, 0] = NOWHERE
            corner[p, 1] = NOWHERE
            continue
        own = at[begin[n] : begin[n + 1]]
        # Round-off goes with the numbers: about the cell of the centre corners are no larger than the polygon.
        x0, y0 = math.floor(centre[n, 0]), math.floor(centre[n, 1])
        left, right, low, high = turn_corners(
            outline[begin[n] : begin[n + 1]], centre[n, 0] - x0, centre[n, 1] - y0, angle[n], own
        )
        i0, j0 = math.floor(left), math.floor(low)
        columns = math.floor(right) - i0 + 1
        corner[p, 0] = x0 + i0
        corner[p, 1] = y0 + j0
        height[p] = math.floor(high) - j0 + 1
        stride[p] = (columns + BLOCK - 1) // BLOCK * BLOCK
        for k in range(own.shape[0]):
            own[k, 0] -= i0
        # Full and empty to the bit: what is left of two edges, each good to four roundings of the largest number.
        little = 16 * 2.3e-16 * max(right - left, high - low, 1.0)
        row = line[n, : stride[p]]
        for j in range(height[p]):
            row[:] = 0.0
            for k in range(own.shape[0]):
                m = k + 1 if k + 1 < own.shape[0] else 0
                add_edge(own[k, 0], own[k, 1], own[m, 0], own[m, 1], float(j0 + j), row)
            first = start[p] + j * stride[p]
            for i in range(row.shape[0]):
                e = row[i] if row[i] > little and i < columns else 0.0
                fraction[first + i] = e if e < 1.0 - little else 1.0


def pointed(corners: Reals, shift: float) -> Reals:
    """Three corners for each of a convex polygon (k, 2): its own, moved out so that ``shift`` times the turn (cells²)
    is added to the area, and before and after it where that begins, ``TIP`` from it or halfway to the next."""
    ahead = np.roll(corners, -1, axis=0) - corners
    length = np.hypot(*ahead.T)
    ahead = ahead / length[:, None]
    behind = np.roll(ahead, 1, axis=0)
    tip = np.minimum(TIP, 0.5 * length)
    before = np.roll(tip, 1)
    turn = np.arctan2(behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0], np.sum(behind * ahead, axis=1))
    outwards = behind - ahead
    straight = np.column_stack((ahead[:, 1], -ahead[:, 0]))
    outwards = np.where(turn[:, None] > STRAIGHT, outwards, straight)
    outwards /= np.hypot(*outwards.T)[:, None]
    far = 2.0 * shift * turn / ((before + tip) * np.cos(0.5 * turn))
    three = corners - before[:, None] * behind, corners + far[:, None] * outwards, corners + tip[:, None] * ahead
    return np.stack(three, axis=1).reshape(-1, 2)


def convex(corners: ArrayLike, name: str = "polygon") -> Reals:
    """The corners (k, 2) counterclockwise, or InputError if they make no convex polygon."""
    at = np.array(corners, float).reshape(-1, 2)
    if len(at) < 3 or not np.isfinite(at).all():
        raise InputError(Fault(f"{name}.corners", len(at), "make no polygon", allowed="three corners or more"))
    ahead = np.roll(at, -1, axis=0) - at
    if float(np.sum(at[:, 0] * ahead[:, 1] - at[:, 1] * ahead[:, 0])) < 0.0:
        at = at[::-1].copy()
        ahead = np.roll(at, -1, axis=0) - at
    length = np.hypot(*ahead.T)
    if not length.min() > 0.0:
        raise InputError(Fault(f"{name}.corners", int(length.argmin()), "this corner and the next are one point"))
    behind, before = np.roll(ahead, 1, axis=0), np.roll(length, 1)
    sine = (behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]) / (before * length)
    turn = np.arctan2(sine, np.sum(behind * ahead, axis=1) / (before * length))
    # A star that goes round twice turns left everywhere too.
    if sine.min() < -STRAIGHT or abs(turn.sum() - 2.0 * math.pi) > 1.0:
        worst = tuple(at[int(sine.argmin())].tolist())
        raise InputError(
            Fault(f"{name}.corners", worst, "the outline turns inwards here, or crosses itself: it must be convex",
                  repair="cut it into convex polygons, or take its convex hull")
        )  # fmt: skip
    return at


def least_width(corners: Reals) -> float:
    """The smallest distance of two parallels that a convex polygon (k, 2) lies between; one of them holds a side."""
    along = np.roll(corners, -1, axis=0) - corners
    across = np.column_stack((-along[:, 1], along[:, 0])) / np.hypot(*along.T)[:, None]
    return float(np.ptp(corners @ across.T, axis=0).min())


class Polygons:
    """Convex polygons that cover cells of the fluid, lattice units.

    corners : of each, (k, 2) cells from what it turns about, either way round.

    centre (m, 2), angle (m,), velocity (m, 2), spin (m,): written by the owner between steps;  area, width (m,): of the
    outlines given, the width the least;  covered_area (m,): of those that the fluid sees, with the tips that ``fit``
    gives them;  bare: whether cells are covered by the outlines given instead, for output.
    Raises InputError at one that is not convex.
    """

    def __init__(self, corners: Sequence[ArrayLike]) -> None:
        self._corners = [convex(each, f"polygon[{n}]") for n, each in enumerate(corners)]
        m = len(self._corners)
        self.outline = np.concatenate([np.zeros((0, 2)), *self._corners])
        self._given, self.bare = self.outline, False
        self._begins = _starts(self._corners), _starts(self._corners)
        self.centre, self.velocity = np.zeros((m, 2)), np.zeros((m, 2))
        self.angle, self.spin = np.zeros(m), np.zeros(m)
        self.area = np.array([_area(each) for each in self._corners])
        self.width = np.array([least_width(each) for each in self._corners])
        self.covered_area = self.area.copy()
        self._at, self._line = np.zeros_like(self.outline), np.zeros((m, 0))
        self._motion = np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0)

    @property
    def count(self) -> int:
        """Number of polygons that cover cells."""
        return len(self.angle)

    def fit(self, fluid: Fluid, shift: float, discs: int) -> Integers:
        """Cells along a side of the patches that hold them wherever they turn, (m,); to be called once.

        shift: cells², what exact walls add to a radius times the radius;  discs: that come before them among bodies.
        ValueError where one does not fit into a periodic box.
        """
        moved = [pointed(each, shift) if shift > 0.0 else each for each in self._corners]
        self.outline = np.concatenate([np.zeros((0, 2)), *moved])
        self._begins = _starts(self._corners), _starts(moved)
        self._at = np.zeros_like(self.outline)
        self.covered_area = np.array([_area(each) for each in moved])
        widest = np.array([_extent(each) for each in moved])
        for whole, joined in zip((fluid.nx, fluid.ny), fluid.sides.periodic, strict=True):
            if joined and widest.max(initial=0.0) > whole:
                raise ValueError("a polygon is longer than the periodic box")
        cells: Integers = np.floor(widest).astype(np.int64) + SPARE
        self._line = np.zeros((self.count, int(whole_blocks(cells).max(initial=BLOCK))))
        bodies = discs + self.count
        self._motion = np.zeros((bodies, 2)), np.zeros((bodies, 2)), np.zeros(bodies)
        return cells

    def cover(self, patches: Patches, discs: int) -> None:
        """Fill the patches of the polygons, which come after ``discs`` discs."""
        outline = self._given if self.bare else self.outline
        begin = self._begins[0] if self.bare else self._begins[1]
        cover_polygons(discs, outline, begin, self.centre, self.angle, self._at, self._line, patches)

    def gather(self, centre: Reals, velocity: Reals, spin: Reals) -> tuple[Reals, Reals, Reals]:
        """Centre, velocity and spin of all bodies: the discs' as given, then the polygons'."""
        n = len(spin)
        for every, given, own in zip(
            self._motion, (centre, velocity, spin), (self.centre, self.velocity, self.spin), strict=True
        ):
            every[:n], every[n:] = given, own
        return self._motion


def _starts(polygons: Sequence[Reals]) -> Integers:
    """Where the corners of each begin in the list of all, and how many there are, (m + 1,)."""
    return np.concatenate(([0], np.cumsum([len(each) for each in polygons]))).astype(np.int64)


def _area(corners: Reals) -> float:
    """Area of a polygon (k, 2) by the shoelace formula, cells²."""
    x, y = corners.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _extent(corners: Reals) -> float:
    """Largest distance of two corners."""
    return float(np.hypot(*np.moveaxis(corners[:, None] - corners, -1, 0)).max())
