"""A sheet pile: a rigid, impermeable wall that stands upright in soil and water, with either of them on both sides.

One column of particles thick, so that a kernel reaches through it.  Seen from both sides, its particles would carry a
stress between theirs.  So there are three sets of wall particles, each seen from one side only: from the left and from
the right, both as deep as kernels reach and in the same places as particles on the other side, and from below the tip,
in the pile alone.  Each takes stress or pressure, and its image of the velocity, from those that see it (Adami, Hu &
Adams, J. Comput. Phys. 231 (2012) 7057).  Pairs of others across the pile are cut where both lie above its tip.

So every place is seen once, as particle or image, but about the level of the tip: there a particle that passes it on
the other side is lost from sight while its image stays.  It is two spacings away, where a kernel's slope is a tenth of
that next to a particle.  Without any thickness, and with lines of sight past the tip in place of its level (visibility:
Belytschko, Lu & Gu, Int. J. Numer. Meth. Engng. 37 (1994) 229), it is next to it, and the tip is torn open.

In flow around it, a slab of thickness t that ends square is a sheet that is longer by 0.8 to 1 t, and kernels make it
longer still (`sheet_flow`).  A `Pile` ends a row above that of the tip, and for the rest, which may be a share of a
spacing of either sign, the ground about its foot resists the water more or less (`Foot`), as a well has an index where
cells are wider than the well (Peaceman, SPE Journal 18 (1978) 183).  So the tip lies where it is put, between rows too.

What is on which side is that of the last build of the list, in which particles move by half a skin at most.  A particle
that would enter the pile is put on its surface, without its speed across; what energy that takes is not counted.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage.sheet_flow import longer
from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList

FOOT_REACH = 2.5  # spacings: how far from the foot of a pile the ground's resistance is changed
FOOT_GAIN = 0.345
"""Spacings by which a foot of strength 1 shortens the sheet: 0.31 to 0.40 for strengths of 1.5 to -1, s/T 0.2 to 0.9,
h of 1.3 spacings."""
MOST_SHIFT = 0.8  # spacings: the largest that a foot is made for
LEFT, RIGHT, UNDER = range(3)
"""Sides of a pile, from which its sets are seen."""
FREE = -1
NONE, AT_REST = np.zeros(0, np.int64), np.zeros((0, 2))


@inline
def side_of(x, y, at, bottom):
    """On which side of a pile in x = ``at``, that ends at ``bottom``, a point (x, y) lies, all m."""
    if y < bottom:
        return UNDER
    return LEFT if x < at else RIGHT


@kernel
def cut_pairs(x, side, start, partner, at, bottom):
    """Leave in a list what the pile lets see each other: overwrites ``start`` (n + 1,) and ``partner``; returns the
    number of pairs left.

    x (n, 2) m;  side (n,): from which particles of the pile are seen, FREE for all else;  at, bottom: m.
    """
    kept, first = 0, start[0]
    for i in range(start.shape[0] - 1):
        last = start[i + 1]
        own = side[i]
        here = side_of(x[i, 0], x[i, 1], at, bottom)
        for k in range(first, last):
            j = partner[k]
            other = side[j]
            there = side_of(x[j, 0], x[j, 1], at, bottom)
            if own == FREE and other == FREE:
                sees = there in (here, UNDER) or here == UNDER
            elif own == FREE:
                sees = other == here
            else:
                sees = other == FREE and own == there
            if sees:
                partner[kept] = j
                kept += 1
        first = last
        start[i + 1] = kept
    return kept


@kernel
def keep_out(x, v, last, at, bottom, half):
    """Put particles that have entered the pile since they were at ``last`` (k, 2) m on the side that they came from:
    overwrites their x (m), v (m/s), the first k rows of (n, 2), and ``last``.  at, bottom, half its thickness: m.
    Particles that come from farther than its thickness have not moved, but been put there.  Returns how many."""
    held = 0
    for i in range(last.shape[0]):
        if abs(x[i, 0] - last[i, 0]) + abs(x[i, 1] - last[i, 1]) > 2.0 * half:
            last[i, 0] = x[i, 0]
            last[i, 1] = x[i, 1]
            continue
        before = side_of(last[i, 0], last[i, 1], at, bottom)
        here = side_of(x[i, 0], x[i, 1], at, bottom)
        if here != UNDER and (abs(x[i, 0] - at) < half or (before != here and before != UNDER)):
            held += 1
            if before == LEFT:
                x[i, 0] = at - half
                v[i, 0] = min(0.0, v[i, 0])
            elif before == RIGHT:
                x[i, 0] = at + half
                v[i, 0] = max(0.0, v[i, 0])
            else:
                x[i, 1] = bottom
                v[i, 1] = min(0.0, v[i, 1])
        last[i, 0] = x[i, 0]
        last[i, 1] = x[i, 1]
    return held


@parallel_kernel
def ease_foot(x, plain, resisting, at, bottom, reach, strength):
    """Overwrites ``resisting`` (s,): ``plain`` (s,) times exp(-strength (1 - r)⁴ (1 + 4 r)) of soil at ``x`` (s, 2) m,
    r its distance from (at, bottom) over ``reach``, all m; 1 farther off."""
    inverse = 1.0 / reach
    for s in prange(plain.shape[0]):
        dx = (x[s, 0] - at) * inverse
        dy = (x[s, 1] - bottom) * inverse
        r = np.sqrt(dx * dx + dy * dy)
        resisting[s] = plain[s]
        if r < 1.0:
            rest = (1.0 - r) * (1.0 - r)
            resisting[s] *= np.exp(-strength * rest * rest * (1.0 + 4.0 * r))


@dataclass(frozen=True)
class Foot:
    """Ground about the foot (x, bottom) of a pile, all m, whose resistance to water makes the flow that of a sheet.

    spacing : of the particles, m;  strength : of `ease_foot`, eases the flow where positive.
    """

    x: float
    bottom: float
    spacing: float
    strength: float

    def ease(self, x: Floats, plain: Floats, resisting: Floats) -> None:
        """Overwrite ``resisting`` (s,) of soil at ``x`` (s, 2) m, ``plain`` (s,) without a foot."""
        ease_foot(x, plain, resisting, self.x, self.bottom, FOOT_REACH * self.spacing, self.strength)


@dataclass(frozen=True)
class Pile:
    """A pile from ``bottom`` (m), an edge of the particles' rows, to the top of the tank and beyond, in ``x`` (m), the
    middle of a column of theirs.

    tip : m, of the sheet that it stands for;  spacing : of the particles, and its thickness, m;  rough : soil is held
    by its faces, else it slips.
    """

    x: float
    tip: float
    bottom: float
    spacing: float
    rough: bool = False

    def foot(self, surface: float) -> Foot | None:
        """What makes the flow that of the sheet, in ground up to a ``surface`` (m) over a base at 0; none where the
        sheet ends outside."""
        if not 0.0 < self.tip < surface:
            return None
        wanted = longer(1.0 - self.tip / surface, surface / self.spacing)
        shift = wanted - (self.bottom - self.tip) / self.spacing
        strength = min(MOST_SHIFT, max(-MOST_SHIFT, shift)) / FOOT_GAIN
        return Foot(self.x, self.bottom, self.spacing, strength)

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Which of ``points`` (n, 2) m lie in it."""
        return (np.abs(points[:, 0] - self.x) < 0.5 * self.spacing) & (points[:, 1] > self.bottom)

    def particles(self, layers: int, ceiling: float) -> tuple[Floats, Floats, NDArray[np.int64]]:
        """Wall particles through a ``ceiling`` (m), as many ``layers`` deep as kernels reach: places (n, 2) m; for each
        the nearest point of the face that it lies behind, and the normal out of it, (n, 4); the side that it is seen
        from, (n,).
        """
        half, spacing = 0.5 * self.spacing, self.spacing
        low, high = round(self.bottom / spacing), round(ceiling / spacing) + layers
        behind, rows = np.meshgrid(np.arange(layers), np.arange(low, high))
        depth, up = (behind.ravel() + 0.5) * spacing, (rows.ravel() + 0.5) * spacing
        first = np.flatnonzero((behind.ravel() == 0) & (rows.ravel() < low + layers))
        zero, one = np.zeros(len(up)), np.ones(len(up))
        left, right = zero + self.x - half, zero + self.x + half
        foot = np.array([self.x, self.bottom, 0.0, -1.0])
        places = (
            np.column_stack((left + depth, up)), np.column_stack((right - depth, up)),
            np.column_stack((zero + self.x, up))[first],
        )  # fmt: skip
        facing = (
            np.column_stack((left, up, -one, zero)), np.column_stack((right, up, one, zero)),
            np.tile(foot, (len(first), 1)),
        )  # fmt: skip
        side = np.repeat([LEFT, RIGHT, UNDER], [len(up), len(up), len(first)])
        return np.concatenate(places), np.concatenate(facing), side


