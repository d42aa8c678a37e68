"""Collision in partially saturated cells: the odd half of SC1, bounce-back of the non-equilibrium part.

SC1 (Noble & Torczynski 1998) is  Omega^s_i = f_-i - f_i + f^eq_i(rho, u_s) - f^eq_-i(rho, u)  in

    f_i* = f_i + (1 - B)(Omega_i + S_i) + B Omega^s_i

with rho u = sum f c + (1 - B) F/2: the forcing belongs inside (1 - B), or a resting disc feels a force that is not
there.  Its even half, f^eq+(u_s) - f^eq+(u), has no moment of mass or momentum, is quadratic in velocity, and nothing
relaxes it where B = 1: density and stress inside a grain drift without end (a disc spun for 20 000 steps: density 0.75,
torque 4 % down; grains at rest in a collapsing column: 0.85).  It is left out, which changes drag by less than 1e-4 and
stops the drift (0.998, torque to 1e-5).  What remains is  Omega^s_i = f_-i - f_i + 3 w_i rho c.(u_s + u).

Mass is conserved in each cell; the solid gains  B (sum f c - (1 - B) F/2 - rho u_s)  of momentum.  Where B = 0 this is
the plain operator.  Grains that share a cell act with the mean velocity of the solid in it, u_s = sum e u_s,n / sum e;
their loads use each one's own velocity and add up to the same total (load.py).
"""

from porescale.coupling.coverage import lay_row
from porescale.coupling.load import take_row
from porescale.coupling.weighting import saturation_weight
from porescale.ground.jit import inline, parallel_kernel, prange
from porescale.lbm.collision.trt import collide_row, moments, relax, targets
from porescale.lbm.stream import even_slots, odd_slots


@inline
def collide_saturated_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, s, sx, sy, first, last, k, p):
    """Collide cells ``first`` to ``last`` - 1 of a row in which grains lie.

    a_i (nx,): slots, as in collide_row;  k (1,): tau - 1/2;  p: parameters.  s, sx, sy (nx,): sum of the solid
    fractions e and of e times solid velocity; overwritten with what loads are made of, density and the first moment
    less (1 - B) F/2, both times B/sum e.
    """
    one, half, fx, fy = p[12], p[13], p[2], p[3]
    even, odd, two = p[0], p[1], p[12] + p[12]
    zero = one - one
    # Cut to the range first: an index that might be negative keeps the loop from being vectorised.
    a0, a1, a2, a3, a4 = a0[first:last], a1[first:last], a2[first:last], a3[first:last], a4[first:last]
    a5, a6, a7, a8 = a5[first:last], a6[first:last], a7[first:last], a8[first:last]
    s, sx, sy = s[first:last], sx[first:last], sy[first:last]
    for x in range(s.shape[0]):
        f0, f1, f2, f3, f4 = a0[x], a1[x], a2[x], a3[x], a4[x]
        f5, f6, f7, f8 = a5[x], a6[x], a7[x], a8[x]
        e = s[x]
        b = saturation_weight(e, k[0], one)
        free = one - b
        part = one / (e if e > zero else one)
        vx, vy = sx[x] * part, sy[x] * part
        d, jx, jy = moments(f0, f1, f2, f3, f4, f5, f6, f7, f8)
        hx = half * free * fx
        hy = half * free * fy
        rho = one + d
        lightness = one / rho
        ux, uy = (jx + hx) * lightness, (jy + hy) * lightness
        q, xx, yy, xy, mx, my = targets(d, jx + hx, jy + hy, ux, uy, p)
        br = b * rho
        mx = free * mx + br * (vx + ux)
        my = free * my + br * (vy + uy)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = relax(
            f0,
            f1,
            f2,
            f3,
            f4,
            f5,
            f6,
            f7,
            f8,
            free * even,
            free * odd + two * b,
            free * q,
            free * xx,
            free * yy,
            free * xy,
            mx,
            my,
            p,
        )
        a0[x], a2[x], a1[x], a4[x], a3[x] = g0, g1, g2, g3, g4
        a6[x], a5[x], a8[x], a7[x] = g5, g6, g7, g8
        part *= b
        s[x] = part * rho
        sx[x] = part * (jx - hx)
        sy[x] = part * (jy - hy)


@inline
def saturated_row(
    a0, a1, a2, a3, a4, a5, a6, a7, a8, begin, end, row_disc, row_line, centre, velocity, spin, patch_start,
    patch_width, patch, corner, reach, periodic_x, row_load, s, sx, sy, k, p,
):  # fmt: skip
    """One row of the lattice: lay out its discs, collide, take their loads.

    Plain fluid outside of what the discs cover.  s, sx, sy (nx,): scratch, zero before and after.
    """
    n = s.shape[0]
    left = n
    right = n
    if begin < end:
        left, right = lay_row(
            begin, end, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch, corner, reach,
            periodic_x, s, sx, sy,
        )  # fmt: skip
    if left >= right:
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, 0, n, p)
        left = right
    else:
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, 0, left, p)
        collide_saturated_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, s, sx, sy, left, right, k, p)
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, right, n, p)
    take_row(
        begin, end, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch, corner, reach,
        periodic_x, s, sx, sy, row_load,
    )  # fmt: skip
    s[left:right] = 0
    sx[left:right] = 0
    sy[left:right] = 0


@parallel_kernel
def sweep_even(
    f, band_order, height, row_start, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch,
    corner, reach, periodic_x, row_load, scratch, k, p,
):  # fmt: skip
    """Even step with grains; overwrites populations f and row_load.

    scratch (bands, 3, nx): zero before and after.  Bands of ``height`` rows are spread over the threads in
    ``band_order``; other arguments as in coverage.py and load.py.
    """
    for turn in prange(band_order.shape[0]):
        band = band_order[turn]
        for y in range(band * height, min((band + 1) * height, f.shape[1] - 2)):
            a0, a1, a2, a3, a4, a5, a6, a7, a8 = even_slots(f, y + 1)
            saturated_row(
                a0, a1, a2, a3, a4, a5, a6, a7, a8, row_start[y], row_start[y + 1], row_disc, row_line, centre,
                velocity, spin, patch_start, patch_width, patch, corner, reach, periodic_x, row_load, scratch[band, 0],
                scratch[band, 1], scratch[band, 2], k, p,
            )  # fmt: skip


@parallel_kernel
def sweep_odd(
    f, band_order, height, row_start, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch,
    corner, reach, periodic_x, row_load, scratch, k, p,
):  # fmt: skip
    """Odd step with grains; the halo must have been filled."""
    for turn in prange(band_order.shape[0]):
        band = band_order[turn]
        for y in range(band * height, min((band + 1) * height, f.shape[1] - 2)):
            a0, a1, a2, a3, a4, a5, a6, a7, a8 = odd_slots(f, y + 1)
            saturated_row(
                a0, a1, a2, a3, a4, a5, a6, a7, a8, row_start[y], row_start[y + 1], row_disc, row_line, centre,
                velocity, spin, patch_start, patch_width, patch, corner, reach, periodic_x, row_load, scratch[band, 0],
                scratch[band, 1], scratch[band, 2], k, p,
            )  # fmt: skip
