"""Contacts of a region: coordination, rattlers and fabric."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats
from porescale.dem.measures.contact_list import Contacts
from porescale.dem.measures.region import Period, Region
from porescale.dem.measures.stress import principal

Mask = NDArray[np.bool_]

LEAST_WITH_FRICTION, LEAST_WITHOUT = 2, 3
"""Fewest loaded contacts with which a disc can be held in two dimensions."""


def loads(contacts: Contacts) -> Mask:
    """Which contacts carry: a normal force that pushes, (c,) bool."""
    return np.greater(contacts.normal_force, 0.0)


def rattlers(contacts: Contacts, count: int, least: int = LEAST_WITH_FRICTION, held: Mask | None = None) -> Mask:
    """Discs (count,) bool with fewer than ``least`` loaded contacts, those with other rattlers not counted.

    held (count,) bool: discs that are held from outside and never rattle.  Repeated until no more fall out.
    """
    kept = contacts.chosen(loads(contacts))
    loose = np.zeros(count, bool)
    pair = kept.pairs
    while True:
        alive = ~loose[kept.first] & ~np.where(pair, loose[kept.second], False)
        found = _per_disc(kept, alive, count) < least
        if held is not None:
            found &= ~held
        if (found == loose).all():
            return loose
        loose = found | loose


def contact_numbers(contacts: Contacts, count: int) -> NDArray[np.int64]:
    """Loaded contacts of each disc, those with walls included, (count,)."""
    return _per_disc(contacts, loads(contacts), count)


def coordination(
    contacts: Contacts, region: Region, position: Floats, period: Period, loose: Mask | None = None,
    apart: Mask | None = None,
) -> float:  # fmt: skip
    """Mean number of loaded contacts of the discs whose centre lies in the region; nan where there is none.

    loose (n,) bool: discs left out, with their contacts (rattlers: the mechanical coordination number); walls count
    as neighbours.  apart (n,) bool: discs that are neighbours but not averaged over, such as held ones.
    """
    inside = region.holds(position, period)
    alive = loads(contacts)
    if loose is not None:
        inside = inside & ~loose
        alive &= ~loose[contacts.first] & ~np.where(contacts.pairs, loose[contacts.second], False)
    if apart is not None:
        inside = inside & ~apart
    if not inside.any():
        return float("nan")
    return float(_per_disc(contacts, alive, len(position))[inside].mean())


class Fabric(NamedTuple):
    """tensor (2, 2): mean of n n;  anisotropy a and angle (rad) of the density (1 + a cos 2(theta - angle))/(2 pi) that
    has this tensor;  contacts: their number in the region."""

    tensor: Floats
    anisotropy: float
    angle: float
    contacts: int


def fabric(contacts: Contacts, region: Region, period: Period = (0.0, 0.0)) -> Fabric:
    """Fabric of the loaded contacts whose point lies in the region; nan where there is none.

    Sources: Satake 1982; a = 2 (major - minor value) in two dimensions, Rothenburg & Bathurst 1989, Geotechnique 39,
    601.
    """
    chosen = contacts.chosen(loads(contacts) & region.holds(contacts.point, period))
    if not chosen.count:
        return Fabric(np.full((2, 2), np.nan), float("nan"), float("nan"), 0)
    tensor = np.einsum("ca,cb->ab", chosen.normal, chosen.normal) / chosen.count
    _, half, angle = principal(tensor)
    return Fabric(np.asarray(tensor), 4.0 * half, angle, chosen.count)


def _per_disc(contacts: Contacts, alive: Mask, count: int) -> NDArray[np.int64]:
    """How many of the contacts that are ``alive`` each disc has."""
    pair = alive & contacts.pairs
    return np.asarray(
        np.bincount(contacts.first[alive], minlength=count) + np.bincount(contacts.second[pair], minlength=count)
    )
