"""Force and torque of the fluid on every body (Noble & Torczynski 1998, with SC1's moments).

F_n = sum over its cells of B_n (j - rho u_s,n),  B_n = B e_n/sum e,  j = sum f c - (1 - B) F/2;
T_n = sum (x - X_n) x the same.  Lattice units.

Each row of a body's patch is summed when the lattice row has been collided and is still at hand; the rows are added in
order afterwards, so that loads do not depend on threads.
"""

from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange, prefetch, tree_sum, unchecked_view
from porescale.coupling.coverage.rows import AHEAD, BLOCK, blocks_inside

total = tree_sum(BLOCK)


@inline
def accumulate_load_row(y, rows, patches, motion, periodic_x, ramp, scratch, partial, row_load):
    """Load of one collided row on the bodies in it.

    scratch (3, BLOCK + nx + BLOCK): rho, then j along x and y, times B/sum e, as collide_saturated_row leaves them,
    and zero beyond the box;  the rest as in ``rasterize_row``.  Overwrites partial (5 * BLOCK,), and row_load (n,
    largest height, 5) for these bodies and rows: force along x and y, torque, inside mass and its moment of inertia;
    where rims are soft, with a fourth row of scratch, the slip |u - v|, also the sums of e (1 - e) times slip and of
    e (1 - e) (partial 7 * BLOCK, row_load 7).
    """
    centre, velocity, spin, shift = motion.centre, motion.velocity, motion.spin, motion.shift
    nx = scratch.shape[1] - 2 * BLOCK
    density, jx, jy = scratch[0], scratch[1], scratch[2]
    for k in range(rows.start[y], rows.start[y + 1]):
        if k + AHEAD < rows.body.shape[0]:
            prefetch(row_load, (rows.body[k + AHEAD] * row_load.shape[1] + rows.line[k + AHEAD]) * row_load.shape[2])
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
        twist = ramp.dtype.type(shift[n, 2])
        cx = ramp.dtype.type(shift[n, 0] - shift[n, 2] * ry)
        cy0 = shift[n, 1] + shift[n, 2] * rx
        fx = 0.0
        fy = 0.0
        tz = 0.0
        mass = 0.0
        inertia = 0.0
        slipping = 0.0
        rim = 0.0
        soft = scratch.shape[0] > 3
        if periodic_x:
            base %= nx
        while base + stride > 0:  # once, or again for what lies beyond a periodic side
            first, last = blocks_inside(base, stride, nx)
            for b in range(first, last, BLOCK):
                arm = ramp.dtype.type(rx + b)
                vy = ramp.dtype.type(vy0 + spin[n] * b)
                cy = ramp.dtype.type(cy0 + shift[n, 2] * b)
                e = unchecked_view(patches.fraction, at + b, BLOCK)
                x = base + b + BLOCK
                rho = unchecked_view(density, x, BLOCK)
                kx = unchecked_view(jx, x, BLOCK)
                ky = unchecked_view(jy, x, BLOCK)
                for i in range(BLOCK):
                    gy = e[i] * (ky[i] - rho[i] * (vy + turning * ramp[i] + e[i] * (cy + twist * ramp[i])))
                    gx = e[i] * (kx[i] - rho[i] * (vx + e[i] * cx))
                    m = e[i] * rho[i]
                    x1 = arm + ramp[i]
                    partial[i] = gx
                    partial[BLOCK + i] = gy
                    partial[2 * BLOCK + i] = x1 * gy - height * gx
                    partial[3 * BLOCK + i] = m
                    partial[4 * BLOCK + i] = m * (x1 * x1 + height * height)
                fx += total(partial, 0)
                fy += total(partial, BLOCK)
                tz += total(partial, 2 * BLOCK)
                mass += total(partial, 3 * BLOCK)
                inertia += total(partial, 4 * BLOCK)
                if soft:
                    slip = unchecked_view(scratch[3], x, BLOCK)
                    for i in range(BLOCK):
                        edge = e[i] * (1 - e[i]) * (rho[i] > 0)  # none of what lies beyond the box
                        partial[5 * BLOCK + i] = edge * slip[i]
                        partial[6 * BLOCK + i] = edge
                    slipping += total(partial, 5 * BLOCK)
                    rim += total(partial, 6 * BLOCK)
            if not periodic_x:
                break
            base -= nx
        row_load[n, j, 0] = fx
        row_load[n, j, 1] = fy
        row_load[n, j, 2] = tz
        row_load[n, j, 3] = mass
        row_load[n, j, 4] = inertia
        if soft:
            row_load[n, j, 5] = slipping
            row_load[n, j, 6] = rim


@parallel_kernel
def add_rows(corner, height, ny, periodic_y, row_load, load, inside):
    """Sum of the rows of every body; overwrites load (n, 3), force and torque, and inside (n, 2), mass and inertia.

    Inside mass: sum of B_n rho, what of the fluid takes the body's velocity in one step.
    """
    for n in prange(load.shape[0]):
        fx = 0.0
        fy = 0.0
        tz = 0.0
        mass = 0.0
        inertia = 0.0
        for j in range(height[n]):
            y = corner[n, 1] + j
            if periodic_y or 0 <= y < ny:
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


@kernel
def sum_rim_slip(corner, height, ny, periodic_y, row_load, rim):
    """Sum of the rows of the first bodies where rims are soft; overwrites rim (n, 2), see ``accumulate_load_row``."""
    for n in range(rim.shape[0]):
        rim[n, 0] = 0.0
        rim[n, 1] = 0.0
        for j in range(height[n]):
            if periodic_y or 0 <= corner[n, 1] + j < ny:
                rim[n, 0] += row_load[n, j, 5]
                rim[n, 1] += row_load[n, j, 6]


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
