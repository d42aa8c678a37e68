"""What a scene gives its grains besides places and a law: materials, energy budget, clumps, controls, walls, cell."""

from collections.abc import Sequence

import numpy as np

from porescale.builders.initial.clumps import add_clumps
from porescale.builders.initial.contact_laws import MaterialPlan
from porescale.builders.initial.control import add_controls
from porescale.builders.initial.frames import Placed
from porescale.builders.initial.placed import by_hand
from porescale.builders.initial.time_functions import schedule_of
from porescale.builders.initial.walls import add_walls, moving_sides
from porescale.dem.contact.budget import BUDGET
from porescale.dem.grains import Grains
from porescale.dem.motion.time_function import Schedule
from porescale.scene.cell import RATES, STRESSES, Cell
from porescale.scene.scene import Scene
from porescale.scene.time_function import TimeFunction


def apply_sections(scene: Scene, grains: Grains, mass: float, placed: Sequence[Placed] = ()) -> list[str]:
    """Give ``grains``, all discs in place, what the scene requests; what it does not name is not built.

    mass (kg/m): of a mean grain, whose restitution is meant where a material gives one;  placed: its frames, whose
    corners come last.  Returns the names of the bodies that are recorded.
    """
    materials = MaterialPlan.of(scene).laws(mass) if scene.grains else None
    if scene.output.energy:
        grains.budget = np.zeros((grains.discs.count, BUDGET))
    if materials:
        own = [it.frame.material for it in placed for _ in it.frame.corners]
        names = names_of(scene, grains.discs.count - len(own))
        if len(materials.names) > 1:
            numbers = [materials.names.index(name or materials.names[0]) for name in names]
            grains.material = np.array(numbers + own, np.uint8)
        grains.set_law(materials)
    elif scene.output.energy:
        grains.set_law(grains.law, grains.wall_law)  # kernels take the energy budget with the law
    if scene.clump or placed:
        add_clumps(scene, grains, placed)
    recorded = add_controls(scene, grains, placed) if scene.control or placed else []
    if scene.wall or moving_sides(scene.domain):
        add_walls(scene.domain, scene.wall, grains)
    if scene.cell:
        strain(scene.cell, grains)
    return recorded


def names_of(scene: Scene, count: int) -> list[str]:
    """The material of each of ``count`` discs by name, "" for the first."""
    placed = [it.material for it in by_hand(scene)]
    walls = scene.contact.wall_material if scene.contact else ""
    held = [it.material or walls for it in scene.disc]
    packing = scene.grains.packing if scene.grains else None
    packed = count - len(placed) - len(held)
    return [packing.material if packing else ""] * packed + placed + held


def strain(it: Cell, grains: Grains) -> None:
    """Strain the cell of ``grains`` at the rates, or by the stresses, of the section."""

    def prescribed(name: str) -> Schedule | None:
        """A rate or stress over time; None where the section names none."""
        function: TimeFunction | None = getattr(it, name)
        return schedule_of(function) if function else None

    xx, yy, xy = (prescribed(name) for name in RATES)
    along, up, shear = (prescribed(name) for name in STRESSES)
    grains.steering.strain_cell(xx, yy, xy, pressure=(along, up), shear_stress=shear, limit=it.fastest or 0.0)
