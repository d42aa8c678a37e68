"""Bodies of grains as sections: clumps of discs, and control of grains and clumps; and how they are made."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pydantic

from porescale.build.frame_build import PLATES, Placed, bind_frames, plates_of, tell_frames
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.dem.bodies.clumps import Body
from porescale.dem.bodies.union import outline
from porescale.dem.contact.materials import Law
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.motion.drivers import Clump as ClumpNumber
from porescale.scene.contact import density_of
from porescale.scene.time_function import Component, Turning

if TYPE_CHECKING:
    from porescale.scene.sections import Grain, Scene

PLACE: Any = {"ge": -1e3, "le": 1e3}
SPEED: Any = {"ge": -1e4, "le": 1e4}


class Clump(Section):
    """Rigid bodies of discs that may overlap, all alike: placed by hand, as many as there are points.

    Mass, centroid and moment of inertia are those of the union of the discs at the density of the material, or of
    [grains]; or mass and inertia are given.  In fluid they displace that union of discs of the radius that it sees.
    """

    discs: tuple[tuple[float, float, float], ...] = quantity(
        "m", ge=-1e3, le=1e3, help="discs of the body, [x, y, radius] from its point"
    )
    at: tuple[tuple[float, float], ...] = quantity("m", **PLACE, help="where the points of the bodies are")
    angle: tuple[float, ...] = quantity("rad", (), ge=-1e3, le=1e3, help="by how much each is turned about its point")
    density: float | None = quantity("kg/m^3", None, ge=1e-3, le=1e5, help="density (default: of its material)")
    mass: float | None = quantity("kg/m", None, gt=0, le=1e9, help="mass per metre of depth, by hand")
    inertia: float | None = quantity("kg m", None, gt=0, le=1e9, help="moment of inertia per metre, by hand")
    centroid: tuple[float, float] | None = quantity(
        "m", None, **PLACE, help="centre of mass from the point, by hand (default: of the union)"
    )
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity of the centre at the start")
    spin: float = quantity("rad/s", 0.0, ge=-1e7, le=1e7, help="angular velocity at the start, counter-clockwise")
    material: str = pydantic.Field("", description="name of its material (default: the first)")

    @pydantic.model_validator(mode="after")
    def _whole(self) -> Clump:
        faults = []
        for key, values in (("discs", self.discs), ("at", self.at)):
            if not values:
                faults.append(Fault(key, None, "holds none", repair="give at least one"))
        for k, disc in enumerate(self.discs):
            if not disc[2] > 0.0:
                faults.append(Fault(f"discs[{k}]", disc[2], "has no radius", "m", "> 0"))
        if self.angle and len(self.angle) != len(self.at):
            faults.append(Fault("angle", len(self.angle), "are not as many as bodies", "", str(len(self.at))))
        if (self.mass is None) != (self.inertia is None):
            missing = "mass" if self.mass is None else "inertia"
            faults.append(Fault(missing, None, "is needed with the other", repair="give mass and inertia, or neither"))
        if self.mass is not None and self.density is not None:
            faults.append(Fault("density", self.density, "says nothing beside mass", "kg/m^3", repair="leave one out"))
        if self.centroid is not None and self.mass is None:
            faults.append(Fault("centroid", None, "follows from the discs", "m", repair="give mass and inertia, too"))
        if faults:
            raise Refused(*faults)
        return self

    def turned(self, copy: int, point: tuple[float, float]) -> tuple[float, float]:
        """Where ``point`` of the body is, in the box, in a copy of it; both m."""
        (x, y), angle = self.at[copy], self.angle[copy] if self.angle else 0.0
        c, s = math.cos(angle), math.sin(angle)
        return x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]

    def body(self, copy: int) -> Body | None:
        """What is given by hand, None where it follows from the discs."""
        if self.mass is None or self.inertia is None:
            return None
        centre = self.centroid
        if centre is None:
            discs = np.array(self.discs)
            x, y = outline(discs[:, :2], discs[:, 2]).centroid
            centre = float(x), float(y)
        return Body(self.mass, self.turned(copy, centre), self.inertia)


class Controlled(Section):
    """Control of one body: each of x, y, rotation "free", or told a velocity, a displacement or a force.

    record = true: force and displacement in control.csv; what a control gives is what contacts, weight and fluid take.
    """

    grain: int | None = pydantic.Field(None, ge=0, description="number of the grain: packing first, then by hand")
    clump: int | None = pydantic.Field(None, ge=0, description="number of the clump, copies one after the other")
    segment: int | None = pydantic.Field(None, ge=0, description="number of the body of segments, likewise")
    polygon: int | None = pydantic.Field(None, ge=0, description="number of the polygon, likewise")
    name: str = pydantic.Field("", description="name in the columns (default: what it is and its number)")
    x: Component = Component()
    y: Component = Component()
    rotation: Turning = Turning()
    record: bool = pydantic.Field(False, description="force and displacement over time in control.csv")

    @pydantic.model_validator(mode="after")
    def _of_one(self) -> Controlled:
        if sum(getattr(self, kind) is not None for kind in BODIES) != 1:
            repair = "give one of them"
            raise Refused(Fault(", ".join(BODIES), None, "exactly one of them is needed", repair=repair))
        return self

    @property
    def of(self) -> tuple[str, int]:
        """Kind of the body and its number."""
        kind = next(kind for kind in BODIES if getattr(self, kind) is not None)
        return kind, int(getattr(self, kind))

    @property
    def called(self) -> str:
        """Name in the columns."""
        kind, number = self.of
        return self.name or f"{kind} {number}"


BODIES = ("grain", "clump", "segment", "polygon")
"""What can be controlled."""


def body_of(scene: Scene, it: Controlled) -> int | ClumpNumber:
    """A controlled body as the grains name it: frames are clumps after the clumps, segments before polygons."""
    kind, number = it.of
    counts = [counted(scene, before) for before in BODIES[1 : BODIES.index(kind)]]
    return number if kind == "grain" else ClumpNumber(number + sum(counts))


def counted(scene: Scene, kind: str) -> int:
    """How many clumps, bodies of segments or polygons a scene has."""
    if kind == "clump":
        return sum(len(it.at) for it in scene.clump)
    return sum(len(it.copies) for it in (scene.segment if kind == "segment" else scene.polygon))


@dataclass(frozen=True)
class Member:
    """One disc of a clump, where it is; fields as of a grain placed by hand."""

    x: float
    y: float
    diameter: float
    velocity: tuple[float, float]
    spin: float
    material: str


def members(scene: Scene) -> list[list[Member]]:
    """The discs of every clump of a scene, copy by copy."""
    return [
        [Member(*it.turned(copy, disc[:2]), 2 * disc[2], it.velocity, it.spin, it.material) for disc in it.discs]
        for it in scene.clump
        for copy in range(len(it.at))
    ]


def by_hand(scene: Scene) -> list[Grain | Member]:
    """All that is placed by hand and free: grains, then the discs of clumps."""
    grains = scene.grains.grain if scene.grains else ()
    return [*grains, *(disc for body in members(scene) for disc in body)]


def hand_names(scene: Scene) -> tuple[list[str], list[int]]:
    """Key of the section of each of ``by_hand``, and the number of its clump, -1 for none."""
    count = len(scene.grains.grain) if scene.grains else 0
    names, groups, number = [f"grains.grain[{k}]" for k in range(count)], [-1] * count, 0
    for k, it in enumerate(scene.clump):
        for _ in it.at:
            names += [f"clump[{k}]"] * len(it.discs)
            groups += [number] * len(it.discs)
            number += 1
    return names, groups


def judge_bodies(scene: Scene, count: int, faults: list[Fault]) -> None:
    """Add faults of controls; ``count``: grains that are free, the discs of clumps last."""
    bodies = members(scene)
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


def least_density(scene: Scene) -> float:
    """Density (kg/m^3) of the lightest grain or clump of a scene with grains, of what it displaces."""
    assert scene.grains
    found = [density_of(scene, it.name) for it in scene.material] or [scene.grains.density]
    for it in scene.clump:
        discs = np.array(it.discs)
        area = outline(discs[:, :2], discs[:, 2]).area
        found.append(it.mass / area if it.mass else it.density or density_of(scene, it.material))
    return min(found)


def lightest(scene: Scene, every: list[Law]) -> float:
    """Mass (kg/m) of the disc that answers as fast as the fastest clump of a scene that has some.

    Raises InputError at a clump that no rigid body can be.
    """
    first = [replace_at(it) for it in scene.clump]
    discs = [disc for it in first for disc in it.discs]
    made = make_discs([disc[:2] for disc in discs], np.array([disc[2] for disc in discs]), 1.0)
    box = Box((-1.0, -1.0), (1.0, 1.0), *["open"] * 4)
    grains = Grains(made, every[0], box)
    ends = np.cumsum([0, *(len(it.discs) for it in first)])
    _bind(grains, first, [np.arange(*ends[k : k + 2]) for k in range(len(first))], scene)
    return grains.steering.lightest(every)


def replace_at(clump: Clump) -> Clump:
    """``clump`` as one body at the origin."""
    return clump.model_copy(update={"at": ((0.0, 0.0),), "angle": ()})


def _bind(grains: Grains, clumps: Iterable[Clump], numbers: list[Any], scene: Scene) -> None:
    """Make the copies of ``clumps`` of the discs with these ``numbers``, copy by copy."""
    grains.steering.bind(*_bodies(clumps, numbers, scene))


def _bodies(clumps: Iterable[Clump], numbers: list[Any], scene: Scene) -> tuple[list[Any], list[float], list[Any]]:
    """Disc numbers, density (kg/m^3) and mass by hand of the copies of ``clumps``."""
    copies = [(it, copy) for it in clumps for copy in range(len(it.at))]
    density = [it.density or density_of(scene, it.material) for it, _ in copies]
    return numbers, density, [it.body(copy) for it, copy in copies]


def add_clumps(scene: Scene, grains: Grains, placed: Sequence[Placed] = ()) -> None:
    """Bind the discs of clumps, which come after all other free grains and before those that are held, and frames of
    the corners that come last."""
    sizes = [len(body) for body in members(scene)]
    corners = sum(len(it.frame.corners) for it in placed)
    first = grains.discs.count - corners - len(scene.disc) - sum(sizes)
    ends = first + np.cumsum([0, *sizes])
    clumps = _bodies(scene.clump, [np.arange(*ends[k : k + 2]) for k in range(len(sizes))], scene)
    if placed:
        bind_frames(grains, placed, clumps)
    else:
        grains.steering.bind(*clumps)
    c, d = grains.steering.clumps, grains.discs
    each = [it for it in scene.clump for _ in it.at]
    if each:
        c.velocity[: len(each)], c.spin[: len(each)] = [it.velocity for it in each], [it.spin for it in each]
        c.place(d)


def add_controls(scene: Scene, grains: Grains, placed: Sequence[Placed] = ()) -> list[str]:
    """Tell bodies what they are told, and watch those that are recorded: their names, in the order of the record."""
    own = tell_frames(grains, placed) if placed else []
    for it in scene.control:
        grains.steering.control(body_of(scene, it), it.x.control, it.y.control, it.rotation.control)
    watched = [(it.called, body_of(scene, it)) for it in scene.control if it.record]
    watched += zip((it.name for it in placed if it.record), own, strict=True)
    if scene.rock and scene.rock.plates != "none":
        watched += zip(PLATES, plates_of(grains), strict=True)
    if watched:
        grains.steering.watch(*(body for _, body in watched))
    return [name for name, _ in watched]


def control_row(grains: Grains, recorded: Sequence[str]) -> dict[str, float]:
    """Columns of control.csv but the time: displacement since the start, forces of contacts and of the control.

    Forces are means over the last step of the model.  recorded : names of the first bodies that are watched.
    """
    row: dict[str, float] = {}
    for name, line in zip(recorded, grains.steering.record(), strict=False):
        for what, values, units in (
            ("displacement", line.displacement, ("m", "m", "rad")),
            ("contact", line.contact, ("N/m", "N/m", "N m/m")),
            ("control", line.supply, ("N/m", "N/m", "N m/m")),
        ):
            kinds = ("x", "y", "rotation") if what == "displacement" else ("force x", "force y", "moment")
            row |= {f"{name} {what} {kind} ({unit})": value
                    for kind, value, unit in zip(kinds, values, units, strict=True)}  # fmt: skip
    return row
