"""What a trade study may read of a run besides its tables: the flow field, and where its strongest vortex lies."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from porescale.common.core.types import Floats
from porescale.piv.fields.of_run import field_of_run
from porescale.piv.fields.vortices import vortices

PLACES = 24
"""Places along a side of the domain at which fields of any resolution are compared."""


def velocity_field(folder: Path, time: float | None) -> Floats:
    """(2 · PLACES²,) m/s: both components of the fluid's velocity, means over PLACES² equal parts of the domain.

    Cells inside grains count as at rest, so that every run answers at the same places.
    """
    field = field_of_run(folder, time)
    return np.concatenate([_means(np.nan_to_num(part)).ravel() for part in (field.u, field.v)])


def strongest_vortex(folder: Path, time: float | None) -> Floats:
    """(2,) m: centre of the vortex of largest circulation; empty where there is none."""
    found = vortices(field_of_run(folder, time))
    return np.array([found[0].x, found[0].y]) if found else np.zeros(0)


def _means(values: Floats) -> Floats:
    """(PLACES, PLACES) means over blocks; a cell that lies in two blocks counts in both by its shares."""
    for axis in (0, 1):
        count = values.shape[axis]
        edges = np.linspace(0.0, count, PLACES + 1)
        total = np.concatenate([np.zeros_like(values.take([0], axis)), np.cumsum(values, axis)], axis)
        at = np.minimum(edges.astype(int), count - 1)
        shares = (edges - at).reshape((-1, 1) if axis == 0 else (1, -1))
        upto = total.take(at, axis) + shares * values.take(at, axis)
        values = np.diff(upto, axis=axis) * PLACES / count
    return values


FEATURES: Mapping[str, Callable[[Path, float | None], Floats]] = {
    "velocity field": velocity_field,
    "strongest vortex": strongest_vortex,
}
"""By the names that trade.toml uses."""
