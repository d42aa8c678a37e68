"""What stands in a packing's rectangle, or where it falls: the packing is made around it, and around all else."""

from collections.abc import Sequence

from porescale.builders.initial.frames import Placed
from porescale.builders.initial.placed import placed
from porescale.builders.initial.rectangles import stand_ins
from porescale.common.core.errors import Fault, InputError
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.prepare.obstacles import NOTHING, Obstacles
from porescale.dem.prepare.settle import Pile
from porescale.scene.packing import Packing
from porescale.scene.scene import Scene


def obstacles_of(scene: Scene, frames: Sequence[Placed]) -> Obstacles:
    """All discs, frames and rectangles of a scene where they are at the start, if one of them is in the packing's way;
    else nothing.  Of rectangles, those that ``rectangles_around`` names.

    Raises InputError where segments are in the way of a packing that is compressed.
    """
    packing = scene.grains.packing if scene.grains else None
    if packing is None or scene.rock:
        return NOTHING
    _, x, r = placed(scene)
    rectangles = [scene.rectangle[k] for k in _around(scene, packing)]
    d = scene.domain
    found = Obstacles(
        tuple((a, b, c) for (a, b), c in zip(x.tolist(), r.tolist(), strict=True)),
        tuple(Rectangle(it.lower, it.upper, friction=it.friction) for it in rectangles),
        tuple(it.frame for it in frames), tuple(it.frame.closed and it.kind != "container" for it in frames),
        (d.width if d.periodic[0] else 0.0, d.height if d.periodic[1] else 0.0),
    )  # fmt: skip
    if not found or not found.stand_in(*_way(packing)):
        return NOTHING
    if packing.compress and frames:
        problem = "is in the way of a packing that is compressed, which goes around discs alone"
        raise InputError(Fault(frames[0].key, None, problem, repair="let the packing settle, or move one of them"))
    return found


def rectangles_around(scene: Scene, around: Obstacles) -> list[int]:
    """Numbers of the rectangles among ``around``, in their order."""
    packing = scene.grains.packing if scene.grains else None
    return _around(scene, packing) if packing and around else []


def _around(scene: Scene, packing: Packing) -> list[int]:
    """Numbers of the rectangles for which no plate stands in while the packing settles."""
    return [k for k, it in enumerate(scene.rectangle) if not stand_ins([it], packing)]


def _way(packing: Packing) -> tuple[tuple[float, float], tuple[float, float]]:
    """Corners (m) of the rectangle in which grains are placed, and down to the floor where they fall: of one that is
    loosely filled, the part in which they start."""
    right, top = packing.left + packing.width, packing.bottom + packing.height
    if not packing.settle:
        return (packing.left, packing.bottom), (right, top)
    start = packing.bottom + packing.packing_fraction * packing.height / Pile.fraction + packing.diameter
    return (packing.left, 0.0), (right, min(top, start))
