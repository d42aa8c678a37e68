"""More grains to a system at rest: it keeps its contacts, so that what rested goes on resting."""

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.neighbors.search import carry
from porescale.dem.discs import FIELDS, Discs
from porescale.dem.forces.walls import HIGH, LOW, VELOCITY, Plate, X
from porescale.dem.grains import Grains


def together(*parts: Discs) -> Discs:
    """All discs of ``parts`` (at least one), in their order; everything is copied."""
    return Discs(*(np.concatenate([getattr(part, name) for part in parts]) for name in FIELDS))


def joined(grains: Grains, more: Discs, skin: float | None = None) -> Grains:
    """A new system of ``grains`` followed by ``more``: same laws, box and plates, clock at zero.

    The tangential springs of pairs, walls and plates, the forces on walls and plates and the external loads of
    ``grains`` are kept (m, N/m, N m/m); those of ``more`` start at zero.  Its pair list is up to date.  skin : as for
    Grains.
    """
    if grains.steered:
        raise InputError(
            Fault("grains", "clumps, controls or a strained cell", "join them before", repair="join first")
        )
    count = grains.discs.count
    plates = [
        Plate(row[X], row[LOW], row[HIGH], row[VELOCITY], friction, name)
        for row, friction, name in zip(grains.plates, grains.plate_frictions, grains.plate_names, strict=True)
    ]
    every = together(grains.discs, more)
    new = Grains(every, grains.law, grains.box, wall_law=grains.wall_law, plates=plates, skin=skin)
    new.plates[:] = grains.plates  # one may have been removed
    new.wall_spring[:, :count], new.plate_spring[:, :count] = grains.wall_spring, grains.plate_spring
    new.wall_force[:], new.plate_force[:] = grains.wall_force, grains.plate_force
    new.external_force[:count], new.external_torque[:count] = grains.external_force, grains.external_torque
    new.refresh()
    # The old list has no pairs of the added discs: rows without partners.  A half list names a pair at its
    # lower index, so the rows of the old discs hold every old pair.
    old = grains.pairs
    rows = np.concatenate([old.start, np.full(more.count, old.start[-1])])
    carry(rows, old.partner, old.carried, new.pairs.start, new.pairs.partner, new.pairs.carried)
    return new
