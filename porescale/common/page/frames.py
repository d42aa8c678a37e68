"""One snapshot of a run as a page reads it.

A frame is: the length of its head (four bytes, little endian), the head (JSON, filled up to a multiple of eight bytes),
the arrays of `quantise` one after the other.  The head says time, step, and of every grid and cloud where its arrays
lie.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.core.picked import every_so_many
from porescale.common.page.quantise import ALIGNED, Packed, Precision
from porescale.common.record.card import plain
from porescale.common.record.model import Cloud, Grid, Snapshot

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.core.types import AnyArray
    from porescale.common.pictures.look import Line, Look

FINE = Precision()


def frame(run: Run, i: int, precision: Precision = FINE, first: Snapshot | None = None) -> bytes:
    """Frame ``i`` of what a page holds of a run: snapshot ``precision.thin * i`` (the last one at the end).

    first : the first frame's snapshot: what has not changed since is not repeated.  IndexError beyond the last,
    InputError when the file is damaged.
    """
    k = every_so_many(len(run), precision.thin)[i]
    return pack(run.snapshot(k), run.program.look(run), precision, first if i else None)


def pack(snapshot: Snapshot, look: Look, precision: Precision, first: Snapshot | None = None) -> bytes:
    """A snapshot as the bytes of a frame."""
    packed = Packed(bytearray())
    head: dict[str, Any] = {"time": snapshot.time, "step": snapshot.step}
    head["lines"] = _ends(look.lines_at(snapshot))
    head["marks"] = _ends(look.marks_at(snapshot))
    head["grids"] = {
        name: _grid(packed, grid, precision, first.grids.get(name) if first else None)
        for name, grid in snapshot.grids.items()
    }
    head["clouds"] = {
        name: _cloud(packed, cloud, precision, first.clouds.get(name) if first else None)
        for name, cloud in snapshot.clouds.items()
    }
    text = json.dumps(plain(head), separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-(4 + len(text)) % ALIGNED)
    return struct.pack("<I", len(text)) + text + bytes(packed.content)


def _ends(lines: Iterable[Line]) -> list[list[float]]:
    """Lines as [x, y, x, y] m."""
    return [[float(value) for point in line for value in point] for line in lines]


def _grid(packed: Packed, grid: Grid, precision: Precision, first: Grid | None) -> dict[str, Any]:
    """Cells: every so many-th, the middle one of those that it stands for."""
    every = min(precision.every, *grid.shape)
    at = slice(every // 2, None, every)
    arrays = {}
    for name, values in grid.cells.items():
        same = first is not None and _equal(values, first.cells[name])
        shown = values[at, at]
        arrays[name] = {"same": 1} if same else packed.add(shown, precision.bits, cells=True, full=precision.full)
    ny, nx = next(iter(grid.cells.values()))[at, at].shape[:2]
    return {"origin": grid.origin, "spacing": grid.spacing, "every": every, "first": every // 2, "shape": [ny, nx],
            "extent": grid.extent, "arrays": arrays}  # fmt: skip


def _cloud(packed: Packed, cloud: Cloud, precision: Precision, first: Cloud | None) -> dict[str, Any]:
    """Points, with lines and polygons between them."""

    def added(name: str, values: AnyArray) -> dict[str, Any]:
        """Where an array lies; nothing is added for one that is that of the first frame."""
        old = None if first is None else first.position if name == "position" else first.data[name]
        if old is not None and _equal(values, old):
            return {"same": 1}
        return packed.add(values, 16, cells=False, full=precision.full)

    arrays = {name: added(name, values) for name, values in {"position": cloud.position, **cloud.data}.items()}
    found: dict[str, Any] = {"count": len(cloud.position), "arrays": arrays}
    if cloud.lines is not None and len(cloud.lines):
        found["lines"] = packed.add(cloud.lines, 32, cells=False, full=False)
        found["line_count"] = len(cloud.lines)
    if cloud.polygons is not None and len(cloud.polygons[1]):
        offsets, corners = cloud.polygons
        found["offsets"] = packed.add(offsets, 32, cells=False, full=False)
        found["corners"] = packed.add(corners, 32, cells=False, full=False)
        found["loop_count"], found["corner_count"] = len(offsets) - 1, len(corners)
    return found


def _equal(values: AnyArray, old: AnyArray) -> bool:
    """Whether an array is that of the first frame, in every bit."""
    return values.shape == old.shape and np.array_equal(values, old)


@cache
def colour_maps() -> dict[str, str]:
    """Perceptual colour maps of matplotlib, 256 RGB bytes each, in base64."""
    from base64 import b64encode

    from porescale.common.pictures.look import colour_table

    names = ("viridis", "cividis", "magma", "RdBu_r", "PuOr_r")
    return {name: b64encode(colour_table(name).tobytes()).decode() for name in names}
