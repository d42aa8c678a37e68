"""Impacts of discs on walls and on each other by the linear law: restitution, sliding impacts, and no gain of energy.

Protocols: Chung & Ooi 2011 (Granular Matter 13, 643), here with the linear law.  SI.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.measures.survey import kinetic_energy
from porescale.validation.dem.setups import APART, MASS, RADIUS, STIFFNESS, free, law_at, on_floor

VALIDATIONS = Validations()

RATIOS = (0.0, 0.05, 0.2155, 0.5, 0.9)
CHUNG = "Chung & Ooi 2011 protocols, linear law in two dimensions"


def bounce(law: ContactLaw, lasts: float, steps_per_contact: float, speed: float = 1.0, phases: int = 20) -> Floats:
    """Restitution of a disc on a wall, (phases,), touching at evenly spread moments of a contact step.

    The floor is approached from above without gravity; a contact ``lasts`` (s) so many steps.
    """
    dt = lasts / steps_per_contact
    grains = on_floor(law, speed * dt * (np.arange(phases) + 0.5) / phases)
    grains.discs.velocity[:, 1] = -speed
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return grains.discs.velocity[:, 1] / speed


def bounce_pair(law: ContactLaw, lasts: float) -> float:
    """Restitution of two discs of radius ratio 2, head on at 1 m/s at an angle to the axes; a contact ``lasts`` (s)
    1000 steps."""
    n = np.array([math.cos(0.3), math.sin(0.3)])
    grains = free([(0.0, 0.0), 3.0 * RADIUS * n], law, [RADIUS, 2.0 * RADIUS])
    grains.discs.velocity[0] = n
    grains.step(lasts / 1000.0, count=1203)
    return float((grains.discs.velocity[1] - grains.discs.velocity[0]) @ n)


def _restitution(release: str, ratios: tuple[float, ...]) -> Measured:
    laws = [law_at(h, release) for h in ratios]
    bounced = [bounce(law, law.contact_time(MASS), 1000.0) for law in laws]
    exact = [law.restitution(MASS) for law in laws]
    worst = max(float(np.abs(e - x).max()) for e, x in zip(bounced, exact, strict=True))
    return Measured(exact, [float(e.mean()) for e in bounced], worst)


@VALIDATIONS.row(
    "dem.restitution_release_at_zero_force",
    source="Schwager & Poeschel 2007, Granular Matter 9, 465",
    because="the dashpot starts up to a step late: 2 h w0 dt e < 1e-3 at T_c/1000 for any of 20 touch phases",
    tolerance=1e-3,
)
def restitution_force() -> Measured:
    """Parting over approach speed of a disc on a wall, h = 0 to 2, contact left when the force vanishes."""
    return _restitution("force", (*RATIOS, 1.0, 2.0))


@VALIDATIONS.row(
    "dem.restitution_release_at_zero_overlap",
    source="damped oscillator, exp(-pi h/sqrt(1-h^2)); Matsushima's DEMseg tutorial section 5",
    because="the dashpot starts and ends up to a step late: 2 h w0 dt e each, < 1e-3 at T_c/1000",
    tolerance=1e-3,
)
def restitution_overlap() -> Measured:
    """Parting over approach speed, with the contact kept until the overlap is zero."""
    return _restitution("overlap", RATIOS)


@VALIDATIONS.row(
    "dem.restitution_of_pairs",
    source="Schwager & Poeschel 2007, effective mass m1 m2/(m1 + m2)",
    because="as for the wall: 1e-3 at T_c/1000",
    tolerance=1e-3,
)
def restitution_pair() -> Measured:
    """Two discs of radius ratio 2, head on, at an angle to the axes."""
    mass = MASS * 4.0 / 5.0
    law = law_at(0.2155, mass=mass)
    return Measured.absolute(law.restitution(mass), bounce_pair(law, law.contact_time(mass)))


def impact(
    law: ContactLaw, lasts: float, down: ArrayLike, along: ArrayLike, spin: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Speed up, along and spin of discs once they have hit a floor with ``down``, ``along`` (n,) m/s, ``spin`` (n,)
    rad/s; a contact ``lasts`` (s) 1000 steps."""
    fall, slide, turn = np.broadcast_arrays(*(np.asarray(part, float) for part in (down, along, spin)))
    dt = lasts / 1000.0
    grains = on_floor(law, 0.5 * fall * dt)
    discs = grains.discs
    # Discs of different speeds run for 1.3 contact times and must not touch.
    run = 1.3 * lasts * float(np.abs(slide).max(initial=0.0))
    discs.position[:, 0] = np.arange(fall.size) * (APART + 2.0 * run)
    discs.velocity[:, 0], discs.velocity[:, 1], discs.spin[:] = slide, -fall, turn
    grains.step(dt, count=1303)
    return discs.velocity[:, 1].copy(), discs.velocity[:, 0].copy(), discs.spin.copy()


