"""What experiments with grains in fluid share: discs immersed in a box, and the choices that are varied.

Unless SI is named, spacing, step and density of the fluid are 1, so that everything is in lattice units.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import Floats
from porescale.coupling.step import Coupled
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.forces.walls import Plate as GrainPlate
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import Kind, Sides
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales
from porescale.validation.lbm.channels import one_thread

TAU = 0.8

LAW = Linear(2.0, 0.1, 0.5, 0.05, 0.4)
"""Contact of discs some five cells wide: two of radius 4 and density 2 touch for about 16 fluid steps."""
GATE = "gate"


@dataclass(frozen=True)
class Method:
    """What is chosen by name: operators of fluid and solid, weight, and the magic parameter of the fluid's."""

    solid_operator: str = "exact-wall"
    weighting: str | None = None
    operator: str = "trt"
    magic: float = MAGIC_MIDWAY_WALL


DEFAULT = Method()
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
NO_DISCS = np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0)
"""Places, velocities and spins of none."""


def in_box(
    cells: tuple[int, int], grains: Callable[[Box], Grains], scales: Scales, sides: tuple[Kind, Kind], *,
    method: Method = DEFAULT, force: tuple[float, float] = (0.0, 0.0), ratio: float = 1.0, contact_steps: int = 4,
    acceleration: tuple[float, float] = (0.0, 0.0), gate: int | None = None,
) -> Coupled:  # fmt: skip
    """What ``grains`` makes of a box of so many cells, in fluid at rest there; the others as `immersed` has them."""
    across, along = sides
    fluid = Fluid(
        *cells, scales.relaxation_time, operator=method.operator, magic=method.magic, force=force,
        sides=Sides(across, across, along, along),
    )  # fmt: skip
    if gate is not None:
        fluid.add_plate(gate)
    kinds = ["periodic" if kind == "periodic" else "solid" for kind in (across, across, along, along)]
    box = Box((0.0, 0.0), (scales.spacing * cells[0], scales.spacing * cells[1]), *kinds)
    return Coupled(
        fluid, grains(box), scales, hydraulic_ratio=ratio, contact_steps=contact_steps, acceleration=acceleration,
        solid_operator=method.solid_operator, weighting=method.weighting,
    )  # fmt: skip


def lattice_units(relaxation_time: float = TAU) -> Scales:
    """Spacing, step and density 1."""
    return Scales(1.0, 1.0, relaxation_time, 1.0)


def immersed(
    cells: tuple[int, int],
    position: ArrayLike,
    radius: ArrayLike,
    density: ArrayLike,
    velocity: ArrayLike = 0.0,
    spin: ArrayLike = 0.0,
    *,
    relaxation_time: float = TAU,
    sides: tuple[Kind, Kind] = ("wall", "wall"),
    acceleration: tuple[float, float] = (0.0, 0.0),
    ratio: float = 1.0,
    gate: int | None = None,
    scales: Scales | None = None,
    force: tuple[float, float] = (0.0, 0.0),
    method: Method = DEFAULT,
) -> Coupled:
    """Discs in a box of fluid at rest; lengths and densities in the units of ``scales`` (default: all 1).

    sides: left and right, bottom and top;  ratio: hydraulic over mechanical radius;  gate: column it stands left of;
    force: on the fluid, lattice units.
    """
    scales = scales or lattice_units(relaxation_time)
    h = scales.spacing
    plates = [] if gate is None else [GrainPlate(gate * h, 0.0, cells[1] * h, name=GATE)]
    discs = make_discs(position, radius, density, velocity, spin)
    return in_box(
        cells, lambda box: Grains(discs, LAW, box, plates=plates), scales, sides, method=method, force=force,
        ratio=ratio, acceleration=acceleration, gate=gate,
    )  # fmt: skip


def without_inner_mass(coupled: Coupled) -> Coupled:
    """The same with the fluid inside the discs taken for theirs: the common mistake."""
    coupled.inner_mass[:] = 0.0
    coupled.inner_inertia[:] = 0.0
    return coupled


def handful(
    *, sides: tuple[Kind, Kind] = ("periodic", "periodic"), acceleration: tuple[float, float] = (0.0, 0.0),
    ratio: float = 0.8, mirrored: bool = False, gate: bool = False, method: Method = DEFAULT,
) -> Coupled:  # fmt: skip
    """Six discs of density 1.5 to 4 in a box of 60 x 40 cells, ``mirrored`` left for right.

    They spin, and fly at each other, at the walls and at where the gate stands, left of column 30.
    """
    cells, column = (60, 40), 30
    position = np.array([(8.1, 9.3), (18.4, 10.2), (12.7, 27.4), (23.6, 28.8), (38.2, 12.3), (52.2, 24.6)])
    velocity = np.array([(0.05, 0.01), (-0.03, 0.0), (0.06, 0.01), (0.05, -0.02), (-0.06, 0.01), (0.06, -0.02)])
    spin = np.array([0.004, -0.003, 0.005, 0.002, -0.004, 0.001])
    radius = np.array([4.0, 3.5, 4.5, 3.8, 4.9, 4.2])
    if mirrored:
        position[:, 0] = cells[0] - position[:, 0]
        velocity[:, 0] *= -1
        spin = -spin
        acceleration = -acceleration[0], acceleration[1]
    return immersed(
        cells, position, radius, [3.0, 1.5, 4.0, 2.0, 3.5, 2.5], velocity, spin, relaxation_time=0.6, sides=sides,
        acceleration=acceleration, ratio=ratio, gate=column if gate else None, method=method,
    )  # fmt: skip


def carried(coupled: Coupled, velocity: tuple[float, float]) -> Coupled:
    """The same with fluid and discs moving at ``velocity``."""
    coupled.fluid.set_flow(*velocity)
    coupled.grains.discs.velocity[:] = coupled.inner_velocity[:] = velocity
    return coupled


def momentum_error(coupled: Coupled, steps: int, momentum: Callable[[], Floats] | None = None) -> float:
    """Largest error of the momentum budget, weights counted, over sum m |v| of discs at the start.

    momentum : all of it (2,), lattice units, if it is not to be `Coupled.momentum`.
    """
    read, discs = momentum or coupled.momentum, coupled.grains.discs
    size = float(np.sum(discs.mass[:, None] * np.abs(discs.velocity)))
    first, per_step, worst = read(), coupled.weight.sum(axis=0), 0.0
    with one_thread():
        for step in range(1, steps + 1):
            coupled.advance()
            worst = max(worst, float(np.abs(read() - first - step * per_step).max()))
    return worst / size
