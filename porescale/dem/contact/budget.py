"""The energy budget that contacts keep: what dashpots and sliders lose, and the work of moving surfaces.

Where there is no budget its arrays are None, and all of this is left out when kernels are compiled.
"""

from porescale.common.compiled.jit import inline
from porescale.dem.contact.law import KR, KT, stiffness, stiffness_scale

NORMAL_DASHPOT, TANGENTIAL_DASHPOT, FRICTION, ROLLING_DASHPOT, ROLLING_FRICTION = range(5)
SURFACES, EXTERNAL, HOLDERS, DRAG = range(5, 9)
BEFORE_X, BEFORE_Y, BEFORE_SPIN = range(9, 12)
"""Columns of the energy budget: lost in dashpots and friction, work of moving surfaces, of external forces and of
constraints that hold discs, lost to the background drag (J/m); velocity and spin half a step before the last force
(m/s, rad/s)."""
BUDGET = 12


@inline
def has_budget(budget):
    """Whether ``budget`` is an energy budget; else it is None."""
    return budget is not None


@inline
def element_losses(before, after, force, slip, old_stiff, stiff, dt):
    """(lost in the dashpot, lost in the slider), J/m, of one Coulomb element over the step that led here.

    before, after: spring (m);  force (N/m) on the body;  slip (m/s);  stiffness (N/m) before and after.  The spring's
    force at both ends of the step does work on the slip between them, trapezoidal, as leap-frog does; what the spring
    has not kept went into the slider.
    """
    held, holds = old_stiff * before, stiff * after
    worked = 0.5 * (held + holds) * slip * dt
    return (-force - holds) * slip * dt, worked - 0.5 * (holds * after - held * before)


@inline
def contact_losses(seen, spring, roll, found, mass, dt, p, law):
    """What one contact lost in the step, J/m: in the normal dashpot, the tangential one, friction, the rolling dashpot
    and rolling friction, the first columns of the budget.

    Arguments and Response of ``contact``, with the springs before.
    """
    elastic, _, scale, _, _, _ = stiffness(seen.overlap, seen.radius, mass, p, law)
    old = stiffness_scale(max(seen.overlap - seen.closing * dt, 0.0), seen.radius, law)
    slid = element_losses(spring, found.spring, found.tangential, seen.slip, p[KT] * old, p[KT] * scale, dt)
    rolled = element_losses(roll, found.roll, found.rolling, seen.rolling, p[KR] * old, p[KR] * scale, dt)
    return (found.normal - elastic) * seen.closing * dt, slid[0], slid[1], rolled[0], rolled[1]


@inline
def losses_if(budget, seen, spring, roll, found, mass, dt, p, law):
    """As contact_losses; zeros where ``budget`` is None, which leaves it out when compiled."""
    if budget is None:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    return contact_losses(seen, spring, roll, found, mass, dt, p, law)


@inline
def add_losses(budget, i, losses, rolling):
    """Add ``losses`` (J/m) of contact_losses to ``budget`` (n, BUDGET), row i, those of rolling where ``rolling`` is
    not None;  nothing where ``budget`` is None."""
    if budget is None:
        return
    budget[i, NORMAL_DASHPOT] += losses[0]
    budget[i, TANGENTIAL_DASHPOT] += losses[1]
    budget[i, FRICTION] += losses[2]
    if rolling is not None:
        budget[i, ROLLING_DASHPOT] += losses[3]
        budget[i, ROLLING_FRICTION] += losses[4]


@inline
def add_release_losses(i, seen, spring, roll, dt, p, budget, law):
    """Add to ``budget`` (n, BUDGET), row i, what springs (m) lost that were released within the step; nothing where it
    is None.

    seen: Relative motion, with an overlap < 0.  The force of a step ago does half a step's work more, and what the
    springs held is gone.
    """
    if budget is None:
        return
    old = stiffness_scale(max(seen.overlap - seen.closing * dt, 0.0), seen.radius, law)
    budget[i, FRICTION] += element_losses(spring, 0.0, 0.0, seen.slip, p[KT] * old, 0.0, dt)[1]
    budget[i, ROLLING_FRICTION] += element_losses(roll, 0.0, 0.0, seen.rolling, p[KR] * old, 0.0, dt)[1]


@inline
def add_work(budget, i, column, power, dt):
    """Add ``power`` (W/m) over ``dt`` (s) to a column of ``budget`` (n, BUDGET), row i; nothing where it is None."""
    if budget is None:
        return
    budget[i, column] += power * dt
