"""Validations of contact laws and of several contacts together: exact answers, and the tolerance each allows."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.linear import Linear
from porescale.validation.dem import contact_trials as lab
from porescale.validation.dem.discs_trials import MASS, RADIUS, STIFFNESS, law_at, momentum_drift, relative
from porescale.validation.dem.discs_trials import cloud as thrown

VALIDATIONS = Validations()

RATIOS = (0.0, 0.05, 0.2155, 0.5)
SPEEDS = (0.1, 1.0)
TANGENTIAL: dict[str, Any] = {"tangential_stiffness": 0.25 * STIFFNESS, "friction": 0.3}
ANTYPOV = "Antypov & Elliott 2011, EPL 94, 50004"


def hertz_restitution(release: str) -> Measured:
    """Largest distance from the exact restitution over damping ratios, speeds and touch phases, and of a pair."""
    exact, found, worst = [], [], 0.0
    for ratio in RATIOS:
        law = Hertz(lab.MODULUS, damping_ratio=ratio, release=release)
        bounced = np.concatenate([lab.hertz_bounce(law, speed, 1000.0) for speed in SPEEDS])
        pair = lab.hertz_bounce_of_pair(law, 2.0, 1.0, 1000.0)
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
    """The same, contact kept until the overlap is zero."""
    return hertz_restitution("overlap")


@VALIDATIONS.row(
    "dem.hertz_impact",
    source="Hertz 1882: deepest overlap (5 m v^2/4K)^(2/5), duration 2.943 times that over v",
    because="read to a step: 1e-3 of the duration; the overlap is flat where it is deepest",
    tolerance=2e-3,
)
def hertz_impact() -> Measured:
    """Deepest overlap (m) and duration (s) of an undamped impact at 1 m/s."""
    deepest = lab.HERTZ.overlap_at(MASS, RADIUS, 1.0)
    exact = (deepest, 2.94327518432201 * deepest)
    found = lab.hertz_impact(lab.HERTZ, 1.0)
    return Measured(exact, found, relative(found, exact))


@VALIDATIONS.row(
    "dem.critical_step_of_a_hertz_contact",
    source="dt = 2 sqrt(m/k), k = dF/dd = 3/2 K sqrt(d)",
    because="1 %: growth within 2000 steps shows 1e-3 beyond the limit, bisection stops at 2e-3",
    tolerance=0.01,
)
def hertz_critical() -> Measured:
    """Longest stable step (s) of a disc pressed to 1e-4 and 1e-2 of its radius."""
    shares = (1e-4, 1e-2)
    exact = [2.0 * math.sqrt(MASS / (1.5 * lab.HERTZ.constant(RADIUS) * math.sqrt(s * RADIUS))) for s in shares]
    found = [lab.hertz_critical_step(share) for share in shares]
    return Measured(exact, found, relative(found, exact))


@VALIDATIONS.row(
    "dem.no_hertz_impact_gains_energy",
    source="second law, at grazing angles; Thornton, Cummins & Cleary 2011 on unloading springs",
    because="leap-frog errs at touch by (w0 dt)^3 = 3e-8 of the energy at T_c/1000, nothing else may be gained",
    tolerance=1e-7,
)
def hertz_grazing() -> Measured:
    """Largest gain of kinetic energy over angles 0 to 89.9 degrees, with and without dashpots."""
    angles = np.radians(np.concatenate((np.arange(0.0, 90.0, 6.0), (89.5, 89.9))))
    rubbing = replace(lab.HERTZ, friction=0.3)
    damped = replace(rubbing, damping_ratio=0.1, tangential_damping_ratio=0.1)
    gains = [float(lab.grazing_gain(law, angles).max()) for law in (rubbing, damped)]
    return Measured(0.0, gains, max(0.0, *gains))


@VALIDATIONS.row(
    "dem.rolling_resistance_on_an_incline",
    source="at rest for tan < mu_r; else a = (g sin - mu_r g cos r/a)/(1 + r^2/2a^2), a = r less the static overlap",
    because="rest: the rolling spring creeps until dashpots have taken its motion, exp(-h w0 t) after 0.05 s; rolling:"
    " the limit is exact, round-off of 4e5 steps",
    tolerance=1e-5,
)
def rolling_incline() -> Measured:
    """Acceleration over g at tan = 0.09 and 0.31 with mu_r = 0.1."""
    exact = [lab.resisted_acceleration(slope, 0.1) / GRAVITY for slope in (0.09, 0.3)]
    found = [lab.resisted_incline(slope, 0.1) / GRAVITY for slope in (0.09, 0.3)]
    return Measured(exact, found, float(np.abs(np.subtract(found, exact)).max()))


@VALIDATIONS.row(
    "dem.angular_momentum_with_rolling_resistance",
    source="Newton's third law: equal and opposite torques on both bodies",
    because="60 discs, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=1e-13,
)
def rolling_momenta() -> Measured:
    """A cloud of spinning discs that resist rolling, linear and Hertz: relative drift of both momenta."""
    drifts: list[float] = []
    for law in (
        replace(law_at(0.1, **TANGENTIAL), rolling_friction=0.2, rolling_stiffness=STIFFNESS, rolling_damping=50.0),
        replace(lab.HERTZ, damping_ratio=0.1, friction=0.3, rolling_friction=0.2, deepest=0.1),
    ):
        grains = thrown()
        grains.set_law(law)
        drifts += momentum_drift(grains, 5000)
    return Measured((0.0,) * 4, drifts, max(drifts))


@VALIDATIONS.row(
    "dem.dispersion_of_a_chain",
    source="w = 2 sqrt(k/m) sin(q a/2), Brillouin, Wave Propagation in Periodic Structures; tutorial I-4",
    because="leap-frog raises a frequency by (w dt)^2/24 = 7e-5 at w dt = 0.04; half as much again to read it",
    tolerance=1e-4,
)
def dispersion() -> Measured:
    """Frequencies (sqrt(k/m)) of standing waves on a ring of 32 discs, 1 to 16 waves."""
    modes = (1, 4, 8, 12, 16)
    exact = [2.0 * math.sin(math.pi * mode / 32) for mode in modes]
    found = [lab.chain_frequency(mode) for mode in modes]
    return Measured(exact, found, relative(found, exact))


@VALIDATIONS.row(
    "dem.kick_travels_along_a_chain",
    source="v_n(t) = v0 J_2|n|(2 sqrt(k/m) t), Schroedinger 1914; tutorial I-4",
    because="phase of leap-frog at t = 20: 2t (w dt)^2/24 = 40 (0.02)^2/24 = 7e-4 of a profile of height 0.3",
    tolerance=3e-4,
)
def kick() -> Measured:
    """Velocities of the ten discs behind the front and those ahead, 20 sqrt(m/k) after the kick."""
    from scipy.special import jv

    at, found = lab.kicked_chain(20.0)
    n = np.arange(len(found))
    exact = jv(2 * np.minimum(n, len(n) - n), 2.0 * at)
    return Measured(exact[:24].tolist(), found[:24].tolist(), float(np.abs(found - exact).max()))


@VALIDATIONS.row(
    "dem.unlike_materials_in_contact",
    source="springs in series, 2 k1 k2/(k1 + k2); the same between discs and with a wall",
    because="rest is reached to exp(-20) = 2e-9; overlaps of 3e-6 m are read off positions known to 3e-17 m",
    tolerance=1e-8,
)
def materials() -> Measured:
    """Overlap over load (m/N per metre): a disc ten times softer than the floor and the disc on it."""
    mixed = 2.0 * 0.1 / 1.1 * STIFFNESS
    exact = (2.0 / mixed, 1.0 / mixed)
    found = tuple(float(value) for value in lab.unlike_stack())
    return Measured(exact, found, relative(found, exact))


@VALIDATIONS.row(
    "dem.energy_book_closes_with_the_step",
    source="first law; order of the residual by halving the step",
    because="first order or better: 0.05 below one, as the mean over touch phases still varies by 5 % at T_c/50",
    tolerance=0.05,
)
def energy_order() -> Measured:
    """Order at which the unaccounted energy of oblique, spinning impacts falls from T_c/50 to T_c/200, three laws."""
    damped = law_at(0.2, **TANGENTIAL, tangential_damping=300.0)
    orders = []
    for law in (law_at(0.0, **TANGENTIAL), damped, replace(damped, release="overlap")):
        coarse, fine = lab.impact_residual(law, 50.0), lab.impact_residual(law, 200.0)
        orders.append(math.log(coarse / fine, 4.0))
    return Measured((1.0,) * 3, orders, max(0.0, 1.0 - min(orders)))


@VALIDATIONS.row(
    "dem.energy_book_of_the_repose_run",
    source="first law; DEMseg tutorial I-7: 582 discs, 112 000 steps, friction, a gate that opens",
    because="asked for: 1e-3 of the energy turned over, at the tutorial's own step (18 steps in a contact)",
    tolerance=1e-3,
    slow=True,
)
def energy_repose() -> Measured:
    """Unaccounted energy over the energy turned over."""
    _, book = lab.repose()
    share = book["residual (J/m)"] / book["turned over (J/m)"]
    return Measured(0.0, share, abs(share))


@VALIDATIONS.row(
    "dem.threads_give_the_same_bits",
    source="sums in one order whoever takes them, see sweep.py",
    because="bits",
    tolerance=0.0,
    slow=True,
)
def same_bits() -> Measured:
    """Numbers of a state of 2e4 discs, numbered at random, that differ between one loop and the sweep over blocks."""
    differ = lab.difference_of_sweeps(Linear(STIFFNESS, 1e3, **TANGENTIAL, tangential_damping=300.0))
    return Measured(0.0, float(differ), float(differ))
