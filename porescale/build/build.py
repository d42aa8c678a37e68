"""From a scene to a simulation: each part is built only if the scene has its section."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from porescale.build.checks.frame_places import refuse_overlaps_of_frames
from porescale.build.checks.geometry import placed, refuse_overlaps
from porescale.build.checks.rectangle_places import refuse_buried
from porescale.build.cost import refuse_too_large
from porescale.build.derive import Derived, derive, grain_count
from porescale.build.frame_build import Placed, any_frames, disc_count, placed_frames, with_corners
from porescale.build.outfit import fit_out
from porescale.build.simulation import Gatekeeper, Simulation
from porescale.common.core.errors import InputError
from porescale.common.neighbors.placement import place
from porescale.common.schema.sections import load
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.step import Coupled, buoyant_weight
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.prepare.merge import joined, together
from porescale.dem.prepare.settle import Pile, prepare
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales
from porescale.scene.bodies_of_grains import by_hand
from porescale.scene.contact import density_of
from porescale.scene.packing import compressed, radii_of
from porescale.scene.rectangles import Movers, on_the_lattice, stand_ins, take_over
from porescale.scene.rock import rock_discs, rock_frames
from porescale.scene.sections import Packing, Scene
from porescale.scene.sides import Domain
from porescale.scene.sleep import let_sleep

GATE = "gate"
UNTOUCHED = Linear(1.0, 0.0)
"""Contact law where all discs are held: nothing comes of it."""

NO_DISCS = make_discs(np.zeros((0, 2)), np.zeros(0), np.zeros(0))


def load_scene(path: str | Path, *, quality: str | None = None, settings: Sequence[str] = ()) -> Scene:
    """The scene at ``path`` (a TOML file or a folder with scene.toml), with ``section.key=value`` settings."""
    return load(path, Scene, quality=quality, overrides=settings)


def build(scene: Scene) -> Simulation:
    """The simulation of ``scene`` at time 0; raises InputError for what the scene must not ask.

    A packing is settled first, or read from the cache; that can take seconds.
    """
    derived = derive(scene)
    refuse_too_large(derived)
    frames = _frames(scene, derived) if any_frames(scene) else []
    grains, recorded = _grains(scene, derived, frames) if scene.grains or scene.disc or scene.rectangle else (None, [])
    fluid = _fluid(scene, derived) if scene.fluid else None
    solids = on_the_lattice(scene, derived.scales) if derived.scales else []
    coupled = _coupled(scene, derived, fluid, grains, solids) if fluid and grains else None
    movers = Movers(scene, solids, derived.scales, grains) if scene.rectangle else None
    weight = buoyant_weight(grains, 0.0, scene.gravity) if grains and not fluid else None
    if grains and scene.sleep:
        let_sleep(scene, grains, coupled.weight if coupled else buoyant_weight(grains, 0.0, scene.gravity))
    gate = None
    if scene.gate:
        plate = fluid.add_plate(derived.gate_column or 0) if fluid else None
        gate = Gatekeeper(scene.gate.opens_at, scene.gate.lift_speed, plate, grains, GATE)
    return Simulation(
        scene, derived, fluid=fluid, grains=grains, coupled=coupled, weight=weight, gate=gate, movers=movers,
        frames=frames, recorded=recorded,
    )  # fmt: skip


def _coupled(scene: Scene, derived: Derived, fluid: Fluid, grains: Grains, rectangles: Sequence[Rectangle]) -> Coupled:
    """Fluid and grains, each as large to the other as the scene says: grains by lambda, held discs as they are."""
    assert scene.fluid
    assert derived.scales
    ratio = np.ones(grains.discs.count)
    if scene.grains and scene.grains.hydraulic_radius_ratio:
        ratio[: disc_count(grains) - len(scene.disc)] = scene.grains.hydraulic_radius_ratio
    size: Any = ratio
    films = scene.lubrication
    return Coupled(
        fluid, grains, derived.scales, hydraulic_ratio=size, contact_steps=derived.contact_steps or 1,
        acceleration=scene.gravity, **scene.fluid.solid_laws,
        lubrication=films is not None, film_gap=films.gap if films else 1.0, rectangles=rectangles,
    )  # fmt: skip


def _fluid(scene: Scene, derived: Derived) -> Fluid:
    assert scene.fluid
    assert derived.cells
    assert derived.scales
    unit = derived.scales.body_force
    fx, fy = (component / unit for component in scene.fluid.body_force)
    fluid = Fluid(
        *derived.cells, derived.scales.relaxation_time, **scene.fluid.laws, force=(fx, fy),
        sides=lattice_sides(scene.domain, derived.scales, derived.cells), dtype=scene.fluid.precision,
    )  # fmt: skip
    if scene.fluid.velocity != (0.0, 0.0):
        fluid.set_flow(*(component / derived.scales.velocity for component in scene.fluid.velocity))
    return fluid


def lattice_sides(domain: Domain, scales: Scales, cells: tuple[int, int]) -> Sides:
    """The sides in lattice units: speeds of walls, velocity in every cell of an inlet, density of a pressure."""
    values: dict[str, Any] = {}
    for name, side in domain.sides.items():
        values[name] = side.kind
        if side.speed:
            values[f"{name}_speed"] = side.speed / scales.velocity
        if side.velocity is not None:
            count = cells[1] if name in ("left", "right") else cells[0]
            along = np.arange(count) + 0.5  # halves: the parabola is symmetric to the last bit
            shape = 6 * along * (count - along) / count**2 if side.profile == "parabola" else np.ones(count)
            values[f"{name}_velocity"] = shape[:, None] * np.asarray(side.velocity) / scales.velocity
        if "pressure" in side.boundary.numbers:
            values[f"{name}_density"] = 1 + (side.pressure or 0.0) / scales.pressure
    return Sides(**values)


def _box(domain: Domain) -> Box:
    kinds = {name: "periodic" if side.boundary.periodic else "solid" for name, side in domain.sides.items()}
    return Box((0.0, 0.0), (domain.width, domain.height), **kinds)


def _frames(scene: Scene, derived: Derived) -> list[Placed]:
    """All bodies of segments, a rock's last."""
    rock = rock_frames(scene, derived.law) if scene.rock and derived.law else []
    return [*placed_frames(scene), *rock]


