"""Bodies whose motion is prescribed: that they exist, once each, and that nothing stands in their way."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from porescale.builders.initial.placed import controls_by_hand, counted, members
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.dem.sanity import WORST_OVERLAP
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


class Driven(NamedTuple):
    """A disc or grain with a prescribed motion, or a disc that stands: key of its section, name in words, centre (m) at
    the start, radius (m), and what prescribes x and y, None where it is free."""

    key: str
    name: str
    at: tuple[float, float]
    radius: float
    courses: tuple[Component | None, Component | None]

    @property
    def fastest(self) -> float:
        """Its largest speed, m/s, of components that change with time each at its largest."""
        return math.hypot(*(it.fastest if it else 0.0 for it in self.courses))


def check_controls(scene: Scene, count: int, faults: list[Fault]) -> None:
    """Add faults of controls; ``count``: grains that are free, the discs of clumps last."""
    bodies = members(scene.clump)
    single, seen, names = count - sum(map(len, bodies)), [], []
    for k, it in enumerate(scene.control):
        body, number = it.of
        key, most = f"control[{k}].{body}", single if body == "grain" else counted(scene, body)
        if number >= most:
            allowed = f"0 to {most - 1}" if most else f"none: there is no {body} of its own"
            faults.append(Fault(key, number, f"there is no such {body}", "", allowed))
        if it.of in seen:
            faults.append(Fault(key, number, "is controlled twice", repair="put both into one [[control]]"))
        elif it.called in names:
            faults.append(Fault(f"control[{k}].name", it.called, "is taken", repair="give each its own"))
        seen.append(it.of)
        names.append(it.called)


def check_motions(scene: Scene, faults: list[Fault]) -> None:
    """Add a fault where a body is moved into a side of the box, or two into each other: for the first to do so.

    Of held discs, and grains placed by hand whose x or y is controlled.  Into: by more than a run allows, WORST_OVERLAP
    of the (smaller) radius.  Sides that move, and a box that is strained, are left out.
    """
    bodies = list(_driven(scene))
    fastest = max((it.fastest for it in bodies), default=0.0)
    if fastest == 0.0 or scene.cell:
        return
    pairs = sum(it.fastest > 0.0 for it in bodies) * len(bodies)
    wanted = 1 + math.ceil(fastest * scene.time.end / (CLOSE * min(it.radius for it in bodies)))
    looks = min(wanted, LOOKS, PLACES // pairs, AT_ONCE // len(bodies))
    times = np.linspace(0.0, scene.time.end, max(2, looks))
    ways = [[np.zeros(len(times)) if it is None else _way(it, times) for it in body.courses] for body in bodies]
    places = np.array(
        [[x + at for x, at in zip(way, it.at, strict=True)] for way, it in zip(ways, bodies, strict=True)]
    )
    found = []
    if hit := min(_into_sides(scene, bodies, places), default=None):
        look, k, side = hit
        problem = f"goes more than {WORST_OVERLAP:g} of its radius into the {side} side after {times[look]:.3g} s"
        repair = "end its motion or the run before, or make the box larger"
        found.append((look, Fault(bodies[k].key, None, problem, repair=repair)))
    if met := _first_met(scene, bodies, places):
        look, i, j = met
        problem = f"and {bodies[j].name} run into each other after {times[look]:.3g} s, by more than"
        problem += f" {WORST_OVERLAP:g} of the smaller radius"
        repair = "end their motion or the run before, or move one of them"
        found.append((look, Fault(bodies[i].key, None, problem, repair=repair)))
    if found:
        faults.append(min(found, key=lambda it: it[0])[1])


def _driven(scene: Scene) -> Iterator[Driven]:
    """All bodies that are looked at."""
    for k, it in enumerate(scene.disc):
        x, y = it.velocity_x or TimeFunction(mean=it.velocity[0]), it.velocity_y or TimeFunction(mean=it.velocity[1])
        yield Driven(f"disc[{k}]", f"disc {k}", (it.x, it.y), 0.5 * it.diameter,
                     (Component(velocity=x), Component(velocity=y)))  # fmt: skip
    grains, controls = scene.grains.grain if scene.grains else (), controls_by_hand(scene)
    for grain, by in zip(grains, controls, strict=False):
        if by and (by.x.prescribes or by.y.prescribes):
            kind, number = by.of
            courses = (by.x if by.x.prescribes else None), (by.y if by.y.prescribes else None)
            key = f"control[{scene.control.index(by)}]"
            yield Driven(key, f"{kind} {number}", (grain.x, grain.y), 0.5 * grain.diameter, courses)


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


def _into_sides(scene: Scene, bodies: list[Driven], places: Floats) -> Iterator[tuple[int, int, str]]:
    """(look, number, side) of every body of those at ``places`` (n, 2, looks) m that is moved into a side of the box,
    and is not there at the start."""
    d = scene.domain
    for k, (body, at) in enumerate(zip(bodies, places, strict=True)):
        for axis, size in enumerate((d.width, d.height)):
            if body.courses[axis] is None or d.periodic[axis]:
                continue
            for side, away in zip(NAMES[axis], (at[axis], size - at[axis]), strict=True):
                inside = body.radius - away > WORST_OVERLAP * body.radius
                if inside.any() and not inside[0] and not _moves(d.side(side)):
                    yield int(inside.argmax()), k, side


def _first_met(scene: Scene, bodies: list[Driven], places: Floats) -> tuple[int, int, int] | None:
    """(look, number, other's number) of the first two bodies of those at ``places`` (n, 2, looks) m that overlap, and
    do not at the start; None where there are none.  Of two with the same motion nothing is looked at."""
    whole = np.array([k for k, it in enumerate(bodies) if None not in it.courses], int)
    radius, motion = np.array([it.radius for it in bodies]), [repr(it.courses) for it in bodies]
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
            allowed = WORST_OVERLAP * np.minimum(radius[js], radius[i])
            met = np.hypot(apart[:, 0], apart[:, 1]) < (radius[js] + radius[i] - allowed)[:, None]
            met &= ~met[:, :1]
            if met.any():
                looks = np.where(met.any(axis=1), met.argmax(axis=1), places.shape[2])
                k = int(looks.argmin())
                found = int(looks[k]), min(i, int(js[k])), max(i, int(js[k]))
                first = found if first is None else min(first, found)
    return first
