"""Whether friction is anywhere in a system: where it is not, its contacts have half the work."""

from __future__ import annotations

from porescale.dem.contact.law import KernelLaw, LinearSliding, LinearSmooth
from porescale.dem.state import State


def law_of_steps(grains: State) -> KernelLaw | None:
    """The law as steps of free discs take it: a linear one as LinearSmooth, to the same bits but for the sign of zero,
    where no law and no surface has friction and no energy is booked.  None while springs are left of earlier friction,
    which a step under the law as it is ends.
    """
    law = grains.contact
    own = *grains.wall_frictions, *grains.plate_frictions, *grains.rectangle_frictions
    frictions = *(each.friction for each in grains.laws), *(each or 0.0 for each in own)
    springs = grains.pairs.carried, grains.wall_spring, grains.plate_spring, grains.rectangle_spring
    if not isinstance(law, LinearSliding) or law.book is not None or any(frictions):
        return law
    return None if any(spring.any() for spring in springs) else LinearSmooth(*law)


def turning(grains: State, law: KernelLaw) -> bool:
    """Whether discs may turn in steps under ``law`` with the external torques that are set."""
    return bool(not isinstance(law, LinearSmooth) or grains.discs.spin.any() or grains.external_torque.any())
