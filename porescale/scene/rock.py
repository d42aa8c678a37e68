"""Rock as a section: a pressed packing made into bonded discs, triangles or Voronoi cells between two plates.

The packing of [grains.packing] is pressed in its rectangle, wherever that lies in the box; its discs, or polygons with
its centres as seeds, stand there at rest and are bonded, plates and all, when the run begins.
Source: Matsushima, DEMseg tutorial II-4; see dem/prepare/rock.py, dem/prepare/tessellate.py.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pydantic
from numpy.typing import NDArray

from porescale.build.frame_build import FREE, HELD, PLATES, Placed, material_number
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.dem.bodies.frames import chain, polygon
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Law
from porescale.dem.discs import Discs, make_discs
from porescale.dem.grains import Grains
from porescale.dem.motion.control import Placed as PlacedControl
from porescale.dem.motion.time_function import Constant, Schedule, Sine, Table
from porescale.dem.prepare.tessellate import delaunay, shrunk, voronoi
from porescale.scene.contact import density_of
from porescale.scene.packing import compressed
from porescale.scene.time_function import Course, with_courses

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

Array = NDArray[np.float64]
LENGTH: Any = {"gt": 0, "le": 1e3}
BEYOND = 0.1
"""Of the length of a plate's side of the sample: how far it stands out at both ends."""


class Rock(Section):
    """A bonded sample made of the packing, between plates: left and right of it, or below and above.

    Polygons are shrunk to stand ``gap`` apart and get so much thickness that their sides overlap by ``pressed``.  The
    second plate moves by ``strain`` of the sample's length, > 0 away, the first stands: rock.csv.
    """

    kind: Literal["discs", "triangles", "cells"] = pydantic.Field(
        "discs", description="the packing's discs, Delaunay triangles or Voronoi cells of their centres"
    )
    gap: float | None = quantity("m", None, **LENGTH, help="distance of neighbouring polygons' lines")
    pressed: float | None = quantity("m", None, **LENGTH, help="overlap of their sides, from which they are bonded")
    plates: Literal["x", "y", "none"] = pydantic.Field("x", description="along which axis the plates press and pull")
    strain: Course | None = pydantic.Field(None, description="of the sample over time, > 0 pulled; left out, it stands")

    @pydantic.model_validator(mode="before")
    @classmethod
    def _courses(cls, table: Any) -> Any:
        return with_courses(table, {"strain": ("", "strain of the sample")})

    @pydantic.model_validator(mode="after")
    def _whole(self) -> Rock:
        faults = []
        for name in ("gap", "pressed"):
            value = getattr(self, name)
            if self.kind == "discs" and value is not None:
                faults.append(Fault(name, value, "is of polygons", "m", repair="leave it out, or take another kind"))
            if self.kind != "discs" and value is None:
                faults.append(Fault(name, None, "is missing", "m", "> 0", f"add it: {self.kind} need it"))
        if self.plates == "none" and self.strain is not None:
            faults.append(Fault("strain", None, "needs plates", repair='write plates = "x" or "y"'))
        if faults:
            raise Refused(*faults)
        return self

    @property
    def polygons(self) -> bool:
        """Whether it is of polygons."""
        return self.kind != "discs"


def judge_rock(scene: Scene) -> list[Fault]:
    """What a rock needs."""
    if scene.rock is None:
        return []
    faults, packing = [], scene.grains.packing if scene.grains else None
    if packing is None or packing.pressure is None:
        repair = "add [grains.packing] with pressure, or pressure to it"
        faults.append(Fault("rock", None, "is made of a packing that was pressed together", repair=repair))
    if scene.contact and scene.contact.law != "linear":
        faults.append(Fault("contact.law", scene.contact.law, "rock is bonded under the linear law", "", "linear"))
    if packing and scene.rock.gap and scene.rock.gap > 0.2 * packing.diameter:
        problem = "leaves little of polygons as large as the packing's discs"
        faults.append(Fault("rock.gap", scene.rock.gap, problem, "m", f"<= {0.2 * packing.diameter:.3g}"))
    return faults


def rock_discs(scene: Scene, law: Law) -> Discs | None:
    """The discs of a rock of discs, at rest; None of polygons."""
    assert scene.rock
    assert scene.grains
    assert scene.grains.packing
    if scene.rock.polygons:
        return None
    at, radius = _packing(scene, law)
    return make_discs(at, radius, density_of(scene, scene.grains.packing.material))


