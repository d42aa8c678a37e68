"""A rock: the packing pressed, its discs or polygons with its centres as seeds, and the plates.

Source: Matsushima, DEMseg tutorial II-4; see dem/prepare/rock.py, dem/prepare/tessellate.py.
"""

from functools import lru_cache

from porescale.builders.initial.contact_laws import MaterialPlan
from porescale.builders.initial.frames import FREE, HELD, PLATES, Placed
from porescale.builders.initial.packing import compressed
from porescale.builders.initial.time_functions import schedule_of
from porescale.common.core.types import Floats
from porescale.dem.bodies.frames import polygon
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import Discs, make_discs
from porescale.dem.motion.control import Placed as PlacedControl
from porescale.dem.motion.time_function import Schedule, Sine, Table
from porescale.dem.prepare.rock import blocks, lines, plates_beside
from porescale.scene.bodies.rock import Rock
from porescale.scene.packing import Packing
from porescale.scene.scene import Scene


def has_plates(rock: Rock | None) -> bool:
    """Whether there is a rock, and it is between plates."""
    return rock is not None and rock.plates != "none"


def rock_discs(scene: Scene, law: ContactLaw) -> Discs | None:
    """The discs of a rock of discs, at rest; None of polygons."""
    assert scene.rock
    assert scene.grains
    assert scene.grains.packing
    if scene.rock.polygons:
        return None
    plan, packing = MaterialPlan.of(scene), scene.grains.packing
    at, radius = _pressed(packing, plan.density_of_grains, law)
    return make_discs(at, radius, plan.density(packing.material))


def rock_frames(scene: Scene, law: ContactLaw) -> list[Placed]:
    """Polygons of a rock and its plates, the first plate before the second.  The packing is read from the cache, or
    pressed, which takes seconds."""
    assert scene.rock
    assert scene.grains
    assert scene.grains.packing
    rock, packing, plan = scene.rock, scene.grains.packing, MaterialPlan.of(scene)
    at, radius = _pressed(packing, plan.density_of_grains, law)
    lower = (packing.left, packing.bottom)
    upper = (packing.left + packing.width, packing.bottom + packing.height)
    density, material = plan.density(packing.material), plan.number(packing.material)
    made: list[Placed] = []
    thickness, off = lines(float(radius.mean()), rock.gap, rock.pressed)
    if rock.polygons:
        assert rock.gap
        made = [
            Placed("rock", "rock", polygon(part, thickness, density, material=material), FREE)
            for part in blocks(rock.kind, at, lower, upper, rock.gap)
        ]
    if rock.plates == "none":
        return made
    axis = 0 if rock.plates == "x" else 1
    moves = PlacedControl(_times(schedule_of(rock.strain), upper[axis] - lower[axis])) if rock.strain else HELD[axis]
    wall = plan.number("", wall=True)
    plates = plates_beside(lower, upper, thickness, off, density, axis=axis, material=wall)
    for name, frame in zip(PLATES, plates, strict=True):
        motion = list(HELD)
        if name == PLATES[1]:
            motion[axis] = moves
        made.append(Placed("rock", "plate", frame, (motion[0], motion[1], motion[2]), name))
    return made


def _times(schedule: Schedule, factor: float) -> Schedule:
    """A schedule with its values multiplied."""
    if isinstance(schedule, Table):
        return Table(schedule.times, [factor * value for value in schedule.values])
    if isinstance(schedule, Sine):
        return Sine(factor * schedule.amplitude, schedule.frequency, schedule.phase, factor * schedule.mean)
    return factor * schedule


@lru_cache(maxsize=2)
def _pressed(packing: Packing, density: float, law: ContactLaw) -> tuple[Floats, Floats]:
    """Centres (n, 2) m and radii (n,) m of the packing pressed in its rectangle."""
    discs = compressed(packing, density, (False, False), law).grains.discs
    return discs.position.copy(), discs.radius.copy()
