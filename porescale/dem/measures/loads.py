"""Force and moment of the discs on each wall, plate and rectangle, and of contacts on chosen discs."""

from collections.abc import Sequence

import numpy as np

from porescale.common.core.types import Floats
from porescale.dem.discs import Discs
from porescale.dem.measures.contact_list import Contacts


def on_surface(contacts: Contacts, name: str, about: tuple[float, float] = (0.0, 0.0)) -> tuple[float, float, float]:
    """Force (x, y) N/m of all discs on a surface and its moment N m/m about a point (m), counter-clockwise."""
    found = contacts.of(name)
    arm = found.point - np.asarray(about)
    moment = float(np.sum(arm[:, 0] * found.force[:, 1] - arm[:, 1] * found.force[:, 0] + found.torque[:, 1]))
    x, y = found.force.sum(axis=0)
    return float(x), float(y), moment


def on_discs(contacts: Contacts, discs: Discs, chosen: Sequence[int]) -> Floats:
    """Force (x, y) N/m and moment N m/m about its centre of all contacts on each chosen disc, (k, 3)."""
    force, torque = contacts.resultants(discs.count)
    which = np.asarray(chosen, np.int64)
    return np.column_stack((force[which], torque[which]))
