"""The sweep over the cells on the device: a thread takes a cell, whose bodies stand in the list of its tile (tiles.py),
in index order as the CPU's rows have them.

Plain functions: ``device_kernel`` of common/compiled/cuda.py compiles them for laws and a precision.
"""

from typing import Any

from porescale.common.compiled.cuda import grid
from porescale.common.compiled.jit import inline
from porescale.coupling.coverage.rows import (
    BLOCK,
    blocks_inside,
    motion_of_block,
    motion_of_body,
    motion_of_row,
    solid_velocity,
)
from porescale.coupling.device.layout import first_place, next_place
from porescale.coupling.device.tiles import TILE_HEIGHT, TILE_WIDTH
from porescale.coupling.psm_kernels import collide_saturated_cell, stretches, weights_of_cell
from porescale.coupling.solid.law import is_soft
from porescale.lbm.collision.law import collide_row
from porescale.lbm.stream import slots


def move_blocks(motion: Any, patches: Any, owners: Any) -> None:
    """``motion_of_block`` of all blocks: overwrites ``blocks``;  threads: blocks.

    In double precision, once a block, so that single precision suffices in the cells.
    """
    k = grid()
    if k < owners.block.shape[0]:
        n = owners.block[k]
        stride = patches.stride[n]
        j = (k * BLOCK - patches.start[n]) // stride
        b = k * BLOCK - patches.start[n] - j * stride
        if j < patches.height[n]:
            row = motion_of_row(j, motion_of_body(n, patches, motion))
            x, y, spin, twist, vx, cx, vy, cy = motion_of_block(b, row, patches.fraction)
            patches.blocks[k, 0], patches.blocks[k, 1] = x, y
            patches.blocks[k, 2], patches.blocks[k, 3] = spin, twist
            patches.blocks[k, 4], patches.blocks[k, 5] = vx, cx
            patches.blocks[k, 6], patches.blocks[k, 7] = vy, cy


@inline
def block_at(k, patches):
    """The block ``k`` as ``motion_of_block`` gives it."""
    b = patches.blocks
    return b[k, 0], b[k, 1], b[k, 2], b[k, 3], b[k, 4], b[k, 5], b[k, 6], b[k, 7]


@inline
def tile_extent(t, y, box, tiles, patches):
    """First column that bodies of tile ``t`` may cover of row ``y``, and one past the last; nx and 0 if none does."""
    leftmost, rightmost = box.nx, 0
    for k in range(tiles.start[t], tiles.start[t + 1]):
        n = tiles.body[k]
        j = y - patches.corner[n, 1]
        if box.periodic_y:
            j %= box.ny
        if 0 <= j < patches.height[n]:
            base, stride = patches.corner[n, 0], patches.stride[n]
            if box.periodic_x:
                base %= box.nx
            while base + stride > 0:
                first, last = blocks_inside(base, stride, box.nx)
                if first < last:
                    leftmost, rightmost = min(leftmost, base + first), max(rightmost, base + last)
                if not box.periodic_x:
                    break
                base -= box.nx
    return max(leftmost, 0), min(rightmost, box.nx)


def find_extents(box: Any, tiles: Any, patches: Any) -> None:
    """Which cells of every row are saturated, as in ``collide_partly``: overwrites ``extent``;  threads: ny.

    All bodies that reach as far to the left as any do are listed in the first tile that holds one.
    """
    y = grid()
    if y < box.ny:
        wide = (box.nx + TILE_WIDTH - 1) // TILE_WIDTH
        first = y // TILE_HEIGHT * wide
        left, right = box.nx, 0
        for t in range(first, first + wide):
            left, _ = tile_extent(t, y, box, tiles, patches)
            if left < box.nx:
                break
        for t in range(first + wide - 1, first - 1, -1):
            _, right = tile_extent(t, y, box, tiles, patches)
            if right > 0:
                break
        tiles.extent[y, 0], tiles.extent[y, 1] = stretches(left, right, box.nx)


@inline
def bodies_of_cell(x, y, t, box, tiles, patches, soft):
    """``rasterize_band`` of one cell: sums of fractions, of fraction times theta, and of fraction times velocity."""
    real = patches.fraction.dtype.type
    s, theta, sx, sy = real(0), real(0), real(0), real(0)
    for k in range(tiles.start[t], tiles.start[t + 1]):
        n = tiles.body[k]
        at = first_place(n, x, y, box, patches)
        while at >= 0:  # once, or again for what lies beyond a periodic side
            e = patches.fraction[at]
            vx, vy = solid_velocity(e, real(at % BLOCK), block_at(at // BLOCK, patches))
            s += e
            sx += e * vx
            sy += e * vy
            if soft:
                theta += e * real(patches.theta[n])
            at = next_place(at, n, box, patches)
    return s, theta, sx, sy


def sweep_tiles(f: Any, parity: Any, part: Any, box: Any, tiles: Any, patches: Any, laws: Any) -> None:
    """``collide_partly`` of the cells of some tiles: overwrites populations f, and ``gained`` where there are bodies.

    part: the first of the tiles in ``order``, and how many;  laws: of weight, solid and fluid operator;  threads: cells
    of as many tiles.
    """
    k = grid()
    tile = part[0] + k // (TILE_WIDTH * TILE_HEIGHT)
    if k // (TILE_WIDTH * TILE_HEIGHT) < part[1]:
        t, c = tiles.order[tile], k % (TILE_WIDTH * TILE_HEIGHT)
        wide = (box.nx + TILE_WIDTH - 1) // TILE_WIDTH
        x = t % wide * TILE_WIDTH + c % TILE_WIDTH
        y = t // wide * TILE_HEIGHT + c // TILE_WIDTH
        if x < box.nx and y < box.ny:
            planes = slots(f, box.nx, y + 1, parity)
            weighting, solid, law = laws
            if tiles.extent[y, 0] <= x < tiles.extent[y, 1]:
                soft = is_soft(solid)
                s, theta, sx, sy = bodies_of_cell(x, y, t, box, tiles, patches, soft)
                weights = weights_of_cell(s, weighting, solid)
                a0, a1, a2, a3, a4, a5, a6, a7, a8 = planes
                here = (a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x])
                body = (s, theta, sx * weights[0], sy * weights[0])
                g, gain, slip = collide_saturated_cell(here, body, weights, laws)
                a0[x], a2[x], a1[x], a4[x], a3[x] = g[0], g[1], g[2], g[3], g[4]
                a6[x], a5[x], a8[x], a7[x] = g[5], g[6], g[7], g[8]
                if tiles.start[t] < tiles.start[t + 1]:
                    tiles.gained[0, y, x], tiles.gained[1, y, x], tiles.gained[2, y, x] = gain
                    if soft:
                        tiles.gained[3, y, x] = slip
            else:
                collide_row(planes, x, x + 1, law)
