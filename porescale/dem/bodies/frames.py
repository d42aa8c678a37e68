"""Frames: rigid bodies of line segments with thickness: single ones, chains, and closed chains, which are polygons.

Mass.  A polygon is solid within the lines of its segments (their thickness lies outside and has no mass): area,
centroid and second moment by the shoelace formula.  Other frames are rods: a segment of length L is a rectangle of L by
``width`` (default: twice the thickness), its round ends have no mass, joints count for each segment that ends there.
A hollow frame is of rods also where its chain closes: a drum.

A frame is a clump (clumps.py) of discs at its corners, as large as the thickness, with segments between them; it moves,
is controlled and monitored as clumps are.  Walls act on the corners.  Sources: Matsushima, DEMseg tutorial I-2 and
II-2.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.clumps import Body
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.segment_list import SegmentList
from porescale.dem.forces.walls import Box
from porescale.dem.grains import SKIN, Grains
from porescale.dem.prepare.merge import together

Index = NDArray[np.int64]
Corners = tuple[tuple[float, float], ...]
Ends = tuple[tuple[int, int], ...]

NOT_PAIRED = -2  # group of corners in the pair list of discs: the list of segments has their contacts
JOINED = 1e-9  # of a frame's size: ends this close to each other are one corner


@dataclass(frozen=True)
class Frame:
    """A rigid body of line segments.

    corners : m;  ends : corners at the ends of each segment, by number;  thickness : m, >= 0, half of what a segment
    measures across;  density : kg/m^3;  width : m, of rods, None: twice the thickness;  velocity m/s, spin rad/s: at
    the start;  long : its segments are containers, kept out of the cells (see segment_list.py);  material : number;
    hollow : of rods also where closed;  body : mass, centroid and inertia by hand.

    Raises InputError where there is no segment, one without length, a corner without a segment, a polygon that
    crosses itself, has a spike or no area, or no mass.
    """

    corners: Corners
    ends: Ends
    thickness: float
    density: float
    width: float | None = None
    velocity: tuple[float, float] = (0.0, 0.0)
    spin: float = 0.0
    long: bool = False
    material: int = 0
    hollow: bool = False
    body: Body | None = None

    def __post_init__(self) -> None:
        at, ends = np.array(self.corners, float).reshape(-1, 2), np.array(self.ends, int).reshape(-1, 2)
        for key, value, unit, fine in (
            ("corners", self.corners, "m", bool(np.isfinite(at).all())),
            ("thickness", self.thickness, "m", self.thickness >= 0.0 and math.isfinite(self.thickness)),
            ("density", self.density, "kg/m^3", self.density > 0.0 and math.isfinite(self.density)),
        ):
            if not fine:
                raise InputError(Fault(f"frame.{key}", value, "makes no sense", unit))
        if not len(ends) or set(ends.ravel().tolist()) != set(range(len(at))):
            raise InputError(Fault("frame.ends", self.ends, "every corner must be the end of a segment, and no other"))
        if np.hypot(*(at[ends[:, 1]] - at[ends[:, 0]]).T).min() <= JOINED * float(np.ptp(at, axis=0).max()):
            raise InputError(Fault("frame.corners", self.corners, "a segment has no length", "m"))
        if self.closed and _flat(at):
            raise InputError(Fault("frame.corners", None, "the polygon has no area: its corners lie on one line"))
        if self.closed and (crossing := _crossing(at[self.loop])) is not None:
            numbers = tuple(self._segment(crossed) for crossed in crossing)
            problem = "the polygon crosses itself between these segments"
            if len({*self.ends[numbers[0]], *self.ends[numbers[1]]}) == 3:  # they share a corner
                problem = "the polygon goes out and back along one line: a spike between these segments"
            raise InputError(Fault("frame.corners", numbers, problem))
        if not self.mass_properties().mass > 0.0:
            raise InputError(Fault("frame.width", self.width, "rods without thickness have no mass", "m", "> 0"))

    @property
    def loop(self) -> Index:
        """Corners in their order round a closed chain; empty when the frame is none."""
        beside: list[list[int]] = [[] for _ in self.corners]
        for a, b in self.ends:
            beside[a].append(b)
            beside[b].append(a)
        if len(self.corners) < 3 or any(len(each) != 2 for each in beside):
            return np.zeros(0, np.int64)
        walked, before = [0], beside[0][1]
        while len(walked) < len(self.corners) + 1:
            one, other = beside[walked[-1]]
            ahead = other if one == before else one
            if ahead == 0:
                break
            before = walked[-1]
            walked.append(ahead)
        return np.array(walked if len(walked) == len(self.corners) else [], np.int64)

    def _segment(self, place: int) -> int:
        """Number of the segment from one corner of the loop, by its place there, to the next."""
        loop = self.loop
        wanted = {int(loop[place]), int(loop[(place + 1) % len(loop)])}
        return next(k for k, ends in enumerate(self.ends) if set(ends) == wanted)

    @property
    def closed(self) -> bool:
        """Whether the segments make one closed chain: the frame is a polygon."""
        return len(self.loop) > 0

    def mass_properties(self) -> Body:
        """Mass (kg/m), centroid (m) and moment of inertia about it (kg m^2/m), see module."""
        if self.body is not None:
            return replace(self.body, frame=True)
        at = np.array(self.corners, float)
        if self.closed and not self.hollow:
            area, centroid, second = polygon_moments(at[self.loop])
        else:
            ends = np.array(self.ends)
            width = 2.0 * self.thickness if self.width is None else self.width
            area, centroid, second = rod_moments(at[ends[:, 0]], at[ends[:, 1]], width)
        return Body(self.density * area, (float(centroid[0]), float(centroid[1])), self.density * second, True, area)


def polygon(corners: ArrayLike, thickness: float, density: float, **more: Any) -> Frame:
    """The polygon with these corners (k, 2) m, either way round; ``more``: see Frame.  InputError below three."""
    at = _corners(corners)
    if len(at) < 3:
        raise InputError(Fault("frame.corners", at, "a polygon has three corners at least", "m"))
    return Frame(at, tuple((k, (k + 1) % len(at)) for k in range(len(at))), thickness, density, **more)


def chain(corners: ArrayLike, thickness: float, density: float, **more: Any) -> Frame:
    """The chain of segments from corner to corner (k, 2) m; two make a single segment;  ``more``: see Frame."""
    at = _corners(corners)
    return Frame(at, tuple((k, k + 1) for k in range(len(at) - 1)), thickness, density, **more)


def from_ends(segments: ArrayLike, thickness: float, density: float, **more: Any) -> Frame:
    """The frame of segments given by their two ends each, (s, 2, 2) m; ends that coincide are one corner."""
    corners, ends = joined(segments)
    return Frame(corners, ends, thickness, density, **more)


def joined(segments: ArrayLike) -> tuple[Corners, Ends]:
    """Corners of segments given by their two ends each, (s, 2, 2) m, and the corners at the ends of each, by number;
    ends closer than JOINED of the whole size are one corner."""
    points = np.asarray(segments, float).reshape(-1, 2)
    size = float(np.ptp(points, axis=0).max(initial=0.0))
    corners: list[Floats] = []
    number = []
    for point in points:
        near = [k for k, corner in enumerate(corners) if float(np.hypot(*(point - corner))) <= JOINED * size]
        number.append(near[0] if near else len(corners))
        if not near:
            corners.append(point)
    return _corners(corners), tuple((number[k], number[k + 1]) for k in range(0, len(number), 2))


def _corners(points: ArrayLike) -> Corners:
    return tuple((float(x), float(y)) for x, y in np.asarray(points, float).reshape(-1, 2))


def polygon_moments(corners: Floats) -> tuple[float, Floats, float]:
    """Area m^2, centroid (2,) m and polar second moment about it m^4 of a polygon (k, 2) m, by the shoelace formula."""
    origin = corners.mean(axis=0)
    a = corners - origin
    b = np.roll(a, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = 0.5 * float(cross.sum())
    centroid = (cross @ (a + b)) / (6.0 * area)
    second = float(cross @ np.sum(a * a + a * b + b * b, axis=1)) / 12.0
    return abs(area), origin + centroid, (second - area * float(centroid @ centroid)) * math.copysign(1.0, area)


def rod_moments(one: Floats, other: Floats, width: float) -> tuple[float, Floats, float]:
    """The same of rectangles along the ways from ``one`` to ``other`` (s, 2) m, ``width`` m across, each counted."""
    length = np.hypot(*(other - one).T)
    middle = 0.5 * (one + other)
    centroid = length @ middle / length.sum()
    own = length * (length**2 + width**2) / 12.0
    away = length * np.sum((middle - centroid) ** 2, axis=1)
    return width * float(length.sum()), np.asarray(centroid), width * float((own + away).sum())


def _flat(at: Floats) -> bool:
    """Whether points (k, 2) m lie on one line, within JOINED of their size."""
    long, across = np.linalg.svd(at - at.mean(axis=0), compute_uv=False)
    return bool(across <= JOINED * long)


def _crossing(at: Floats) -> tuple[int, int] | None:
    """Numbers of two sides of a polygon (k, 2) m, by their first corners, that cross, or of two in a row of which the
    second goes back along the first; None if none do."""

    def left(a: Floats, b: Floats, c: Floats) -> float:
        """Twice the area of the triangle a, b, c, m²: > 0 where c lies left of the way from a to b."""
        return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

    count = len(at)
    for i in range(count):
        a, b, c = at[i], at[(i + 1) % count], at[(i + 2) % count]
        out, back = b - a, c - b
        if out @ back < 0.0 and abs(left(a, b, c)) <= JOINED * float(np.hypot(*out) * np.hypot(*back)):
            return i, (i + 1) % count
    for i in range(count):
        a, b = at[i], at[(i + 1) % count]
        for j in range(i + 2, count - (i == 0)):
            c, d = at[j], at[(j + 1) % count]
            if left(a, b, c) * left(a, b, d) <= 0.0 and left(c, d, a) * left(c, d, b) <= 0.0:
                return i, j
    return None


def framed(
    discs: Discs | None,
    frames: Sequence[Frame],
    law: ContactLaw | Materials,
    box: Box,
    *,
    clumps: Sequence[ArrayLike] = (),
    clump_density: ArrayLike = 1.0,
    rule: str = "outline",
    skin: float | None = None,
    material: ArrayLike | None = None,
    corner_material: Sequence[ArrayLike] | None = None,
    **more: Any,
) -> Grains:
    """A system of ``discs``, some of them bound to ``clumps`` (disc numbers of each), and of ``frames``.

    Corners are rows after the discs, frames are clumps after ``clumps``: frame k is ``Clump(len(clumps) + k)``.
    rule : of contacts with segments, see segments.py;  skin : m, of the pair lists (default: half the mean size of
    discs and halves of segments that are not long);  material : of the discs;  corner_material : of the corners of each
    frame (default: the frame's);  more : as for Grains.
    Raises InputError for plates (make them frames) and for Hertz's law with frames that have no thickness.
    """
    first = 0 if discs is None else discs.count
    every = together(*([] if discs is None else [discs]), corner_discs(frames))
    own = np.concatenate(corner_material or [np.full(len(frame.corners), frame.material) for frame in frames])
    given = np.broadcast_to(np.asarray(0 if material is None else material), (first,))
    if more.get("plates"):
        raise InputError(
            Fault("plates", len(more["plates"]), "cannot be in contact with segments", repair="make them frames")
        )
    radii = np.zeros(0) if discs is None else discs.radius
    grains = Grains(
        every, law, box, skin=skin_of(radii, frames) if skin is None else skin,
        material=np.concatenate((given, own)), **more,
    )  # fmt: skip
    add_frames(grains, frames, clumps=clumps, clump_density=clump_density, rule=rule)
    return grains


def add_frames(
    grains: Grains,
    frames: Sequence[Frame],
    *,
    clumps: Sequence[ArrayLike] = (),
    clump_density: ArrayLike = 1.0,
    clump_bodies: Sequence[Body | None] = (),
    rule: str = "outline",
) -> None:
    """Make ``frames`` of the last discs of ``grains``, their corners (corner_discs), and clumps of others; see framed.

    It replaces the clumps of the discs.  clump_bodies : mass and inertia by hand.  Raises InputError as framed does.
    """
    discs = grains.discs
    if any(each.needs_radius for each in grains.laws) and min(frame.thickness for frame in frames) == 0.0:
        raise InputError(Fault("frame.thickness", 0.0, "the law of Hertz needs a radius of corners", "m", "> 0"))
    sizes = [len(frame.corners) for frame in frames]
    first = discs.count - sum(sizes)
    starts = first + np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    members = [*clumps, *(np.arange(starts[k], starts[k + 1]) for k in range(len(frames)))]
    bodies = [*(clump_bodies or [None] * len(clumps)), *(frame.mass_properties() for frame in frames)]
    density = np.concatenate((np.broadcast_to(np.asarray(clump_density, float), (len(clumps),)), np.ones(len(frames))))
    table = grains.steering.bind(members, density, bodies)
    for k, frame in enumerate(frames):
        body = len(clumps) + k
        table.velocity[body], table.spin[body] = frame.velocity, frame.spin
    table.place(discs)
    ends = np.concatenate([np.array(frame.ends) + starts[k] for k, frame in enumerate(frames)])
    long = np.concatenate([np.full(len(frame.ends), frame.long) for frame in frames])
    table.corner_contacts[len(table.member) - sum(sizes) :] = _corner_contacts(discs, ends, first)
    grains.segments = SegmentList(discs, table.group, grains.box, grains.pairs.skin, ends, long, rule)
    corner = grains.segments.is_corner
    grains.pairs.group = np.where(corner, NOT_PAIRED, table.group).astype(np.int32)
    grains.refresh(anew=True)


def skin_of(radius: Floats, frames: Sequence[Frame]) -> float:
    """Skin (m) of the lists of discs with these radii (n,) m and of frames, see framed."""
    return SKIN * float(np.mean([*radius.tolist(), *_halves(frames)]))


def corner_discs(frames: Sequence[Frame]) -> Discs:
    """Discs at the corners of all frames; their masses are placeholders until the frames are bound."""
    corners = make_discs([corner for frame in frames for corner in frame.corners], 1.0, 1.0)
    corners.radius[:] = np.concatenate([np.full(len(frame.corners), frame.thickness) for frame in frames])
    return corners


def cells_of(frames: Sequence[Frame], solid: Sequence[bool] | None = None) -> tuple[Index, tuple[Index, Index]]:
    """What all corners make, for pictures: ends of lines (m, 2), and polygons, (offsets (p + 1,), corners (k,)).

    solid : which of the closed ones are polygons (None: all); numbers of corners go on from frame to frame.
    """
    starts = np.cumsum([0, *(len(frame.corners) for frame in frames)])
    whole = [frame.closed and (solid is None or solid[k]) for k, frame in enumerate(frames)]
    loops = [starts[k] + frame.loop for k, frame in enumerate(frames) if whole[k]]
    lines = [starts[k] + np.array(frame.ends) for k, frame in enumerate(frames) if not whole[k]]
    offsets = np.cumsum([0, *(len(loop) for loop in loops)]).astype(np.int64)
    none = np.zeros(0, np.int64)
    return np.concatenate([none.reshape(0, 2), *lines]), (offsets, np.concatenate([none, *loops]))


def _halves(frames: Sequence[Frame]) -> list[float]:
    """Half the length (m) of every segment that is not long, or of all where all are."""
    short = [frame for frame in frames if not frame.long] or frames
    return [0.5 * math.dist(frame.corners[a], frame.corners[b]) for frame in short for a, b in frame.ends]


def _corner_contacts(discs: Discs, ends: Index, first: int) -> Floats:
    """Number of contacts assumed at each corner for the stable step: its own, and at each end of a segment one and
    half of the discs that fit along it.
    """
    length = np.hypot(*(discs.position[ends[:, 1]] - discs.position[ends[:, 0]]).T)
    along = 1.0 + (0.25 * length / float(discs.radius[:first].min()) if first else 0.0 * length)
    touch = 1.0 + np.bincount(ends[:, 0], along, discs.count) + np.bincount(ends[:, 1], along, discs.count)
    return np.asarray(touch[first:])
