"""What a packing is made around: discs, rectangles and bodies of segments, which stand still meanwhile.

Grains are placed where these leave room for them, and settle or grow against them under the law of their contacts.
"""

import dataclasses
import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.placement import DENSEST, Placement, Standing, place
from porescale.dem.bodies.frames import NOT_PAIRED, Frame, add_frames, corner_discs, skin_of
from porescale.dem.bodies.outline import from_sides, within_outline
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.dem.prepare.merge import together

Pair = tuple[float, float]

POINTS = 1024
"""Along the longer side of a rectangle: at so many points it is looked whether an obstacle is there, for the area."""
DRAWS = 500
"""Most places that are drawn for a grain before it is said that there is no room for it."""
TRIES = 3
"""Starts from which it is tried to place grains without overlap."""
HEAVY = 1e3
"""Density of what stands over that of the grains: it must not be the lightest body, which sets the step."""


Beside = tuple[Floats, Floats]
"""Distance (n,) m of points from a body, below zero inside, and the unit vector (n, 2) away from it."""


class Shape(NamedTuple):
    """Corners of the rectangle around a body, m, and where points (n, 2) m lie beside it."""

    lower: Floats
    upper: Floats
    beside: Callable[[Floats], Beside]


@dataclass(frozen=True)
class Obstacles:
    """discs : x, y, radius of each, m;  rectangles;  frames, and which of them are ``solid`` within a closed outline;
    period : m, 0 where a side is not periodic."""

    discs: tuple[tuple[float, float, float], ...] = ()
    rectangles: tuple[Rectangle, ...] = ()
    frames: tuple[Frame, ...] = ()
    solid: tuple[bool, ...] = ()
    period: Pair = (0.0, 0.0)

    def __bool__(self) -> bool:
        return bool(self.discs or self.rectangles or self.frames)

    def shapes(self, lower: ArrayLike, upper: ArrayLike) -> list[Shape]:
        """The bodies and their periodic images that reach into the rectangle from ``lower`` to ``upper`` (m)."""
        low, high = np.asarray(lower, float), np.asarray(upper, float)
        shifts = itertools.product(*((-p, 0.0, p) if p else (0.0,) for p in self.period))
        moved = [_shifted(it, np.array(shift)) for shift in shifts for it in self._bodies()]
        return [it for it in moved if np.all(it.lower < high) and np.all(it.upper > low)]

    def stand_in(self, lower: Pair, upper: Pair) -> bool:
        """Whether a body, or a side without thickness, takes room of the rectangle from ``lower`` to ``upper`` (m)."""
        return self.area(lower, upper) > 0.0 or any(crosses(it, lower, upper) for it in self.frames)

    def depth(self, points: Floats, reach: float) -> Floats:
        """How deep (m) points (n, 2) m lie in the deepest body, below zero outside.

        reach : m, bodies further than that from all points do not count.
        """
        deepest = np.full(len(points), -np.inf)
        for it in self.shapes(points.min(axis=0) - reach, points.max(axis=0) + reach) if len(points) else []:
            deepest = np.maximum(deepest, -it.beside(points)[0])
        return deepest

    def area(self, lower: Pair, upper: Pair) -> float:
        """Area (m²) that the bodies take of a rectangle, each point once, to a cell of POINTS along the longer side."""
        sides = np.subtract(upper, lower)
        counts = np.maximum(1, np.ceil(POINTS * sides / sides.max())).astype(int)
        x, y = (low + side * (np.arange(n) + 0.5) / n for low, side, n in zip(lower, sides, counts, strict=True))
        taken = self._taken(x, y, lower, upper)
        return float(taken.mean() * sides.prod())

    def place(self, lower: Pair, upper: Pair, radii: Floats, seed: int, periodic: tuple[bool, bool]) -> Placement:
        """Grains of ``radii`` (n,) m in a rectangle (m), none in a body or another; the same for the same seed.

        Raises InputError where there is no room for them, see neighbors/placement.py.
        """
        whole = float(np.subtract(upper, lower).prod())
        area = min(self.area(lower, upper), whole)
        share = float(np.pi * np.sum(radii**2)) / whole
        most, repair = DENSEST * (1.0 - area / whole), "place fewer grains, or make the rectangle larger"
        if share > most:
            problem = "of the rectangle do not fit beside what stands in it"
            allowed = f"<= {math.floor(1e3 * most) / 1e3:g}"
            raise InputError(Fault("packing_fraction", round(share, 4), problem, "", allowed, repair))
        corner = np.array(lower)
        discs = dataclasses.replace(self, rectangles=(), frames=(), solid=()).shapes(lower, upper)
        others = dataclasses.replace(self, discs=()).shapes(lower, upper)
        standing = Standing(
            np.array([0.5 * (it.lower + it.upper) for it in discs]).reshape(-1, 2) - corner,
            np.array([0.5 * (it.upper[0] - it.lower[0]) for it in discs]), area,
            lambda points: [it.beside(points + corner) for it in others],
        )  # fmt: skip
        rng = np.random.default_rng(seed)
        for last in (*[False] * (TRIES - 1), True):
            start = self._starts(lower, upper, radii, rng, periodic) - corner
            try:
                return place(lower, upper, radii=radii, periodic=periodic, seed=seed, start=start, standing=standing)
            except InputError as error:
                if any(fault.key != "packing_fraction" for fault in error.faults):
                    raise
                if last:
                    problem = "of the rectangle find no places without overlap beside what stands in it"
                    raise InputError(Fault("packing_fraction", round(share, 4), problem, repair=repair)) from None
        raise AssertionError

    def _starts(
        self, lower: Pair, upper: Pair, radii: Floats, rng: np.random.Generator, periodic: tuple[bool, bool]
    ) -> Floats:
        """A place (n, 2) m for each grain at which it fits beside the bodies, and into the rectangle where that is not
        periodic; InputError where none is found."""
        off = np.where(periodic, 0.0, radii[:, None])
        low, high = lower + off, upper - off
        largest = float(radii.max())
        start, unfit = np.zeros((len(radii), 2)), np.ones(len(radii), bool)
        for _ in range(DRAWS):
            start[unfit] = rng.uniform(low[unfit], high[unfit])
            unfit = self.depth(start, largest) > -radii
            if not unfit.any():
                return start
        raise InputError(
            Fault("diameter", 2.0 * float(radii[unfit].max()), "finds no place beside what stands there", "m",
                  repair="make the rectangle larger, or what stands in it smaller")
        )  # fmt: skip

    def beside(self, discs: Discs, law: ContactLaw, box: Box, density: float, **more: Any) -> Grains:
        """A system of ``discs``, which are free, then of all that stands, held: discs, then corners of frames.

        density (kg/m³): of the grains;  more : as for Grains.
        """
        count, frames = discs.count, [dataclasses.replace(it, density=HEAVY * density, body=None, velocity=(0.0, 0.0),
                                                          spin=0.0, material=0) for it in self.frames]  # fmt: skip
        held = self.as_discs(density)
        parts = [discs, *([held] if held.count else []), *([corner_discs(frames)] if frames else [])]
        if frames:
            more["skin"] = skin_of(np.concatenate((discs.radius, held.radius)), frames)
        grains = Grains(together(*parts), law, box, **more)
        grains.set_rectangles(self.rectangles)
        group = np.full(grains.discs.count, -1, np.int32)
        group[count : count + held.count] = 0  # what stands is not pressed apart, members of a clump among it
        if frames:
            add_frames(grains, frames)
            assert grains.segments is not None
            group[grains.segments.is_corner] = NOT_PAIRED
            still = Moved()
            for k in range(len(frames)):
                grains.steering.control(Clump(k), still, still, still)
        grains.pairs.group = group
        if held.count:
            grains.hold(slice(count, count + held.count))
        grains.refresh(anew=True)
        return grains

    def as_discs(self, density: float) -> Discs:
        """The discs at rest, of a density, kg/m³."""
        table = np.array(self.discs).reshape(-1, 3)
        return make_discs(table[:, :2], table[:, 2], np.full(len(table), HEAVY * density))

    def _bodies(self) -> Iterator[Shape]:
        """Each body where it stands."""
        for x, y, r in self.discs:
            centre = np.array((x, y))
            yield Shape(centre - r, centre + r, _from_disc(centre, r))
        for it in self.rectangles:
            low, high = np.array(it.lower), np.array(it.upper)
            yield Shape(low, high, _from_rectangle(low, high))
        for frame, solid in zip(self.frames, self.solid, strict=True):
            at = np.array(frame.corners)
            low, high = at.min(axis=0) - frame.thickness, at.max(axis=0) + frame.thickness
            yield Shape(low, high, _from_frame(frame, at, solid))

    def _taken(self, x: Floats, y: Floats, lower: Pair, upper: Pair) -> NDArray[np.bool_]:
        """Mask (len(y), len(x)) of the points of a grid in a rectangle (m) that are in a body."""
        found = np.zeros((len(y), len(x)), bool)
        for it in self.shapes(lower, upper):
            (i0, i1), (j0, j1) = (
                np.searchsorted(along, (it.lower[axis], it.upper[axis])) for axis, along in enumerate((x, y))
            )
            if i1 > i0 and j1 > j0:
                across, up = np.meshgrid(x[i0:i1], y[j0:j1])
                distance = it.beside(np.column_stack((across.ravel(), up.ravel())))[0]
                found[j0:j1, i0:i1] |= (distance < 0.0).reshape(across.shape)
        return found


