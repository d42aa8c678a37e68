"""What is known once grains are placed: whether one of a packing stands where something was placed by hand, whether
there is something to bond, and how far bonds move it that pull harder than its contacts carry."""

import numpy as np

from porescale.builders.derive import Derived
from porescale.builders.initial.contact_laws import law_class
from porescale.builders.initial.grains import frames_of, grains_of
from porescale.builders.initial.obstacles import obstacles_of
from porescale.builders.initial.placed import placed
from porescale.builders.parts.bonds import BondsPart
from porescale.builders.stepper import Clock
from porescale.builders.system import System
from porescale.dem.bodies.bonding import segments_now
from porescale.dem.forces.bonds import pressing, touched
from porescale.dem.sanity import WORST_OVERLAP
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


def require_first_bonds(scene: Scene, derived: Derived) -> list[str]:
    """Warnings about bonds at time 0 that pull too hard.  InputError, as of the run, where they have nothing that
    touches, or bodies that there are not."""
    if any(it.at == 0.0 for it in scene.bonds):
        made = System(scene, derived, Clock(derived.model_step), frames=frames_of(scene, derived))
        made.grains, made.recorded = grains_of(scene, derived, made.frames)
        assert scene.contact
        return doubts_of_bonds(BondsPart(made), made.clock.seconds, linear=law_class(scene.contact).compresses)
    return []


def doubts_of_bonds(part: BondsPart, seconds: float, *, linear: bool) -> list[str]:
    """Warnings about the bonds that a ``part`` made at time 0, with contact steps of so many ``seconds``.

    A bond of tension b on a contact of overlap d that carries f sets its bodies into motion with (b - f)/m, m their
    reduced mass.  Where that is more than d in a step, (b - f) dt²/m > d, steps decide whether they part when they come
    back, with an error of energy of order b²dt²/m, of any size beside that of the motion before.  Under a ``linear``
    law without damping they swing to an overlap of 2 b/k - d, k = f/d.
    """
    grains, bonds = part.grains, part.grains.bonds
    if bonds is None:
        return []
    d, segments, n = grains.discs, segments_now(grains), len(bonds.back)
    way, far, other, carried = np.zeros((n, 2)), np.zeros((n, 2)), np.zeros(n, np.int64), np.zeros(n)
    touched(d.position, bonds.ends, segments, grains.cell, way, far, other)
    pressing(
        d.position, d.radius, grains.body_mass, grains.material, bonds.ends, segments, grains.contact, grains.cell,
        carried,
    )  # fmt: skip
    first = bonds.ends[:, 0]
    overlap = d.radius[first] + d.radius[other] - np.hypot(way[:, 0], way[:, 1])
    apart = (carried > 0.0) & (overlap > 0.0) & (bonds.back > carried)
    if not apart.any():
        return []
    one, two = grains.body_mass[first], grains.body_mass[other]
    pull, carried, overlap, mass = (it[apart] for it in (bonds.back, carried, overlap, one * two / (one + two)))
    found, at_most = [], carried + overlap * mass / seconds**2
    if (pull > at_most).any():
        k = int(np.argmax(pull / at_most))
        found.append(
            f"a bond of {pull[k]:.3g} N/m is {pull[k] / carried[k]:.2g} times what its contact carries, and moves its "
            f"bodies in a step by more than its overlap of {overlap[k]:.2g} m: whether it breaks, and with what "
            f"energy, is left to the steps, which resolve {at_most[k]:.2g} N/m at most: press bodies together before "
            "they are bonded (bonds.at), or lower bonds.factor or tension"
        )
    limit = WORST_OVERLAP * np.minimum(d.radius[first], d.radius[other])[apart]
    deepest = (2.0 * pull / carried - 1.0) * overlap
    if linear and (deepest > limit).any():
        k = int(np.argmax(deepest / limit))
        found.append(
            f"a bond of {pull[k]:.3g} N/m draws its bodies into each other by up to {deepest[k]:.2g} m, and beyond "
            f"{limit[k]:.2g} m, {WORST_OVERLAP:g} of the radius, a run stops: contacts "
            f"{1.1 * deepest[k] / limit[k]:.2g} times as stiff suffice, or lower bonds.factor or tension"
        )
    return found
