"""What device kernels of bodies are given: arrays on the device, in bundles."""

from typing import Any, NamedTuple


class Box(NamedTuple):
    """Cells along x and y, and whether those axes are periodic."""

    nx: int
    ny: int
    periodic_x: bool
    periodic_y: bool


class DevicePatches(NamedTuple):
    """``Patches`` of rows.py;  blocks (blocks of all patches, 8): ``motion_of_block`` of each, in the precision of the
    populations;  theta (n,): softness of the rims."""

    corner: Any
    height: Any
    stride: Any
    start: Any
    fraction: Any
    blocks: Any
    theta: Any


class Owners(NamedTuple):
    """Which body an entry belongs to: of a block of cells, of a row (with the first row of each body), and of a block
    of lines of a disc (with the first line of each disc)."""

    block: Any
    row: Any
    first_row: Any
    line: Any
    first_line: Any


class Tiles(NamedTuple):
    """``TileLists``;  extent (ny, 2): first and one past the last saturated cell of each row;  gained (3 or 4, ny, nx):
    what loads are made of, ``collide_saturated_cell``, in tiles that hold bodies."""

    start: Any
    order: Any
    body: Any
    extent: Any
    gained: Any
