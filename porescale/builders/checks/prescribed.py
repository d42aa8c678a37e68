"""Bodies whose motion is prescribed: that they exist, once each, and that nothing stands in their way."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from porescale.builders.initial.frames import Placed
from porescale.builders.initial.placed import controls_by_hand, counted, members
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.common.schema.names import names_of, sign_faults
from porescale.dem.bodies.union import outline
from porescale.dem.sanity import WORST_OF_CORNERS, WORST_OVERLAP
from porescale.scene.bodies.control import Controlled
from porescale.scene.bodies.wall import Wall
from porescale.scene.domain import Side
from porescale.scene.scene import Scene
from porescale.scene.time_function import Component, TimeFunction

CLOSE = 0.05
"""Share of the smallest radius that a body goes at most between two times that are looked at: a sixth of the overlap at
which a run stops."""
LOOKS, PLACES = 4000, 100_000_000
"""Most times that are looked at, and most places of pairs."""
AT_ONCE = 1_000_000
"""Places of bodies, and of pairs, that are held in memory."""
NAMES = ("left", "right"), ("bottom", "top")
ROOM = "end its motion or the run before, or make the box larger"
APART = "end the motion or the run before, or move one of them"
"""What mends a body that goes into a side, and into a wall."""


class Hit(NamedTuple):
    """At which look a body, by its number, is in what, in words, and what mends that."""

    look: int
    body: int
    what: str
    repair: str


class Driven(NamedTuple):
    """A disc or corner with a prescribed motion, or a disc that stands: key of its section, name of its body in words,
    centre (m) at the start, radius (m), and what prescribes x and y of its body, None where it is free.

    share : of the radius, that it may overlap before a run stops, of what in words;  turning : what prescribes the
    body's rotation;  arm (m) : from the point about which it turns;  is_corner : of a body of segments.
    """

    key: str
    name: str
    at: tuple[float, float]
    radius: float
    courses: tuple[Component | None, Component | None]
    share: float = WORST_OVERLAP
    of_what: str = "its radius"
    turning: Component | None = None
    arm: tuple[float, float] = (0.0, 0.0)
    is_corner: bool = False

    @property
    def fastest(self) -> float:
        """Its largest speed, m/s, of components that change with time each at its largest."""
        turns = self.turning.fastest * math.hypot(*self.arm) if self.turning else 0.0
        return math.hypot(*(it.fastest if it else 0.0 for it in self.courses)) + turns

    @property
    def motion(self) -> str:
        """What it has in common with all that moves as it does."""
        centre = (self.at[0] - self.arm[0], self.at[1] - self.arm[1]) if self.turning else None
        return repr((self.courses, self.turning, centre))

    def places(self, times: Floats) -> Floats:
        """Where it is (2, n) m at ``times`` (n,) s; a free component stands."""
        at = np.array([np.zeros(len(times)) if it is None else _way(it, times) for it in self.courses])
        if self.turning:
            angle, (x, y) = _way(self.turning, times), self.arm
            c, s = np.cos(angle) - 1.0, np.sin(angle)
            at += np.array([c * x - s * y, s * x + c * y])
        return np.asarray(at + np.array(self.at)[:, None])


def check_controls(scene: Scene, count: int, faults: list[Fault]) -> None:
    """Add faults of controls; ``count``: grains that are free, the discs of clumps last."""
    bodies = members(scene.clump)
    single, seen, names = count - sum(map(len, bodies)), [], names_of(scene.container, "container")
    for k, it in enumerate(scene.control):
        body, number = it.of
        key, most = f"control[{k}].{body}", single if body == "grain" else counted(scene, body)
        if number >= most:
            allowed = f"0 to {most - 1}" if most else f"none: there is no {body} of its own"
            faults.append(Fault(key, number, f"there is no such {body}", "", allowed))
        if it.of in seen:
            faults.append(Fault(key, number, "is controlled twice", repair="put both into one [[control]]"))
        elif bad := sign_faults(f"control[{k}].name", it.called):
            faults += bad
        elif it.called in names:
            faults.append(Fault(f"control[{k}].name", it.called, "is taken", repair="give each its own"))
        seen.append(it.of)
        names.append(it.called)


def check_motions(scene: Scene, frames: Sequence[Placed], faults: list[Fault]) -> None:
    """Add a fault where a body is moved into a side of the box or a free wall, or two into each other: for the first to
    do so.

    Of held discs, and of what is placed by hand and has x or y controlled: grains, clumps, and with their corners
    bodies of segments among ``frames`` with a thickness.  What turns freely counts by the circle that it covers at any
    angle, without one (segments) not at all.  Into: by more than a run allows, of discs WORST_OVERLAP of the (smaller)
    radius.  Sides that move, walls under stress or force, and a box that is strained, are left out.
    """
    bodies = [*_driven(scene), *_driven_frames(scene, frames)]
    span = math.hypot(scene.domain.width, scene.domain.height)
    walls = [(name, it) for name, it in zip(names_of(scene.wall, "wall"), scene.wall, strict=True)
             if it.stress is None and it.force is None]  # fmt: skip
    fastest = max((it.fastest for it in bodies), default=0.0)
    fastest = max([fastest, *(_fastest(it, span) for _, it in walls)])
    if fastest == 0.0 or scene.cell or not bodies:
        return
    pairs = max(1, sum(it.fastest > 0.0 for it in bodies)) * len(bodies)
    wanted = 1 + math.ceil(fastest * scene.time.end / (CLOSE * min(it.radius for it in bodies)))
    looks = min(wanted, LOOKS, PLACES // pairs, AT_ONCE // len(bodies))
    times = np.linspace(0.0, scene.time.end, max(2, looks))
    places = np.array([it.places(times) for it in bodies])
    found = []
    into = [*_into_sides(scene, bodies, places), *_into_walls(walls, bodies, places, times)]
    if hit := min(into, default=None):
        body = bodies[hit.body]
        problem = f"goes more than {body.share:g} of {body.of_what} into {hit.what} after {times[hit.look]:.3g} s"
        found.append((hit.look, Fault(body.key, None, problem, repair=hit.repair)))
    if met := _first_met(scene, bodies, places):
        look, i, j = met
        problem = f"and {bodies[j].name} run into each other after {times[look]:.3g} s, by more than"
        problem += f" {WORST_OVERLAP:g} of the smaller radius"
        repair = "end their motion or the run before, or move one of them"
        found.append((look, Fault(bodies[i].key, None, problem, repair=repair)))
    if found:
        faults.append(min(found, key=lambda it: it[0])[1])


def _prescribed(by: Controlled) -> tuple[Component | None, Component | None]:
    """What prescribes x and y, None where they are free or pushed."""
    return (by.x if by.x.prescribes else None), (by.y if by.y.prescribes else None)


def _driven(scene: Scene) -> Iterator[Driven]:
    """All discs that are looked at: held ones, grains, and those of clumps."""
    for k, it in enumerate(scene.disc):
        x, y = it.velocity_x or TimeFunction(mean=it.velocity[0]), it.velocity_y or TimeFunction(mean=it.velocity[1])
        yield Driven(f"disc[{k}]", f"disc {k}", (it.x, it.y), 0.5 * it.diameter,
                     (Component(velocity=x), Component(velocity=y)))  # fmt: skip
    grains, controls = scene.grains.grain if scene.grains else (), controls_by_hand(scene)
    for grain, by in zip(grains, controls, strict=False):
        if by and _prescribed(by) != (None, None):
            kind, number = by.of
            key = f"control[{scene.control.index(by)}]"
            yield Driven(key, f"{kind} {number}", (grain.x, grain.y), 0.5 * grain.diameter, _prescribed(by))
    given = {it.of: (k, it) for k, it in enumerate(scene.control)}
    copies = [(it, copy) for it in scene.clump for copy in range(len(it.at))]
    for number, ((clump, copy), discs) in enumerate(zip(copies, members(scene.clump), strict=True)):
        k, control = given.get(("clump", number), (0, None))
        if control is None or _prescribed(control) == (None, None):
            continue
        own = np.array(clump.discs)
        middle = clump.centroid or tuple(outline(own[:, :2], own[:, 2]).centroid.tolist())
        x0, y0 = clump.turned(copy, middle)
        key, name, of_what = f"control[{k}]", f"clump {number}", "a disc's radius"
        if control.rotation.prescribes:
            for disc in discs:
                yield Driven(key, name, (disc.x, disc.y), 0.5 * disc.diameter, _prescribed(control), WORST_OVERLAP,
                             of_what, control.rotation, (disc.x - x0, disc.y - y0))  # fmt: skip
            continue
        covered, radius = max((0.5 * it.diameter - math.hypot(it.x - x0, it.y - y0), 0.5 * it.diameter) for it in discs)
        if covered > 0.0:
            share = WORST_OVERLAP * radius / covered
            yield Driven(key, name, (x0, y0), covered, _prescribed(control), share, "its narrowest radius")


def _driven_frames(scene: Scene, frames: Sequence[Placed]) -> Iterator[Driven]:
    """The corners of bodies of segments whose place and rotation are controlled."""
    for kind in ("segment", "polygon"):
        placed = [it.frame for it in frames if it.kind == kind]
        for k, control in enumerate(scene.control):
            body, number = control.of
            if body != kind or _prescribed(control) == (None, None) or not control.rotation.prescribes:
                continue
            frame = placed[number]
            x0, y0 = (frame.body or frame.mass_properties()).centroid
            for x, y in frame.corners if frame.thickness > 0.0 else ():
                yield Driven(f"control[{k}]", f"{kind} {number}", (x, y), frame.thickness, _prescribed(control),
                             WORST_OF_CORNERS, "its thickness", control.rotation, (x - x0, y - y0), True)  # fmt: skip


def _fastest(wall: Wall, span: float) -> float:
    """The largest speed (m/s) of a wall within ``span`` (m) of its point."""
    x, y, turning = (it.largest if it else 0.0 for it in (wall.velocity_x, wall.velocity_y, wall.turning))
    return math.hypot(x, y) + turning * span


def _gone(speed: TimeFunction | None, times: Floats) -> Floats:
    """How far (m, or rad) a ``speed`` has moved a wall at ``times`` (s)."""
    return np.zeros(len(times)) if speed is None else _way(Component(velocity=speed), times)


def _way(course: Component, times: Floats) -> Floats:
    """How far (m) what is prescribed has moved a body at ``times`` (s)."""
    if (speed := course.velocity) is not None:
        if not (speed.times or speed.amplitude):
            return speed.mean * times
        return np.array([speed.integral(float(time)) for time in times])
    place = course.displacement
    assert place is not None
    return np.array([place.value(float(time)) - place.value(0.0) for time in times])


def _moves(side: Side) -> bool:
    """Whether a side moves, and grains with it."""
    moved = side.velocity is not None and not side.open
    return moved or side.stress is not None or side.force is not None


def _into_sides(scene: Scene, bodies: list[Driven], places: Floats) -> Iterator[Hit]:
    """When and where each of the bodies at ``places`` (n, 2, looks) m is moved into a side of the box, where it is not
    at the start."""
    d = scene.domain
    for k, (body, at) in enumerate(zip(bodies, places, strict=True)):
        for axis, size in enumerate((d.width, d.height)):
            if body.courses[axis] is None or d.periodic[axis]:
                continue
            for side, away in zip(NAMES[axis], (at[axis], size - at[axis]), strict=True):
                inside = body.radius - away > body.share * body.radius
                if inside.any() and not inside[0] and not _moves(d.side(side)):
                    yield Hit(int(inside.argmax()), k, f"the {side} side", ROOM)


def _into_walls(
    walls: Sequence[tuple[str, Wall]], bodies: list[Driven], places: Floats, times: Floats
) -> Iterator[Hit]:
    """When and where bodies at ``places`` (n, 2, looks) m come into a free wall, or it into them, where they are not at
    the start."""
    for name, wall in walls:
        angle = math.atan2(wall.normal[1], wall.normal[0]) + _gone(wall.turning, times)
        x, y = wall.x + _gone(wall.velocity_x, times), wall.y + _gone(wall.velocity_y, times)
        for k, body in enumerate(bodies):
            if None in body.courses:
                continue
            away = (places[k, 0] - x) * np.cos(angle) + (places[k, 1] - y) * np.sin(angle)
            inside = body.radius - away > body.share * body.radius
            if inside.any() and not inside[0]:
                yield Hit(int(inside.argmax()), k, name, APART)


def _first_met(scene: Scene, bodies: list[Driven], places: Floats) -> tuple[int, int, int] | None:
    """(look, number, other's number) of the first two bodies of those at ``places`` (n, 2, looks) m that overlap, and
    do not at the start; None where there are none.  Of two with the same motion, and corners, nothing is looked at."""
    whole = np.array([k for k, it in enumerate(bodies) if None not in it.courses and not it.is_corner], int)
    radius, motion = np.array([it.radius for it in bodies]), [it.motion for it in bodies]
    bears = radius * np.array([it.share for it in bodies])
    box = [size if periodic else 0.0 for size, periodic in zip((scene.domain.width, scene.domain.height),
                                                               scene.domain.periodic, strict=True)]  # fmt: skip
    first: tuple[int, int, int] | None = None
    for i in (int(k) for k in whole if bodies[k].fastest > 0.0):
        others = [int(j) for j in whole if motion[j] != motion[i] and (j > i or bodies[j].fastest == 0.0)]
        block = max(1, AT_ONCE // places.shape[2])
        for js in (np.array(others[k : k + block]) for k in range(0, len(others), block)):
            apart = places[js] - places[i]
            for axis, period in enumerate(box):
                if period:
                    apart[:, axis] -= period * np.round(apart[:, axis] / period)
            allowed = np.minimum(bears[js], bears[i])
            met = np.hypot(apart[:, 0], apart[:, 1]) < (radius[js] + radius[i] - allowed)[:, None]
            met &= ~met[:, :1]
            if met.any():
                looks = np.where(met.any(axis=1), met.argmax(axis=1), places.shape[2])
                k = int(looks.argmin())
                found = int(looks[k]), min(i, int(js[k])), max(i, int(js[k]))
                first = found if first is None else min(first, found)
    return first
