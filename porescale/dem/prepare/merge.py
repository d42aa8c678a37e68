"""More grains to a system at rest: it keeps its contacts, so that what rested goes on resting."""

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.neighbors.search import carry
from porescale.dem.discs import FIELDS, Discs
from porescale.dem.forces.rectangle import Rectangle
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
    return _remade(grains, together(grains.discs, more), grains.discs.count, skin)


def released(grains: Grains, discs: Discs) -> Grains:
    """A new system of ``discs``, in the places of as many first ones of ``grains``, with the springs and loads that
    these had, as in ``joined``: free, and without the frames that come after them."""
    return _remade(grains, discs, discs.count, None)


def _remade(grains: Grains, discs: Discs, count: int, skin: float | None) -> Grains:
    """A new system of ``discs``, of which the first ``count`` keep what they had as the first ones of ``grains``."""
    plates = [
        Plate(row[X], row[LOW], row[HIGH], row[VELOCITY], friction, name)
        for row, friction, name in zip(grains.plates, grains.plate_frictions, grains.plate_names, strict=True)
    ]
    new = Grains(discs, grains.law, grains.box, wall_law=grains.wall_law, plates=plates, skin=skin)
    new.plates[:] = grains.plates  # one may have been removed
    new.set_rectangles([
        Rectangle((row[0], row[1]), (row[2], row[3]), (row[4], row[5]), friction)
        for row, friction in zip(grains.rectangles.tolist(), grains.rectangle_frictions, strict=True)
    ])  # fmt: skip
    for kind in ("wall", "plate", "rectangle"):
        getattr(new, f"{kind}_spring")[:, :count] = getattr(grains, f"{kind}_spring")[:, :count, : new.springs]
        getattr(new, f"{kind}_force")[:] = getattr(grains, f"{kind}_force")
    new.external_force[:count] = grains.external_force[:count]
    new.external_torque[:count] = grains.external_torque[:count]
    new.refresh()
    # The old list has no pairs of added discs: rows without partners.  A half list names a pair at its lower index, so
    # the rows of the old discs hold every old pair.
    old = grains.pairs
    rows = np.concatenate([old.start[: count + 1], np.full(discs.count - count, old.start[count])])
    carry(rows, old.partner, old.carried, new.pairs.start, new.pairs.partner, new.pairs.carried)
    return new
