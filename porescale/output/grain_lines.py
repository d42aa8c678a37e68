"""Force chains as lines for ParaView: chains.vtp, a VTK XML file of poly-lines, one along each contact that carries.

Points are the centres of the discs, or the point at a surface; cells carry normal and tangential force and whether the
contact slides (in ParaView: Tube, radius by ``normal_force``).  Layout: VTK user's guide, "XML file formats", ascii.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from porescale.common.core.atomic import write_bytes
from porescale.common.core.types import AnyArray

KINDS = {"f": "Float64", "i": "Int32", "b": "Int8"}
"""VTK's names of what arrays hold, by numpy's kind."""


def write_lines(path: Path, ends: AnyArray, data: Mapping[str, AnyArray]) -> None:
    """Write lines between ``ends`` (c, 2, 2) m with numbers (c,) for each, by name; whole or absent."""
    count = len(ends)
    points = np.zeros((2 * count, 3))
    points[:, :2] = ends.reshape(-1, 2)
    cells = [_array(name, np.asarray(values)) for name, values in data.items()]
    connectivity = _array("connectivity", np.arange(2 * count, dtype=np.int32))
    offsets = _array("offsets", 2 * np.arange(1, count + 1, dtype=np.int32))
    text = (
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n<PolyData>\n'
        f'<Piece NumberOfPoints="{2 * count}" NumberOfVerts="0" NumberOfLines="{count}" NumberOfStrips="0"'
        ' NumberOfPolys="0">\n'
        f"<Points>\n{_array('Points', points)}</Points>\n"
        f"<Lines>\n{connectivity}{offsets}</Lines>\n"
        f"<CellData>\n{''.join(cells)}</CellData>\n"
        "</Piece>\n</PolyData>\n</VTKFile>\n"
    )
    write_bytes(path, text.encode())


def _array(name: str, values: AnyArray) -> str:
    """One array (n,) or (n, 3) as an element."""
    flat = values.astype(np.int8) if values.dtype == bool else values
    kind = "b" if flat.dtype == np.int8 else flat.dtype.kind
    parts = f' NumberOfComponents="{flat.shape[1]}"' if flat.ndim > 1 else ""
    numbers = " ".join(repr(value) for value in flat.ravel().tolist())
    return f'<DataArray type="{KINDS[kind]}" Name="{name}"{parts} format="ascii">{numbers}</DataArray>\n'
