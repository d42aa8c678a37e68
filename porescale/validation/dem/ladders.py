"""Convergence of the discs with the step: impacts, their energy, a pendulum.  Levels are steps."""

from dataclasses import replace
from functools import partial

from porescale.common.evidence.convergence import Ladders
from porescale.validation.dem.bodies import pendulum_exact, pendulum_period
from porescale.validation.dem.energy import impact_residual
from porescale.validation.dem.hertz import HERTZ
from porescale.validation.dem.restitution import bounce
from porescale.validation.dem.segments import bouncing
from porescale.validation.dem.setups import MASS, RADIUS, TANGENTIAL, law_at

LADDERS = Ladders()
STEPS = (50, 100, 200, 400)
SWING = 1.0  # rad
RATIO = 0.2155
"""Damping ratio: half of the speed is left."""


@LADDERS.ladder(
    "dem.restitution",
    title="|restitution of a disc on a wall, less the exact one|, mean over 20 moments of touch; damping ratio 0.2155",
    along="steps in a contact",
    levels=(*STEPS, 800),
    expected=1.0,
    within=0.022,
    because="damping takes the velocity of half a step before: first order; the next term, of a coefficient taken as"
    " one, is pi/50 of the error at T_c/50: 0.021 of the order",
)
def linear_impact(steps: float) -> float:
    """Linear spring and dashpot, let go where the force is zero."""
    law = law_at(RATIO)
    return abs(float(bounce(law, law.contact_time(MASS), steps).mean()) - law.restitution(MASS))


@LADDERS.ladder(
    "dem.restitution_by_hertz",
    title="As above, Hertz's law",
    along="steps in a contact",
    levels=(*STEPS, 800),
    expected=1.0,
    within=0.022,
    because="as for the linear law",
)
def hertz_impact(steps: float) -> float:
    """Damping ratio 0.2155, 1 m/s."""
    law = replace(HERTZ, damping_ratio=RATIO)
    return abs(float(bounce(law, law.contact_time(MASS, RADIUS, 1.0), steps).mean()) - law.restitution())


@LADDERS.ladder(
    "dem.energy_of_an_impact",
    title="Energy not accounted for over energy turned over, oblique impacts with spin, mean over 20 moments of touch",
    along="steps in a contact",
    levels=STEPS,
    expected=1.0,
    within=0.044,
    because="leap-frog is of first order where contacts begin and end; the mean varies by 5 % at T_c/50: 0.043 of the"
    " order if the first and the last err by it, one up, one down",
)
def energy_of_impact(steps: float) -> float:
    """Without damping, with friction."""
    return impact_residual(law_at(0.0, **TANGENTIAL), steps)


@LADDERS.ladder(
    "dem.period_of_a_pendulum",
    title="Relative error of the period of a clump of two discs that swings by 1 rad",
    along="steps in 1.5 small swings",
    levels=(125, 250, 500, 1000),
    expected=2.0,
    within=0.033,
    because="leap-frog is of second order in smooth motion; the crossing is read between steps, of third order, of a"
    " coefficient taken as one 2 pi 1.5/125 of the error at 125 steps: 0.033 of the order",
)
def pendulum(steps: float) -> float:
    """Over 4 K(sin(s/2)) sqrt(I/(m g r))."""
    return abs(pendulum_period(SWING, int(steps)) / pendulum_exact(SWING) - 1)


def bounced(what: str, steps: float) -> float:
    """Largest energy residual of a body that bounces for half a second, over its most kinetic energy."""
    return float(bouncing(what, steps).max())


for body in ("disc", "segment"):
    LADDERS.ladder(
        f"dem.energy_of_a_bouncing_{body}",
        title=f"Largest energy residual of a {body} that bounces on an uneven floor, over its most kinetic energy",
        along="steps in a contact",
        levels=STEPS,
        expected=1.0,
        within=0.2,
        because="second order in smooth motion, first where contacts begin and end: one at least; the moments of touch"
        " fall anew at every step; 0.2 is chosen for them, not derived: a factor of 1.5 between 50 and 400 steps",
    )(partial(bounced, body))
