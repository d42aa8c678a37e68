"""Validations of clumps of discs in fluid: what a rigid body must do there, whatever its shape."""

from __future__ import annotations

import math

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.coupling import clumps_trials as lab

VALIDATIONS = Validations()

APART = 0.02 * lab.R
EPS = 2.0**-52


@VALIDATIONS.row(
    "coupling.momentum_of_clumps",
    source="Newton: momentum of clumps and fluid, less that of the fluid inside them, in shares of members",
    because="round-off: each of 200 fluid and 800 contact steps rounds every velocity, all one way: 1000 eps",
    tolerance=1000 * EPS,
)
def momentum() -> Measured:
    """Error of the book over sum m |v| at the start: two clumps that meet in a periodic box."""
    error = lab.momentum_error_of_clumps()
    return Measured(0.0, error, error)


@VALIDATIONS.row(
    "coupling.two_discs_in_one_place",
    source="a clump of two discs almost in one place is a disc, larger by 2 apart/(pi R) of its area",
    because="weight grows by 1.3 %, and what drag has of the shape by no more",
    tolerance=2.0 * APART / (math.pi * lab.R),
)
def round_limit() -> Measured:
    """Speed of the clump over that of the disc after 300 steps from rest."""
    found = lab.pair_beside_disc(APART)
    return Measured(1.0, found, abs(found - 1.0))


@VALIDATIONS.row(
    "coupling.level_pair_sinks_straight",
    source="mirror symmetry",
    because="round-off: sums over 3e3 cells of populations less those at rest, as large as the speed: 3e3 eps",
    tolerance=3000 * EPS,
)
def mirror() -> Measured:
    """Sideways speed and spin of two discs side by side, over the speed down."""
    aside, turning = lab.level_pair()
    return Measured((0.0, 0.0), (aside, turning), max(abs(aside), abs(turning)))
