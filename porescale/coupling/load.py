"""Force and torque of the fluid on every grain (Noble & Torczynski 1998, with SC1's moments).

F_n = sum over its cells of B_n (j - rho u_s,n),  B_n = B e_n/sum e,  j = sum f c - (1 - B) F/2;
T_n = sum (x - X_n) x the same.  Lattice units.

Each row of a disc's patch is summed when the lattice row has been collided and is still at hand; the rows are added in
order afterwards, so that loads do not depend on threads.
"""

from porescale.coupling.coverage import inside_box
from porescale.ground.jit import inline, kernel


@inline
def take_row(
    begin, end, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch, corner, reach, periodic_x,
    density, jx, jy, row_load,
):  # fmt: skip
    """Load of one collided row on the discs in it.

    density, jx, jy (nx,): rho and j times B/sum e, as collide_saturated_row leaves them;  the rest as in ``lay_row``.
    Overwrites row_load (n, largest width, 3) for these discs and rows: force along x and y, torque.
    """
    nx = density.shape[0]
    for k in range(begin, end):
        n = row_disc[k]
        j = row_line[k]
        first, last, base = inside_box(reach[n, j, 0], reach[n, j, 1], corner[n, 0], nx, periodic_x)
        at = patch_start[n] + j * patch_width[n]
        ry = corner[n, 1] + j + 0.5 - centre[n, 1]
        rx = corner[n, 0] + 0.5 - centre[n, 0]
        turning = spin[n]
        vx = velocity[n, 0] - turning * ry
        vy = velocity[n, 1] + turning * rx
        fx = 0.0
        fy = 0.0
        tz = 0.0
        while first < last:  # once, or again for what lies beyond a periodic side
            stop = min(last, nx - base)
            if first < stop:
                e = patch[at + first : at + stop]
                rho = density[base + first : base + stop]
                kx = jx[base + first : base + stop]
                ky = jy[base + first : base + stop]
                for i in range(e.shape[0]):
                    gy = e[i] * (ky[i] - rho[i] * (vy + turning * (first + i)))
                    fx += e[i] * (kx[i] - rho[i] * vx)
                    fy += gy
                    tz += (rx + (first + i)) * gy
                first = stop
            base -= nx
        row_load[n, j, 0] = fx
        row_load[n, j, 1] = fy
        row_load[n, j, 2] = tz - ry * fx


@kernel
def add_rows(corner, patch_width, reach, ny, periodic_y, row_load, force, torque):
    """Sum of the rows of every disc; overwrites force (n, 2) and torque (n,)."""
    for n in range(torque.shape[0]):
        fx = 0.0
        fy = 0.0
        tz = 0.0
        for j in range(patch_width[n]):
            y = corner[n, 1] + j
            if (periodic_y or 0 <= y < ny) and reach[n, j, 0] < reach[n, j, 1]:
                fx += row_load[n, j, 0]
                fy += row_load[n, j, 1]
                tz += row_load[n, j, 2]
        force[n, 0] = fx
        force[n, 1] = fy
        torque[n] = tz
