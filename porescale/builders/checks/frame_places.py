"""Where bodies of segments must not be: out of the box, in each other, in discs; and sections they do not go with.

All of it is geometry by hand, outside the time loop: a pair of bodies whose boxes overlap is compared side by side.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from porescale.builders.checks.wall_places import across_walls
from porescale.builders.initial.contact_laws import law_class
from porescale.builders.initial.frames import Placed
from porescale.common.core.constants import EDGE
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.outline import from_sides, within_outline
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import Discs
from porescale.dem.motion.control import Control, Moved, schedule_of
from porescale.dem.motion.control import Placed as PlacedControl
from porescale.dem.motion.time_function import schedule_rows, value_at
from porescale.dem.prepare.obstacles import crosses

if TYPE_CHECKING:
    from porescale.scene.contact import Contact
    from porescale.scene.domain import Domain
    from porescale.scene.scene import Scene


MOST = 0.25
"""Overlap over the sum of radius and thickness up to which bodies may start: a system beyond 0.3 is out of bounds."""
LOOKS = 201
"""Moments at which the way of a container is looked at."""
WAVES = 0.5
"""Share of the way to the middle of two segments that the speed to expect may press them: beyond, a warning."""


def check_frames(scene: Scene, placed: Sequence[Placed], discs: Discs, names: Sequence[str]) -> list[Fault]:
    """Faults of the places of frames among each other and the discs placed by hand, which have ``names``."""
    share = scene.grains.overlap if scene.grains else 0.0
    faults = [*_out_of_the_box(scene.domain, placed, share), *_too_thin(scene.contact, placed)]
    moving = [it for it in placed if it.kind != "container"]
    if scene.wall and moving and not faults:
        corners = np.concatenate([np.array(it.frame.corners) for it in moving])
        reach = np.concatenate([np.full(len(it.frame.corners), it.frame.thickness) for it in moving])
        keys = [it.key for it in moving for _ in it.frame.corners]
        faults += across_walls(scene, corners, reach, keys, 0.0)
    found = None if faults else first_overlap(share, placed, discs, names)
    return faults + ([found] if found else [])


def check_sample(scene: Scene, placed: Sequence[Placed], discs: Discs, names: Sequence[str]) -> list[Fault]:
    """A fault for the first body placed by hand, of discs with ``names`` and frames, that stands in the sample of a
    [rock]: bonds would be made with it, or torn by it."""
    packing = scene.grains.packing if scene.grains else None
    if scene.rock is None or packing is None:
        return []
    low = np.array([packing.left, packing.bottom])
    high = low + np.array([packing.width, packing.height])
    gap = discs.position - np.clip(discs.position, low, high)
    found = [name for name, inside in zip(names, np.hypot(*gap.T) < discs.radius, strict=True) if inside]
    for it in placed:
        if crosses(it.frame, tuple(low - it.frame.thickness), tuple(high + it.frame.thickness)):
            found.append(it.key)
    problem = "stands in the sample of [rock], which fills the rectangle of grains.packing"
    return [Fault(found[0], None, problem, repair="move it out")] if found else []


def require_frames_apart(share: float, placed: Sequence[Placed], discs: Discs, names: Sequence[str]) -> None:
    """InputError naming the first frame that lies in another, or in a disc; the first discs are the packing's;
    share : of the smaller one's size that may overlap."""
    every = [*["a grain of the packing"] * (discs.count - len(names)), *names]
    found = first_overlap(share, placed, discs, every)
    if found:
        raise InputError(found)


def _out_of_the_box(domain: Domain, placed: Sequence[Placed], share: float) -> list[Fault]:
    """The first frame of each section that reaches out of a box with solid sides, or is as long as a period.

    A side presses back what is pressed into it: ``share`` of a body's size at most, as of discs, and MOST of its
    thickness where it has one.  A container is moved, whatever presses on it.
    """
    size, periodic = np.array([domain.width, domain.height]), np.array(domain.periodic)
    faults: dict[str, Fault] = {}
    for it in placed:
        at = np.array(it.frame.corners)
        reach, pressed = 0.0, 0.0
        if it.kind != "container":
            reach, pressed = it.frame.thickness, share * float(np.ptp(at, axis=0).max())
            pressed = min(pressed, MOST * reach) if reach > 0.0 else pressed
        edge = EDGE * size + pressed
        out = ((at - reach < -edge) | (at + reach > size + edge)) & ~periodic
        if out.any():
            corner = at[out.any(axis=1).argmax()]
            where = f"({corner[0]:g}, {corner[1]:g})"
            faults.setdefault(it.key, Fault(it.key, where, "reaches out of the box", "m", repair="move it inside"))
        long = np.ptp(at, axis=0) > 0.5 * size
        if np.any(long & periodic):
            problem = "is longer than half of a periodic box, so that it would be in contact with its own image"
            faults.setdefault(it.key, Fault(it.key, None, problem, repair="make the box larger, or walls of its sides"))
    return list(faults.values())


