"""Packings that settle among obstacles, which are held meanwhile and part of the system afterwards."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from porescale.common.core.errors import PorescaleError
from porescale.common.core.types import AnyArray
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import Discs
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.prepare.merge import released, together
from porescale.dem.prepare.obstacles import Obstacles
from porescale.dem.prepare.on_disk import once
from porescale.dem.prepare.settle import Pile, come_to_rest, relax, settle, weight_per_area, weights_of

LOST = 0.1
"""Of a grain's radius: overlap with an obstacle, at rest, beyond which it is in it and not on it."""


class Among(NamedTuple):
    """grains: those of the pile, then the discs of the obstacles, at rest, with the springs of their contacts and of
    those with rectangles, nothing held;  springs: of contacts with frames, by SegmentList.state, {} without frames."""

    grains: Grains
    springs: Mapping[str, AnyArray]


class MaterialOf(NamedTuple):
    """Laws by material, and the number of the material of every disc and then corner of the obstacles' frames."""

    laws: Materials
    number: AnyArray


def prepare_among(
    pile: Pile,
    box: Box,
    law: ContactLaw,
    *,
    wall_law: ContactLaw | None = None,
    plates: Sequence[Plate] = (),
    weight_density: float | None = None,
    material: MaterialOf | None = None,
) -> Among:
    """Grains of ``pile`` at rest in ``box`` among its obstacles, as settle.prepare without them.

    material : the laws under which they come to rest in the end (None: ``law`` everywhere).  Raises as prepare does,
    InputError where there is no room for the grains, and PorescaleError where one was pressed into an obstacle.
    """
    weighs, around = weight_per_area(pile, weight_density), pile.around

    def make() -> Among:
        """The grains at rest."""
        grains = around.beside(pile.discs(), law, box, pile.density, wall_law=wall_law, plates=plates)
        settle(grains, pile)
        weights, gravity = weights_of(grains.discs, weighs, pile.gravity), pile.gravity * weighs / pile.density
        weights[pile.count :] = 0.0
        relax(grains, law, weights, gravity, wall_law=wall_law, free=pile.count)
        if material:
            grains.material = material.number.astype(np.uint8)
            grains.set_law(material.laws)
            come_to_rest(grains, weights, gravity, free=pile.count)
            grains.material = None
            grains.set_law(law, wall_law)
        require_outside(grains.discs, pile.count, around)
        springs = {} if grains.segments is None else grains.segments.state()
        discs = together(grains.discs)
        kept = Discs(*(array[: pile.count + len(around.discs)] for array in vars(discs).values()))
        made = Among(released(grains, kept), springs)
        made.grains.reset_clock()
        return made

    def read(state: dict[str, Any]) -> Among:
        """The grains of a state that was kept."""
        discs = Discs(**{name: np.array(array) for name, array in state["discs"].items()})
        grains = Grains(discs, law, box, wall_law=wall_law, plates=plates)
        grains.set_rectangles(around.rectangles)
        grains.restore(state)
        return Among(grains, state.get("springs", {}))

    made_of: list[Any] = [pile, box, law, wall_law or law, *plates]
    made_of += [*material.laws.all(), *material.laws.against(material.laws.wall)] if material else []
    numbers = [] if material is None else material.number.tolist()
    return once(
        [*(dataclasses.asdict(part) for part in made_of), weighs, numbers], read, make,
        lambda made: {**made.grains.state(), "springs": dict(made.springs)},
    )  # fmt: skip


def require_outside(discs: Discs, count: int, around: Obstacles) -> None:
    """PorescaleError where one of the first ``count`` discs lies in an obstacle instead of on it."""
    x, r = discs.position[:count], discs.radius[:count]
    lost = (around.depth(x, float(r.max())) + r) / r
    k = int(lost.argmax())
    if lost[k] > LOST:
        where = f"({x[k, 0]:.4g}, {x[k, 1]:.4g}) m"
        raise PorescaleError(f"a grain of the packing at {where} was pressed into what stands there: take another seed")
