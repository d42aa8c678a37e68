"""Validations of fluid and grains together."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.coupling import exact
from porescale.validation.coupling import grains_trials as lab

VALIDATIONS = Validations()

EPS = float(np.finfo(float).eps)
TIMES = (0.05, 0.1, 0.2, 0.5)  # nu t/a²
RATIOS = (1.5, 2.5, 7.8)
FALL = (1e-5, -5e-5)  # acceleration of a handful, cells per step²
STEPS = 500


@VALIDATIONS.row(
    "coupling.settling_disc",
    source="Glowinski et al. 2001; Wan & Turek 2006: disc in a box of 2 x 6 cm, 5.55 cm/s",
    because="0.1 cm/s: the published values spread by that much",
    tolerance=1e-3,
)
def settling() -> Measured:
    """Terminal speed, m/s, at 16 cells per diameter."""
    found = lab.settling_disc()
    return Measured(0.0555, found, abs(found - 0.0555))


@VALIDATIONS.row(
    "coupling.release_from_rest",
    source="Stokes 1851, unbounded and linear, by numerical inverse Laplace transform",
    because="4 %: the disc looks C h²/d too big (0.6 % in added mass), a wall ten diameters off adds 2 (a/W)² = 0.5 %"
    " of it, and at 0.05 the rim is 2 cells thick where the viscous layer has 2.2",
    tolerance=0.04,
)
def release() -> Measured:
    """v/((s - 1) g a²/nu) at nu t/a² 0.05, 0.1, 0.2, 0.5 for s 1.5, 2.5, 7.8; tau 0.56, 20 cells per diameter."""
    reference = [exact.start_up(ratio, time) for ratio in RATIOS for time in TIMES]
    found = [value for ratio in RATIOS for value in lab.release(ratio, TIMES)]
    return Measured(reference, found, float(np.abs(np.divide(found, reference) - 1).max()))


@VALIDATIONS.row(
    "coupling.spin_down",
    source="flow K1 around a turning cylinder, unbounded and linear, by numerical inverse Laplace transform",
    because="as for the release from rest; the wall four diameters off holds back (a/W)² = 1.6 %",
    tolerance=0.04,
)
def spin_down() -> Measured:
    """Spin over its first value at nu t/a² 0.05, 0.1, 0.2, 0.5 for s 0.5 and 2.5; tau 0.56, 20 cells per diameter."""
    reference = [exact.spin_down(ratio, time) for ratio in (0.5, 2.5) for time in TIMES]
    found = [value for ratio in (0.5, 2.5) for value in lab.spin_down(ratio, TIMES)]
    return Measured(reference, found, float(np.abs(np.divide(found, reference) - 1).max()))


@VALIDATIONS.row(
    "coupling.neutral_grains_feel_no_force",
    source="Galilean invariance: B rho (u - u_s) = 0 in every cell, shared or not",
    because="round-off: four roundings of 0.036 in each of the 95 cells of the largest disc, all one way",
    tolerance=4 * 95 * 0.036 * EPS,
)
def neutral() -> Measured:
    """Largest load and torque over the radius on three discs carried by uniform flow, two sharing cells, 300 steps."""
    loads = lab.loads_on_neutral(steps=300)
    return Measured(0.0, loads, max(loads))


@VALIDATIONS.row(
    "coupling.mass",
    source="each collision, side and plate conserves mass",
    because="asked for: 1e-12 of the mass",
    tolerance=1e-12,
)
def mass() -> Measured:
    """Relative change of the fluid's mass: a handful of discs colliding in a closed box with a gate, 500 steps."""
    coupled = lab.handful(sides=("wall", "wall"), acceleration=FALL, gate=True)
    before = coupled.fluid.mass_excess()
    for _ in range(STEPS):
        coupled.advance()
    found = (coupled.fluid.mass_excess() - before) / (coupled.fluid.nx * coupled.fluid.ny)
    return Measured(0.0, found, abs(found))


@VALIDATIONS.row(
    "coupling.momentum",
    source="Newton: sum rho u + sum(m_p U^n - m_f U^(n-1)) changes by the weights alone",
    because="round-off: each of 500 fluid and 2000 contact steps rounds every velocity, all one way: 2500 eps",
    tolerance=2500 * EPS,
)
def momentum() -> Measured:
    """Error of the book over sum m |v| at the start: colliding discs in a periodic box, with and without weights."""
    errors = [lab.momentum_error(acceleration, STEPS) for acceleration in ((0.0, 0.0), FALL)]
    return Measured(0.0, errors, max(errors))


@VALIDATIONS.row(
    "coupling.mirror",
    source="symmetry of the equations, left for right",
    because="asked for: 1e-12 of the box",
    tolerance=1e-12,
)
def mirror() -> Measured:
    """Difference over the box's width of a scene and its mirrored twin: discs, walls, a gate that goes, 1000 steps."""
    found = lab.mirror_error(FALL, 1000)
    return Measured(0.0, found, found)
