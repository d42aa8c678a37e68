"""Rectangles of a scene: as sections, in motion for fluid and grains alike, and in each other's way or not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pydantic
from numpy.typing import NDArray

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.coupling.coverage.rectangle import Rectangle as LatticeRectangle
from porescale.dem.forces.rectangle import LEFT, RIGHT, VELOCITY_X
from porescale.dem.forces.rectangle import Rectangle as GrainRectangle
from porescale.dem.forces.walls import Plate
from porescale.dem.grains import Grains
from porescale.lbm.scales import Scales

if TYPE_CHECKING:
    from porescale.coupling.step import Coupled
    from porescale.scene.sections import Packing, Scene

PLACE: Any = {"ge": -1e3, "le": 1e3}
SPEED: Any = {"ge": -1e4, "le": 1e4}
MAKE_GOOD = 64
"""Steps after which what left with rectangles is made good: even, and too few for a density to change that is seen."""

Array = NDArray[Any]


class Rectangle(Section):
    """A solid rectangle along the grid: a gate of finite thickness, a piston, a step; fixed, or moved at a velocity.

    It may reach through the sides of the box, and leave through them or come in: the side moves with it there.  What
    fills it goes along; in a box without open sides the fluid's mass is made good, as if its level followed.
    """

    lower: tuple[float, float] = quantity("m", **PLACE, help="lower left corner at the start")
    upper: tuple[float, float] = quantity("m", **PLACE, help="upper right corner at the start")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity while it moves; [0, 0]: fixed")
    starts_at: float = quantity("s", 0.0, ge=0, le=1e9, help="time at which it starts to move")
    stops_at: float | None = quantity("s", None, ge=0, le=1e9, help="time at which it stops (default: never)")
    friction: float | None = quantity("", None, ge=0, le=1e3, help="friction with grains (default: that of walls)")
    make_good: bool | None = pydantic.Field(
        None, description="the fluid's mass is made good for what moves through sides (default: if no side is open)"
    )

    @pydantic.model_validator(mode="after")
    def _has_size(self) -> Rectangle:
        faults = []
        if not (self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]):
            faults.append(Fault("upper", str(self.upper), "does not lie right of and above lower", "m",
                                f"> {self.lower}", "exchange them"))  # fmt: skip
        if self.stops_at is not None and self.stops_at < self.starts_at:
            faults.append(Fault("stops_at", self.stops_at, "is before starts_at", "s", f">= {self.starts_at:g}"))
        if faults:
            raise Refused(*faults)
        return self

    @property
    def fastest(self) -> float:
        """Speed, m/s."""
        return float((self.velocity[0] ** 2 + self.velocity[1] ** 2) ** 0.5)

    def travelled(self, time: float) -> tuple[float, float]:
        """How far it has gone at ``time`` (s), m."""
        return travelled(self.velocity, self.starts_at, self.stops_at, time)


def travelled(
    velocity: tuple[float, float], starts_at: float, stops_at: float | None, time: float
) -> tuple[float, float]:
    """Way (m) until ``time`` of what moves at ``velocity`` (m/s) from starts_at to stops_at (s; None: for ever)."""
    moving = max(0.0, (time if stops_at is None else min(time, stops_at)) - starts_at)
    return velocity[0] * moving, velocity[1] * moving


def outline(
    section: Mapping[str, Any], time: float, size: tuple[float, float]
) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Edges, pairs of points (m), of a section as run cards keep it, at ``time`` (s) in a box of ``size`` (m)."""
    gone = travelled(section["velocity"], section["starts_at"], section["stops_at"], time)
    (left, bottom), (right, top) = (
        tuple(at + by for at, by in zip(section[corner], gone, strict=True)) for corner in ("lower", "upper")
    )
    x0, x1, y0, y1 = max(left, 0.0), min(right, size[0]), max(bottom, 0.0), min(top, size[1])
    if x0 >= x1 or y0 >= y1:
        return []
    upright = [((x, y0), (x, y1)) for x in (left, right) if 0.0 < x < size[0]]
    return upright + [((x0, y), (x1, y)) for y in (bottom, top) if 0.0 < y < size[1]]


