"""Grains in fluid with known answers: what ``verify`` measures and tests vary.

Unless SI is named, spacing, step and density of the fluid are 1, so that everything is in lattice units.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.coupling.psm import Saturated
from porescale.coupling.step import Coupled
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.forces.walls import Plate as GrainPlate
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import Kind, Sides
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.lbm.scales import Scales
from porescale.validation.lbm.channels import one_thread

Array = NDArray[np.floating]

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
    scales = scales or Scales(1.0, 1.0, relaxation_time, 1.0)
    across, along = sides
    fluid = Fluid(
        *cells, scales.relaxation_time, operator=method.operator, magic=method.magic, force=force,
        sides=Sides(across, across, along, along),
    )  # fmt: skip
    plates = []
    if gate is not None:
        fluid.add_plate(gate)
        plates = [GrainPlate(gate * scales.spacing, 0.0, cells[1] * scales.spacing, name=GATE)]
    width, height = (n * scales.spacing for n in cells)
    kinds = ["periodic" if kind == "periodic" else "solid" for kind in (across, across, along, along)]
    box = Box((0.0, 0.0), (width, height), *kinds)
    grains = Grains(make_discs(position, radius, density, velocity, spin), LAW, box, plates=plates)
    return Coupled(
        fluid, grains, scales, hydraulic_ratio=ratio, contact_steps=4, acceleration=acceleration,
        solid_operator=method.solid_operator, weighting=method.weighting,
    )  # fmt: skip


def without_inner_mass(coupled: Coupled) -> Coupled:
    """The same with the fluid inside the discs taken for theirs: the common mistake."""
    coupled.inner_mass[:] = 0.0
    coupled.inner_inertia[:] = 0.0
    return coupled


def settling_disc(
    cells_per_diameter: int = 16, relaxation_time: float = 0.65, ratio: float = 1.0, method: Method = DEFAULT
) -> float:
    """Largest speed (m/s) of the disc of Glowinski et al. 2001 before it is within a diameter of the bottom.

    Box 2 x 6 cm, d 0.25 cm, density ratio 1.25, nu 0.1 cm²/s, g 9.81 m/s², released at (1, 4) cm.  The step follows
    from the relaxation time; at 16 cells and 0.65 the disc falls at a Mach number of 0.075.  ratio: hydraulic over
    mechanical radius.
    """
    diameter, nu = 0.0025, 1e-5
    spacing = diameter / cells_per_diameter
    step = (relaxation_time - 0.5) / 3 * spacing**2 / nu
    cells = round(0.02 / spacing), round(0.06 / spacing)
    coupled = immersed(
        cells, [(0.01, 0.04)], diameter / 2, 1250.0,
        acceleration=(0.0, -9.81), ratio=ratio, scales=Scales(spacing, step, relaxation_time),
        method=method,
    )  # fmt: skip
    discs, fastest = coupled.grains.discs, 0.0
    while discs.position[0, 1] > 1.5 * diameter:
        coupled.advance()
        fastest = max(fastest, -float(discs.velocity[0, 1]))
        if coupled.fluid.step * step > 2.0:  # twice what it takes: it hovers
            break
    return fastest


def release(
    ratio: float,
    times: Sequence[float],
    *,
    diameter: float = 20.0,
    relaxation_time: float = 0.56,
    width: float = 20.0,
    inner_mass: bool = True,
    method: Method = DEFAULT,
) -> list[float]:
    """v/((s - 1) g a²/nu) of a disc of density ratio s released from rest, at ``times`` nu t/a².

    A closed box ``width`` diameters wide; so light a weight that the flow is linear.  Velocities live half a step back.
    """
    a, nu = diameter / 2, viscosity(relaxation_time)
    unit = 1e-5
    g = unit * nu / a**2 / (ratio - 1)
    n = round(width * diameter)
    middle = n / 2 + 0.3, n / 2 + 0.1
    coupled = immersed(
        (n, n), [middle], a, ratio, relaxation_time=relaxation_time, acceleration=(0.0, -g), method=method
    )
    if not inner_mass:
        without_inner_mass(coupled)
    return _followed(
        coupled, [t * a**2 / nu for t in times], lambda: -float(coupled.grains.discs.velocity[0, 1]) / unit
    )


def spin_down(
    ratio: float,
    times: Sequence[float],
    *,
    diameter: float = 20.0,
    relaxation_time: float = 0.56,
    width: float = 8.0,
    inner_mass: bool = True,
    method: Method = DEFAULT,
) -> list[float]:
    """Spin over its first value of a disc set spinning in fluid at rest, at ``times`` nu t/a².

    The fluid inside spins with it from the start.
    """
    a, nu = diameter / 2, viscosity(relaxation_time)
    n = round(width * diameter)
    x0, y0 = n / 2 + 0.3, n / 2 + 0.1
    first = 1e-4 / a
    coupled = immersed((n, n), [(x0, y0)], a, ratio, 0.0, first, relaxation_time=relaxation_time, method=method)
    if not inner_mass:
        without_inner_mass(coupled)
    _, _, _, solid = coupled.fields()
    y, x = np.mgrid[:n, :n] + 0.5
    coupled.fluid.set_flow(-first * (y - y0) * solid, first * (x - x0) * solid)
    return _followed(coupled, [t * a**2 / nu for t in times], lambda: float(coupled.grains.discs.spin[0]) / first)


def _followed(coupled: Coupled, steps: Sequence[float], value: Callable[[], float]) -> list[float]:
    """``value`` of a disc's half-step velocity, interpolated to times in ``steps`` (ascending)."""
    found, before, now = [], 0.0, value()
    for wanted in steps:
        while coupled.fluid.step - 0.5 < wanted:
            coupled.advance()
            before, now = now, value()
        share = wanted - (coupled.fluid.step - 1.5)
        found.append(before + share * (now - before))
    return found


