"""Packings that settle among obstacles, which are held meanwhile and part of the system afterwards."""

import contextlib
import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
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
from porescale.dem.prepare.settle import (
    UNREADABLE,
    Pile,
    cached_at,
    come_to_rest,
    pack,
    relax,
    settle,
    unpack,
    weight_per_area,
    weights_of,
)

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
    folder: Path | None = None,
    cache: bool = True,
) -> Among:
    """Grains of ``pile`` at rest in ``box`` among its obstacles, as settle.prepare without them.

    material : the laws under which they come to rest in the end (None: ``law`` everywhere).  Raises as prepare does,
    InputError where there is no room for the grains, and PorescaleError where one was pressed into an obstacle.
    """
    weighs, around = weight_per_area(pile, weight_density), pile.around
    made_of: list[Any] = [pile, box, law, wall_law or law, *plates]
    made_of += [*material.laws.all(), *material.laws.against(material.laws.wall)] if material else []
    numbers = [] if material is None else material.number.tolist()
    path = cached_at([*(dataclasses.asdict(part) for part in made_of), weighs, numbers], folder)
    if cache:
        with contextlib.suppress(*UNREADABLE):
            return _read(path, pile, box, law, wall_law, plates)
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
    if cache:
        with contextlib.suppress(OSError):  # no room or no right to write: the next run settles again
            pack(path, {**made.grains.state(), "springs": dict(made.springs)})
    return made


def require_outside(discs: Discs, count: int, around: Obstacles) -> None:
    """PorescaleError where one of the first ``count`` discs lies in an obstacle instead of on it."""
    x, r = discs.position[:count], discs.radius[:count]
    lost = (around.depth(x, float(r.max())) + r) / r
    k = int(lost.argmax())
    if lost[k] > LOST:
        where = f"({x[k, 0]:.4g}, {x[k, 1]:.4g}) m"
        raise PorescaleError(f"a grain of the packing at {where} was pressed into what stands there: take another seed")


def _read(
    path: Path, pile: Pile, box: Box, law: ContactLaw, wall_law: ContactLaw | None, plates: Sequence[Plate]
) -> Among:
    """What was kept at ``path``; raises one of UNREADABLE where it is not that."""
    state = unpack(path)
    discs = Discs(**{name: np.array(array) for name, array in state["discs"].items()})
    grains = Grains(discs, law, box, wall_law=wall_law, plates=plates)
    grains.set_rectangles(pile.around.rectangles)
    grains.restore(state)
    springs = state.get("springs", {})
    return Among(grains, {name: springs[name] for name in springs})
