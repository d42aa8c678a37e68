"""From the sections of segments, polygons and containers to frames among the grains.

Order of the discs of a system: packing, grains and clumps placed by hand, discs that are held, then the corners of
frames.  Order of its clumps: clumps, then frames: segments, polygons, containers, rock, plates.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from porescale.builders.initial.contact_laws import MaterialPlan
from porescale.builders.initial.random_polygons import copies_of
from porescale.builders.initial.time_functions import control_of
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.schema.names import names_of
from porescale.dem.bodies.clumps import Body, shares
from porescale.dem.bodies.frames import Frame, add_frames, chain, corner_discs, framed, from_ends, polygon, skin_of
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.motion.control import Control, Moved, Pushed
from porescale.dem.motion.drivers import Clump as ClumpNumber
from porescale.dem.prepare.merge import joined
from porescale.scene.bodies.segments import Container, PolygonBody, SegmentBody
from porescale.scene.scene import Scene

Kind = Literal["segment", "polygon", "container", "rock", "plate"]

Prescribed = tuple[Control | None, Control | None, Control | None]

PLATES = ("first plate", "second plate")

FREE: Prescribed = (None, None, None)

HELD: Prescribed = (Moved(), Moved(), Moved())

ROD = 1e-3
"""Width of the rods of a container without thickness, over its size: it must weigh something to be a body."""


@dataclass(frozen=True)
class Placed:
    """A frame of a scene: ``key`` of its section, what it is, and how its components are prescribed to move."""

    key: str
    kind: Kind
    frame: Frame
    prescribed: Prescribed = FREE
    name: str = ""
    record: bool = False

    @property
    def free(self) -> bool:
        """Whether forces move it: it is one of the grains."""
        return self.kind not in ("container", "plate") and not _without_force(self.prescribed)


def _without_force(motion: Prescribed) -> bool:
    """Whether each component has a velocity or a displacement, so that no force moves the body."""
    return all(it is not None and not isinstance(it, Pushed) for it in motion)


def placed_frames(scene: Scene) -> list[Placed]:
    """The frames that are placed by hand, in their order; raises InputError at one that cannot be, by its key."""
    found: list[Placed] = []
    faults: list[Fault] = []
    names = iter(names_of(scene.container, "container"))
    for key, kind, section in _sections(scene):
        try:
            found += _made(MaterialPlan.of(scene), key, kind, section, next(names) if kind == "container" else "")
        except InputError as error:
            faults += [_of_section(fault, key) for fault in error.faults]
    if faults:
        raise InputError(faults)
    return _controlled(scene, found)


def _controlled(scene: Scene, placed: Sequence[Placed]) -> list[Placed]:
    """The bodies, held ones moved as their [[control]] says: where it leaves a component free, forces move it."""
    given, numbers, found = {it.of: it for it in scene.control}, Counter[str](), []
    for it in placed:
        by = given.get((it.kind, numbers[it.kind]))
        numbers[it.kind] += 1
        if by is not None and it.prescribed == HELD:
            it = replace(it, prescribed=(control_of(by.x), control_of(by.y), control_of(by.rotation)))
        found.append(it)
    return found


def _sections(scene: Scene) -> Iterator[tuple[str, Kind, SegmentBody | PolygonBody | Container]]:
    for k, segment in enumerate(scene.segment):
        yield f"segment[{k}]", "segment", segment
    for k, each in enumerate(scene.polygon):
        yield f"polygon[{k}]", "polygon", each
    for k, container in enumerate(scene.container):
        yield f"container[{k}]", "container", container


def _of_section(fault: Fault, key: str) -> Fault:
    """A fault of a frame as one of its section."""
    name = fault.key.removeprefix("frame.").removeprefix("clump.")
    value = fault.value if isinstance(fault.value, int | float | str) else None
    repair = fault.repair
    if "between these segments" in fault.problem:
        value = f"corners {fault.value[0]} and {fault.value[1]}" if isinstance(fault.value, tuple) else None
        repair = "give the corners in their order round the outline"
        if "spike" in fault.problem:
            repair = "leave the corner at its tip out"
    elif fault.key == "frame.corners":
        repair = "leave out points that coincide"
    return replace(fault, key=f"{key}.{name}", value=value, repair=repair)


def _made(
    plan: MaterialPlan, key: str, kind: Kind, section: SegmentBody | PolygonBody | Container, name: str
) -> list[Placed]:
    """The bodies of all copies of one section;  name : of a container."""
    number = plan.number(section.material, wall=kind == "container")
    more: dict[str, Any] = {"material": number}
    if isinstance(section, Container):
        return [Placed(key, kind, _container(plan, section, more), _prescribed(section), name, section.record)]
    density = section.density or plan.density(section.material)
    more |= {"velocity": section.velocity, "spin": section.spin}
    motion, made = HELD if section.held else FREE, []
    for at, angle, size in copies_of(section):
        if isinstance(section, PolygonBody):
            frame = polygon(_turned(section.points, at, angle, size), section.thickness, density, **more)
        else:
            frame = _lines(section, at, angle, density, more | {"width": section.width, "long": section.long})
        made.append(Placed(key, kind, frame, motion))
    return made


def _prescribed(section: Container) -> Prescribed:
    """How each component of a container moves: it stands where none is prescribed."""
    stands = Moved()
    x, y, rotation = (control_of(it) or stands for it in (section.x, section.y, section.rotation))
    return x, y, rotation


def _lines(section: SegmentBody | Container, at: Any, angle: float, density: float, more: dict[str, Any]) -> Frame:
    """A chain, closed where it ends where it began, or segments by their ends; closed, a container is hollow."""
    if section.chain:
        points = _turned(section.chain, at, angle)
        if len(points) > 3 and section.chain[0] == section.chain[-1]:
            return polygon(points[:-1], section.thickness, density, **more)
        return chain(points, section.thickness, density, **more)
    ends = _turned(np.array(section.ends).reshape(-1, 2), at, angle)
    return from_ends(ends.reshape(-1, 2, 2), section.thickness, density, **more)


def _container(plan: MaterialPlan, section: Container, more: dict[str, Any]) -> Frame:
    """The frame of a container, with its pivot for a centroid; anywhere where no force moves it."""
    points = np.array(section.chain or section.ends).reshape(-1, 2)
    width = max(2.0 * section.thickness, ROD * float(np.ptp(points, axis=0).max()))
    density = plan.density(section.material or plan.of_walls)
    frame = _lines(section, (0.0, 0.0), 0.0, density, more | {"width": width, "long": True, "hollow": True})
    if section.pivot is None:
        return frame
    own = frame.mass_properties()
    driven, arm = _without_force(_prescribed(section)), np.array(frame.corners) - section.pivot
    if not driven and shares(np.ones(len(arm)), arm, float(np.abs(arm).max())) is None:
        problem, repair = "must lie amid the points of its segments, as a force moves it", "take a point between them"
        raise InputError(Fault("frame.pivot", None, problem, "m", repair=repair))
    centroid = own.centroid if driven else None
    return replace(frame, body=Body(own.mass, section.pivot, own.inertia, True, own.area, centroid))


def _turned(points: Any, at: Any, angle: float, size: float = 1.0) -> Floats:
    """Points (k, 2) m of a body turned by ``angle`` about its point, in the box."""
    if angle == 0.0 and size == 1.0:
        moved: Floats = np.array(points, float) + np.array(at, float)
        return moved
    c, s = np.cos(angle), np.sin(angle)
    turned: Floats = size * np.array(points, float) @ np.array([[c, s], [-s, c]]) + np.array(at, float)
    return turned


def disc_count(grains: Grains) -> int:
    """Number of discs of a system that are no corners of frames."""
    return grains.discs.count if grains.segments is None else int(np.sum(~grains.segments.is_corner))


def with_corners(grains: Grains, placed: Sequence[Placed]) -> Grains:
    """``grains``, free and at rest, with the corners of frames after all discs."""
    frames = [it.frame for it in placed]
    return joined(grains, corner_discs(frames), skin_of(grains.discs.radius, frames))


def bind_frames(
    grains: Grains, placed: Sequence[Placed], clumps: tuple[list[Any], list[float], list[Body | None]]
) -> None:
    """Make frames of the last discs, beside clumps (numbers, densities, bodies); no motion is prescribed so far.

    Raises InputError by the keys of sections.
    """
    numbers, density, bodies = clumps
    try:
        add_frames(grains, [it.frame for it in placed], clumps=numbers, clump_density=density, clump_bodies=bodies)
    except InputError as error:
        raise InputError([_of_clump(fault, placed, len(numbers)) for fault in error.faults]) from None


def _of_clump(fault: Fault, placed: Sequence[Placed], before: int) -> Fault:
    """A fault of clump[k] as one of the section of a frame."""
    head, _, rest = fault.key.partition("].")
    number = head.removeprefix("clump[")
    if not number.isdigit() or int(number) < before:
        return _of_section(fault, next(it.key for it in placed if it.frame.thickness == 0.0 or it is placed[-1]))
    it = placed[int(number) - before]
    return replace(fault, key=f"{it.key}.{rest}")


def prescribe_motion(grains: Grains, placed: Sequence[Placed]) -> list[ClumpNumber]:
    """Prescribe the motion of frames; returns those that are recorded of themselves, in their order."""
    first = grains.steering.clumps.count - len(placed)
    for k, it in enumerate(placed):
        if it.prescribed != FREE:
            grains.steering.control(ClumpNumber(first + k), *it.prescribed)
    return [ClumpNumber(first + k) for k, it in enumerate(placed) if it.record]


def plates_of(grains: Grains) -> tuple[ClumpNumber, ClumpNumber]:
    """The plates of a rock, the last clumps."""
    count = grains.steering.clumps.count
    return ClumpNumber(count - 2), ClumpNumber(count - 1)


def free_rows(grains: Grains, placed: Sequence[Placed], held: int) -> NDArray[np.int64]:
    """Rows of the discs that are grains: all but the last ``held`` discs and what is controlled in all components, and
    corners of frames that forces move."""
    discs = disc_count(grains)
    owner = np.repeat([it.free for it in placed], [len(it.frame.corners) for it in placed])
    moved = np.flatnonzero(~without_force(grains)[: discs - held])
    return np.concatenate((moved, discs + np.flatnonzero(owner)))


def without_force(grains: Grains) -> NDArray[np.bool_]:
    """Which discs (n,) no force moves, since each component of theirs, or of their clump, is held or prescribed."""
    still: NDArray[np.bool_] = np.zeros(grains.discs.count, bool)
    if len(grains.held):
        still |= grains.held.all(axis=1)
    clumps = clumps_of(grains)
    if clumps is not None:
        still[clumps.member] = np.repeat(clumps.held.all(axis=1), np.diff(clumps.start))
    return still


def lightest_frame(placed: Sequence[Placed], every: list[ContactLaw], radius: float | None) -> float | None:
    """Mass (kg/m) of the disc that answers as fast as the fastest frame that forces move; None without any.

    radius (m): of the smallest disc that can lie at a segment, None without discs.
    """
    sizes: dict[tuple[str, float], Frame] = {}
    for it in (it for it in placed if it.free):
        # Copies of a section that weigh the same are alike; polygons of a rock are each their own.
        own = len(sizes) if it.kind == "rock" else float(f"{it.frame.mass_properties().mass:.9g}")
        sizes[it.key, own] = it.frame
    moving = list(sizes.values())
    if not moving:
        return None
    corners = np.concatenate([np.array(frame.corners) for frame in moving])
    far = 1.0 + float(np.ptp(corners, axis=0).max())
    (left, low), (right, top) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    small = None if radius is None else make_discs([(left - far, low)], radius, 1.0)
    box = Box((left - 2.0 * far, low - far), (right + far, top + far), *["open"] * 4)
    of_one = [np.zeros(len(frame.corners), np.int64) for frame in moving]  # no law of these grains is used
    grains = framed(small, moving, every[0], box, corner_material=of_one)
    return grains.steering.lightest(every)


def longest_of(placed: Sequence[Placed]) -> float:
    """Largest distance (m) between two corners of a frame; 0 without any."""
    corners = [np.array(it.frame.corners) for it in placed]
    return max((float(np.hypot(*(at[:, None] - at).T).max()) for at in corners), default=0.0)


def sizes_of(placed: Sequence[Placed]) -> list[float]:
    """Diameter (m) of the disc of equal area of every frame that forces move; of the polygons, where they move none."""
    meant = [it for it in placed if it.free] or [it for it in placed if it.frame.mass_properties().area]
    return [2.0 * float(np.sqrt((it.frame.mass_properties().area or 0.0) / np.pi)) for it in meant]
