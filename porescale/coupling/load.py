"""Force and torque of the fluid on every grain (Noble & Torczynski 1998, with SC1's moments).

F_n = sum over its cells of B_n (j - rho u_s,n),  B_n = B e_n/sum e,  j = sum f c - (1 - B) F/2;
T_n = sum (x - X_n) x the same.  Lattice units.
"""

from porescale.coupling.coverage import inside_box
from porescale.ground.jit import parallel_kernel, prange


@parallel_kernel
def loads(
    centre, velocity, spin, patch_start, patch_width, patch, corner, reach, periodic_x, periodic_y, density, jx, jy,
    force, torque,
):  # fmt: skip
    """Overwrites force (n, 2) and torque (n,).

    patch: fractions e_n of each disc, in the cells of ``reach``;  density, jx, jy (ny, nx): rho and j times B/sum e, as
    the sweep leaves them in the solid fields.  A disc's cells are summed in one order by one thread.
    """
    ny, nx = density.shape
    for n in prange(centre.shape[0]):
        w = patch_width[n]
        fx = 0.0
        fy = 0.0
        tz = 0.0
        for j in range(w):
            y = corner[n, 1] + j
            ry = y + 0.5 - centre[n, 1]
            if periodic_y:
                y %= ny
            elif y < 0 or y >= ny:
                continue
            first, last, base = inside_box(reach[n, j, 0], reach[n, j, 1], corner[n, 0], nx, periodic_x)
            vx = velocity[n, 0] - spin[n] * ry
            for i in range(first, last):
                e = patch[patch_start[n] + j * w + i]
                rx = corner[n, 0] + i + 0.5 - centre[n, 0]
                x = base + i
                while x >= nx:
                    x -= nx
                gx = e * (jx[y, x] - density[y, x] * vx)
                gy = e * (jy[y, x] - density[y, x] * (velocity[n, 1] + spin[n] * rx))
                fx += gx
                fy += gy
                tz += rx * gy - ry * gx
        force[n, 0] = fx
        force[n, 1] = fy
        torque[n] = tz
