"""Where rectangles must not be or come: in the packing, each other, discs, the gate, open sides; all else is allowed.

Everything moves straight and evenly between a few times, so what overlaps when follows from linear inequalities.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from porescale.builders.checks.held_places import path_of
from porescale.builders.initial.rectangles import stands_in
from porescale.common.core.constants import EDGE
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray
from porescale.dem.discs import Discs
from porescale.scene.bodies.disc import Disc
from porescale.scene.bodies.rectangle import Rectangle, travelled

if TYPE_CHECKING:
    from porescale.scene.bodies.gate import Gate
    from porescale.scene.packing import Packing
    from porescale.scene.scene import Scene

TOUCH = 1e-3
"""Share of a radius by which a disc may start in a rectangle."""
NEVER = float("inf")
PARTS = 8
"""Of a ramp, in each of which motion is taken for even."""
HALVINGS = 60
"""Of an interval in which a smallest distance is looked for: to the last bit of its ends."""

Pair = tuple[float, float]


class Body(NamedTuple):
    """Something that moves as a rectangle does; m, m/s, s."""

    lower: Pair
    upper: Pair
    velocity: Pair = (0.0, 0.0)
    starts_at: float = 0.0
    stops_at: float | None = None
    ramp: float = 0.0

    def travelled(self, time: float) -> Pair:
        """How far it has gone, m."""
        return travelled(self.velocity, self.starts_at, self.stops_at, time, self.ramp)


def check_rectangles(
    scene: Scene, places: AnyArray, radii: AnyArray, names: Sequence[str], faults: list[Fault]
) -> None:
    """Add a fault for everything that the rectangles of a scene are in each other's, or anything else's, way.

    places (n, 2) m, radii (n,) m, names: of discs, grains or held, that were placed by hand.
    """
    _check_box(scene, faults)
    if scene.grains and scene.grains.packing:
        _check_packing(scene.grains.packing, scene.rectangle, faults)
    _check_discs(scene, places, radii, names, faults)
    slack = EDGE * max(scene.domain.width, scene.domain.height)
    gate = _gate(scene.gate, scene.domain.height) if scene.gate else None
    for k, it in enumerate(scene.rectangle):
        for j in range(k):
            time = first_meeting(it, scene.rectangle[j], scene.time.end, slack)
            if time < NEVER:
                faults.append(_in_the_way(k, f"rectangle {j}", time))
        if gate:
            time = first_meeting(it, gate[0], min(scene.time.end, gate[1]), slack)
            if time < NEVER:
                faults.append(_in_the_way(k, "the gate", time))


def first_meeting(one: Rectangle | Body, other: Rectangle | Body, end: float, slack: float) -> float:
    """First time (s) up to ``end`` at which they overlap by more than ``slack`` (m); infinite if they never do."""
    for t0, t1 in phases(one, other, end):
        first, last = t0, t1
        for a in range(2):
            begin = one.travelled(t0)[a] - other.travelled(t0)[a]
            rate = (one.travelled(t1)[a] - other.travelled(t1)[a] - begin) / (t1 - t0) if t1 > t0 else 0.0
            # Both depths must exceed the slack: begin + rate (t - t0) lies between low and high.
            low, high = other.lower[a] + slack - one.upper[a], other.upper[a] - slack - one.lower[a]
            if rate == 0.0:
                if not low < begin < high:
                    first = NEVER
            else:
                bounds = sorted(t0 + (bound - begin) / rate for bound in (low, high))
                first, last = max(first, bounds[0]), min(last, bounds[1])
        if first < last or (first == last == t0 == t1):
            return first
    return NEVER


def phases(one: Rectangle | Body, other: Rectangle | Body, end: float) -> list[Pair]:
    """The spans of time (s) in which both move evenly; one of no length where ``end`` is 0.

    A ramp is cut into ``PARTS``: within each the way is even to velocity times ramp over 8 PARTS².
    """
    given = [time for it in (one, other) for time in (it.starts_at, it.stops_at) if time is not None]
    for it in (one, other):
        cuts = [it.ramp * k / PARTS for k in range(1, PARTS + 1)] if it.ramp else []
        given += [it.starts_at + cut for cut in cuts]
        given += [it.stops_at - cut for cut in cuts if it.stops_at is not None]
    times = sorted({0.0, end, *(time for time in given if 0.0 < time < end)})
    return list(itertools.pairwise(times)) or [(0.0, 0.0)]


def _gate(it: Gate, height: float) -> tuple[Body, float]:
    """The gate in a box of a height (m), and until when it stands (s)."""
    body = Body((it.x, 0.0), (it.x, height), (0.0, it.lift_speed or 0.0), it.opens_at)
    return body, NEVER if it.lift_speed else it.opens_at


def _in_the_way(k: int, what: str, time: float) -> Fault:
    problem = f"stands in {what}" if time == 0.0 else f"runs into {what} after {time:.4g} s"
    repair = "move one of them" if time == 0.0 else "give stops_at, or move one of them"
    return Fault(f"rectangle[{k}]", None, problem, repair=repair)


def _check_box(scene: Scene, faults: list[Fault]) -> None:
    """A rectangle must enter the box, leave part of it free, fit in a period, and not reach open sides."""
    d, end = scene.domain, scene.time.end
    size = d.width, d.height
    slack = EDGE * max(size)
    whole = Body((0.0, 0.0), size)
    given = {it.make_good for it in scene.rectangle} - {None}
    if len(given) > 1:
        repair = "give it once, or the same everywhere"
        faults.append(Fault("rectangle.make_good", None, "differs from one to the next", repair=repair))
    if scene.grains and any(d.periodic):
        faults.append(
            Fault("rectangle", None, "is not available beside grains in a periodic box", repair="give the box walls")
        )
    for k, it in enumerate(scene.rectangle):
        key = f"rectangle[{k}]"
        for a, axis in enumerate("xy"):
            if d.periodic[a] and it.upper[a] - it.lower[a] > size[a] * (1 + EDGE):
                problem, allowed = f"is longer along {axis} than the periodic box", f"<= {size[a]:g}"
                faults.append(Fault(key, it.upper[a] - it.lower[a], problem, "m", allowed, "shorten it"))
        if not any(d.periodic) and first_meeting(it, whole, end, slack) == NEVER:
            faults.append(Fault(key, None, "is never in the box", repair="move it, or leave it out"))
        if all(it.upper[a] - it.lower[a] >= size[a] - slack for a in range(2)):
            # Where it must have gone to, for its edges to lie beyond those of the box.
            gone = Body((size[0] - it.upper[0], size[1] - it.upper[1]), (-it.lower[0], -it.lower[1]))
            way = Body((0.0, 0.0), (0.0, 0.0), it.velocity, it.starts_at, it.stops_at, it.ramp)
            time = first_meeting(way, gone, end, -slack)
            if time < NEVER:
                problem = f"fills the whole box{f' after {time:.4g} s' if time else ''}"
                faults.append(Fault(key, None, problem, repair="leave room for the fluid"))
        for side, strip in _beyond(size).items():
            kind = d.side(side).boundary
            moves = it.fastest > 0 and it.starts_at < end
            if kind.prescribes_velocity or (kind.passes and moves):
                time = first_meeting(it, strip, end, -2 * slack)  # touching it counts
                if time < NEVER:
                    faults.append(_in_the_way(k, f"the {side} side, which is open", time))


def _beyond(size: Pair) -> dict[str, Body]:
    """What lies beyond each side, for the length of it."""
    w, h = size
    far = 1e6
    return {
        "left": Body((-far, 0.0), (0.0, h)), "right": Body((w, 0.0), (far, h)),
        "bottom": Body((0.0, -far), (w, 0.0)), "top": Body((0.0, h), (w, far)),
    }  # fmt: skip


def _check_packing(packing: Packing, sections: Sequence[Rectangle], faults: list[Fault]) -> None:
    """A packing settles or is placed around rectangles; compressed, it is clear of them."""
    for k, it in enumerate(sections):
        if packing.compress and stands_in(it, packing):
            repair = "move one of them, or let the packing settle around it"
            faults.append(Fault(f"rectangle[{k}]", None, "stands in the packing, which is compressed", repair=repair))


def _check_discs(scene: Scene, places: AnyArray, radii: AnyArray, names: Sequence[str], faults: list[Fault]) -> None:
    """No disc starts in a rectangle, and no held disc, which cannot give way, moves into one."""
    held = {f"disc[{j}]": it for j, it in enumerate(scene.disc)}
    for k, it in enumerate(scene.rectangle):
        for name, place, radius in zip(names, places, radii, strict=True):
            disc = held.get(name)
            if disc is not None and disc.timed:
                time = _hit(it, disc, scene.time.end)
                if time < NEVER:
                    problem = f"stands in rectangle {k}" if time == 0.0 else f"and rectangle {k} run into each other"
                    faults.append(Fault(name, None, problem, repair="move one of them"))
                    break
                continue
            velocity = disc.velocity if disc else None
            path = Body((0.0, 0.0), (0.0, 0.0), velocity or (0.0, 0.0))
            spans = [(0.0, 0.0)] if velocity is None else phases(it, path, scene.time.end)
            if any(nearest(it, path, place, *span) < radius * (1 - TOUCH) for span in spans):
                at_once = nearest(it, path, place, 0.0, 0.0) < radius * (1 - TOUCH)
                problem = f"stands in rectangle {k}" if at_once else f"and rectangle {k} run into each other"
                faults.append(Fault(name, None, problem, repair="move one of them"))
                break


def _hit(it: Rectangle, disc: Disc, end: float) -> float:
    """First time (s) at which a disc that functions of time move is in a rectangle; infinite if it never is."""
    for time, at in zip(*path_of(disc, end), strict=True):
        gone = np.asarray(it.travelled(float(time)))
        off = at - np.clip(at, it.lower + gone, it.upper + gone)
        if np.hypot(*off) < 0.5 * disc.diameter * (1 - TOUCH):
            return float(time)
    return NEVER


def nearest(it: Rectangle, path: Body, place: AnyArray, t0: float, t1: float) -> float:
    """Smallest distance (m) of a centre, from ``place`` along ``path``, to a rectangle between t0 and t1 (s).

    The distance to what is convex is convex along a line: ternary search keeps the side of the smaller value.
    """

    def distance(time: float) -> float:
        """Distance at a ``time`` (s), m."""
        at = np.asarray(place) + path.travelled(time)
        gone = np.asarray(it.travelled(time))
        return float(np.hypot(*(at - np.clip(at, it.lower + gone, it.upper + gone))))

    for _ in range(HALVINGS if t1 > t0 else 0):
        one, two = t0 + (t1 - t0) / 3, t1 - (t1 - t0) / 3
        if distance(one) <= distance(two):
            t1 = two
        else:
            t0 = one
    return min(distance(t0), distance(t1))


def require_free_of_rectangles(sections: Sequence[Rectangle], discs: Discs) -> None:
    """InputError naming the first disc, for example of a settled packing, that overlaps a rectangle."""
    for k, it in enumerate(sections):
        off = discs.position - np.clip(discs.position, it.lower, it.upper)
        inside = np.hypot(*off.T) < discs.radius * (1 - 0.1)
        if inside.any():
            where = discs.position[int(inside.argmax())]
            problem = f"a grain of the packing at ({where[0]:.4g}, {where[1]:.4g}) m has come to rest in it"
            raise InputError(Fault(f"rectangle[{k}]", None, problem, repair="move one of them"))
