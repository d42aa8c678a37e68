"""Validations of fluid and grains together."""

from __future__ import annotations

import numpy as np

from porescale.coupling import exact, verify_fast, verify_moving, verify_towed
from porescale.coupling import experiments as lab
from porescale.workbench.validations import Measured, Validations

VALIDATIONS = Validations()

EPS = float(np.finfo(float).eps)
TIMES = (0.05, 0.1, 0.2, 0.5)  # nu t/a²
RATIOS = (1.5, 2.5, 7.8)
ARRAY_DRAG = 51.53  # F/(mu U), square array, solid fraction 0.2
ARRAY_DEFICIT = 0.049  # share of it that is missing at tau 0.6 and 10 cells per diameter, found by an independent code
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
    "coupling.square_array_drag",
    source="Stokes drag on a square array of cylinders, solid fraction 0.2: 51.53 mu U",
    because="the reference is less the 4.9 % by which this method is known to miss it at tau 0.6, d = 10 (an"
    " independent code's number); 1 %: the place in the cell moves that deficit by up to a fifth",
    tolerance=0.01,
)
def array() -> Measured:
    """Drag F/(mu U) at about ten cells per diameter, tau 0.6, against the known one; error over the exact drag."""
    expected = (1 - ARRAY_DEFICIT) * ARRAY_DRAG
    found = lab.array_drag(20, relaxation_time=0.6)
    return Measured(expected, found, abs(found - expected) / ARRAY_DRAG)


@VALIDATIONS.row(
    "coupling.square_array_order",
    source="the deficit in radius is C h²/d, found by an independent code of the method",
    because="second order at tau 0.8; 0.3 asked for: the place in the cell moves each error by up to a fifth",
    tolerance=0.3,
)
def array_order() -> Measured:
    """Order of the drag's error over about 10, 20 and 40 cells per diameter."""
    errors = [abs(lab.array_drag(cells) / ARRAY_DRAG - 1) for cells in (20, 40, 80)]
    found = float(np.log2(errors[0] / errors[2]) / 2)
    return Measured(2.0, found, abs(found - 2.0))


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
    "coupling.disc_at_rest_in_a_body_force",
    source="hydrostatics: F sum(B + w- B(1 - B)/2), less the drag at F/2 with which SC1's skin lets fluid through",
    because="0.3 %: Faxen's channel, taken for the square box, is 5 % off in a drag that is at most 5 % of the load",
    tolerance=3e-3,
)
def body_force() -> Measured:
    """Load over F of a disc (5 cells in a closed box of 40) in water at rest under a body force, tau 0.8 and 1.5."""
    pairs = [lab.weighing(tau) for tau in (0.8, 1.5)]
    found, expected = [pair[0] for pair in pairs], [pair[1] for pair in pairs]
    return Measured(expected, found, float(np.abs(np.divide(found, expected) - 1).max()))


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


@VALIDATIONS.row(
    "coupling.spinning_disc_does_not_drift",
    source="steady state",
    because="density and torque hold to four digits",
    tolerance=1e-4,
)
def drift() -> Measured:
    """Density inside, and torque, of a disc kept spinning (R 5 in a box of 30, tau 1.5): change from 1500 to 15 000."""
    density, torque = lab.spinning_disc([1500, 15_000])
    error = max(abs(density[1] - density[0]), abs(torque[1] / torque[0] - 1))
    return Measured([density[0], torque[0]], [density[1], torque[1]], error)


for _more in (verify_towed.VALIDATIONS, verify_moving.VALIDATIONS, verify_fast.VALIDATIONS):
    VALIDATIONS.include(_more)
