"""Verlet list: pairs of points within reach of each other, kept until some may have come nearer by a skin.

Source of the list and its skin: Verlet, Phys. Rev. 159 (1967) 98; of the cells: Hockney & Eastwood, Computer
Simulation Using Particles (1981), section 8.4.
"""

import math

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import most_threads, threads
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors import search
from porescale.common.neighbors import skin as skins
from porescale.common.neighbors.cells import COLUMNS, Grid, grid_shape, largest_below, sort_into_cells

SERIAL_BELOW = 20_000  # points; fewer cost less in one thread than a barrier costs (measured)
ROW = 256  # entries for a row that is being made, to begin with
BUILD = 2.0  # steps that a build costs (measured: smoothed water, 20 neighbours)
LONG = 64  # updates after which a list that still holds may be made anew with a lesser skin
LEAST = 0.2  # of the largest skin: less hardly changes the time of a step
BLOCK = 2.0  # cutoffs: smaller blocks move more alike, but what is not beside them must stay away
FINER = 4.0  # largest over smallest reach of a level: points that differ by less share a grid
LEVELS = 8  # at most: what is FINER ** LEVELS times smaller than the largest lies in the last
CELLS_PER_CUTOFF = 2  # half-cutoff cells: a window of 6.25 instead of 9 squared cutoffs to look through