def _too_thin(contact: Contact | None, placed: Sequence[Placed]) -> list[Fault]:
    """Frames without thickness that can touch: nothing would push them apart.  Hertz's law needs one everywhere."""
    bare = [it for it in placed if it.frame.thickness == 0.0]
    law = law_class(contact) if contact else None
    needs_radius = law is not None and law.needs_radius
    if not bare or not (needs_radius or (len(bare) > 1 and any(it.free for it in bare))):
        return []
    problem = "two segments without thickness go through each other"
    if law and needs_radius:
        problem = f"the law {law.name!r} needs a radius of corners"
    size = float(np.ptp(np.array(bare[0].frame.corners), axis=0).max())
    repair = f"give it one, such as {0.02 * size:.2g} m"
    return [Fault(f"{bare[0].key}.thickness", 0.0, problem, "m", "> 0", repair)]


def first_overlap(share: float, placed: Sequence[Placed], discs: Discs, names: Sequence[str]) -> Fault | None:
    """A fault for the first frame, in their order, that lies too deep in a disc (``names``) or an earlier frame."""
    shapes = [_Shape(it) for it in placed]
    low, high = np.array([it.low for it in shapes]), np.array([it.high for it in shapes])
    thickness = np.array([it.thickness for it in shapes])
    for k, shape in enumerate(shapes):
        if discs.count:
            depth = shape.depth_of(discs.position, discs.radius)
            reach = discs.radius + shape.thickness
            allowed = np.minimum(share * np.minimum(2.0 * discs.radius, shape.size), MOST * reach)
            worst = int((depth - allowed).argmax())
            if depth[worst] > allowed[worst]:
                return _lies_in(shape, _plain(names[worst]), float(depth[worst]))
        both = (shape.thickness + thickness[:k])[:, None]
        apart = (shape.low - both > high[:k]) | (low[:k] - both > shape.high)
        for other in (shapes[j] for j in np.flatnonzero(~apart.any(axis=1))):
            reach_of_both = shape.thickness + other.thickness
            allowed_depth = min(share * min(shape.size, other.size), MOST * reach_of_both)
            deep = shape.depth_in(other)
            if deep > allowed_depth:
                return _lies_in(shape, _plain(other.placed.key), deep)
    return None


def _lies_in(shape: _Shape, other: str, depth: float) -> Fault:
    what = f"overlaps {other} by {depth:.3g} m" if np.isfinite(depth) else f"lies across {other}"
    return Fault(shape.placed.key, shape.where, what, "m", repair="move one of them")


def _plain(name: str) -> str:
    """grains.grain[0] as "grain 0", polygon[0] as "polygon 0"."""
    return name.removeprefix("grains.").replace("[", " ").rstrip("]")


class _Shape:
    """A frame as geometry: its sides (s, 2, 2) m, whether it is solid, its box and how large it is."""

    def __init__(self, placed: Placed) -> None:
        self.placed, frame = placed, placed.frame
        at = np.array(frame.corners)
        self.thickness, self.corners = frame.thickness, at
        self.sides = at[np.array(frame.ends)]
        solid = frame.closed and placed.kind != "container"
        self.outline: Floats | None = at[frame.loop] if solid else None
        self.low, self.high = at.min(axis=0), at.max(axis=0)
        self.size = float((self.high - self.low).max())
        middle = 0.5 * (self.low + self.high)
        self.where = f"({middle[0]:g}, {middle[1]:g})"

    def depth_of(self, points: Floats, radius: Floats) -> Floats:
        """How deep (m) discs (n, 2) m lie in its rim, infinite inside of it, below zero outside."""
        depth = radius + self.thickness - self.distance(points)
        return np.where(self.holds(points), np.inf, depth)

    def distance(self, points: Floats) -> Floats:
        """Distance from points (n, 2) m to the nearest side, m."""
        return from_sides(points, self.sides)[0]

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Which points (n, 2) m lie within the outline of a solid one, by the parity of sides crossed above."""
        if self.outline is None:
            return np.zeros(len(points), bool)
        return within_outline(points, self.outline)

    def depth_in(self, other: _Shape) -> float:
        """How deep (m) it lies in another one's rim; infinite where sides cross or one holds a corner of the other."""
        if _cross(self.sides, other.sides):
            return float("inf")
        if self.holds(other.corners).any() or other.holds(self.corners).any():
            return float("inf")
        apart = min(float(self.distance(other.corners).min()), float(other.distance(self.corners).min()))
        return self.thickness + other.thickness - apart


