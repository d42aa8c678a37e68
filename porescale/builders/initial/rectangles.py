"""Rectangles as fluid and grains have them, and the plates between which a packing settles."""

from collections.abc import Sequence

import numpy as np

from porescale.common.core.constants import EDGE
from porescale.coupling.coverage.rectangle import Rectangle as LatticeRectangle
from porescale.dem.forces.rectangle import Rectangle as GrainRectangle
from porescale.dem.forces.walls import Plate
from porescale.dem.grains import Grains
from porescale.lbm.scales import Scales
from porescale.scene.bodies.rectangle import Rectangle
from porescale.scene.packing import Packing


def on_the_lattice(sections: Sequence[Rectangle], scales: Scales) -> list[LatticeRectangle]:
    """The rectangles as bodies in the fluid, at rest at the start: they move from the first step on."""
    h = scales.spacing
    return [LatticeRectangle(np.array(it.lower) / h, np.array(it.upper) / h) for it in sections]


def stand_ins(sections: Sequence[Rectangle], packing: Packing) -> list[Plate]:
    """Plates on the upright faces between which a packing settles: on those next to it, at its height."""
    edges = packing.left, packing.left + packing.width
    return [
        Plate(x, it.lower[1], it.upper[1], friction=it.friction, name=f"rectangle {k} {side}")
        for k, it in enumerate(sections)
        for side, x, edge in (("left", it.lower[0], edges[1]), ("right", it.upper[0], edges[0]))
        if holds(it, packing) and not stands_in(it, packing) and abs(x - edge) < packing.diameter
    ]


def stands_in(it: Rectangle, packing: Packing) -> bool:
    """Whether a rectangle takes room of the packing's, or stands below it where it falls."""
    low, high = packing.bottom + EDGE * packing.height, packing.bottom + packing.height * (1 - EDGE)
    wide = min(it.upper[0], packing.left + packing.width) - max(it.lower[0], packing.left)
    return wide > EDGE * packing.width and it.lower[1] < high and (packing.settle or it.upper[1] > low)


def holds(it: Rectangle, packing: Packing) -> bool:
    """Whether a rectangle stands at the height of the packing."""
    return it.lower[1] < packing.bottom + packing.height and it.upper[1] > packing.bottom


def beside(sections: Sequence[Rectangle], packing: Packing) -> tuple[bool, bool]:
    """Whether a face holds the packing on its left, and on its right, while it settles."""
    names = [plate.name for plate in stand_ins(sections, packing)]
    return any(name.endswith("right") for name in names), any(name.endswith("left") for name in names)


def take_over(sections: Sequence[Rectangle], grains: Grains, there: Sequence[int] = ()) -> None:
    """Rectangles instead of the plates that stood in for them, and of those by number that were ``there`` while the
    packing settled, with the springs that these had; if there were any."""
    before = grains.rectangle_spring
    grains.set_rectangles(
        [GrainRectangle(it.lower, it.upper, friction=it.friction, name=f"rectangle[{k}]")
         for k, it in enumerate(sections)]
    )  # fmt: skip
    for spring, k in zip(before, there, strict=True):
        grains.rectangle_spring[k] += spring
    for k in range(len(sections)):
        for name in (f"rectangle {k} left", f"rectangle {k} right"):
            if name in grains.plate_names:
                grains.rectangle_spring[k] += grains.plate_spring[grains.plate(name)]
                grains.remove_plate(name)
