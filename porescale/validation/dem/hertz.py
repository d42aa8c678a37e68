"""Impacts by the Hertz law: restitution at any speed, overlap, duration, critical step, no gain of energy.  SI."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.hertz import Hertz
from porescale.validation.dem.restitution import bounce, bounce_pair, gain_at_a_wall
from porescale.validation.dem.setups import MASS, RADIUS, grows, on_floor, stability_limit

VALIDATIONS = Validations()

MODULUS = 1e9  # Pa
HERTZ = Hertz(MODULUS, 0.8 * MODULUS)
RATIOS = (0.0, 0.05, 0.2155, 0.5)
SPEEDS = (0.1, 1.0)
ANTYPOV = "Antypov & Elliott 2011, EPL 94, 50004"


def hertz_restitution(release: str) -> Measured:
    """Largest distance from the exact restitution over damping ratios, speeds and touch phases, and of a pair."""
    exact, found, worst = [], [], 0.0
    for ratio in RATIOS:
        law = Hertz(MODULUS, damping_ratio=ratio, release=release)
        bounced = np.concatenate(
            [bounce(law, law.contact_time(MASS, RADIUS, speed), 1000.0, speed) for speed in SPEEDS]
        )
        pair = bounce_pair(law, law.contact_time(MASS * 4.0 / 5.0, RADIUS * 2.0 / 3.0, 1.0))
        exact.append(law.restitution())
        found.append(float(bounced.mean()))
        worst = max(worst, float(np.abs(bounced - exact[-1]).max()), abs(pair - exact[-1]))
    return Measured(exact, found, worst)


@VALIDATIONS.row(
    "dem.hertz_restitution_release_at_zero_force",
    source=ANTYPOV + "; release: Schwager & Poeschel 2007, Granular Matter 9, 465",
    because="as for the linear law: the dashpot lags by a step of T_c/1000 at most, 2 h w0 dt e < 1e-3",
    tolerance=1e-3,
)
def hertz_force() -> Measured:
    """Restitution is that of the linear oscillator at the same damping ratio, at any speed."""
    return hertz_restitution("force")


@VALIDATIONS.row(
    "dem.hertz_restitution_release_at_zero_overlap",
    source=ANTYPOV + ", exp(-pi h/sqrt(1-h^2))",
    because="as for the linear law: the dashpot lags by a step at touch and parting, 2 h w0 dt e each, < 1e-3",
    tolerance=1e-3,
)
def hertz_overlap() -> Measured:
    """Parting over approach speed, with the contact kept until the overlap is zero."""
    return hertz_restitution("overlap")


def hertz_impact() -> tuple[float, float]:
    """(deepest overlap, m; duration, s) of an undamped impact on a floor at 1 m/s, read to a step."""
    dt = HERTZ.contact_time(MASS, RADIUS, 1.0) / 1000.0
    grains = on_floor(HERTZ, 0.5 * dt)
    grains.discs.velocity[:, 1] = -1.0
    deepest, lasted = 0.0, 0
    for _ in range(1500):
        grains.step(dt)
        overlap = RADIUS - float(grains.discs.position[0, 1])
        deepest = max(deepest, overlap)
        lasted += overlap > 0.0
    return deepest, lasted * dt


@VALIDATIONS.row(
    "dem.hertz_impact",
    source="Hertz 1882: deepest overlap (5 m v^2/4K)^(2/5), duration 2.943 times that over v",
    because="read to a step: 1e-3 of the duration; the overlap is flat where it is deepest",
    tolerance=2e-3,
)
def impact_row() -> Measured:
    """Deepest overlap (m) and duration (s) of an undamped impact at 1 m/s."""
    deepest = HERTZ.overlap_at(MASS, RADIUS, 1.0)
    return Measured.relative((deepest, 2.94327518432201 * deepest), hertz_impact())


def hertz_critical_step(share: float) -> float:
    """Measured stability limit (s) of a disc pressed on a floor to ``share`` of its radius, undamped, by bisection."""
    load = np.array([[0.0, -HERTZ.constant(RADIUS) * (share * RADIUS) ** 1.5]])
    unit = math.sqrt(MASS / (1.5 * HERTZ.constant(RADIUS) * math.sqrt(share * RADIUS)))
    pressed = partial(on_floor, HERTZ, -share * RADIUS)
    return stability_limit(0.5 * unit, 3.0 * unit, 2e-3, lambda step: grows(pressed(), load, step, 2000))


@VALIDATIONS.row(
    "dem.critical_step_of_a_hertz_contact",
    source="dt = 2 sqrt(m/k), k = dF/dd = 3/2 K sqrt(d)",
    because="1 %: growth within 2000 steps shows 1e-3 beyond the limit, bisection stops at 2e-3",
    tolerance=0.01,
)
def hertz_critical() -> Measured:
    """Longest stable step (s) of a disc pressed to 1e-4 and 1e-2 of its radius."""
    shares = (1e-4, 1e-2)
    exact = [2.0 * math.sqrt(MASS / (1.5 * HERTZ.constant(RADIUS) * math.sqrt(s * RADIUS))) for s in shares]
    return Measured.relative(exact, [hertz_critical_step(share) for share in shares])


def hertz_gain(law: Hertz, angles: Floats) -> float:
    """Largest `gain_at_a_wall`; steps follow the contact's duration, which depends on the speed along the normal."""
    return max(
        float(gain_at_a_wall(law, law.contact_time(MASS, RADIUS, math.cos(angle)), angle)[0]) for angle in angles
    )


@VALIDATIONS.row(
    "dem.no_hertz_impact_gains_energy",
    source="second law, at grazing angles; Thornton, Cummins & Cleary 2011 on unloading springs",
    because="leap-frog errs at touch by (w0 dt)^3 = 3e-8 of the energy at T_c/1000, nothing else may be gained",
    tolerance=1e-7,
)
def hertz_grazing() -> Measured:
    """Largest gain of kinetic energy over angles 0 to 89.9 degrees, with and without dashpots."""
    angles = np.radians(np.concatenate((np.arange(0.0, 90.0, 6.0), (89.5, 89.9))))
    rubbing = replace(HERTZ, friction=0.3)
    damped = replace(rubbing, damping_ratio=0.1, tangential_damping_ratio=0.1)
    gains = [hertz_gain(law, angles) for law in (rubbing, damped)]
    return Measured(0.0, gains, max(0.0, *gains))
