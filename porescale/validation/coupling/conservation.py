"""What fluid and grains together conserve: mass, momentum, mirror symmetry, uniform flow.  Lattice units."""

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.step import Coupled
from porescale.validation.coupling.setups import GATE, carried, handful, immersed, momentum_error

EPS = float(np.finfo(float).eps)
VALIDATIONS = Validations()

FALL = (1e-5, -5e-5)  # acceleration of a handful, cells per step²
STEPS = 500


def loads_on_neutral(steps: int, extra: float = 0.0) -> list[float]:
    """Largest force, and torque over radius, on discs of density 1 that a uniform flow of 0.036 carries.

    Two of them touch and share cells; all cross the periodic sides.  ``extra``: what the first is faster by.
    """
    place, radius = [(10.3, 12.2), (18.42, 12.4), (30.0, 30.0)], [4.0, 4.1, 5.0]
    coupled = carried(immersed((40, 36), place, radius, 1.0, sides=("periodic", "periodic")), (0.03, 0.02))
    coupled.grains.discs.velocity[0, 0] += extra
    force = torque = 0.0
    for _ in range(steps):
        coupled.advance()
        force = max(force, float(np.abs(coupled.saturated.force).max()))
        torque = max(torque, float(np.abs(coupled.saturated.torque / radius).max()))
    return [force, torque]


@VALIDATIONS.row(
    "coupling.neutral_grains_feel_no_force",
    source="Galilean invariance: B rho (u - u_s) = 0 in every cell, shared or not",
    because="round-off: four roundings of 0.036 in each of the 95 cells of the largest disc, all one way",
    tolerance=4 * 95 * 0.036 * EPS,
)
def neutral() -> Measured:
    """Largest load and torque over the radius on three discs carried by uniform flow, two sharing cells, 300 steps."""
    return Measured.absolute(0.0, loads_on_neutral(steps=300))


@VALIDATIONS.row(
    "coupling.mass",
    source="each collision, side and plate conserves mass",
    because="required: 1e-12 of the mass",
    tolerance=1e-12,
)
def mass() -> Measured:
    """Relative change of the fluid's mass: a handful of discs colliding in a closed box with a gate, 500 steps."""
    coupled = handful(sides=("wall", "wall"), acceleration=FALL, gate=True)
    before = coupled.fluid.mass_excess()
    for _ in range(STEPS):
        coupled.advance()
    return Measured.absolute(0.0, (coupled.fluid.mass_excess() - before) / (coupled.fluid.nx * coupled.fluid.ny))


@VALIDATIONS.row(
    "coupling.momentum",
    source="Newton: sum rho u + sum(m_p U^n - m_f U^(n-1)) changes by the weights alone",
    because="round-off: each of 500 fluid and 2000 contact steps rounds every velocity, all one way: 2500 eps",
    tolerance=2500 * EPS,
)
def momentum() -> Measured:
    """Error of the momentum budget over sum m |v| at the start: discs in a periodic box, with and without weights."""
    return Measured.absolute(0.0, [momentum_error(handful(acceleration=way), STEPS) for way in ((0.0, 0.0), FALL)])


def lift_gate(coupled: Coupled) -> None:
    """Take the gate away, from fluid and grains."""
    coupled.fluid.plates.clear()
    coupled.grains.remove_plate(GATE)


def mirror_error(acceleration: tuple[float, float], steps: int, nudge: float = 0.0) -> float:
    """Difference over the width of discs in a walled box and in its mirrored twin; the gate goes halfway.

    ``nudge``: how far the twin's first disc is out of place.
    """
    pair = [handful(sides=("wall", "wall"), acceleration=acceleration, gate=True, mirrored=m) for m in (False, True)]
    pair[1].grains.discs.position[0, 0] += nudge
    for step in range(steps):
        for coupled in pair:
            if step == steps // 2:
                lift_gate(coupled)
            coupled.advance()
    one, two = (coupled.grains.discs.position for coupled in pair)
    width = pair[0].fluid.nx
    return float(max(np.abs(one[:, 0] + two[:, 0] - width).max(), np.abs(one[:, 1] - two[:, 1]).max())) / width


@VALIDATIONS.row(
    "coupling.mirror",
    source="symmetry of the equations, left for right",
    because="required: 1e-12 of the box",
    tolerance=1e-12,
)
def mirror() -> Measured:
    """Difference over the box's width of a scene and its mirrored twin: discs, walls, a gate that goes, 1000 steps."""
    return Measured.absolute(0.0, mirror_error(FALL, 1000))
