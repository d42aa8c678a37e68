"""From a scene to a simulation: each part is built only if the scene has its section."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from porescale.build.cost import require_memory
from porescale.build.derive import derive
from porescale.build.initial.fluid import _coupled, _fluid
from porescale.build.initial.frames import any_frames
from porescale.build.initial.grains import GATE, _frames, _grains
from porescale.build.initial.rectangles import on_the_lattice
from porescale.build.parts.rectangles import Movers
from porescale.build.parts.sleep import let_sleep
from porescale.build.scene import Scene
from porescale.build.simulation import Gatekeeper, Simulation
from porescale.common.schema.sections import load
from porescale.coupling.step import buoyant_weight


def load_scene(path: str | Path, *, quality: str | None = None, settings: Sequence[str] = ()) -> Scene:
    """The scene at ``path`` (a TOML file or a folder with scene.toml), with ``section.key=value`` settings."""
    return load(path, Scene, quality=quality, overrides=settings)


def build(scene: Scene) -> Simulation:
    """The simulation of ``scene`` at time 0; raises InputError for what the scene must not ask.

    A packing is settled first, or read from the cache; that can take seconds.
    """
    derived = derive(scene)
    require_memory(derived)
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
