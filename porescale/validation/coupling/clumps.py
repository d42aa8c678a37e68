"""Clumps of discs in fluid: what a rigid body must do there, whatever its shape.  Lattice units."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.step import Coupled
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import Kind
from porescale.validation.coupling.setups import LAW, in_box, lattice_units, momentum_error
from porescale.validation.lbm.channels import run

WIDE, HIGH, R = 48, 64, 6.0
"""Cells of the box, and of the radius of most discs."""
Member = tuple[float, float, float]
"""A disc of a clump: x, y, radius."""


def immersed_clumps(
    bodies: Sequence[Sequence[Member]],
    ratio: float = 2.0,
    g: float = 1e-5,
    side: Kind = "wall",
    bound: bool = True,
    velocity: Any = 0.0,
) -> Coupled:
    """Clumps of discs in a box of fluid at rest; ratio: of densities;  g: downwards;  bound: or else discs are free."""
    discs = [disc for body in bodies for disc in body]
    radius = np.array([disc[2] for disc in discs])
    made = make_discs([disc[:2] for disc in discs], radius, ratio, velocity)

    def grains(box: Box) -> Grains:
        """The discs, bound or free."""
        those = Grains(made, LAW, box)
        if bound:
            ends = np.cumsum([0, *map(len, bodies)])
            those.steering.bind([np.arange(*ends[k : k + 2]) for k in range(len(bodies))], ratio)
        return those

    return in_box((WIDE, HIGH), grains, lattice_units(), (side, side), acceleration=(0.0, -g))


def sunk(coupled: Coupled, steps: int) -> Coupled:
    """The coupled system after ``steps`` steps."""
    run(coupled.advance, steps)
    return coupled


def momentum_error_of_clumps(steps: int = 200) -> float:
    """Largest error of the momentum of clumps that collide in a periodic box and the fluid, over their own at first."""
    bodies = [[(12.0, 20.0, 5.0), (16.0, 23.0, 4.0)], [(30.0, 24.0, 5.0), (34.0, 22.0, 5.0)]]
    velocity = np.array([[0.02, 0.01]] * 2 + [[-0.03, 0.0]] * 2)
    return momentum_error(immersed_clumps(bodies, g=0.0, side="periodic", velocity=velocity), steps)


def pair_beside_disc(apart: float, steps: int = 300, *, shared: bool = True) -> float:
    """Speed of a clump of two discs ``apart`` cells from each other over that of one disc, sinking from rest.

    shared : cells on both rims hold their union;  else their sum.
    """
    single = sunk(immersed_clumps([[(24.3, 44.0, R)]], bound=False), steps).grains.discs.velocity[0, 1]
    pair = immersed_clumps([[(24.3, 44.0, R), (24.3, 44.0 + apart, R)]])
    if not shared:
        pair.saturated.pairs = np.zeros((0, 2), np.int64)
    return float(sunk(pair, steps).grains.steering.clumps.velocity[0, 1] / single)


def level_pair(smaller: float = R, steps: int = 200) -> tuple[float, float]:
    """Sideways speed, and radius times spin, of two discs side by side that sink as one, over the speed down."""
    body = [(20.0, 40.0, R), (28.0, 40.0, smaller)]
    clumps = sunk(immersed_clumps([body]), steps).grains.steering.clumps
    down = -float(clumps.velocity[0, 1])
    return float(clumps.velocity[0, 0]) / down, float(clumps.spin[0]) * R / down


VALIDATIONS = Validations()

APART = 0.02 * R
EPS = 2.0**-52


@VALIDATIONS.row(
    "coupling.momentum_of_clumps",
    source="Newton: momentum of clumps and fluid, less that of the fluid inside them, in shares of members",
    because="round-off: each of 200 fluid and 800 contact steps rounds every velocity, all one way: 1000 eps",
    tolerance=1000 * EPS,
    slow=True,
)
def momentum() -> Measured:
    """Error of the momentum budget over sum m |v| at the start: two clumps that collide in a periodic box."""
    return Measured.absolute(0.0, momentum_error_of_clumps())


@VALIDATIONS.row(
    "coupling.two_discs_in_one_place",
    source="a clump of two discs almost in one place is a disc, larger by 2 apart/(pi R) of its area",
    because="weight grows by 1.3 %, and what drag has of the shape by no more",
    tolerance=2.0 * APART / (math.pi * R),
)
def round_limit() -> Measured:
    """Speed of the clump over that of the disc after 300 steps from rest."""
    return Measured.absolute(1.0, pair_beside_disc(APART))


@VALIDATIONS.row(
    "coupling.level_pair_sinks_straight",
    source="mirror symmetry",
    because="round-off: sums over 3e3 cells of populations less those at rest, as large as the speed: 3e3 eps",
    tolerance=3000 * EPS,
)
def mirror() -> Measured:
    """Sideways speed and spin of two discs side by side, over the speed down."""
    aside, turning = level_pair()
    return Measured.absolute((0.0, 0.0), (aside, turning))