NOTHING = Obstacles()
"""No obstacle."""


def _shifted(it: Shape, by: Floats) -> Shape:
    """A body moved by (x, y) m."""
    if not by.any():
        return it
    return Shape(it.lower + by, it.upper + by, lambda points: it.beside(points - by))


def _unit(ways: Floats) -> Floats:
    """Unit vectors along ``ways`` (n, 2) m; upwards where one has no length."""
    length = np.hypot(*ways.T)[:, None]
    return np.where(length > 0.0, ways / np.where(length > 0.0, length, 1.0), (0.0, 1.0))


def _from_disc(centre: Floats, radius: float) -> Callable[[Floats], Beside]:
    def beside(points: Floats) -> Beside:
        """From the rim, away from the centre."""
        ways = points - centre
        return np.hypot(*ways.T) - radius, _unit(ways)

    return beside


def _from_rectangle(lower: Floats, upper: Floats) -> Callable[[Floats], Beside]:
    def beside(points: Floats) -> Beside:
        """From the nearest point of a rectangle outside, from the nearest face inside."""
        ways = points - np.clip(points, lower, upper)
        outside = np.hypot(*ways.T)
        below = np.column_stack((points - lower, upper - points))
        face = below.argmin(axis=1)
        away = np.array([(-1.0, 0.0), (0.0, -1.0), (1.0, 0.0), (0.0, 1.0)])[face]
        out = outside > 0.0
        return np.where(out, outside, -below.min(axis=1)), np.where(out[:, None], _unit(ways), away)

    return beside


