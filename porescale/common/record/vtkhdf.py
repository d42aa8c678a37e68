"""Temporal VTKHDF files: what ParaView >= 5.12, VTK >= 9.3 and h5py open as they are.

A grid becomes an ImageData file: ``CellData/<name>`` of shape (nt, ny, nx[, 3]), one chunk a frame.  A
cloud becomes a PolyData file whose points are vertices, or ends of lines and corners of polygons where it has some
(vtkhdf_cells.py), with ``PointData/<name>`` of shape (sum of n, ...).
Every dataset is compressed, protected by Fletcher-32 and carries its unit as attribute ``units``.  Steps,
kind and name of the frames lie in the group ``/porescale``, which VTK ignores.  Layout: the VTKHDF
specification (docs.vtk.org, "VTKHDF file format"), and what the reader needs, found by removing one item at a time.

Files are written in one go, all frame counts known beforehand; :func:`join` copies grids as compressed
chunks, so that no more than one frame is ever in memory and nothing is compressed twice.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porescale.common.core.hdf5 import writing
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud, Grid
from porescale.common.record.read_card import require_format
from porescale.common.record.vtkhdf_cells import (
    JOINED,
    NO_CELLS,
    TOPOLOGIES,
    Cells,
    cells_of,
    read_cells,
    used,
    with_cells,
)

FORMAT = 1
"""Format number that is written into these files."""
ROWS = 512, 65536
"""Rows of points in a chunk, at least and at most; in between those of a frame: frames are read one by one."""
FILTERS: dict[str, Any] = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}
"""Shuffled bytes compress as well at level 1 as plain ones at level 9, several times faster."""


@dataclass(frozen=True)
class Column:
    """One array of a file: element type, shape of one item after its frame or point axis, unit."""

    dtype: np.dtype[Any]
    item: tuple[int, ...]
    units: str


@dataclass(frozen=True)
class Frame:
    """One frame of a file: its path, index there, step, time (s) and number of points (0 for a grid)."""

    path: Path
    index: int
    step: int
    time: float
    count: int


# ---------------------------------------------------------------- writing


def write_frame(path: Path, name: str, block: Grid | Cloud, step: int, time: float) -> None:
    """A file of one frame, whole or absent.  ValueError for names, shapes, types it cannot hold."""
    with writing(path) as file:
        if isinstance(block, Grid):
            arrays = {key: _storable(key, array) for key, array in block.cells.items()}
            columns = {key: _column(key, array, block.shape, block.units) for key, array in arrays.items()}
            data = _image(file, name, block.origin, block.spacing, columns, [step], [time])
            for key, array in arrays.items():
                data[key][0] = array
        else:
            arrays = {key: _storable(key, array) for key, array in block.data.items()}
            count = len(block.position)
            columns = {key: _column(key, array, (count,), block.units) for key, array in arrays.items()}
            points, data = _points(file, name, columns, [count], [step], [time], [cells_of(block)])
            _fill(points, slice(0, count), np.pad(block.position, ((0, 0), (0, 1))))
            for key, array in arrays.items():
                _fill(data[key], slice(0, count), array)


def join(path: Path, frames: Sequence[Frame]) -> None:
    """One file of all ``frames`` (at least one, of files with equal columns), whole or absent."""
    steps, times = [frame.step for frame in frames], [frame.time for frame in frames]
    with writing(path) as file:
        with h5py.File(frames[0].path, "r") as first:
            kind, name = _kind(first), str(first["porescale"].attrs["name"])
            columns = _columns(first)
            if kind == "grids":
                origin, spacing = _geometry(first)
                data = _image(file, name, origin, spacing, columns, steps, times)
            else:
                counts = [frame.count for frame in frames]
                cells = [_cells(frame) for frame in frames]
                points, data = _points(file, name, columns, counts, steps, times, cells)
        start = 0
        for place, frame in enumerate(frames):
            with h5py.File(frame.path, "r") as source:
                if _columns(source) != columns:
                    raise ValueError(f"{frame.path} has other arrays than {frames[0].path}")
                if kind == "grids":
                    for key in columns:
                        _copy_chunk(source["VTKHDF/CellData"][key], frame.index, data[key], place)
                    continue
                rows = _rows(source, frame.index)
                to = slice(start, start + frame.count)
                _fill(points, to, source["VTKHDF/Points"][rows])
                for key in columns:
                    _fill(data[key], to, source["VTKHDF/PointData"][key][rows])
                start += frame.count


def _image(
    file: h5py.File,
    name: str,
    origin: tuple[float, float],
    spacing: tuple[float, float],
    columns: dict[str, Column],
    steps: Sequence[int],
    times: Sequence[float],
) -> h5py.Group:
    """The skeleton of an ImageData file; returns CellData, datasets (nt, ny, nx[, 3]) still empty."""
    root = _root(file, "ImageData", "grids", name, steps, times)
    ny, nx = next(iter(columns.values())).item[:2]
    root.attrs["WholeExtent"] = np.array([0, nx, 0, ny, 0, 0])
    root.attrs["Origin"] = np.array([*origin, 0.0])
    root.attrs["Spacing"] = np.array([*spacing, 1.0])
    root.attrs["Direction"] = np.eye(3).ravel()
    data = root.create_group("CellData")
    for key, column in columns.items():
        shape = (len(steps), *column.item)
        made = data.create_dataset(key, shape, column.dtype, chunks=(1, *column.item), **FILTERS)
        made.attrs["units"] = column.units
    return data


def _points(
    file: h5py.File,
    name: str,
    columns: dict[str, Column],
    counts: Sequence[int],
    steps: Sequence[int],
    times: Sequence[float],
    cells: Sequence[Cells],
) -> tuple[h5py.Dataset, h5py.Group]:
    """The skeleton of a PolyData file with its ``cells``; returns Points and PointData, still to be filled."""
    root = _root(file, "PolyData", "clouds", name, steps, times)
    n = np.array(counts, np.int64)
    before = np.cumsum(n) - n
    total, frames = int(n.sum()), len(n)
    _dataset(root, "NumberOfPoints", n)
    points = _empty(root, "Points", total, Column(np.dtype(float), (3,), "m"), frames)
    data = root.create_group("PointData")
    for key, column in columns.items():
        _empty(data, key, total, column, frames)
    firsts, befores = np.zeros((frames, 4), np.int64), np.zeros((frames, 4), np.int64)
    for side, topology in enumerate(TOPOLOGIES):
        group = root.create_group(topology)
        own = [each.get(topology, NO_CELLS) for each in cells]
        counts_of_cells = np.array([len(offsets) - 1 for offsets, _ in own], np.int64)
        counts_of_ids = np.array([len(ids) for _, ids in own], np.int64)
        _dataset(group, "NumberOfCells", counts_of_cells)
        _dataset(group, "NumberOfConnectivityIds", counts_of_ids)
        # VTK takes steps of equal CellOffsets for one and the same mesh and then reads the first one's offsets
        # (seen with 9.7): a step without cells gets room for one that it does not have, where others have some.
        used = any(topology in each for each in cells)
        room = np.maximum(counts_of_cells, 1) if used else 0 * counts_of_cells
        firsts[:, side], befores[:, side] = np.cumsum(room) - room, np.cumsum(counts_of_ids) - counts_of_ids
        index = Column(np.dtype(np.int64), (), "1")
        made_offsets = _empty(group, "Offsets", frames + int(room.sum()), index, frames)
        made_ids = _empty(group, "Connectivity", int(counts_of_ids.sum()), index, frames)
        for k, (offsets, ids) in enumerate(own if used else []):
            at, id_at = int(firsts[k, side]) + k, int(befores[k, side])
            made_offsets[at : at + len(offsets)] = offsets
            _fill(made_ids, slice(id_at, id_at + len(ids)), ids)
    series = root["Steps"]
    _dataset(series, "PartOffsets", np.arange(frames))
    _dataset(series, "PointOffsets", before)
    _dataset(series, "CellOffsets", firsts)
    _dataset(series, "ConnectivityIdOffsets", befores)
    return points, data


def _root(file: h5py.File, kind: str, ours: str, name: str, steps: Sequence[int], times: Sequence[float]) -> h5py.Group:
    """What both kinds share: type, time values, and our own group."""
    root = file.create_group("VTKHDF", track_order=True)
    root.attrs["Version"] = np.array([2, 0])
    root.attrs["Type"] = np.bytes_(kind)
    series = root.create_group("Steps")
    series.attrs["NSteps"] = len(steps)
    _dataset(series, "Values", np.array(times, float), "s")
    own = file.create_group("porescale")
    own.attrs.update({"format": FORMAT, "kind": ours, "name": name})
    _dataset(own, "step", np.array(steps, np.int64))
    return root


def _dataset(group: h5py.Group, name: str, values: AnyArray, units: str = "1") -> None:
    """Write a small dataset with a checksum and its units."""
    made = group.create_dataset(name, data=values, chunks=values.shape, fletcher32=True)
    made.attrs["units"] = units


def _empty(group: h5py.Group, name: str, rows: int, column: Column, frames: int) -> h5py.Dataset:
    """A dataset of ``rows`` items of all frames to be filled; HDF5 cannot protect one without items."""
    piece = min(rows, max(ROWS[0], min(-(-rows // max(frames, 1)), ROWS[1])))
    how: dict[str, Any] = {"chunks": (piece, *column.item), **FILTERS} if rows else {}
    made = group.create_dataset(name, (rows, *column.item), column.dtype, **how)
    made.attrs["units"] = column.units
    return made


def _fill(target: h5py.Dataset, rows: slice, values: AnyArray) -> None:
    """Write ``values`` into these rows, unless there are none."""
    if len(values):
        target[rows] = values


def _copy_chunk(source: h5py.Dataset, index: int, target: h5py.Dataset, place: int) -> None:
    """Copy one frame as it is stored: compressed, with its checksum."""
    rest = (0,) * (source.ndim - 1)
    mask, stored = source.id.read_direct_chunk((index, *rest))
    target.id.write_direct_chunk((place, *rest), stored, mask)


def _storable(name: str, array: AnyArray) -> AnyArray:
    """``array`` in a type that VTK reads: flags as uint8, half floats as float32, native byte order."""
    if not name or "/" in name or "." in name:
        raise ValueError(f"array name {name!r}: VTKHDF allows neither '/' nor '.'")
    array = np.asarray(array)
    if array.dtype.kind == "b":
        return array.astype(np.uint8)
    if array.dtype == np.float16:
        return array.astype(np.float32)
    if array.dtype.kind not in "iuf" or array.dtype.itemsize > 8:
        raise ValueError(f"array {name!r}: VTKHDF cannot hold {array.dtype}")
    return array.astype(array.dtype.newbyteorder("="), copy=False)


def _column(name: str, array: AnyArray, shape: tuple[int, ...], units: dict[str, str]) -> Column:
    """The column of one frame's ``array``, whose leading axes must be ``shape``."""
    rest = array.shape[len(shape) :]
    if array.shape[: len(shape)] != shape or rest not in ((), (3,)):
        raise ValueError(f"array {name!r} has shape {array.shape}, not {shape} or {(*shape, 3)}")
    item = array.shape if len(shape) == 2 else rest
    return Column(array.dtype, item, units.get(name) or "1")


