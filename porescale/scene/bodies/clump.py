"""[[clump]]: rigid bodies of discs that may overlap."""

import math

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import PLACE, SPEED


class Clump(Section):
    """Rigid bodies of discs that may overlap, all alike: placed by hand, as many as there are points.

    Mass, centroid and moment of inertia are those of the union of the discs at the density of the material, or of
    [grains]; or mass and inertia are given.  In fluid they displace that union of discs of the fluid's radius.
    """

    discs: tuple[tuple[float, float, float], ...] = quantity(
        "m", ge=-1e3, le=1e3, help="discs of the body, [x, y, radius] from its point"
    )
    at: tuple[tuple[float, float], ...] = quantity("m", **PLACE, help="places of the points of the bodies")
    angle: tuple[float, ...] = quantity("rad", (), ge=-1e3, le=1e3, help="angle of each, about its point")
    density: float | None = quantity("kg/m^3", None, ge=1e-3, le=1e5, help="density (default: of its material)")
    mass: float | None = quantity("kg/m", None, gt=0, le=1e9, help="mass per metre of depth, by hand")
    inertia: float | None = quantity("kg m", None, gt=0, le=1e9, help="moment of inertia per metre, by hand")
    centroid: tuple[float, float] | None = quantity(
        "m", None, **PLACE, help="centre of mass from the point, by hand (default: of the union)"
    )
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity of the centre at the start")
    spin: float = quantity("rad/s", 0.0, ge=-1e7, le=1e7, help="angular velocity at the start, counter-clockwise")
    material: str = pydantic.Field("", description="name of its material (default: the first)")

    def _faults(self) -> list[Fault]:
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
        return faults

    def turned(self, copy: int, point: tuple[float, float]) -> tuple[float, float]:
        """Position in the box of a ``point`` of the body, in one of its copies; both m."""
        (x, y), angle = self.at[copy], self.angle[copy] if self.angle else 0.0
        c, s = math.cos(angle), math.sin(angle)
        return x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]