@VALIDATIONS.row(
    "dem.oblique_impact_in_gross_sliding",
    source=CHUNG + "; v_t' = v_t - mu(1+e)v_n, w' = 2mu(1+e)v_n/r; spinning: v_t' = mu(1+e)v_n",
    because="restitution within 1e-3/(1+e), lever arm short by up to v_n/(w0 r) = 2.8e-4: 1e-3 of the impulse",
    tolerance=1e-3,
)
def oblique() -> Measured:
    """Change of slip velocity and spin in units of mu(1+e)v_n and 2mu(1+e)v_n/r; v_n 1 cm/s, v_t or w r 5 cm/s."""
    damped = law_at(0.1)
    law = law_at(0.1, tangential_stiffness=0.25 * STIFFNESS, friction=0.3, tangential_damping=damped.damping)
    fall, slide = 0.01, 0.05
    unit = 0.3 * (1.0 + law.restitution(MASS)) * fall
    _, along, spin = impact(law, law.contact_time(MASS), fall, [slide, 0.0], [0.0, slide / RADIUS])
    found = (
        (slide - along[0]) / unit, -spin[0] * RADIUS / (2.0 * unit),
        -along[1] / unit, (slide - spin[1] * RADIUS) / (2.0 * unit),
    )  # fmt: skip
    return Measured.relative((1.0, 1.0, 1.0, 1.0), found)


def gain_at_a_wall(law: ContactLaw, lasts: float, angles: ArrayLike) -> Floats:
    """Kinetic energy after over before, minus one, for impacts on a floor at 1 m/s and ``angles`` (rad from the
    normal); a contact ``lasts`` (s) 1000 steps."""
    up, along, spin = impact(law, lasts, np.cos(angles), np.sin(angles), 0.0)
    return up**2 + along**2 + 0.5 * (RADIUS * spin) ** 2 - 1.0


def gain_of_a_pair(law: Linear, angles: Floats) -> Floats:
    """The same of two discs, one at rest."""
    mass, gain = 0.5 * MASS, []
    dt = law.contact_time(mass) / 1000.0
    for a in angles:
        grains = free([(0.0, 0.0), (2.0 * RADIUS + 0.5 * dt * math.cos(a), 0.0)], law)
        grains.discs.velocity[0] = math.cos(a), math.sin(a)
        before = kinetic_energy(grains.discs)
        grains.step(dt, count=1300)
        gain.append(kinetic_energy(grains.discs) / before - 1.0)
    return np.array(gain)


@VALIDATIONS.row(
    "dem.no_impact_gains_energy",
    source="second law, at grazing angles",
    because="leap-frog errs at touch by (w0 dt)^3 = 3e-8 of the energy at T_c/1000, nothing else may be gained",
    tolerance=1e-7,
)
def grazing() -> Measured:
    """Largest gain of kinetic energy over angles 0 to 89.9 degrees against walls and discs, with and without loss."""
    angles = np.radians(np.concatenate((np.arange(0.0, 90.0, 2.0), (89.5, 89.9))))
    rubbing: dict[str, Any] = {"tangential_stiffness": 0.25 * STIFFNESS, "friction": 0.3}
    gains = [
        float(gain.max())
        for law in (law_at(0.0, **rubbing), law_at(0.1, **rubbing, tangential_damping=300.0))
        for gain in (gain_at_a_wall(law, law.contact_time(MASS), angles), gain_of_a_pair(law, angles))
    ]
    return Measured(0.0, gains, max(0.0, *gains))
