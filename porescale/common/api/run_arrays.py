"""Arrays of all snapshots of a run as an xarray Dataset, read when values are used."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.extras import extra
from porescale.common.core.types import AnyArray
from porescale.common.record.columns import missing
from porescale.common.record.model import Cloud, Grid, Snapshot

if TYPE_CHECKING:
    import xarray

    from porescale.common.record.open_run import Run

COMPONENTS = ["x", "y"]
"""Of vectors; their third one is zero."""


def block_with(snapshot: Snapshot, arrays: Sequence[str], of: str | None) -> tuple[str, Grid | Cloud]:
    """The grid or cloud ``of`` a snapshot, None: the first grid that has the arrays, or else the first cloud; and its
    name.  InputError with the nearest name where there is none.
    """
    known = {name: block for _, name, block in snapshot.blocks()}
    if of is not None and of not in known:
        raise missing("grid or cloud", of, known, "the snapshots")
    found = {name: block for name, block in known.items() if of in (None, name)}
    for name, block in found.items():
        if all(array in arrays_of(block) for array in arrays):
            return name, block
    everything = {array: None for block in found.values() for array in arrays_of(block)}
    for array in arrays:
        if array not in everything:
            raise missing("array", array, everything, "the snapshots")
    repair = "ask for those of one grid or cloud at a time"
    raise InputError(Fault("arrays", ", ".join(arrays), "are not of one grid or cloud", repair=repair))


def arrays_of(block: Grid | Cloud) -> dict[str, AnyArray]:
    """The arrays of a grid or a cloud, by name."""
    return block.cells if isinstance(block, Grid) else block.data


def dataset(run: Run, arrays: Sequence[str] | None, of: str | None) -> xarray.Dataset:
    """The Dataset of `Run.xarray`."""
    xr = extra("xarray")
    from porescale.common.api.run_lazy import lazy

    if not len(run):
        raise InputError(Fault("run folder", str(run.folder), "no snapshots", repair="let it run until its first"))
    name, block = block_with(run.snapshot(0), [arrays] if isinstance(arrays, str) else arrays or [], of)
    cells = arrays_of(block)
    wanted = list(cells) if arrays is None else [arrays] if isinstance(arrays, str) else list(arrays)
    frames = run.frames(name)
    time = {"time": ("time", run.times, {"units": "s"}), "step": ("time", run.steps)}
    made = xr.Dataset(attrs={"title": run.name, "run": str(run.folder), "of": name}, coords=time)
    axes: tuple[str, ...] = ("time", "y", "x")
    size: tuple[int, ...]
    if isinstance(block, Grid):
        (ny, nx), (dx, dy), (left, bottom) = block.shape, block.spacing, block.origin
        size = (len(run), ny, nx)
        y, x = bottom + (np.arange(ny) + 0.5) * dy, left + (np.arange(nx) + 0.5) * dx
        made = made.assign_coords(y=("y", y, {"units": "m"}), x=("x", x, {"units": "m"}))
    else:
        axes, size = ("time", "point"), (len(run), max(frame.count for frame in frames))
        for k, axis in enumerate(COMPONENTS):
            place = lazy(run.folder, frames, "position", size, np.dtype(float), k)
            made = made.assign_coords({axis: (axes, place, {"units": "m"})})
    even = isinstance(block, Grid) or len({frame.count for frame in frames}) == 1
    for key in wanted:
        values = cells[key]
        vector = values.ndim == len(axes)
        shape = (*size, len(COMPONENTS)) if vector else size
        kind = values.dtype if even or values.dtype.kind == "f" else np.dtype(float)
        if vector:
            made = made.assign_coords(component=COMPONENTS)
        dims = (*axes, "component") if vector else axes
        place = lazy(run.folder, frames, key, shape, kind, slice(len(COMPONENTS)) if vector else None)
        made[key] = (dims, place, {"units": block.units.get(key, "1")})
    return made
