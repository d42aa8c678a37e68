"""Which contact law holds where in a system: between discs, by their materials, and at every surface."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, numbers
from porescale.common.core.types import Floats
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.bodies.rigid import masses
from porescale.dem.contact.law import ContactLaw, springs_of
from porescale.dem.contact.materials import Materials
from porescale.dem.state import State


def material_numbers(law: ContactLaw | Materials, material: ArrayLike | None, count: int) -> NDArray[np.uint8] | None:
    """Numbers (count,) of the discs' materials, or None where there is one; InputError at a number that is none, and
    where there is not one number for each disc, or one for all."""
    known = len(law.names) if isinstance(law, Materials) else 1
    within = Range(ge=0, le=known - 1)
    given = numbers("material", 0 if material is None else material, (count,), within, "grain", spread=True)
    broken = np.flatnonzero(given % 1.0)
    if len(broken):
        raise InputError(Fault("material", float(given[broken[0]]), f"of grain {broken[0]} is no whole number"))
    return None if known == 1 else given.astype(np.uint8)


def set_law(grains: State, law: ContactLaw | Materials, wall_law: ContactLaw | None = None) -> None:
    """Use ``law`` between discs and ``wall_law`` (default: the same) at sides and plates from now on.

    One law holds between all materials.  Raises InputError when the laws are of different kinds, or have fewer
    materials than the discs.
    """
    known = 1 if grains.material is None else int(grains.material.max(initial=0)) + 1
    if isinstance(law, Materials):
        if known > len(law.names):
            raise InputError(Fault("material", known - 1, "no such material", allowed=f"< {len(law.names)}"))
        at_walls = law.against(law.wall) if wall_law is None else [wall_law] * len(law.names)
        table, used = law.table(), [*law.all(), *at_walls]
    else:
        at_walls = [law if wall_law is None else wall_law] * known
        table, used = np.tile(law.row(), (known, known, 1)), [law, *at_walls]
    if len({type(each) for each in used}) > 1:
        raise InputError(Fault("contact.law", "linear and hertz", "all laws of a system must be of one kind"))
    grains.law, grains.laws_at_walls, grains.laws = law, at_walls, used
    grains.wall_law = law if wall_law is None and not isinstance(law, Materials) else wall_law
    rolling = 1.0 if grains.springs > 1 or any(each.rolls for each in used) else None
    grains.contact, grains.body_mass = used[0].kernel(table, 1.0, rolling), masses(grains)
    _widen(grains, springs_of(grains.contact))
    grains.wall_laws = surface_laws(grains, grains.wall_frictions)
    grains.plate_laws = surface_laws(grains, grains.plate_frictions)
    grains.rectangle_laws = surface_laws(grains, grains.rectangle_frictions)


def surface_laws(grains: State, frictions: Sequence[float | None]) -> Floats:
    """Rows (surfaces, materials, COLUMNS) of the wall laws, with its own friction where a surface has one."""
    grains.free_law = None  # see resting/frictionless.py
    rows = [
        [(each if own is None else each.with_friction(own)).row() for each in grains.laws_at_walls] for own in frictions
    ]
    return np.array(rows).reshape(len(rows), len(grains.laws_at_walls), len(grains.laws[0].row()))


def _widen(grains: State, springs: int) -> None:
    """Arrays for ``springs`` springs per contact; what there is is kept, new ones are zero."""
    more = springs - grains.springs
    if more == 0:
        return
    box = grains.box
    pairs = PairList(grains.discs.count, grains.skin, box.lower, box.upper, box.periodic, carried=springs)
    if grains.springs > 0:
        state = grains.pairs.state()
        pairs.group = grains.pairs.group
        pairs.restore({**state, "carried": np.pad(state["carried"], ((0, 0), (0, more)))})
    grains.pairs = pairs
    grains.sweeps.forget()
    grains.springs = springs
    for name in ("wall_spring", "plate_spring", "rectangle_spring"):
        setattr(grains, name, np.pad(getattr(grains, name), ((0, 0), (0, 0), (0, more))))