class Movers:
    """Moves the rectangles of a scene, for fluid and grains alike."""

    def __init__(
        self, scene: Scene, lattice: Sequence[LatticeRectangle], scales: Scales | None, grains: Grains | None
    ) -> None:
        self.sections, self.lattice, self.scales, self.grains = scene.rectangle, list(lattice), scales, grains
        closed = not any(side.open for side in scene.domain.sides.values())
        wanted = [it.make_good for it in self.sections if it.make_good is not None]
        self.make_good = wanted[0] if wanted else closed
        self.made_good = 0.0  # cells

    def place(self, step: int, step_seconds: float) -> None:
        """Put all where they are at the start of ``step``."""
        for k, section in enumerate(self.sections):
            here = section.travelled(step * step_seconds)
            for a in range(2):
                if self.scales:
                    self.lattice[k].lower[a] = (section.lower[a] + here[a]) / self.scales.spacing
                if self.grains:
                    self.grains.rectangles[k, LEFT + a] = section.lower[a] + here[a]
                    self.grains.rectangles[k, RIGHT + a] = section.upper[a] + here[a]

    def advance(self, step: int, step_seconds: float, coupled: Coupled | None) -> None:
        """Give all the velocity that takes them through ``step``, and now and then make the fluid's mass good."""
        time = step * step_seconds
        for k, section in enumerate(self.sections):
            here, there = section.travelled(time), section.travelled(time + step_seconds)
            for a in range(2):
                speed = (there[a] - here[a]) / step_seconds
                if self.scales:
                    self.lattice[k].velocity[a] = speed / self.scales.velocity
                if self.grains:
                    self.grains.rectangles[k, VELOCITY_X + a] = speed
        if coupled and self.make_good and step % MAKE_GOOD == 0:
            self.made_good += coupled.saturated.make_good(coupled.fluid)

    def row(self, coupled: Coupled) -> dict[str, float]:
        """Columns of the series."""
        area = coupled.scales.spacing**2
        through = self.made_good + coupled.saturated.mass_through_sides
        return {"fluid in with rectangles (m²)": through * area, "of it taken out again (m²)": self.made_good * area}


def rectangle_loads(numbers: Sequence[int], coupled: Coupled) -> dict[str, float]:
    """Forces of the fluid and of the grains on rectangles by number, columns of loads.csv."""
    row: dict[str, float] = {}
    for k in numbers:
        fluid, grains = coupled.rectangle_force[k], coupled.grains.rectangle_force[k]
        for a, axis in enumerate("xy"):
            row[f"rectangle {k} force {axis} (N/m)"] = float(fluid[a])
            row[f"rectangle {k} force of grains {axis} (N/m)"] = float(grains[a])
    return row


def on_the_lattice(scene: Scene, scales: Scales) -> list[LatticeRectangle]:
    """The rectangles as the fluid sees them, at rest at the start: they set off in the first step."""
    h = scales.spacing
    return [LatticeRectangle(np.array(it.lower) / h, np.array(it.upper) / h) for it in scene.rectangle]


def stand_ins(scene: Scene, packing: Packing) -> list[Plate]:
    """Plates on the upright faces between which a packing settles: on those next to it, at its height."""
    edges = packing.left, packing.left + packing.width
    return [
        Plate(x, it.lower[1], it.upper[1], friction=it.friction, name=f"rectangle {k} {side}")
        for k, it in enumerate(scene.rectangle)
        for side, x, edge in (("left", it.lower[0], edges[1]), ("right", it.upper[0], edges[0]))
        if holds(it, packing) and abs(x - edge) < packing.diameter
    ]


def holds(it: Rectangle, packing: Packing) -> bool:
    """Whether a rectangle stands at the height of the packing."""
    return it.lower[1] < packing.bottom + packing.height and it.upper[1] > packing.bottom


def beside(scene: Scene, packing: Packing) -> tuple[bool, bool]:
    """Whether a face holds the packing on its left, and on its right, while it settles."""
    names = [plate.name for plate in stand_ins(scene, packing)]
    return any(name.endswith("right") for name in names), any(name.endswith("left") for name in names)


def take_over(scene: Scene, grains: Grains) -> None:
    """Rectangles instead of the plates that stood in for them, with the springs that those had; if there were any."""
    grains.set_rectangles(
        [GrainRectangle(it.lower, it.upper, friction=it.friction, name=f"rectangle[{k}]")
         for k, it in enumerate(scene.rectangle)]
    )  # fmt: skip
    for k in range(len(scene.rectangle)):
        for name in (f"rectangle {k} left", f"rectangle {k} right"):
            if name in grains.plate_names:
                grains.rectangle_spring[k] += grains.plate_spring[grains.plate(name)]
                grains.remove_plate(name)
