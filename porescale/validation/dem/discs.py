"""Validations of the grains: exact answers, and the tolerance each allows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.dem import discs_trials as lab

VALIDATIONS = Validations()

RATIOS = (0.0, 0.05, 0.2155, 0.5, 0.9)
CHUNG = "Chung & Ooi 2011 protocols, linear law in two dimensions"
PRESSED = lab.MASS * GRAVITY / (lab.STIFFNESS * lab.RADIUS)  # static overlap over radius: 7.7e-5


def _restitution(release: str, ratios: tuple[float, ...]) -> Measured:
    laws = [lab.law_at(h, release) for h in ratios]
    bounced = [lab.bounce(law, 1000.0) for law in laws]
    exact = [law.restitution(lab.MASS) for law in laws]
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
    """The same, contact kept until the overlap is zero."""
    return _restitution("overlap", RATIOS)


@VALIDATIONS.row(
    "dem.restitution_of_pairs",
    source="Schwager & Poeschel 2007, effective mass m1 m2/(m1 + m2)",
    because="as for the wall: 1e-3 at T_c/1000",
    tolerance=1e-3,
)
def restitution_pair() -> Measured:
    """Two discs of radius ratio 2, head on, at an angle to the axes."""
    mass = lab.MASS * 4.0 / 5.0
    law = lab.law_at(0.2155, mass=mass)
    exact, bounced = law.restitution(mass), lab.bounce_pair(law, 2.0, 1000.0)
    return Measured(exact, bounced, abs(bounced - exact))


@VALIDATIONS.row(
    "dem.sliding_turns_into_rolling",
    source="t* = u0/(3 mu g), u = 2/3 u0 (rigid disc, Coulomb)",
    because="t* is read to a step of T_c/20 = 2.6e-4 t*, and the lever arm is short by the overlap, 7.7e-5 r",
    tolerance=4e-4,
)
def sliding_to_rolling() -> Measured:
    """A disc set sliding at 1 m/s without spin, mu = 0.2: when it rolls, and how fast."""
    exact = (1.0 / (3.0 * 0.2 * GRAVITY), 2.0 / 3.0)
    found = lab.slide_to_roll(0.2)
    return Measured(exact, found, lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.rolling_down_an_incline",
    source="a = 2/3 g sin, alpha = a/r for tan < 3 mu; else a = g(sin - mu cos), alpha = 2 mu g cos/r",
    because="lever arms are short by the static overlap over the radius, 7.7e-5",
    tolerance=1.0e-4,
)
def incline() -> Measured:
    """Below (0.3 rad, mu 0.5) and above (0.8 rad, mu 0.1) the angle at which a disc begins to slip."""
    roll = 2.0 / 3.0 * GRAVITY * math.sin(0.3)
    exact = (
        roll, roll / lab.RADIUS,
        GRAVITY * (math.sin(0.8) - 0.1 * math.cos(0.8)), 0.2 * GRAVITY * math.cos(0.8) / lab.RADIUS,
    )  # fmt: skip
    found = (*lab.incline(0.3, 0.5), *lab.incline(0.8, 0.1))
    return Measured(exact, found, lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.rolling_with_its_own_lever_arm",
    source="m a = m g sin - f, I alpha = f b, a = b alpha with b = r - m g cos/k; f = mu N beyond the limit",
    because="the specification: 1e-10; springs have come to rest to exp(-h w0 t) = exp(-43) = 2e-19 after 0.06 s, and"
    " 3e4 steps round the speed, all one way: 3e4 eps = 7e-12",
    tolerance=1e-10,
)
def incline_arm() -> Measured:
    """Acceleration and angular acceleration on the same inclines."""
    exact = (*lab.incline_exact(0.3, 0.5), *lab.incline_exact(0.8, 0.1))
    found = (*lab.incline(0.3, 0.5, wait=0.06), *lab.incline(0.8, 0.1, wait=0.06))
    return Measured(exact, found, lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.oblique_impact_in_gross_sliding",
    source=CHUNG + "; v_t' = v_t - mu(1+e)v_n, w' = 2mu(1+e)v_n/r; spinning: v_t' = mu(1+e)v_n",
    because="restitution within 1e-3/(1+e), lever arm short by up to v_n/(w0 r) = 2.8e-4: 1e-3 of the impulse",
    tolerance=1e-3,
)
def oblique() -> Measured:
    """Change of slip velocity and spin in units of mu(1+e)v_n and 2mu(1+e)v_n/r; v_n 1 cm/s, v_t or w r 5
    cm/s.
    """
    damped = lab.law_at(0.1)
    law = lab.law_at(0.1, tangential_stiffness=0.25 * lab.STIFFNESS, friction=0.3, tangential_damping=damped.damping)
    fall, slide = 0.01, 0.05
    unit = 0.3 * (1.0 + law.restitution(lab.MASS)) * fall
    _, along, spin = lab.impact(law, fall, [slide, 0.0], [0.0, slide / lab.RADIUS])
    found = (
        (slide - along[0]) / unit, -spin[0] * lab.RADIUS / (2.0 * unit),
        -along[1] / unit, (slide - spin[1] * lab.RADIUS) / (2.0 * unit),
    )  # fmt: skip
    exact = (1.0, 1.0, 1.0, 1.0)
    return Measured(exact, [float(value) for value in found], lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.no_impact_gains_energy",
    source="second law, at grazing angles",
    because="leap-frog errs at touch by (w0 dt)^3 = 3e-8 of the energy at T_c/1000, nothing else may be gained",
    tolerance=1e-7,
)
def grazing() -> Measured:
    """Largest gain of kinetic energy over angles 0 to 89.9 degrees against walls and discs, with and
    without loss.
    """
    angles = np.radians(np.concatenate((np.arange(0.0, 90.0, 2.0), (89.5, 89.9))))
    rubbing: dict[str, Any] = {"tangential_stiffness": 0.25 * lab.STIFFNESS, "friction": 0.3}
    gains = [
        float(lab.grazing_gain(law, angles, against).max())
        for law in (lab.law_at(0.0, **rubbing), lab.law_at(0.1, **rubbing, tangential_damping=300.0))
        for against in ("wall", "disc")
    ]
    return Measured(0.0, gains, max(0.0, *gains))


@VALIDATIONS.row(
    "dem.static_stack",
    source="overlap j from the top = j m g/k",
    because="rest is reached to exp(-20) = 2e-9; overlaps of 8e-7 m are read off positions known to 3e-17 m",
    tolerance=1e-8,
)
def stack() -> Measured:
    """Ten discs on a floor, overlaps in m g/k."""
    exact = list(range(1, 11))
    found = lab.stack(10)
    return Measured(exact, found.tolist(), lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.momentum_and_angular_momentum",
    source="Newton's third law; lever arms that meet on the chord of the overlap",
    because="60 discs, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=1e-13,
)
def momenta() -> Measured:
    """A cloud of spinning, rubbing discs colliding in free space: relative drift of both."""
    drift = lab.momentum_drift(lab.cloud(), 5000)
    return Measured((0.0, 0.0), drift, max(drift))


@VALIDATIONS.row(
    "dem.critical_step_of_a_contact",
    source="dt = 2 sqrt(m/k)(sqrt(1+h^2) - h), leap-frog with lagged damping (tutorial I-6, sign corrected)",
    because="1 %: growth within 2000 steps shows 1e-3 beyond the limit, bisection stops at 2e-3",
    tolerance=0.01,
)
def critical() -> Measured:
    """Longest stable step of a disc pressed on a floor, in sqrt(m/k), h = 0, 0.1, 0.5, 1."""
    ratios = (0.0, 0.1, 0.5, 1.0)
    exact = [2.0 * (math.hypot(1.0, h) - h) for h in ratios]
    found = [lab.critical_step(h) for h in ratios]
    return Measured(exact, found, lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.critical_step_of_a_lattice",
    source="largest eigenvalue of the dynamical matrix of the triangular lattice, translation and rotation",
    because="1 %: bisection stops at 3e-3, the lattice is pressed by 1e-4 (geometric stiffness of that order)",
    tolerance=0.01,
)
def critical_lattice() -> Measured:
    """Longest stable step of a periodic lattice of discs in contact, in sqrt(m/k_n), k_t/k_n = 0.25 and
    0.8.
    """
    shears = (0.25, 0.8)
    exact = [2.0 / math.sqrt(lab.lattice_frequency(shear)) for shear in shears]
    found = [lab.lattice_critical_step(shear) for shear in shears]
    return Measured(exact, found, lab.relative(found, exact))
