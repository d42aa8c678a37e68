"""Force and torque of the fluid on every body (Noble & Torczynski 1998, with SC1's moments).

F_n = sum over its cells of B_n (j - rho u_s,n),  B_n = B e_n/sum e,  j = sum f c - (1 - B) F/2;
T_n = sum (x - X_n) x the same.  Lattice units.

Each row of a body's patch is summed when the lattice row has been collided and is still at hand; the rows are added in
order afterwards, so that loads do not depend on threads.
"""

from porescale.coupling.coverage_rows import BLOCK, blocks_inside
from porescale.ground.jit import inline, parallel_kernel, prange


@inline
def total(p, k):
    """Sum of the BLOCK = 16 numbers from ``k`` on, by halves."""
    even = ((p[k] + p[k + 8]) + (p[k + 4] + p[k + 12])) + ((p[k + 2] + p[k + 10]) + (p[k + 6] + p[k + 14]))
    odd = ((p[k + 1] + p[k + 9]) + (p[k + 5] + p[k + 13])) + ((p[k + 3] + p[k + 11]) + (p[k + 7] + p[k + 15]))
    return even + odd


@inline
def take_row(begin, end, rows, patches, centre, velocity, spin, periodic_x, ramp, scratch, partial, row_load):
    """Load of one collided row on the bodies in it.

    scratch (3, BLOCK + nx + BLOCK): rho, then j along x and y, times B/sum e, as collide_saturated_row leaves them,
    and zero beyond the box;  the rest as in ``lay_row``.  Overwrites partial (3 * BLOCK,), and row_load (n, largest
    height, 3) for these bodies and rows: force along x and y, torque.
    """
    nx = scratch.shape[1] - 2 * BLOCK
    density, jx, jy = scratch[0], scratch[1], scratch[2]
    for k in range(begin, end):
        n = rows.body[k]
        j = rows.line[k]
        stride = patches.stride[n]
        at = patches.start[n] + j * stride
        base = patches.corner[n, 0]
        ry = patches.corner[n, 1] + j + 0.5 - centre[n, 1]
        rx = base + 0.5 - centre[n, 0]
        turning = ramp.dtype.type(spin[n])
        height = ramp.dtype.type(ry)
        vx = ramp.dtype.type(velocity[n, 0] - spin[n] * ry)
        vy0 = velocity[n, 1] + spin[n] * rx
        fx = 0.0
        fy = 0.0
        tz = 0.0
        if periodic_x:
            base %= nx
        while base + stride > 0:  # once, or again for what lies beyond a periodic side
            first, last = blocks_inside(base, stride, nx)
            for b in range(first, last, BLOCK):
                arm = ramp.dtype.type(rx + b)
                vy = ramp.dtype.type(vy0 + spin[n] * b)
                e = patches.fraction[at + b : at + b + BLOCK]
                x = base + b + BLOCK
                rho = density[x : x + BLOCK]
                kx = jx[x : x + BLOCK]
                ky = jy[x : x + BLOCK]
                for i in range(BLOCK):
                    gy = e[i] * (ky[i] - rho[i] * (vy + turning * ramp[i]))
                    gx = e[i] * (kx[i] - rho[i] * vx)
                    partial[i] = gx
                    partial[BLOCK + i] = gy
                    partial[2 * BLOCK + i] = (arm + ramp[i]) * gy - height * gx
                fx += total(partial, 0)
                fy += total(partial, BLOCK)
                tz += total(partial, 2 * BLOCK)
            if not periodic_x:
                break
            base -= nx
        row_load[n, j, 0] = fx
        row_load[n, j, 1] = fy
        row_load[n, j, 2] = tz


@parallel_kernel
def add_rows(corner, height, ny, periodic_y, row_load, force, torque):
    """Sum of the rows of every body; overwrites force (n, 2) and torque (n,)."""
    for n in prange(torque.shape[0]):
        fx = 0.0
        fy = 0.0
        tz = 0.0
        for j in range(height[n]):
            y = corner[n, 1] + j
            if periodic_y or 0 <= y < ny:
                fx += row_load[n, j, 0]
                fy += row_load[n, j, 1]
                tz += row_load[n, j, 2]
        force[n, 0] = fx
        force[n, 1] = fy
        torque[n] = tz
