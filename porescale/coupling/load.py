"""Force and torque of the fluid on every grain (Noble & Torczynski 1998, with SC1's moments).

F_n = sum over its cells of B_n (j - rho u_s,n),  j = sum f c - (1 - B) F/2;   T_n = sum (x - X_n) x the same.
Lattice units.
"""

from porescale.ground.jit import parallel_kernel, prange


@parallel_kernel
def loads(
    centre, velocity, spin, patch_start, patch_width, patch, corner, periodic_x, periodic_y, density, jx, jy, force,
    torque,
):  # fmt: skip
    """Overwrites force (n, 2) and torque (n,).

    patch: each disc's share of the weights;  density, jx, jy (ny, nx): what the sweep left in the solid fields.
    A disc's cells are summed in one order by one thread.
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
            for i in range(w):
                b = patch[patch_start[n] + j * w + i]
                if b > 0:
                    x = corner[n, 0] + i
                    rx = x + 0.5 - centre[n, 0]
                    if periodic_x:
                        x %= nx
                    gx = b * (jx[y, x] - density[y, x] * (velocity[n, 0] - spin[n] * ry))
                    gy = b * (jy[y, x] - density[y, x] * (velocity[n, 1] + spin[n] * rx))
                    fx += gx
                    fy += gy
                    tz += rx * gy - ry * gx
        force[n, 0] = fx
        force[n, 1] = fy
        torque[n] = tz
