"""From a scene to a simulation: fluid and grains at time 0, then each part of which the scene has the section."""

from porescale.builders.checks.device import device_of, require_device_of
from porescale.builders.cost import require_memory
from porescale.builders.derive import derive
from porescale.builders.initial.fluid import coupled_of, fluid_of
from porescale.builders.initial.grains import frames_of, grains_of
from porescale.builders.initial.rectangles import on_the_lattice
from porescale.builders.kinds import add_parts
from porescale.builders.scene import Scene
from porescale.builders.simulation import Simulation
from porescale.builders.stepper import Clock
from porescale.builders.system import System
from porescale.coupling.step import buoyant_weight


def build(scene: Scene) -> Simulation:
    """The simulation of ``scene`` at time 0; raises InputError for what the scene must not request.

    A packing is settled first, or read from the cache; that can take seconds.
    """
    system = system_of(scene)
    return Simulation(system, add_parts(system))


def system_of(scene: Scene, *, hasty: bool = False) -> System:
    """Fluid and grains of ``scene`` at time 0; raises InputError.  hasty : as of `grains_of`."""
    derived = derive(scene)
    require_memory(scene, derived)
    require_device_of(scene)
    made = System(scene, derived, Clock(derived.model_step), frames=frames_of(scene, derived))
    if scene.grains or scene.disc or scene.rectangle or scene.ring:
        made.grains, made.recorded = grains_of(scene, derived, made.frames, hasty=hasty)
    if scene.fluid:
        made.fluid = fluid_of(scene.fluid, scene.domain, derived, device_of(scene))
    if derived.scales:
        made.rectangles = on_the_lattice(scene.rectangle, derived.scales)
    if made.fluid and made.grains:
        made.coupled = coupled_of(scene, derived, made.fluid, made.grains, made.rectangles)
    elif made.grains:
        made.weight = buoyant_weight(made.grains, 0.0, scene.gravity)
    return made
