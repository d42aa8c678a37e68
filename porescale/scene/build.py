"""From a scene to a simulation: each part is built only if the scene has its section."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from porescale.coupling.step import Coupled, buoyant_weight
from porescale.dem.discs import Discs, make_discs
from porescale.dem.join import joined, together
from porescale.dem.settle import Pile, prepare
from porescale.dem.system import Grains
from porescale.dem.walls import Box, Plate
from porescale.ground.check import InputError
from porescale.lbm.fluid import Fluid
from porescale.lbm.sides import Sides
from porescale.particles.placement import place
from porescale.scene.cost import refuse_too_large
from porescale.scene.derive import Derived, derive, grain_count
from porescale.scene.geometry import refuse_overlaps
from porescale.scene.sections import Domain, Packing, Scene
from porescale.scene.simulation import Gatekeeper, Simulation
from porescale.workbench.sections import load

GATE = "gate"


def load_scene(path: str | Path, *, quality: str | None = None, settings: Sequence[str] = ()) -> Scene:
    """The scene at ``path`` (a TOML file or a folder with scene.toml), with ``section.key=value`` settings."""
    return load(path, Scene, quality=quality, overrides=settings)


def build(scene: Scene) -> Simulation:
    """The simulation of ``scene`` at time 0; raises InputError for what the scene must not ask.

    A packing is settled first, or read from the cache; that can take seconds.
    """
    derived = derive(scene)
    refuse_too_large(derived)
    grains = _grains(scene, derived) if scene.grains else None
    fluid = _fluid(scene, derived) if scene.fluid else None
    coupled = None
    if fluid and grains and scene.grains:
        assert derived.scales
        assert derived.contact_steps
        assert scene.grains.hydraulic_radius_ratio
        coupled = Coupled(
            fluid, grains, derived.scales, hydraulic_ratio=scene.grains.hydraulic_radius_ratio,
            contact_steps=derived.contact_steps, acceleration=scene.gravity,
        )  # fmt: skip
    weight = buoyant_weight(grains, 0.0, scene.gravity) if grains and not fluid else None
    gate = None
    if scene.gate:
        plate = fluid.add_plate(derived.gate_column or 0) if fluid else None
        gate = Gatekeeper(scene.gate.opens_at, scene.gate.lift_speed, plate, grains, GATE)
    return Simulation(scene, derived, fluid=fluid, grains=grains, coupled=coupled, weight=weight, gate=gate)


def _fluid(scene: Scene, derived: Derived) -> Fluid:
    assert scene.fluid
    assert derived.cells
    assert derived.scales
    fx, fy = (component / derived.scales.body_force for component in scene.fluid.body_force)
    d = scene.domain
    return Fluid(
        *derived.cells, derived.scales.relaxation_time, magic=scene.fluid.magic, force=(fx, fy),
        sides=Sides(d.left, d.right, d.bottom, d.top),
    )  # fmt: skip


def _box(domain: Domain) -> Box:
    kinds = {
        side: "periodic" if getattr(domain, side) == "periodic" else "solid"
        for side in ("left", "right", "bottom", "top")
    }
    return Box((0.0, 0.0), (domain.width, domain.height), **kinds)


def _grains(scene: Scene, derived: Derived) -> Grains:
    assert scene.grains
    assert derived.law
    box, law, wall_law = _box(scene.domain), derived.law, derived.wall_law
    plates = (
        [Plate(scene.gate.x, 0.0, scene.domain.height, friction=scene.gate.friction, name=GATE)] if scene.gate else []
    )
    packing = scene.grains.packing
    by_hand = len(scene.grains.grain)
    if packing and packing.settle:
        grains = prepared(scene, packing, box, derived, plates)
        if by_hand:
            grains = joined(grains, _by_hand(scene))
    else:
        parts = [_placed(scene, packing)] if packing else []
        if by_hand:
            parts.append(_by_hand(scene))
        grains = Grains(together(*parts), law, box, wall_law=wall_law, plates=plates)
        grains.refresh()  # contacts count from the first row of the series on
    if by_hand:
        refuse_overlaps(grains.discs, scene.domain, grains.discs.count - by_hand)
    return grains


def prepared(scene: Scene, packing: Packing, box: Box, derived: Derived, plates: list[Plate]) -> Grains:
    """The packing settled dry, then at rest under the run's contact law and its weight in the fluid."""
    assert scene.grains
    assert derived.law
    pile = Pile(
        corner=(packing.left, packing.bottom), width=packing.width, count=grain_count(scene) - len(scene.grains.grain),
        diameter=packing.diameter, density=scene.grains.density, spread=packing.size_spread,
        friction=packing.settling_friction, seed=packing.seed, gravity=-scene.gravity[1],
    )  # fmt: skip
    lighter = scene.fluid.density if scene.fluid else 0.0
    return prepare(
        pile, box, derived.law, wall_law=derived.wall_law, plates=plates, weight_density=scene.grains.density - lighter
    )


def _placed(scene: Scene, packing: Packing) -> Discs:
    assert scene.grains
    try:
        placed = place(
            (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height),
            diameter=packing.diameter, spread=packing.size_spread, packing_fraction=packing.packing_fraction,
            seed=packing.seed,
        )  # fmt: skip
    except InputError as error:
        raise InputError([replace(fault, key=f"grains.packing.{fault.key}") for fault in error.faults]) from None
    return make_discs(placed.position, placed.radius, scene.grains.density)


def _by_hand(scene: Scene) -> Discs:
    assert scene.grains
    grains = scene.grains.grain
    return make_discs(
        [(g.x, g.y) for g in grains], np.array([g.diameter / 2 for g in grains]), scene.grains.density,
        np.array([g.velocity for g in grains]), np.array([g.spin for g in grains]),
    )  # fmt: skip