def _grains(scene: Scene, derived: Derived, frames: list[Placed]) -> tuple[Grains, list[str]]:
    """All discs in their order: the packing's, those placed by hand, those that are held, corners of frames; and names
    of the bodies that are recorded."""
    box, law, wall_law = _box(scene.domain), derived.law or UNTOUCHED, derived.wall_law
    plates = (
        [Plate(scene.gate.x, 0.0, scene.domain.height, friction=scene.gate.friction, name=GATE)] if scene.gate else []
    )
    packing = scene.grains.packing if scene.grains else None
    parts = [_by_hand(scene)] if by_hand(scene) else []
    parts += [_held(scene)] if scene.disc else []
    if scene.rock:
        of_rock = rock_discs(scene, law)
        parts = [of_rock, *parts] if of_rock else parts
        grains = Grains(together(*parts) if parts else NO_DISCS, law, box, wall_law=wall_law)
    elif packing and packing.settle:
        grains = prepared(scene, packing, box, derived, [*plates, *stand_ins(scene, packing)])
        if parts:
            grains = joined(grains, together(*parts))
    elif packing and packing.compress:
        grains = compressed(scene, packing, law).grains
        grains = joined(grains, together(*parts)) if parts else grains
        grains.set_law(law, wall_law)
    else:
        parts = [_placed(scene, packing), *parts] if packing else parts
        grains = Grains(together(*parts) if parts else NO_DISCS, law, box, wall_law=wall_law, plates=plates)
        if grains.discs.count:  # where bodies of segments are all there is they come with lists of their own
            grains.refresh()  # contacts count from the first row of the series on
    if scene.rectangle:
        take_over(scene, grains)
        refuse_buried(scene, grains.discs)
    discs = grains.discs
    grains = with_corners(grains, frames) if frames else grains
    if scene.disc:
        grains.hold(slice(discs.count - len(scene.disc), discs.count))
    recorded = fit_out(scene, grains, derived.mean_mass, frames)
    added = len(scene.disc) + len(by_hand(scene))
    if added:
        refuse_overlaps(discs, scene, discs.count - added)
    if frames and packing and not scene.rock:
        refuse_overlaps_of_frames(scene, frames, discs, placed(scene)[0])
    return grains, recorded


def _held(scene: Scene) -> Discs:
    """The discs that move as told; their mass moves nothing."""
    density = scene.fluid.density if scene.fluid else 1000.0
    return make_discs(
        [(it.x, it.y) for it in scene.disc], np.array([it.diameter / 2 for it in scene.disc]), density,
        np.array([it.velocity for it in scene.disc]), np.array([it.spin for it in scene.disc]),
    )  # fmt: skip


def prepared(scene: Scene, packing: Packing, box: Box, derived: Derived, plates: list[Plate]) -> Grains:
    """The packing settled dry, then at rest under the run's contact law and its weight in the fluid."""
    assert scene.grains
    assert derived.law
    placed, radii = len(by_hand(scene)) + len(scene.disc), radii_of(packing)
    pile = Pile(
        corner=(packing.left, packing.bottom), width=packing.width, count=grain_count(scene) - placed,
        diameter=packing.diameter, density=density_of(scene, packing.material), spread=packing.size_spread,
        friction=packing.settling_friction, seed=packing.seed, gravity=-scene.gravity[1],
        given=() if radii is None else tuple(radii.tolist()),
    )  # fmt: skip
    lighter = scene.fluid.density if scene.fluid else 0.0
    return prepare(
        pile, box, derived.law, wall_law=derived.wall_law, plates=plates, weight_density=pile.density - lighter
    )


def _placed(scene: Scene, packing: Packing) -> Discs:
    assert scene.grains
    radii = radii_of(packing)
    sizes: dict[str, Any] = (
        {"diameter": packing.diameter, "spread": packing.size_spread, "packing_fraction": packing.packing_fraction}
        if radii is None else {"radii": radii}
    )  # fmt: skip
    try:
        placed = place(
            (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height),
            seed=packing.seed, **sizes,
        )  # fmt: skip
    except InputError as error:
        raise InputError([replace(fault, key=f"grains.packing.{fault.key}") for fault in error.faults]) from None
    return make_discs(placed.position, placed.radius, density_of(scene, packing.material))


def _by_hand(scene: Scene) -> Discs:
    grains = by_hand(scene)
    return make_discs(
        [(g.x, g.y) for g in grains], np.array([g.diameter / 2 for g in grains]),
        np.array([density_of(scene, g.material) for g in grains]),
        np.array([g.velocity for g in grains]), np.array([g.spin for g in grains]),
    )  # fmt: skip