def _cross(one: Floats, other: Floats) -> bool:
    """Whether a side of (s, 2, 2) m crosses one of (k, 2, 2) m."""

    def left(a: Any, b: Any, c: Any) -> Any:
        """Twice the areas of the triangles a, b, c, m²: > 0 where c lies left of the way from a to b."""
        return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])

    a, b = one[:, None, 0], one[:, None, 1]
    c, d = other[None, :, 0], other[None, :, 1]
    return bool(np.any((left(a, b, c) * left(a, b, d) < 0.0) & (left(c, d, a) * left(c, d, b) < 0.0)))


def thin_for(placed: Sequence[Placed], speed: float, mass: float, law: ContactLaw) -> str:
    """A doubt about frames that the speed (m/s) to expect would press through each other; "" where there is none.

    mass (kg/m): of a mean grain.  A head-on impact of two goes  v sqrt(m/2k)  deep on springs, and by Hertz's law
    (15 m v^2/32 E sqrt(R))^(2/5), with R half the thickness.
    """
    found = [it.frame.thickness for it in placed if it.frame.thickness > 0.0]
    if len(found) < 2:
        return ""
    thin = min(found)
    deep, power = law.impact(0.5 * mass, 0.5 * thin, speed)
    allowed = WAVES * 2.0 * thin
    if deep <= allowed:
        return ""
    return (
        f"bodies of segments {thin:.2g} m thick would be pressed {deep:.2g} m into each other at the {speed:.2g} m/s to"
        f" expect, and go through beyond {2.0 * thin:.2g} m: contacts {(deep / allowed) ** power:.2g} times as stiff,"
        " or thicker bodies, withstand it"
    )


def strays(domain: Domain, end: float, placed: Sequence[Placed]) -> list[str]:
    """Warnings of containers that leave a box with solid sides as they move, which pushes them, up to ``end`` (s)."""
    size, periodic = np.array([domain.width, domain.height]), np.array(domain.periodic)
    said = []
    for it in placed:
        motion = [control for control in it.prescribed if control is not None]
        if it.kind != "container" or len(motion) != len(it.prescribed):
            continue
        times = np.linspace(0.0, end, LOOKS)
        x, y, turn = (_path(control, times) for control in motion)
        about = np.array(it.frame.mass_properties().centroid)
        arms = np.array(it.frame.corners) - about
        for time, gone, angle in zip(times, np.column_stack((x, y)), turn, strict=True):
            c, s = np.cos(angle), np.sin(angle)
            at = arms @ np.array([[c, s], [-s, c]]) + about + gone
            out = ((at < -EDGE * size) | (at > (1.0 + EDGE) * size)) & ~periodic
            if out.any():
                corner = at[out.any(axis=1).argmax()]
                said.append(
                    f"{it.name or it.key} leaves the box at t = {time:.3g} s, at ({corner[0]:.3g}, {corner[1]:.3g}) m:"
                    " the sides push it there, and that is in its record and in the energy budget; make the box larger"
                )
                break
    return said


def _path(control: Control, times: Floats) -> Floats:
    """Displacement (m, rad) of a component at ``times`` (s) since the first, by its velocity or displacement."""
    rows, points = schedule_rows([schedule_of(control)])
    values = np.array([value_at(rows, points, 0, time) for time in times])
    if isinstance(control, PlacedControl):
        return np.asarray(values - values[0])
    if not isinstance(control, Moved):
        return np.zeros(len(times))
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(times)
    return np.concatenate(([0.0], np.cumsum(steps)))
