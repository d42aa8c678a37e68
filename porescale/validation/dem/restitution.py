"""Impacts of discs on walls and on each other by the linear law: restitution, sliding impacts, and no gain of energy.

Protocols: Chung & Ooi 2011 (Granular Matter 13, 643), here with the linear law.  SI.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.dem.measures.survey import kinetic_energy
from porescale.validation.dem.setups import APART, MASS, RADIUS, STIFFNESS, free, law_at, row_on_floor

VALIDATIONS = Validations()

RATIOS = (0.0, 0.05, 0.2155, 0.5, 0.9)
CHUNG = "Chung & Ooi 2011 protocols, linear law in two dimensions"


def bounce(law: Linear, steps_per_contact: float, phases: int = 20, speed: float = 1.0) -> Floats:
    """Restitution of a disc on a wall, (phases,), touching at evenly spread moments of a contact step.

    The floor is approached from above without gravity; dt is the contact time over ``steps_per_contact``.
    """
    lasts = law.contact_time(MASS)
    dt = lasts / steps_per_contact
    grains = row_on_floor(phases, speed * dt * (np.arange(phases) + 0.5) / phases, law)
    grains.discs.velocity[:, 1] = -speed
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return grains.discs.velocity[:, 1] / speed


def bounce_pair(law: Linear, ratio: float, steps_per_contact: float, speed: float = 1.0) -> float:
    """Restitution of two discs of radius ratio ``ratio``, head on at an angle to the axes."""
    mass = MASS * ratio**2 / (1.0 + ratio**2)
    dt = law.contact_time(mass) / steps_per_contact
    n = np.array([math.cos(0.3), math.sin(0.3)])
    grains = free([(0.0, 0.0), (1.0 + ratio) * RADIUS * n], law, [RADIUS, ratio * RADIUS])
    grains.discs.velocity[0] = speed * n
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return float((grains.discs.velocity[1] - grains.discs.velocity[0]) @ n) / speed


def _restitution(release: str, ratios: tuple[float, ...]) -> Measured:
    laws = [law_at(h, release) for h in ratios]
    bounced = [bounce(law, 1000.0) for law in laws]
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
    return Measured.absolute(law.restitution(mass), bounce_pair(law, 2.0, 1000.0))


def impact(
    law: Linear, down: ArrayLike, along: ArrayLike, spin: ArrayLike, steps_per_contact: float = 1000.0
) -> tuple[Floats, Floats, Floats]:
    """Speed up, along and spin of discs once they have hit a floor with ``down``, ``along`` (n,) m/s, ``spin`` (n,)
    rad/s."""
    fall, slide, turn = np.broadcast_arrays(*(np.asarray(part, float) for part in (down, along, spin)))
    dt = law.contact_time(MASS) / steps_per_contact
    grains = row_on_floor(fall.size, 0.5 * fall * dt, law)
    discs = grains.discs
    # Discs of different speeds run for 1.3 contact times and must not touch.
    run = 1.3 * law.contact_time(MASS) * float(np.abs(slide).max(initial=0.0))
    discs.position[:, 0] = np.arange(fall.size) * (APART + 2.0 * run)
    discs.velocity[:, 0], discs.velocity[:, 1], discs.spin[:] = slide, -fall, turn
    grains.step(dt, count=int(1.3 * steps_per_contact) + 3)
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
    _, along, spin = impact(law, fall, [slide, 0.0], [0.0, slide / RADIUS])
    found = (
        (slide - along[0]) / unit, -spin[0] * RADIUS / (2.0 * unit),
        -along[1] / unit, (slide - spin[1] * RADIUS) / (2.0 * unit),
    )  # fmt: skip
    return Measured.relative((1.0, 1.0, 1.0, 1.0), found)


def grazing_gain(law: Linear, angles: ArrayLike, against: str = "wall", speed: float = 1.0) -> Floats:
    """Kinetic energy after over before, minus one, for impacts at ``angles`` (rad from the normal)."""
    angle = np.asarray(angles, float)
    if against == "wall":
        up, along, spin = impact(law, speed * np.cos(angle), speed * np.sin(angle), 0.0)
        return (up**2 + along**2 + 0.5 * (RADIUS * spin) ** 2) / speed**2 - 1.0
    mass, gain = 0.5 * MASS, []
    dt = law.contact_time(mass) / 1000.0
    for a in angle:
        grains = free([(0.0, 0.0), (2.0 * RADIUS + 0.5 * dt * math.cos(a) * speed, 0.0)], law)
        grains.discs.velocity[0] = speed * math.cos(a), speed * math.sin(a)
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
        float(grazing_gain(law, angles, against).max())
        for law in (law_at(0.0, **rubbing), law_at(0.1, **rubbing, tangential_damping=300.0))
        for against in ("wall", "disc")
    ]
    return Measured(0.0, gains, max(0.0, *gains))
