"""What device kernels of bodies are given: arrays on the device, in bundles."""

from typing import Any, NamedTuple

from porescale.common.compiled.jit import inline


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


@inline
def first_place(n, x, y, box, patches):
    """Where in ``fraction`` the part of body ``n`` of the cell (x, y) stands, -1 where its patch does not reach."""
    i, j = x - patches.corner[n, 0], y - patches.corner[n, 1]
    if box.periodic_x:
        i %= box.nx
    if box.periodic_y:
        j %= box.ny
    if 0 <= i < patches.stride[n] and 0 <= j < patches.height[n]:
        return patches.start[n] + j * patches.stride[n] + i
    return -1


@inline
def next_place(at, n, box, patches):
    """Where its next part of that cell stands, which lies beyond a periodic side; -1 where there is none."""
    if not (box.periodic_x or box.periodic_y):
        return -1
    stride = patches.stride[n]
    j = (at - patches.start[n]) // stride
    i = at - patches.start[n] - j * stride
    if box.periodic_x and i + box.nx < stride:
        return at + box.nx
    if box.periodic_y and j + box.ny < patches.height[n]:
        return at + box.ny * stride - (i - i % box.nx if box.periodic_x else 0)
    return -1
