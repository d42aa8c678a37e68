"""Force and torque of the fluid on every body (Noble & Torczynski 1998, with SC1's moments).

F_n = sum over its cells of B_n (j - rho u_s,n),  B_n = B e_n/sum e,  j = sum f c - (1 - B) F/2;
T_n = sum (x - X_n) x the same.  Lattice units.

Each row of a body's patch is summed when the lattice row has been collided and is still at hand; the rows are added in
order afterwards, so that loads do not depend on threads.
"""

import numpy as np

from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange, prefetch
from porescale.common.compiled.simd import choose, fma, load_eight, ramp_eight, reduce_add
from porescale.coupling.coverage.rows import (
    AHEAD,
    BLOCK,
    LINE,
    SERIAL_BELOW,
    blocks_inside,
    lines_inside,
    motion_of_block,
    motion_of_body,
    motion_of_row,
    row_of,
    solid_velocity,
)


@inline
def load_of_cell(e, gained, i, block):
    """What a body that covers e of cell ``i`` of a block gains: force along x and y, torque, inside mass and its moment
    of inertia.

    gained: rho, then j along x and y, times B/sum e;  block: ``motion_of_block``.
    """
    rho, jx, jy = gained
    vx, vy = solid_velocity(e, i, block)
    gy = e * fma(-rho, vy, jy)
    gx = e * fma(-rho, vx, jx)
    m = e * rho
    x, y = block[0] + i, block[1]
    return gx, gy, x * gy - y * gx, m, m * (x * x + y * y)


@inline
def rim_of_cell(e, rho, slip):
    """e (1 - e) times the slip of a cell, and without it; none of what lies beyond the box, where rho is 0."""
    edge = choose(rho, 0.0, e - e * e, 0.0)
    return edge * slip, edge


@inline
def accumulate_load_band(band, bands, patches, motion, periodic_x, sums, row_load, soft):
    """Load of the collided rows of a band on the bodies in it.

    sums: four views (height of a band times (BLOCK + nx + BLOCK),) with rho, then j along x and y, times B/sum e, as
    collide_saturated_row leaves them, and zero beyond the box, the fourth where rims are ``soft``, the slip |u - v|;
    the rest as in ``rasterize_band``.  Overwrites row_load (n, largest height, 5) for these bodies and rows: force
    along x and y, torque, inside mass and its moment of inertia; where rims are soft also the sums of e (1 - e) times
    slip and of e (1 - e) (row_load 7).
    """
    density, jx, jy, slip = sums
    wide = density.shape[0] // bands.height
    nx = wide - 2 * BLOCK
    fraction = patches.fraction
    for k in range(bands.start[band], bands.start[band + 1]):
        if k + AHEAD < bands.start[band + 1]:
            j = max(band * bands.height - row_of(k + AHEAD, bands, patches), 0)
            soon = (bands.body[k + AHEAD] * row_load.shape[1] + j) * row_load.shape[2]
            for b in range(0, 3 * LINE, LINE):
                prefetch(row_load, soon + b)
        n = bands.body[k]
        base, stride = patches.corner[n, 0], patches.stride[n]
        body = motion_of_body(n, patches, motion)
        above = row_of(k, bands, patches) - band * bands.height
        if periodic_x:
            base %= nx
        begin, end = lines_inside(k, band, bands, patches)
        again = False
        while base + stride > 0:  # once, or again for what lies beyond a periodic side
            first, last = blocks_inside(base, stride, nx)
            at = patches.start[n] + begin * stride
            x0 = (above + begin) * wide + BLOCK + base
            for j in range(begin, end):
                row = motion_of_row(j, body)
                fx = row_load[n, j, 0] if again else 0.0
                fy = row_load[n, j, 1] if again else 0.0
                tz = row_load[n, j, 2] if again else 0.0
                mass = row_load[n, j, 3] if again else 0.0
                inertia = row_load[n, j, 4] if again else 0.0
                slipping = row_load[n, j, 5] if again and soft else 0.0
                rim = row_load[n, j, 6] if again and soft else 0.0
                for b in range(first, last, BLOCK):
                    block = motion_of_block(b, row, density)
                    e, i, x = load_eight(fraction, at + b), ramp_eight(density), x0 + b
                    rho = load_eight(density, x)
                    gx, gy, turn, m, inside = load_of_cell(e, (rho, load_eight(jx, x), load_eight(jy, x)), i, block)
                    fx += reduce_add(gx)
                    fy += reduce_add(gy)
                    tz += reduce_add(turn)
                    mass += reduce_add(m)
                    inertia += reduce_add(inside)
                    if soft:
                        slipped, edge = rim_of_cell(e, rho, load_eight(slip, x))
                        slipping += reduce_add(slipped)
                        rim += reduce_add(edge)
                row_load[n, j, 0] = fx
                row_load[n, j, 1] = fy
                row_load[n, j, 2] = tz
                row_load[n, j, 3] = mass
                row_load[n, j, 4] = inertia
                if soft:
                    row_load[n, j, 5] = slipping
                    row_load[n, j, 6] = rim
                at += stride
                x0 += wide
            if not periodic_x:
                break
            base -= nx
            again = True