def rock_frames(scene: Scene, law: Law) -> list[Placed]:
    """Polygons of a rock and its plates, the first plate before the second.  The packing is read from the cache, or
    pressed, which takes seconds."""
    assert scene.rock
    assert scene.grains
    assert scene.grains.packing
    rock, packing = scene.rock, scene.grains.packing
    at, radius = _packing(scene, law)
    lower = (packing.left, packing.bottom)
    upper = (packing.left + packing.width, packing.bottom + packing.height)
    density, material = density_of(scene, packing.material), material_number(scene, packing.material)
    made: list[Placed] = []
    thickness = off = 0.5 * float(radius.mean())
    if rock.polygons:
        assert rock.gap
        assert rock.pressed
        thickness, off = 0.5 * (rock.gap + rock.pressed), 0.5 * rock.gap
        for part in (voronoi if rock.kind == "cells" else delaunay)(at, lower, upper):
            # A side shorter than the gap would be hidden behind the thickness of its neighbours.
            left = shrunk(part, 0.5 * rock.gap, shortest=rock.gap)
            if left is not None:
                made.append(Placed("rock", "rock", polygon(left, thickness, density, material=material), FREE))
    if rock.plates == "none":
        return made
    axis = 0 if rock.plates == "x" else 1
    out = BEYOND * (upper[1 - axis] - lower[1 - axis])
    moves = PlacedControl(_times(rock.strain.schedule, upper[axis] - lower[axis])) if rock.strain else HELD[axis]
    for name, place in zip(PLATES, (lower[axis] - off, upper[axis] + off), strict=True):
        ends = [(place, lower[1 - axis] - out), (place, upper[1 - axis] + out)]
        points = ends if axis == 0 else [(x, y) for y, x in ends]
        frame = chain(
            points, thickness, density, width=2.0 * max(thickness, off), long=True,
            material=material_number(scene, "", True),
        )  # fmt: skip
        told = list(HELD)
        if name == PLATES[1]:
            told[axis] = moves
        made.append(Placed("rock", "plate", frame, (told[0], told[1], told[2]), name))
    return made


def _times(schedule: Schedule, factor: float) -> Schedule:
    """A schedule with its values multiplied."""
    if isinstance(schedule, Table):
        return Table(schedule.times, [factor * value for value in schedule.values])
    if isinstance(schedule, Sine):
        return Sine(factor * schedule.amplitude, schedule.frequency, schedule.phase, factor * schedule.mean)
    return Constant(factor * (schedule.value if isinstance(schedule, Constant) else schedule))


def _packing(scene: Scene, law: Law) -> tuple[Array, Array]:
    """Centres (n, 2) m and radii (n,) m of the packing pressed in its rectangle."""
    assert isinstance(law, Linear)
    return _pressed(_Asked(scene, law))


class _Asked:
    """A scene and a law, equal where they press the same packing."""

    def __init__(self, scene: Scene, law: Linear) -> None:
        assert scene.grains
        self.scene, self.law = scene, law
        self.key = scene.grains.packing, scene.grains.density, law

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Asked) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


@lru_cache(maxsize=2)
def _pressed(asked: _Asked) -> tuple[Array, Array]:
    assert asked.scene.grains
    assert asked.scene.grains.packing
    discs = compressed(asked.scene, asked.scene.grains.packing, asked.law).grains.discs
    return discs.position.copy(), discs.radius.copy()


class RockWatch:
    """The record of a rock between its plates: strain, stress and broken bonds."""

    def __init__(self, scene: Scene, grains: Grains, recorded: int) -> None:
        """``recorded`` : bodies that are watched before the plates."""
        assert scene.rock
        assert scene.grains
        assert scene.grains.packing
        packing = scene.grains.packing
        sides = packing.width, packing.height
        self.axis = 0 if scene.rock.plates == "x" else 1
        self.length, self.height = sides[self.axis], sides[1 - self.axis]
        self.grains, self.recorded = grains, recorded

    def row(self, broken: float) -> dict[str, float]:
        """Columns of rock.csv but the time; stress is the mean of both plates over the last step, > 0 tension."""
        one, other = self.grains.steering.record()[self.recorded :]
        stress = 0.5 * (one.contact[self.axis] - other.contact[self.axis]) / self.height
        strain = (other.displacement[self.axis] - one.displacement[self.axis]) / self.length
        return {"strain ()": strain, "stress (Pa)": stress, "broken bonds ()": broken}
