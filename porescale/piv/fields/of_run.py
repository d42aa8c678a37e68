"""The velocity of a run's snapshot as a field, to hold measured ones against."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.record import snapshots
from porescale.common.record.model import Grid, Snapshot
from porescale.common.record.open_run import open_run
from porescale.piv.fields.field import Field
from porescale.piv.fields.surface import Surface, of_grains
from porescale.piv.images.moving import SOLID, grains_of, velocity_grid

MEASURED = "piv"
"""Name of the grid that a measured film keeps its fields in."""


def field_of_run(folder: Path, time: float | None = None) -> Field:
    """The fluid's velocity in a run folder, its uncertainty zero, or a field of a measured film, nearest to ``time`` s
    (None: the last).

    InputError where the folder holds neither.
    """
    return _field(velocity_grid(_snapshot(folder, time), str(folder)))


def moment_of_run(folder: Path, time: float | None = None) -> float:
    """The time (s) of the field that `field_of_run` gives."""
    return _snapshot(folder, time).time


def _snapshot(folder: Path, time: float | None) -> Snapshot:
    """The snapshot of a run or a measured film that is nearest to ``time`` s (None: the last); InputError where none is
    as near as they are to each other."""
    if (folder / f"{MEASURED}.vtkhdf").exists():
        found = snapshots.catalogue(folder)
        steps = list(found)
        times = np.array([next(iter(found[step].values())).time for step in steps])
        step = steps[_number(times, time, folder)]
        return snapshots.load(found[step], step)
    run = open_run(folder)
    run.require_snapshots()
    return run.snapshot(_number(run.times, time, folder))


def _number(times: Floats, time: float | None, folder: Path) -> int:
    """Which of ``times`` (n,) s is nearest to one, see _snapshot."""
    if time is None:
        return -1
    nearest = int(np.abs(times - time).argmin())
    if len(times) > 1 and abs(times[nearest] - time) > float(np.diff(times).max()):
        where = f"{times[0]:g} to {times[-1]:g}"
        raise InputError(Fault("time", time, f"is beyond what {folder} has", "s", where))
    return nearest


def surface_of_run(folder: Path, x: Floats, time: float | None = None) -> Surface | None:
    """The pile's surface at columns x, m, from the grains of a run; None for a folder without (that of a film)."""
    if (folder / f"{MEASURED}.vtkhdf").exists():
        return None
    run = open_run(folder)
    run.require_snapshots()
    snapshot = run.snapshot(-1) if time is None else run.nearest(time)
    grains = grains_of(snapshot)
    return of_grains(grains, x) if len(grains.x) else None


def fields_of_film(folder: Path) -> Iterator[Field]:
    """The fields of a measured film, in time, one in memory at a time."""
    for step, frames in snapshots.catalogue(folder).items():
        yield _field(velocity_grid(snapshots.load(frames, step), str(folder)))


def _field(grid: Grid) -> Field:
    """Cells as vectors, rows from the top down; fields of films without a scale turn back to y down."""
    ny, nx = grid.shape
    velocity = grid.cells["velocity"][::-1]
    cells = {name: it[::-1] for name, it in grid.cells.items()}
    share = cells.get("solid", cells.get("solid_fraction", np.zeros((ny, nx))))
    solid = np.asarray(share > SOLID)
    up = grid.units.get("velocity") != "px"
    sign = 1.0 if up else -1.0
    x: Floats = grid.origin[0] + (np.arange(nx, dtype=float) + 0.5) * grid.spacing[0]
    y: Floats = sign * (grid.origin[1] + (np.arange(ny, dtype=float) + 0.5) * grid.spacing[1])[::-1]
    u, v = np.asarray(velocity[..., 0], float), sign * np.asarray(velocity[..., 1], float)
    valid = np.asarray(cells["valid"] > 0) if "valid" in cells else ~solid
    none = np.full((ny, nx), np.nan)
    exact = np.where(solid, np.nan, 0.0)  # what a simulation computes has no error of measurement
    spread = np.where(valid, cells["uncertainty"], np.inf) if "uncertainty" in cells else exact
    return Field(
        x, y, np.where(solid, np.nan, u), np.where(solid, np.nan, v), valid, ~valid & ~solid, solid,
        cells.get("correlation", none), spread, upwards=up,
    )  # fmt: skip
