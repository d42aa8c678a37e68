"""[[segment]], [[polygon]] and [[container]]: bodies of line segments.

Lengths in m; all points are in the box unless copies are placed ``at`` points, from which they count then.
"""

import math

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH, PLACE, SPEED
from porescale.scene.time_function import Component, Turning

Points = tuple[tuple[float, float], ...]

Lines = tuple[tuple[float, float, float, float], ...]


class Framed(Section):
    """What bodies of segments have in common.  The thickness is half of what a segment measures across."""

    thickness: float = quantity("m", ge=0, le=1e3, help="distance of its surface from its lines, on either side")
    density: float | None = quantity("kg/m^3", None, ge=1e-3, le=1e5, help="density (default: of its material)")
    material: str = pydantic.Field("", description="name of its material (default: the first)")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity of the centre at the start")
    spin: float = quantity("rad/s", 0.0, ge=-1e7, le=1e7, help="angular velocity at the start, counter-clockwise")
    held: bool = pydantic.Field(False, description="stands still whatever pushes it; [[control]] moves it otherwise")
    at: Points = quantity("m", (), **PLACE, help="points with a copy at each (default: one, as it is given)")
    angle: tuple[float, ...] = quantity("rad", (), ge=-1e3, le=1e3, help="angle of each, about its point")

    def _faults(self) -> list[Fault]:
        """What is wrong with what all have."""
        faults = []
        if self.angle and len(self.angle) != max(len(self.at), 1):
            faults.append(Fault("angle", len(self.angle), "are not as many as bodies", "", str(max(len(self.at), 1))))
        if self.held and (self.velocity != (0.0, 0.0) or self.spin):
            faults.append(Fault("held", None, "and a velocity do not go together", repair="move it by a [[control]]"))
        return faults

    @property
    def copies(self) -> list[tuple[tuple[float, float], float, float]]:
        """Point (m), angle (rad) and relative size of every copy that is placed by hand."""
        return [(at, self.angle[k] if self.angle else 0.0, 1.0) for k, at in enumerate(self.at or [(0.0, 0.0)])]


class SegmentBody(Framed):
    """Line segments with thickness, rigid together: ``chain``, from point to point, or ``ends``, each by itself.

    Rods ``width`` across weigh; a chain that closes is a polygon and weighs as one.
    """

    chain: Points = quantity("m", (), **PLACE, help="points from which to which segments go")
    ends: Lines = quantity("m", (), **PLACE, help="ends of each segment, [x1, y1, x2, y2]")
    width: float | None = quantity("m", None, **LENGTH, help="width of the rods (default: twice the thickness)")
    long: bool = pydantic.Field(False, description="much longer than grains: kept out of the cells, as a container")

    def _faults(self) -> list[Fault]:
        return [*super()._faults(), *_one_line(self.chain, self.ends)]


class PolygonBody(Framed):
    """Solid polygons: ``corners`` in their order, or regular ones with ``sides`` of a circle's ``diameter``.

    As many as there are points ``at``, or a ``number`` of them, turned at random, placed at random in a rectangle.
    Mass, centroid and moment of inertia follow from the outline of the lines.
    """

    corners: Points = quantity("m", (), **PLACE, help="corners in their order, either way round")
    sides: int | None = pydantic.Field(None, ge=3, le=1000, description="number of sides of regular ones")
    diameter: float | None = quantity("m", None, **LENGTH, help="diameter of the circle through the corners")
    number: int | None = pydantic.Field(None, ge=1, le=1_000_000, description="how many are placed at random")
    within: tuple[float, float, float, float] | None = quantity(
        "m", None, **PLACE, help="rectangle in which they are placed, [left, bottom, right, top]"
    )
    size_spread: float = quantity("", 0.0, ge=0, lt=1, help="half width of the sizes over their mean, of random ones")
    seed: int = pydantic.Field(1, ge=0, description="seed of the random placement")

    def _faults(self) -> list[Fault]:
        faults = super()._faults()
        if bool(self.corners) == (self.sides is not None):
            faults.append(Fault("corners, sides", None, "exactly one of the two is needed", repair="give one of them"))
        if self.corners and len(self.corners) < 3:
            faults.append(Fault("corners", len(self.corners), "are too few for a polygon", "", ">= 3"))
        if (self.sides is None) != (self.diameter is None):
            missing = "sides" if self.sides is None else "diameter"
            faults.append(Fault(missing, None, "is needed with the other", repair="give both, or corners"))
        if (self.number is None) != (self.within is None):
            missing = "number" if self.number is None else "within"
            faults.append(Fault(missing, None, "is needed with the other", repair="give both, or neither"))
        if self.number is not None and self.at:
            faults.append(Fault("at", None, "and number cannot both be given", repair="give one of them"))
        if self.size_spread and self.number is None:
            faults.append(Fault("size_spread", self.size_spread, "is of polygons placed at random", repair="leave out"))
        if self.within and not (self.within[0] < self.within[2] and self.within[1] < self.within[3]):
            faults.append(Fault("within", None, "must be [left, bottom, right, top]", "m", repair="order them"))
        return faults

    @property
    def points(self) -> Points:
        """Corners of one at the origin, m; a regular one stands on a side."""
        if self.corners:
            return self.corners
        assert self.sides
        assert self.diameter
        turns = [2.0 * math.pi * (k + 0.5) / self.sides - 0.5 * math.pi for k in range(self.sides)]
        return tuple((0.5 * self.diameter * math.cos(it), 0.5 * self.diameter * math.sin(it)) for it in turns)


class Container(Section):
    """Long segments that hold grains: a box, a hopper, a drum.  Kept out of the cells of the neighbour search.

    It stands still but for the components that are prescribed; ``pivot`` is the point that x and y move and about which
    it turns: anywhere, as the hinge of a door, but amid its points where a force moves it.  What it takes is in
    control.csv.
    """

    chain: Points = quantity("m", (), **PLACE, help="points from which to which its segments go")
    ends: Lines = quantity("m", (), **PLACE, help="ends of each segment, [x1, y1, x2, y2]")
    thickness: float = quantity("m", ge=0, le=1e3, help="distance of its surface from its lines, on either side")
    material: str = pydantic.Field("", description="name of its material (default: that of the walls)")
    name: str = pydantic.Field("", description="name in the columns (default: container and its number)")
    pivot: tuple[float, float] | None = quantity("m", None, **PLACE, help="point that moves and about which it turns")
    x: Component = Component()
    y: Component = Component()
    rotation: Turning = Turning()
    record: bool = pydantic.Field(False, description="force and displacement over time in control.csv")

    def _faults(self) -> list[Fault]:
        return _one_line(self.chain, self.ends)


def _one_line(chain: Points, ends: Lines) -> list[Fault]:
    """Faults of a body of which exactly one of the two must be given."""
    if bool(chain) == bool(ends):
        return [Fault("chain, ends", None, "exactly one of the two is needed", repair="give one of them")]
    if chain and len(chain) < 2:
        return [Fault("chain", len(chain), "are too few points for a segment", "", ">= 2")]
    return []