# ---------------------------------------------------------------- reading


def frames_of(path: Path) -> list[Frame]:
    """The frames of a file, in time.  OSError when it cannot be read, KeyError when it was not written by this
    module."""
    path = Path(path)
    with open(path, "rb"):  # a folder, a lock: the system's own word, with the name, which h5py does not give
        pass
    with h5py.File(path, "r") as file:
        steps, times = file["porescale/step"][...], file["VTKHDF/Steps/Values"][...]
        grid = _kind(file) == "grids"
        counts = np.zeros_like(steps) if grid else file["VTKHDF/NumberOfPoints"][...]
    rows = zip(steps, times, counts, strict=True)
    return [Frame(path, k, int(s), float(t), int(n)) for k, (s, t, n) in enumerate(rows)]


class Reader:
    """The frames of a file, which stays open until `close`: what they have in common is read once."""

    def __init__(self, path: Path) -> None:
        self.path, self._file = path, h5py.File(path, "r")
        try:
            root, self._grid = self._file["VTKHDF"], _kind(self._file) == "grids"
            self._stored = dict(root["CellData" if self._grid else "PointData"].items())
            self._units = {key: str(item.attrs["units"]) for key, item in self._stored.items()}
            if self._grid:
                self._geometry = _geometry(self._file)
            else:
                self._points, self._joined = root["Points"], used(self._file, JOINED)
                starts = root["Steps/PointOffsets"][...].tolist(), root["NumberOfPoints"][...].tolist()
                self._rows = [slice(start, start + count) for start, count in zip(*starts, strict=True)]
        except BaseException:
            self.close()
            raise

    def frame(self, index: int, cells: Collection[str] | None = None) -> Grid | Cloud:
        """One frame; of a grid only ``cells``, if named."""
        if self._grid:
            wanted = [key for key in self._stored if cells is None or key in cells] or list(self._stored)[:1]
            arrays = {key: self._stored[key][index] for key in wanted}
            return Grid(*self._geometry, arrays, dict(self._units))
        rows = self._rows[index]
        arrays = {key: item[rows] for key, item in self._stored.items()}
        cloud = Cloud(self._points[rows][:, :2], arrays, dict(self._units))
        return with_cells(cloud, read_cells(self._file, index, self._joined))

    def close(self) -> None:
        """Close the file; no frame can be read after that."""
        self._file.close()


