"""Pairs of discs or corners and segments that may come into contact: candidates kept with a skin, and the springs of
their contacts.

Short segments are found among the discs through cells, as points at their middles that reach to their ends.  Long ones,
such as containers, would make the cells large: they are held against every disc at each listing instead, as DEMseg's
type 2.  Any point of a segment moves no further than the corners at its ends do, so one skin test serves discs,
corners and segments: a listing follows each one of the discs' pair list.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.discs import Discs
from porescale.dem.forces.segments import RULES, Segments
from porescale.dem.forces.walls import Box

Index = NDArray[np.int64]

STATE = ("corner", "corner_memory", "near", "near_memory")
"""Names of the arrays of a segment list that a checkpoint stores."""


class SegmentList:
    """Segments of the rigid bodies (clumps) of ``discs``, between their corners.

    ends (s, 2): discs at the ends of each, members of one clump with one radius;  long (s,): whether a segment is kept
    out of the cells;  group (n,) int32: clump of every disc, -1 for none;  skin : m;  rule : see segments.py.

    beside_corner (n,) m: shortest segment that ends at a disc, 0 if none does;  corner, near and their memories: see
    Segments, of the last listing.
    """

    def __init__(
        self, discs: Discs, group: NDArray[np.int32], box: Box, skin: float, ends: Index, long: NDArray[np.bool_],
        rule: str = "outline",
    ) -> None:  # fmt: skip
        if rule not in RULES:
            raise InputError(Fault("segments.rule", rule, "no such rule", allowed=", ".join(RULES)))
        self.ends, self.long = np.asarray(ends, np.int64).reshape(-1, 2), np.asarray(long, bool)
        self.rule = rule
        count, self.group, self._period = discs.count, group, box.period
        self.is_corner = np.zeros(count, bool)
        self.is_corner[self.ends.ravel()] = True
        both = np.concatenate((self.ends, self.ends[:, ::-1]))
        order = np.argsort(both[:, 0], kind="stable")
        self._other = np.ascontiguousarray(both[order, 1])
        self._of = np.tile(np.arange(len(self.ends)), 2)[order]  # the segment of each entry of other
        self._start = np.searchsorted(both[order, 0], np.arange(count + 1)).astype(np.int64)
        length = np.hypot(*(discs.position[self.ends[:, 1]] - discs.position[self.ends[:, 0]]).T)
        shortest = np.full(count, np.inf)
        np.minimum.at(shortest, self.ends.ravel(), np.repeat(length, 2))
        self.beside_corner = np.where(self.is_corner, shortest, 0.0)
        self._short = np.flatnonzero(~self.long)
        self._search = PairList(count + len(self._short), skin, box.lower, box.upper, box.periodic)
        own = np.concatenate((self.group, self.group[self.ends[self._short, 0]]))
        self._search.group = own.astype(np.int32)
        self._listed = -1  # builds of the discs' pair list at the last listing
        self.corner, self.near = np.zeros((0, 2), np.int64), np.zeros((0, 2), np.int64)
        self.corner_memory, self.near_memory = np.zeros((0, 1)), np.zeros((0, 1))
        self.arrays = self._pack()

    def now(self, discs: Discs, memory: int, builds: int) -> Segments:
        """The segments as kernels take them, with ``memory`` springs for each contact; see update."""
        if self.near_memory.shape[1] != memory:
            self._build(discs, memory, builds)
        return self.arrays

    def update(self, discs: Discs, memory: int, builds: int) -> None:
        """List anew if the discs' pair list has been, ``builds`` times; springs of contacts listed before are kept."""
        if builds != self._listed:
            self._build(discs, memory, builds)

    def _build(self, discs: Discs, memory: int, builds: int) -> None:
        """List the candidates of where everything is now."""
        corner, near = self._found(discs)
        self.corner_memory = _carried(self.corner, self.corner_memory, corner, memory)
        self.near_memory = _carried(self.near, self.near_memory, near, memory)
        self.corner, self.near = corner, near
        self._listed = builds
        self.arrays = self._pack()

    def _found(self, d: Discs) -> tuple[Index, Index]:
        """(pairs with a corner, discs with segments) within reach of each other and the skin, rising."""
        count = d.count
        at, way = d.position[self.ends[:, 0]], d.position[self.ends[:, 1]] - d.position[self.ends[:, 0]]
        half, thickness = 0.5 * np.hypot(*way.T), d.radius[self.ends[:, 0]]
        short = self._short
        self._search.build(
            np.concatenate((d.position, (at + 0.5 * way)[short])),
            np.concatenate((d.radius, (half + thickness)[short])),
        )
        i = np.repeat(np.arange(self._search.count), np.diff(self._search.start))
        j = self._search.partner.astype(np.int64)
        points = j < count
        corner = np.column_stack((i[points], j[points]))
        corner = corner[self.is_corner[corner].any(axis=1) & self._strangers(corner[:, 0], corner[:, 1])]
        sides = ~points & (i < count)
        parts = [np.column_stack((i[sides], short[j[sides] - count]))]
        every = np.arange(count)
        parts += [np.column_stack((every, np.full(count, e))) for e in np.flatnonzero(self.long)]
        near = np.concatenate(parts)
        near = near[self._strangers(near[:, 0], self.ends[near[:, 1], 0])]
        point, segment = near.T
        gone = self._image(d.position[point] - at[segment])
        length = np.einsum("ij,ij->i", way, way)[segment]
        share = np.clip(np.einsum("ij,ij->i", gone, way[segment]) / length, 0.0, 1.0)
        away = np.hypot(*(gone - share[:, None] * way[segment]).T)
        near = near[away < d.radius[point] + thickness[segment] + self._search.skin]
        return corner, near[np.lexsort((near[:, 1], near[:, 0]))]

    def _strangers(self, one: Index, other: Index) -> NDArray[np.bool_]:
        """Mask of the pairs whose discs belong to different bodies."""
        return np.asarray((self.group[one] < 0) | (self.group[one] != self.group[other]))

    def _image(self, difference: Floats) -> Floats:
        """Nearest images of differences (m, 2) m."""
        for axis, period in enumerate(self._period):
            if period > 0.0:
                difference[:, axis] -= period * np.rint(difference[:, axis] / period)
        return difference

    def _beside(self) -> Index:
        """Rows of near that share the points of each corner pair, (m, w), -1 for none."""
        valence = np.diff(self._start)
        most = int(valence.max(initial=0))
        rows = np.full((len(self.corner), 2 * most), -1, np.int64)
        keys, count = _keys(self.near), len(self.near)
        for side in range(2):
            point, corner = self.corner[:, 1 - side], self.corner[:, side]
            for k in range(most):
                has = np.flatnonzero(valence[corner] > k)
                wanted = _keys(np.column_stack((point[has], self._of[self._start[corner[has]] + k])))
                place = np.minimum(np.searchsorted(keys, wanted), max(count - 1, 0))
                found = keys[place] == wanted if count else np.zeros(len(has), bool)
                rows[has[found], side * most + k] = place[found]
        return rows

    def _pack(self) -> Segments:
        return Segments(
            RULES.index(self.rule), self.ends, self._start, self._other, self.corner, self.corner_memory,
            self._beside(), self.near, self.near_memory,
        )  # fmt: skip

    def inherit(self, state: Mapping[str, Any]) -> None:
        """Take the springs of contacts that another list of the same discs and segments had, by its ``state()``."""
        for name in ("corner", "near"):
            memory = getattr(self, f"{name}_memory")
            rows = np.asarray(state[name], np.int64)
            kept = _carried(rows, np.asarray(state[f"{name}_memory"])[:, : memory.shape[1]], getattr(self, name),
                            memory.shape[1])  # fmt: skip
            setattr(self, f"{name}_memory", kept)
        self.arrays = self._pack()

    def state(self) -> dict[str, Any]:
        """Copies of the listing and its springs."""
        return {**{name: getattr(self, name).copy() for name in STATE}, "listed": self._listed}

    def restore(self, state: dict[str, Any], builds: int) -> None:
        """Overwrite the listing with that of ``state()``; InputError where it lists a segment or disc that is absent.

        builds : of the discs' pair list, once restored.
        """
        for name, others in (("corner", len(self.group)), ("near", len(self.ends))):
            refuse_beyond(f"segments.{name}", state[name], len(self.group), others)
        for name in STATE:
            setattr(self, name, np.array(state[name], getattr(self, name).dtype))
        self._listed = int(state["listed"]) if builds else -1  # with the discs' list, if that is due
        self.arrays = self._pack()


