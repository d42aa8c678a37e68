"""Controls: components of bodies that move as prescribed, and the bodies that are recorded."""

from collections.abc import Sequence

from porescale.builders.initial.frames import PLATES, Placed, plates_of, prescribe_motion
from porescale.builders.initial.placed import counted
from porescale.builders.initial.rock import has_plates
from porescale.builders.initial.time_functions import control_of
from porescale.dem.grains import Grains
from porescale.dem.motion.drivers import Clump as ClumpNumber
from porescale.scene.bodies.control import BODIES, Controlled
from porescale.scene.scene import Scene


def body_of(scene: Scene, it: Controlled) -> int | ClumpNumber:
    """A controlled body as the grains name it: frames are clumps after the clumps, segments before polygons."""
    kind, number = it.of
    counts = [counted(scene, before) for before in BODIES[1 : BODIES.index(kind)]]
    return number if kind == "grain" else ClumpNumber(number + sum(counts))


def add_controls(scene: Scene, grains: Grains, placed: Sequence[Placed] = ()) -> list[str]:
    """Prescribe the motion of bodies, and record those that request it: their names, in the order of the record."""
    own = prescribe_motion(grains, placed) if placed else []
    for it in scene.control:
        grains.steering.control(body_of(scene, it), *map(control_of, (it.x, it.y, it.rotation)))
    watched = [(it.called, body_of(scene, it)) for it in scene.control if it.record]
    watched += zip((it.name for it in placed if it.record), own, strict=True)
    if has_plates(scene.rock):
        watched += zip(PLATES, plates_of(grains), strict=True)
    if watched:
        grains.steering.watch(*(body for _, body in watched))
    return [name for name, _ in watched]