@inline
def add_rows_of(n, corner, height, box, row_load, load, inside):
    """``add_rows`` of body ``n``;  box: (ny, whether y is periodic)."""
    fx = 0.0
    fy = 0.0
    tz = 0.0
    mass = 0.0
    inertia = 0.0
    for j in range(height[n]):
        if box[1] or 0 <= corner[n, 1] + j < box[0]:
            fx += row_load[n, j, 0]
            fy += row_load[n, j, 1]
            tz += row_load[n, j, 2]
            mass += row_load[n, j, 3]
            inertia += row_load[n, j, 4]
    load[n, 0] = fx
    load[n, 1] = fy
    load[n, 2] = tz
    inside[n, 0] = mass
    inside[n, 1] = inertia


@parallel_kernel
def add_rows(corner, height, ny, periodic_y, row_load, load, inside):
    """Sum of the rows of every body; overwrites load (n, 3), force and torque, and inside (n, 2), mass and inertia.

    Inside mass: sum of B_n rho, what of the fluid takes the body's velocity in one step.
    """
    if row_load.shape[0] * row_load.shape[1] < SERIAL_BELOW:
        for n in range(load.shape[0]):
            add_rows_of(n, corner, height, (ny, periodic_y), row_load, load, inside)
    else:
        for n in prange(load.shape[0]):
            add_rows_of(np.int64(n), corner, height, (ny, periodic_y), row_load, load, inside)


@inline
def sum_rim_slip_of(n, corner, height, box, row_load, rim):
    """``sum_rim_slip`` of body ``n``;  box: (ny, whether y is periodic)."""
    rim[n, 0] = 0.0
    rim[n, 1] = 0.0
    for j in range(height[n]):
        if box[1] or 0 <= corner[n, 1] + j < box[0]:
            rim[n, 0] += row_load[n, j, 5]
            rim[n, 1] += row_load[n, j, 6]


@kernel
def sum_rim_slip(corner, height, ny, periodic_y, row_load, rim):
    """Sum of the rows of the first bodies where rims are soft; overwrites rim (n, 2), see ``accumulate_load_band``."""
    for n in range(rim.shape[0]):
        sum_rim_slip_of(n, corner, height, (ny, periodic_y), row_load, rim)


@kernel
def half_step_correction(load, inside, buoyancy, share, held, shift):
    """Velocity that full cells must be given for their time-centred one to be the body's: -load/(2 inside mass).

    A cell that takes velocity v after collision has v + (what it was given in the step)/2 in mid-step.  load (n, 3),
    inside (n, 2) of the last step;  buoyancy (n, 2): the part of the load that the body force makes directly;  held
    (n, 3): the load low-passed with ``share`` a step, overwritten;  shift (n, 3): overwritten.
    """
    for n in range(load.shape[0]):
        for a in range(3):
            direct = buoyancy[n, a] if a < 2 else 0.0
            held[n, a] += share * (load[n, a] - direct - held[n, a])
            size = 2.0 * inside[n, 0 if a < 2 else 1]
            shift[n, a] = -held[n, a] / size if size > 0.0 else 0.0
