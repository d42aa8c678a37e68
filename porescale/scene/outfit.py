"""What a scene gives its grains besides places and a law: the energy book."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from porescale.dem.contact.law import BOOK
from porescale.dem.energy import energy_book
from porescale.dem.system import Grains

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

RESIDUAL = "residual (J/m)"


def fit_out(scene: Scene, grains: Grains) -> None:
    """Give ``grains``, all discs in place, what the scene asks for; nothing is made of what it does not name."""
    if scene.output.energy:
        grains.book = np.zeros((grains.discs.count, BOOK))
        grains.set_law(grains.law, grains.wall_law)  # kernels find the book beside the law


def energy_row(grains: Grains, acceleration: tuple[float, float]) -> dict[str, float]:
    """Columns of the series: the energy book since the first step, J/m, its residual last.

    acceleration : of free fall, m/s^2, whose work is the potential energy.
    """
    book = energy_book(grains, acceleration)
    return {**{name: value for name, value in book.items() if name != RESIDUAL}, RESIDUAL: book[RESIDUAL]}
