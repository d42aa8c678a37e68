"""Numbers of bodies that must exist."""

from porescale.builders.initial.placed import counted, members
from porescale.common.core.errors import Fault
from porescale.scene.scene import Scene


def check_controls(scene: Scene, count: int, faults: list[Fault]) -> None:
    """Add faults of controls; ``count``: grains that are free, the discs of clumps last."""
    bodies = members(scene.clump)
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