def no_segments(count: int, springs: int) -> Segments:
    """Segments as kernels take them, where there are none, of ``count`` discs whose contacts have ``springs``."""
    none, memory = np.zeros((0, 2), np.int64), np.zeros((0, springs))
    start = np.zeros(count + 1, np.int64)
    return Segments(0, none, start, np.zeros(0, np.int64), none, memory, none, none, memory)


def refuse_beyond(name: str, rows: Index, one: int, other: int) -> None:
    """InputError unless the first two of each of ``rows`` (m, 2 or more) are numbers below ``one`` and ``other``."""
    for column, count in enumerate((one, other)):
        wrong = (rows[:, column] < 0) | (rows[:, column] >= count)
        if wrong.any():
            raise InputError(Fault(f"state.{name}", int(rows[wrong, column][0]), f"is none of {count}"))


def _keys(rows: Index) -> Index:
    """One number for each row of two, rising with them."""
    return (rows[:, 0] << 32) + rows[:, 1]


def _carried(before: Index, memory: Floats, rows: Index, width: int) -> Floats:
    """Memory (m, width) of ``rows`` as it was in the rows ``before``, which both rise; 0 for new ones."""
    kept = np.zeros((len(rows), width))
    if len(before):
        old, new = _keys(before), _keys(rows)
        place = np.minimum(np.searchsorted(old, new), len(old) - 1)
        same = old[place] == new
        kept[same, : memory.shape[1]] = memory[place[same]]
    return kept
