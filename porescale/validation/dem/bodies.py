"""Validations of clumps, controlled bodies, servo walls and strained cells: exact answers."""

from __future__ import annotations

import math

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.dem import bodies_trials as lab
from porescale.validation.dem import energy_trials as boxed
from porescale.validation.dem.discs_trials import MASS, RADIUS, momentum_drift, relative

VALIDATIONS = Validations()

BOUNCES = ((0.5, 0.0), (1.0, 20.0), (1.5, -30.0))
"""Angle (rad) of a dumbbell and its spin over its speed (1/m)."""
SHEARS = (0.0, 0.5)


@VALIDATIONS.row(
    "dem.dumbbell_bounce",
    source="impulse of a rigid body: J = -2 v_n/(1/M + a^2/I) at a frictionless, elastic contact",
    because="1e-3: the contact lasts 1000 steps and is met up to one late; the body turns by 1e-4 meanwhile",
    tolerance=1e-3,
)
def dumbbell() -> Measured:
    """Speed up and r times spin after a clump of two discs has hit a floor with one end, over its speed."""
    scale = np.array([1.0, RADIUS])
    exact = np.array([lab.dumbbell_exact(*case) for case in BOUNCES]) * scale
    found = np.array([lab.dumbbell_bounce(*case) for case in BOUNCES]) * scale
    return Measured(exact.tolist(), found.tolist(), float(np.abs(found - exact).max()))


@VALIDATIONS.row(
    "dem.clump_as_pendulum",
    source="physical pendulum, T = 4 K(sin(s/2)) sqrt(I/(m g r)), I of two discs exact",
    because="leap-frog: (w dt)^2/24 = 3e-9 at 13 000 steps a period, start half a step late: dt/T squared",
    tolerance=3e-8,
)
def pendulum() -> Measured:
    """Period of a clump held at its centroid of which one disc has weight, let go at 1 rad, s."""
    exact, found = lab.pendulum_exact(1.0), lab.pendulum_period(1.0)
    return Measured(exact, found, relative(found, exact))


@VALIDATIONS.row(
    "dem.momentum_of_clumps",
    source="Newton's third law; shares of members add up to the body",
    because="60 discs, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=1e-13,
)
def momenta() -> Measured:
    """20 clumps and 20 discs that spin, collide and rub in free space: relative drift of both momenta."""
    drift = momentum_drift(lab.clumped_cloud(), 5000)
    return Measured((0.0, 0.0), drift, max(drift))


@VALIDATIONS.row(
    "dem.servo_wall",
    source="statics: the lid bears the wanted force, the floor that and the weight",
    because="left to rest for 160 decay times of its slowest wave at half critical drag, the lid's own are twice that",
    tolerance=1e-6,
)
def servo() -> Measured:
    """Force on floor and lid of a column of ten discs under a lid that is to bear 50 N/m."""
    exact = (50.0 + 10 * MASS * GRAVITY, 50.0)
    found = lab.column_under_servo(50.0)
    return Measured(exact, found, relative(found, exact))


@VALIDATIONS.row(
    "dem.affine_moduli_of_a_lattice",
    source="triangular lattice: sqrt(3)/4 (3 + s), sqrt(3)/4 (1 - s), sqrt(3)/4 (1 + 3 s) k_n with s = k_t/k_n",
    because="the lattice is pressed by 1e-4 of a diameter: geometric stiffness sqrt(3) 1e-4 k_n, up to twice",
    tolerance=4e-4,
)
def moduli() -> Measured:
    """C11, C12 and the shear stress over the shear of a strained periodic cell, over k_n, s = 0 and 0.5."""
    exact = np.array([lab.lattice_exact(shear) for shear in SHEARS])
    found = np.array([lab.lattice_moduli(shear) for shear in SHEARS])
    return Measured(exact.tolist(), found.tolist(), float(np.abs(found - exact).max()))


@VALIDATIONS.row(
    "dem.energy_book_of_driven_bodies",
    source="first law: clumps, bodies moved and pushed, walls that move, turn and bear a load, tutorial I-2 and I-3",
    because="a dashpot is booked half a step too long at touch: w0 dt/pi = 1/200 of what is lost, at T_c/200",
    tolerance=1.0 / 200.0,
)
def driven() -> Measured:
    """Unaccounted energy over the energy turned over, in boxes without drive, with each, and with all."""
    cases = [("free",), ("placed",), ("pushed",), ("wall turns",), ("servo",), tuple(boxed.DRIVES)]
    found = [boxed.unaccounted(names, 200.0) for names in cases]
    return Measured((0.0,) * len(cases), found, max(found))


@VALIDATIONS.row(
    "dem.energy_book_of_driven_bodies_closes_with_the_step",
    source="first law; order of the residual from T_c/50 to T_c/200",
    because="first order or better: 0.2 below one, since what walls and pushes err by has the other sign and has not"
    " gone at 50 steps",
    tolerance=0.2,
)
def driven_order() -> Measured:
    """Order at which the unaccounted energy falls, clumps alone and with all drives."""
    orders = []
    for names in (("free",), tuple(boxed.DRIVES)):
        coarse, fine = (boxed.unaccounted(names, steps) for steps in (50.0, 200.0))
        orders.append(math.log(coarse / fine, 4.0))
    return Measured((1.0, 1.0), orders, max(0.0, 1.0 - min(orders)))
