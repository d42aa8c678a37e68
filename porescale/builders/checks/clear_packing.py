"""What is known once grains are placed: whether one of a packing stands where something was placed by hand, whether
there is something to bond, and how far bonds move it that pull harder than its contacts carry."""

import numpy as np

from porescale.builders.derive import Derived
from porescale.builders.initial.grains import frames_of, grains_of
from porescale.builders.initial.obstacles import obstacles_of
from porescale.builders.initial.placed import placed
from porescale.builders.parts.bonds import BondsPart
from porescale.builders.stepper import Clock
from porescale.builders.system import System
from porescale.scene.scene import Scene


def require_clear_packing(scene: Scene, derived: Derived) -> None:
    """InputError, as of the run, where something placed by hand stands in a grain of the packing.

    The packing is made only where something stands in the rectangle that it fills.  What was settled or compressed is
    kept, and found again by the run.
    """
    packing = scene.grains.packing if scene.grains else None
    if packing is None or scene.rock:
        return
    _, x, r = placed(scene)
    frames = frames_of(scene, derived)
    if obstacles_of(scene, frames):
        grains_of(scene, derived, frames)
        return
    low = [*(x - r[:, None]), *(np.min(it.frame.corners, axis=0) for it in frames)]
    high = [*(x + r[:, None]), *(np.max(it.frame.corners, axis=0) for it in frames)]
    corner, size = np.array((packing.left, packing.bottom)), np.array((packing.width, packing.height))
    beside = packing.diameter  # settled ones are higher here than there
    if any(np.all(one < corner + size + beside) and np.all(other > corner - beside)
           for one, other in zip(low, high, strict=True)):  # fmt: skip
        grains_of(scene, derived, frames)


def require_bonds(scene: Scene, derived: Derived) -> list[str]:
    """Warnings about bonds at time 0 that pull too hard.  InputError, as of the run, where they have nothing that
    touches, or where those of any time name bodies that there are not."""
    if not scene.bonds:
        return []
    made = System(scene, derived, Clock(derived.model_step), frames=frames_of(scene, derived))
    made.grains, made.recorded = grains_of(scene, derived, made.frames)
    return BondsPart(made).doubts()
