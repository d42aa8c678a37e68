"""Snapshots as pyvista objects, which are VTK's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from porescale.common.core.extras import extra
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.vtkhdf_cells import cells_of

if TYPE_CHECKING:
    import pyvista


def blocks(snapshot: Snapshot) -> pyvista.MultiBlock:
    """The MultiBlock of `Run.vtk`: an ImageData for each grid, a PolyData for each cloud, by name."""
    pv = extra("pyvista")
    made = pv.MultiBlock()
    for _, name, block in snapshot.blocks():
        made[name] = found = _image(block) if isinstance(block, Grid) else _points(block)
        found.user_dict["units"] = {key: block.units.get(key) or "1" for key in [*found.cell_data, *found.point_data]}
        for data in (found.cell_data, found.point_data):
            for key in data:
                array = data.VTKObject.GetAbstractArray(key)
                array.GetInformation().Set(array.UNITS_LABEL(), found.user_dict["units"][key])
        found.field_data["TimeValue"] = np.array([snapshot.time])
    return made


def _image(grid: Grid) -> pyvista.ImageData:
    """A grid as cells of an image in the plane z = 0."""
    ny, nx = grid.shape
    made = extra("pyvista").ImageData(
        dimensions=(nx + 1, ny + 1, 1), spacing=(*grid.spacing, 1.0), origin=(*grid.origin, 0.0)
    )
    for name, values in grid.cells.items():
        made.cell_data[name] = values.reshape(ny * nx, *values.shape[2:])
    return made


def _points(cloud: Cloud) -> pyvista.PolyData:
    """A cloud as points: vertices, or ends of its lines and corners of its polygons."""
    made = extra("pyvista").PolyData()
    made.points = np.pad(np.asarray(cloud.position, float), ((0, 0), (0, 1)))
    names = {"Vertices": "verts", "Lines": "lines", "Polygons": "faces"}
    for topology, (offsets, ids) in cells_of(cloud).items():
        if len(offsets) > 1:
            setattr(made, names[topology], np.insert(ids, offsets[:-1], np.diff(offsets)))
    for name, values in cloud.data.items():
        made.point_data[name] = values
    return made