def spinning_disc(
    steps: Sequence[int], *, relaxation_time: float = 1.5, spin: float = 0.02, method: Method = DEFAULT
) -> tuple[list[float], list[float]]:
    """Density at the centre, and torque, of a disc kept spinning (radius 5 in 30 x 30 cells) after ``steps``."""
    fluid = Fluid(30, 30, relaxation_time)
    wet = Saturated(
        fluid, np.array([5.0]), solid_operator=method.solid_operator, weighting=method.weighting
    )  # fmt: skip
    place, rest, turning = np.array([[15.3, 15.1]]), np.zeros((1, 2)), np.array([spin])
    density, torque = [], []
    with one_thread():
        for step in range(1, max(steps) + 1):
            wet.advance(fluid, place, rest, turning)
            if step in steps:
                density.append(float(fluid.fields()[0][15, 15]))
                torque.append(float(wet.torque[0]))
    return density, torque


def faxen(k: float) -> float:
    """Drag F/(mu U) of a cylinder towed midway between walls, k radius over half width (Faxen 1946)."""
    return 4 * math.pi / (-math.log(k) - 0.9157 + 1.7244 * k**2 - 1.7302 * k**4 + 2.4056 * k**6 - 4.5913 * k**8)


def weighing(
    relaxation_time: float, cells: int = 40, radius: float = 5.0, steps: int = 5000, method: Method = DEFAULT
) -> tuple[float, float]:
    """Load over F of a disc held in a closed box under a downward body force F on the fluid, and the area it covers."""
    force = 1e-6
    fluid = Fluid(cells, cells, relaxation_time, force=(0.0, -force))
    wet = Saturated(fluid, np.array([radius]), solid_operator=method.solid_operator, weighting=method.weighting)
    place, rest, no_spin = np.array([[0.3, 0.1]]) + cells / 2, np.zeros((1, 2)), np.zeros(1)
    with one_thread():
        for _ in range(steps):
            wet.advance(fluid, place, rest, no_spin)
    return float(wet.force[0, 1]) / force, math.pi * float(wet.covering_radius[0]) ** 2


def handful(
    *, sides: tuple[Kind, Kind] = ("periodic", "periodic"), acceleration: tuple[float, float] = (0.0, 0.0),
    ratio: float = 0.8, mirrored: bool = False, gate: bool = False,
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
        acceleration=acceleration, ratio=ratio, gate=column if gate else None,
    )  # fmt: skip


def carried(coupled: Coupled, velocity: tuple[float, float]) -> Coupled:
    """The same with fluid and discs moving at ``velocity``."""
    coupled.fluid.set_flow(*velocity)
    coupled.grains.discs.velocity[:] = coupled.inner_velocity[:] = velocity
    return coupled


def lift_gate(coupled: Coupled) -> None:
    """Take the gate away, from fluid and grains."""
    coupled.fluid.plates.clear()
    coupled.grains.remove_plate(GATE)


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


def momentum_error(acceleration: tuple[float, float], steps: int, *, inner_mass: bool = True) -> float:
    """Largest error of the momentum book over sum m |v| at the start: colliding discs in a periodic box."""
    coupled = handful(acceleration=acceleration)
    if not inner_mass:
        without_inner_mass(coupled)
    discs = coupled.grains.discs
    size = float(np.sum(discs.mass[:, None] * np.abs(discs.velocity)))
    first, per_step, worst = coupled.momentum(), coupled.weight.sum(axis=0), 0.0
    for step in range(1, steps + 1):
        coupled.advance()
        worst = max(worst, float(np.abs(coupled.momentum() - first - step * per_step).max()))
    return worst / size


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
