"""The lattice of a scene, and its coupling with grains."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from porescale.builders.derive import Derived
from porescale.builders.initial.fluid_options import collision_options, solid_options
from porescale.builders.initial.frames import disc_count
from porescale.common.compiled.own import OwnLaw
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.coverage.ring import Ring
from porescale.coupling.lubrication import CELLS
from porescale.coupling.step import Coupled
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales
from porescale.scene.bodies.ring import Ring as RingSection
from porescale.scene.domain import Domain
from porescale.scene.fluid import Fluid as FluidSection
from porescale.scene.scene import Scene


def fluid_of(section: FluidSection, domain: Domain, derived: Derived, device: str = "cpu") -> Fluid:
    """The lattice at the start, on a device."""
    assert derived.cells
    assert derived.scales
    unit = derived.scales.body_force
    force = (0.0, 0.0) if isinstance(section.body_force, OwnLaw) else section.body_force
    fx, fy = (component / unit for component in force)
    fluid = _kind(device)(
        *derived.cells, derived.scales.relaxation_time, **collision_options(section), force=(fx, fy),
        sides=lattice_sides(domain, derived.scales, derived.cells), dtype=section.precision,
    )  # fmt: skip
    if section.velocity != (0.0, 0.0):
        fluid.set_flow(*(component / derived.scales.velocity for component in section.velocity))
    return fluid


def _kind(device: str) -> type[Fluid]:
    """The class of a fluid on a device; nothing of a GPU is imported for the CPU."""
    if device == "cpu":
        return Fluid
    from porescale.lbm.device.fluid import DeviceFluid

    return DeviceFluid


def lattice_sides(domain: Domain, scales: Scales, cells: tuple[int, int]) -> Sides:
    """The sides in lattice units: speeds of walls, velocity in every cell of an inlet, density of a pressure."""
    values: dict[str, Any] = {}
    for name, side in domain.sides.items():
        values[name] = side.kind
        if side.speed:
            values[f"{name}_speed"] = side.speed / scales.velocity
        if side.velocity is not None and not isinstance(side.velocity, OwnLaw):
            count = cells[1] if name in ("left", "right") else cells[0]
            along = np.arange(count) + 0.5  # halves: the parabola is symmetric to the last bit
            shape = 6 * along * (count - along) / count**2 if side.profile == "parabola" else np.ones(count)
            values[f"{name}_velocity"] = shape[:, None] * np.asarray(side.velocity) / scales.velocity
        if "pressure" in side.boundary.numbers:
            values[f"{name}_density"] = 1 + (side.pressure or 0.0) / scales.pressure
    return Sides(**values)


def coupled_of(
    scene: Scene, derived: Derived, fluid: Fluid, grains: Grains, rectangles: Sequence[Rectangle]
) -> Coupled:
    """Fluid and grains, coupled with the radii of the scene: grains times lambda, held discs unchanged."""
    assert scene.fluid
    assert derived.scales
    ratio: Any = np.ones(grains.discs.count)
    if scene.grains and scene.grains.hydraulic_radius_ratio:
        ratio[: disc_count(grains) - len(scene.disc)] = scene.grains.hydraulic_radius_ratio
    films = scene.lubrication
    rings = [_ring(scene.ring, derived.scales)] if scene.ring else []
    coupled = Coupled(
        fluid, grains, derived.scales, hydraulic_ratio=ratio, contact_steps=derived.contact_steps or 1,
        acceleration=scene.gravity, **solid_options(scene.fluid),
        lubrication=films is not None, film_gap=films.gap if films else CELLS, rectangles=rectangles,
        rings=rings,
    )  # fmt: skip
    if coupled.set_free_apart(scene.fluid.velocity):
        coupled.start_inside(scene.fluid.velocity)
    rims = coupled.saturated.soft_rim
    if rims and scene.disc:
        rims.stands[-len(scene.disc) :] = [disc.fastest == 0.0 for disc in scene.disc]
    return coupled


def _ring(section: RingSection, scales: Scales) -> Ring:
    """The ring in cells and steps."""
    h = scales.spacing
    return Ring((section.x / h, section.y / h), 0.5 * section.diameter / h, spin=section.spin * scales.step)