class Readers:
    """Context within which files of frames stay open: of each grid and cloud the one that was read last."""

    def __init__(self) -> None:
        self._open: dict[str, Reader] = {}

    def __enter__(self) -> "Readers":
        return self

    def __exit__(self, *_: object) -> None:
        for reader in self._open.values():
            reader.close()

    def of(self, name: str, path: Path) -> Reader:
        """The reader of the file at ``path``, of the grid or cloud ``name``."""
        reader = self._open.get(name)
        if reader is None or reader.path != path:
            if reader is not None:
                self._open.pop(name).close()
            reader = self._open[name] = Reader(path)
        return reader


def read_array(frame: Frame, name: str) -> AnyArray:
    """One array of a frame: of a grid (ny, nx[, 3]), of a cloud (n[, 3]), "position" (n, 3) m; or KeyError."""
    with h5py.File(frame.path, "r") as file:
        root = file["VTKHDF"]
        if _kind(file) == "grids":
            return np.asarray(root["CellData"][name][frame.index])
        return np.asarray((root["Points"] if name == "position" else root["PointData"][name])[_rows(file, frame.index)])


def _cells(frame: Frame) -> Cells:
    """The cells of one frame of a cloud's file."""
    with h5py.File(frame.path, "r") as file:
        return read_cells(file, frame.index, used(file))


def _kind(file: h5py.File) -> str:
    path = Path(file.filename)
    require_format(path.parent, path.name, file["porescale"].attrs["format"], FORMAT)
    return str(file["porescale"].attrs["kind"])


def _geometry(file: h5py.File) -> tuple[tuple[float, float], tuple[float, float]]:
    """Origin and spacing of a grid in the plane, m."""
    at = file["VTKHDF"].attrs
    (x, y, _), (dx, dy, _) = at["Origin"].tolist(), at["Spacing"].tolist()
    return (x, y), (dx, dy)


def _columns(file: h5py.File) -> dict[str, Column]:
    """Description of the arrays in a file, by name."""
    data = file["VTKHDF"]["CellData" if _kind(file) == "grids" else "PointData"]
    return {key: Column(item.dtype, item.shape[1:], str(item.attrs["units"])) for key, item in data.items()}


def _rows(file: h5py.File, index: int) -> slice:
    """Rows of the points of frame ``index`` of a cloud."""
    start = int(file["VTKHDF/Steps/PointOffsets"][index])
    return slice(start, start + int(file["VTKHDF/NumberOfPoints"][index]))