class PairList:
    """Pairs (i, j) with |x_i - x_j| < reach_i + reach_j + skin at the last build.

    count : points;  skin : m, >= 0;  lower, upper : corners of the box, m (points may lie outside);
    periodic : per axis, distances are then between nearest images;  full : list every pair from both ends, else only
    partner > i;  carried : numbers that each listed pair keeps over rebuilds (new pairs start at 0);  between : of a
    full list, pairs only of the first so many points with the others; None: of all.

    group : (n,) int or None, settable: points of the same group >= 0 are not paired, those of groups below -1 with
    no other, from the next build on;
    tilt : m, see ``set_cell``;  adaptive : settable, whether `update` makes the skin less than ``skin`` was where the
    list lasts long.

    After a build (all replaced by the next one: fetch them again after ``update`` returns True)

    start : (n + 1,) int64, row i is ``partner[start[i]:start[i + 1]]``, ascending;  partner : (m,) int32;
    carried : (m, k);  list_position : (n, 2) m, positions at the build;  builds : number of builds so far.

    checked_position (n, 2) m, skin_margin m : the list holds, without ``update``, until some point is further than the
    margin from its checked position;
    both are others after an ``update``.

    The list is the same at any number of threads.  Buffers grow geometrically and are reused.
    """

    def __init__(
        self,
        count: int,
        skin: float,
        lower: tuple[float, float],
        upper: tuple[float, float],
        periodic: tuple[bool, bool] = (False, False),
        full: bool = False,
        carried: int = 0,
        between: int | None = None,
    ) -> None:
        assert full or between is None
        if not (np.isfinite(skin) and skin >= 0.0):
            raise InputError(Fault("skin", skin, "must be a length", "m", ">= 0"))
        if not all(np.isfinite((*lower, *upper))) or lower[0] >= upper[0] or lower[1] >= upper[1]:
            raise InputError(Fault("box", (lower, upper), "upper corner must lie beyond the lower one", "m"))
        self.count, self.skin, self.full, self.between = count, float(skin), full, between
        self.lower = (float(lower[0]), float(lower[1]))
        self.upper = (float(upper[0]), float(upper[1]))
        self.periodic = (bool(periodic[0]), bool(periodic[1]))
        width, height = self.upper[0] - self.lower[0], self.upper[1] - self.lower[1]
        self.period = (width if self.periodic[0] else 0.0, height if self.periodic[1] else 0.0)  # m, 0: none
        self.tilt = 0.0
        self.adaptive, self.most, self.lasted = False, self.skin, 0  # m, largest skin;  updates since the last build
        self.group: NDArray[np.int32] | None = None
        self.builds = self.looks = 0  # of the list; at how far points have gone since
        self.list_position: Floats = np.zeros((count, 2))
        self._list_reach: Floats = np.zeros(count)
        self.checked_position: Floats = np.zeros((count, 2))
        self._checked_reach: Floats = np.zeros(count)
        self.skin_margin = 0.0
        # Two of each, so that a build can read the last list while it writes the next.
        self._starts = [np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)]
        self._partners = [np.empty(0, np.int32), np.empty(0, np.int32)]
        self._carrieds = [np.zeros((0, carried)), np.zeros((0, carried))]
        self._current = 0
        self._first = between or 0  # of the points that others are searched among
        self._cell = np.empty(count - self._first, np.int32)
        self._order = np.empty(count - self._first, np.int32)
        self._cell_start = np.zeros(2, np.int64)
        self._levels = np.zeros((LEVELS, COLUMNS))
        self._sorted = np.empty((3, count - self._first))  # x, y, reach in cell order
        self._block = np.empty(count, np.int32)  # that each anchor lies in, for the list of build ``_blocked``
        self._blocked = -1
        self._bounds = np.empty((0, skins.BOUNDS))
        self._row = np.empty(ROW * most_threads(), np.int32)  # partners of one point before they are put in order
        self._publish(0)

    def _publish(self, total: int) -> None:
        """Name the current buffers, cut to ``total`` pairs."""
        self.start: NDArray[np.int64] = self._starts[self._current]
        self.partner: NDArray[np.int32] = self._partners[self._current][:total]
        self.carried: Floats = self._carrieds[self._current][:total]

    def _reserve(self, which: int, total: int) -> None:
        """Room for ``total`` pairs in buffer ``which``; grows by at least half, contents are lost."""
        have = self._partners[which].shape[0]
        if have < total:
            size = max(total, have + have // 2, 4 * self.count)
            self._partners[which] = np.empty(size, np.int32)
            self._carrieds[which] = np.zeros((size, self._carrieds[which].shape[1]))

    def _lengthen(self, longest: int) -> int:
        """Scratch of ``longest`` entries for each thread, at least as much as there is; returns how many each has."""
        if self._row.shape[0] < longest * most_threads():
            self._row = np.empty(longest * most_threads() * 3 // 2, np.int32)
        return self._row.shape[0] // most_threads()

    def set_cell(self, width: float, height: float, tilt: float) -> None:
        """Another size of a box that is periodic both ways, from the same lower corner, and how far right (m) the image
        one height above lies.  For a box that is strained; its owner also builds the list anew when needed.
        """
        assert all(self.periodic)
        self.upper = (self.lower[0] + width, self.lower[1] + height)
        self.period, self.tilt = (width, height), tilt

    def update(self, x: Floats, reach: Floats) -> bool:
        """Build if two points of ``x`` (n, 2) m may have come nearer, growth of reach (n,) m included, by the skin
        since the last build: see skin.py.

        Those that have not cannot have come within reach unlisted.  True if built; the arrays are then new.  Raises
        ValueError at a position or reach that is no number.
        """
        self.lasted += 1
        if self.builds and self._holds(x, reach) and not (self.adaptive and self._wide(reach)):
            return False
        if self.adaptive and self.builds:
            self.skin = self._best(reach)
        self.build(x, reach)
        return True

    def _best(self, reach: Floats) -> float:
        """Skin (m) that costs least where points come nearer by ``skin`` in ``lasted`` updates, at most ``most``.

        A step costs as many pairs as lie within r + s, and a share u/s of a build: (r + s)² (1 + b u/s) is least where
        2 s² + b u s = b u r, with u = skin/lasted.
        """
        paid = BUILD * self.skin / self.lasted
        cutoff = 2.0 * float(reach.max(initial=0.0))
        best = 0.25 * (math.sqrt(paid * paid + 8.0 * paid * cutoff) - paid)
        return min(self.most, max(LEAST * self.most, best))

    def _wide(self, reach: Floats) -> bool:
        """Whether the list has lasted so long that a build with a lesser skin pays."""
        return self.lasted >= LONG and self._best(reach) < 0.7 * self.skin

    def _holds(self, x: Floats, reach: Floats) -> bool:
        """Whether no pair can be missing from the list."""
        if not skins.needs_rebuild(
            x, self.checked_position, reach, self._checked_reach, self.skin_margin, *self.period
        ):
            return True
        if self.tilt != 0.0:  # images aside: blocks have other neighbours
            return False
        largest = 2.0 * float(self._list_reach.max(initial=0.0))
        size = BLOCK * (largest + self.skin)
        columns, rows = grid_shape(self.lower, self.upper, size, limit=4 * self.count + 64)
        width, height = (self.upper[axis] - self.lower[axis] for axis in (0, 1))
        if self._blocked != self.builds:
            self._blocked = self.builds
            if self._bounds.shape[0] <= columns * rows:
                self._bounds = np.empty((columns * rows + 1, skins.BOUNDS))
            skins.sort_into_blocks(self.list_position, self._grid(columns, rows), self._block)
        gap = min(width / columns, height / rows) - largest
        since = (x, self.list_position, reach, self._list_reach)
        left = skins.remaining_skin(*since, self._block, self._bounds, columns, rows, self.skin, gap, *self.period)
        if left < 0.0:
            return False
        self._restart_margin(x, reach, 0.5 * left)
        return True

    def _restart_margin(self, x: Floats, reach: Floats, margin: float) -> None:
        """The list holds until some point is ``margin`` (m) from where it is now."""
        self.checked_position[:], self._checked_reach[:], self.skin_margin = x, reach, margin
        self.looks += 1

    def build(self, x: Floats, reach: Floats) -> None:
        """List the pairs of ``x`` (n, 2) m with ``reach`` (n,) m now; data of pairs listed before is kept.

        Raises ValueError naming the point whose position or reach is not finite (or reach negative),
        InputError when a periodic side is shorter than two cutoffs: a point would then pair with two images of another.
        """
        assert x.shape == (self.count, 2)
        assert reach.shape == (self.count,)
        bad = search.first_unusable(x, reach)
        if bad >= 0:
            raise ValueError(f"point {bad}: position {x[bad].tolist()} m, reach {reach[bad]} m")
        cutoff = 2.0 * float(reach.max(initial=0.0)) + self.skin
        if self.count > 1:  # none or one has no partner, whatever the box
            self._check_periods(cutoff)
        levels = self._sort(x[self._first :], reach[self._first :])
        new = 1 - self._current
        old_start, old_partner, old_carried = self.start, self.partner, self.carried
        rows, ends = self.count, 1  # points with rows to search, ends of a pair that are listed for each found
        if self.between is not None:
            rows, ends = self.between, 2
        criterion = search.Criterion(self.skin, self.full)
        where = (x[:rows], reach[:rows], self._sorted, self._order, self._cell_start, levels, criterion)
        start = self._starts[new][: rows + 1]
        if self.count < SERIAL_BELOW or threads() == 1:
            total, longest = search.fill_serial(start, self._partners[new], self._row, *where)
            if ends * total > self._partners[new].shape[0] or longest > self._row.shape[0]:
                self._reserve(new, ends * total)
                self._lengthen(longest)
                search.fill_serial(start, self._partners[new], self._row, *where)
        else:
            total, longest = search.count_parallel(start, self._row, *where)
            self._reserve(new, ends * total)
            length = self._lengthen(longest)
            search.fill_parallel(start, self._partners[new], self._row, length, *where)
        start = self._starts[new]
        if self.between is not None:
            total = search.mirror(self.between, start, self._partners[new])
        if self.group is not None:
            total = search.leave_out(self.group, start, self._partners[new])
        self._current = new
        self._publish(total)
        if self.carried.shape[1]:
            search.carry(old_start, old_partner, old_carried, self.start, self.partner, self.carried)
        self.list_position[:] = x
        self._list_reach[:] = reach
        self._restart_margin(x, reach, 0.5 * self.skin)
        self.builds += 1
        self.lasted = 0

    def _check_periods(self, cutoff: float) -> None:
        for axis, name in enumerate(("width", "height")):
            if self.periodic[axis] and self.period[axis] < 2.0 * cutoff:
                problem, repair = "shorter than two cutoffs of the pair search", "use a larger box or smaller particles"
                allowed = f">= {2.0 * cutoff:.6g}"
                raise InputError(Fault(f"periodic {name}", self.period[axis], problem, "m", allowed, repair))

    def _grid(self, columns: int, rows: int) -> Grid:
        """The box cut into so many cells."""
        width, height = self.upper[0] - self.lower[0], self.upper[1] - self.lower[1]
        return Grid(*self.lower, columns / width, rows / height, columns, rows, *self.period, self.tilt)

    def _sort(self, x: Floats, reach: Floats) -> Floats:
        """Sort points into cells of half a cutoff of their level, and return the levels, see `sort_into_cells`."""
        used = cells = 0
        largest, number = largest_below(reach, math.inf)
        while True:
            finer = used < LEVELS - 1 and largest > 0.0
            smaller, less = largest_below(reach, largest / FINER) if finer else (-1.0, 0)
            # Limit: a few cells per point keep the sort linear in points.
            size = (2.0 * max(largest, 0.0) + self.skin) / CELLS_PER_CUTOFF
            columns, rows = grid_shape(self.lower, self.upper, size, limit=4 * (number - less) + 64)
            self._levels[used] = (*self._grid(columns, rows), largest, cells)
            used, cells = used + 1, cells + columns * rows
            if not less:
                break
            largest, number = smaller, less
        levels = self._levels[:used]
        if self._cell_start.shape[0] < cells + 1:
            self._cell_start = np.zeros((cells + 1) * 3 // 2, np.int64)
        sort_into_cells(x, reach, levels, self._cell, self._cell_start[: cells + 1], self._order)
        search.gather_sorted(x, reach, self._order, self._sorted)
        if self._first:
            self._order += np.int32(self._first)
        return levels

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Copies of everything that the next update depends on."""
        kept = {
            "start": self.start, "partner": self.partner, "carried": self.carried, "anchor": self.list_position,
            "anchor_reach": self._list_reach, "mark": self.checked_position, "mark_reach": self._checked_reach,
            "room": self.skin_margin, "builds": np.int64(self.builds), "lasted": np.int64(self.lasted),
            "skin": self.skin,
        }  # fmt: skip
        return {name: np.array(value) for name, value in kept.items()}

    def restore(self, state: dict[str, NDArray[np.generic]]) -> None:
        """Go on exactly from ``state``, taken from a list of the same count, box and options."""
        total = int(state["partner"].shape[0])
        self._reserve(self._current, total)
        self._publish(total)
        self.start[:], self.partner[:], self.carried[:] = state["start"], state["partner"], state["carried"]
        self.list_position[:] = state["anchor"]
        self._list_reach[:] = state["anchor_reach"]
        # Older states do not hold their skin: it may have been less, so the next update makes the list anew.  Bits
        # stay: rows are ascending in both, and pairs beyond reach, in which alone the lists differ, bear nothing.
        self.builds = int(state["builds"]) if "skin" in state else 0
        self.lasted, self.skin = int(state.get("lasted", 0)), float(state.get("skin", self.skin))
        margin = 0.5 * self.skin if self.builds else 0.0
        self._restart_margin(self.list_position, self._list_reach, margin)  # for states without checked positions
        if "mark" in state:
            mark, reach = (np.asarray(state[name], np.float64) for name in ("mark", "mark_reach"))
            self._restart_margin(mark, reach, float(state["room"]))
        self._blocked = -1