def _from_frame(frame: Frame, at: Floats, solid: bool) -> Callable[[Floats], Beside]:
    sides = at[np.array(frame.ends)]
    outline = at[frame.loop] if solid else None

    def beside(points: Floats) -> Beside:
        """From the rim of the nearest side; within a solid outline, out through that side."""
        distance, ways = from_sides(points, sides)
        if outline is None:
            return distance - frame.thickness, _unit(ways)
        outward = np.where(within_outline(points, outline), -1.0, 1.0)
        return outward * distance - frame.thickness, outward[:, None] * _unit(ways)

    return beside


def crosses(frame: Frame, lower: Pair, upper: Pair) -> bool:
    """Whether a side of a frame has a point within the rectangle from ``lower`` to ``upper`` (m)."""
    a, b = np.moveaxis(np.array(frame.corners)[np.array(frame.ends)], 1, 0)
    low, high = np.array(lower), np.array(upper)
    with np.errstate(divide="ignore", invalid="ignore"):  # along an axis: it enters at once, or never
        one, other = (low - a) / (b - a), (high - a) / (b - a)
    along = b == a
    within = (a > low) & (a < high)
    enters = np.where(along, np.where(within, 0.0, np.inf), np.minimum(one, other)).max(axis=1)
    leaves = np.where(along, np.where(within, 1.0, -np.inf), np.maximum(one, other)).min(axis=1)
    return bool(np.any(np.maximum(enters, 0.0) < np.minimum(leaves, 1.0)))