class CutPairList(PairList):
    """A full list of pairs that do not see each other through a pile, whose particles are its last points.

    v : (n, 2) m/s, velocities of the points, the first ``free`` of which the pile keeps out;  side : (m,) of the pile's
    particles, as `Pile.particles` gives it, none if it has none here;  stopped : how often a particle was kept out.
    """

    def __init__(
        self,
        like: PairList,
        pile: Pile,
        free: int = 0,
        side: NDArray[np.int64] = NONE,
        v: Floats = AT_REST,
    ) -> None:
        """like : a full list of the same points, whose place this one takes."""
        super().__init__(
            like.count, like.skin, like.lower, like.upper, like.periodic, full=like.full, between=like.between
        )
        self.group, self.v, self.stopped = like.group, v, 0
        self.at, self.bottom, self.half = pile.x, pile.bottom, 0.5 * pile.spacing
        self.side = np.concatenate((np.full(like.count - len(side), FREE), side))
        self.last = np.zeros((free, 2))

    def update(self, x: Floats, reach: Floats) -> bool:
        """Update the list, after particles that have entered the pile are put on its surface: overwrites ``x``."""
        if not self.builds:
            self.last[:] = x[: len(self.last)]
        self.stopped += keep_out(x, self.v, self.last, self.at, self.bottom, self.half)
        return super().update(x, reach)

    def build(self, x: Floats, reach: Floats) -> None:
        """Build the list without the pairs that the pile separates."""
        super().build(x, reach)
        self._publish(cut_pairs(x, self.side, self.start, self.partner, self.at, self.bottom))

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Copies of everything that determines the next state of the list."""
        return super().state() | {"last": self.last.copy()}

    def restore(self, state: dict[str, NDArray[np.generic]]) -> None:
        """Go on exactly from ``state``, taken from a list of the same count, box and options."""
        super().restore(state)
        self.last[:] = state["last"]
