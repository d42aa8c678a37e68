"""Systems without friction: their contacts need half the work."""

from porescale.dem.contact.law import KernelLaw
from porescale.dem.contact.linear import LinearKernel
from porescale.dem.contact.own import OwnKernel
from porescale.dem.state import State


def law_of_steps(grains: State) -> KernelLaw | None:
    """The law as steps of free discs take it: a linear or own one with no friction part, to the same bits but for the
    sign of zero, where no law and no surface has friction or rolling resistance and there is no energy budget.  None
    while springs are left of earlier friction, which a step under the law as it is ends.
    """
    law = grains.contact
    own = *grains.wall_frictions, *grains.plate_frictions, *grains.rectangle_frictions
    frictions = *(each.friction for each in grains.laws), *(each or 0.0 for each in own)
    springs = grains.pairs.carried, grains.wall_spring, grains.plate_spring, grains.rectangle_spring
    if (
        not isinstance(law, LinearKernel | OwnKernel)
        or law.rolling is not None
        or grains.budget is not None
        or any(frictions)
    ):
        return law
    return None if any(spring.any() for spring in springs) else law._replace(friction=None)


def may_turn(grains: State, law: KernelLaw) -> bool:
    """Whether discs may turn in steps under ``law`` with the external torques that are set."""
    return bool(law.friction is not None or grains.discs.spin.any() or grains.external_torque.any())
