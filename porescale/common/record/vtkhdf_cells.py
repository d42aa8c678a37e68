"""What the points of a cloud make in a VTKHDF file of type PolyData: vertices, or lines and polygons.

Of each topology and step there are offsets from 0, one more than cells, and numbers of points that count within the
step; ``Steps/CellOffsets`` and ``ConnectivityIdOffsets`` (nt, 4) say where a step's begin.
"""

from collections.abc import Collection

import h5py
import numpy as np

from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud

TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")
JOINED = ("Lines", "Polygons")
"""Topologies that a cloud keeps: its vertices are its points."""
Cells = dict[str, tuple[AnyArray, AnyArray]]
"""Topology -> (offsets (c + 1,), numbers of points)."""
NO_CELLS = (np.zeros(1, np.int64), np.zeros(0, np.int64))


def cells_of(cloud: Cloud) -> Cells:
    """The cells of a cloud: its lines and polygons, or a vertex a point where it has neither.

    Raises ValueError where they name points that are not there.
    """
    count = len(cloud.position)
    if cloud.lines is None and cloud.polygons is None:
        return {"Vertices": (np.arange(count + 1), np.arange(count))}
    lines = np.zeros((0, 2), np.int64) if cloud.lines is None else np.asarray(cloud.lines, np.int64)
    found: Cells = {"Lines": (2 * np.arange(len(lines) + 1), lines.ravel())}
    if cloud.polygons is not None:
        offsets, ids = (np.asarray(part, np.int64) for part in cloud.polygons)
        found["Polygons"] = (offsets, ids)
    for name, (_, ids) in found.items():
        if len(ids) and not 0 <= int(ids.min()) <= int(ids.max()) < count:
            raise ValueError(f"{name} of a cloud of {count} points name others")
    return found


def used(file: h5py.File, among: Collection[str] = TOPOLOGIES) -> list[str]:
    """The topologies of ``among`` that have room for a cell in any step."""
    groups = {name: file["VTKHDF"][name] for name in among}
    return [name for name, it in groups.items() if it["Offsets"].shape[0] != it["NumberOfCells"].shape[0]]


def read_cells(file: h5py.File, index: int, topologies: Collection[str]) -> Cells:
    """The cells of a step, of ``topologies`` that are `used`."""
    found: Cells = {}
    root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
    for name in topologies:
        group, column = root[name], TOPOLOGIES.index(name)
        at, before = int(steps["CellOffsets"][index, column]), int(steps["ConnectivityIdOffsets"][index, column])
        cells, ids = int(group["NumberOfCells"][index]), int(group["NumberOfConnectivityIds"][index])
        offsets = group["Offsets"][at + index : at + index + cells + 1]
        found[name] = offsets, group["Connectivity"][before : before + ids]
    return found


def with_cells(cloud: Cloud, cells: Cells) -> Cloud:
    """``cloud`` with the lines and polygons that a file has."""
    if "Lines" in cells:
        cloud.lines = np.asarray(cells["Lines"][1]).reshape(-1, 2)
    if "Polygons" in cells:
        cloud.polygons = cells["Polygons"]
    return cloud
