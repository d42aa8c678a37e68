"""What a scene gives its grains besides places and a law: materials, energy book, clumps, controls, walls, cell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from porescale.build.frame_build import Placed
from porescale.dem.contact.law import BOOK
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_book
from porescale.scene.bodies_of_grains import add_clumps, add_controls, by_hand
from porescale.scene.cell import strain
from porescale.scene.contact import materials_of
from porescale.scene.walls import add_walls, moving_sides

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

RESIDUAL = "residual (J/m)"


def fit_out(scene: Scene, grains: Grains, mass: float, placed: Sequence[Placed] = ()) -> list[str]:
    """Give ``grains``, all discs in place, what the scene asks for; nothing is made of what it does not name.

    mass (kg/m): of a mean grain, whose restitution is meant where a material gives one;  placed: its frames, whose
    corners come last.  Returns the names of the bodies that are recorded.
    """
    materials = materials_of(scene, mass)
    if scene.output.energy:
        grains.book = np.zeros((grains.discs.count, BOOK))
    if materials:
        own = [it.frame.material for it in placed for _ in it.frame.corners]
        names = names_of(scene, grains.discs.count - len(own))
        if len(materials.names) > 1:
            numbers = [materials.names.index(name or materials.names[0]) for name in names]
            grains.material = np.array(numbers + own, np.uint8)
        grains.set_law(materials)
    elif scene.output.energy:
        grains.set_law(grains.law, grains.wall_law)  # kernels find the book beside the law
    if scene.clump or placed:
        add_clumps(scene, grains, placed)
    recorded = add_controls(scene, grains, placed) if scene.control or placed else []
    if scene.wall or moving_sides(scene):
        add_walls(scene, grains)
    if scene.cell:
        strain(scene, grains)
    return recorded


def names_of(scene: Scene, count: int) -> list[str]:
    """The material of each of ``count`` discs by name, "" for the first."""
    placed = [it.material for it in by_hand(scene)]
    walls = scene.contact.wall_material if scene.contact else ""
    held = [it.material or walls for it in scene.disc]
    packing = scene.grains.packing if scene.grains else None
    packed = count - len(placed) - len(held)
    return [packing.material if packing else ""] * packed + placed + held


def energy_row(grains: Grains, acceleration: tuple[float, float]) -> dict[str, float]:
    """Columns of the series: the energy book since the first step, J/m, its residual last.

    acceleration : of free fall, m/s^2, whose work is the potential energy.
    """
    book = energy_book(grains, acceleration)
    return {**{name: value for name, value in book.items() if name != RESIDUAL}, RESIDUAL: book[RESIDUAL]}
