"""What the neighbourhood of a particle lacks: moments of its kernel sums, and the gradient corrected by them.

M_i = Σ V_j (x_j - x_i) ⊗ ∇_i W is the unit tensor when the sums are exact; its trace is 2 inside and about 1.3 on a
free surface.  L_i = M_i⁻¹ makes gradients of linear fields exact: Randles & Libersky, Comput. Methods Appl. Mech.
Eng. 139 (1996) 375; Bonet & Lok, ibid. 180 (1999) 97.  A pair uses (L_i + L_j)/2 in continuity and pressure alike,
which keeps its forces opposite and its energies in balance.  Where neighbours lie on one side only M is nearly
singular: L goes over to the unit tensor as the smaller eigenvalue of M falls from FULL to NONE.

The gradient of density is taken within the fluid, so walls are no partners in it, and a first row before one has half
a neighbourhood.  Where soil encloses water its L goes over to the unit tensor within WALLED only: with FULL and NONE
diffusion of what departs from a linear field (`density`), as among grains, saw a departure in the weight of water, and
moved it in the first rows before each wall, at ±0.02 k; between faces of 8 rows under a gradient of 0.05 flow was 14 to
21 % too much.  In thin water over ground few neighbours are no wall: with WALLED it stood 0.147 m deep on the crest of
a levee, in place of 0.169.

Water in the open that moves shrinks with L_i (12 to 24 % in four sloshes): plain sums push particles towards gaps twice
as hard, and lose no volume.  So among grains alone water has L_i (`seepage.mixture.open_gradients`).  Plain sums over a
lattice lack a share of their own, at any spacing; all particles have its inverse in common (`lattice_gradient`).
"""

import numpy as np

from continuum_sph.water.bundles import image, inverse_period, nearest_image, row
from continuum_sph.water.fluids import pair_fluid
from continuum_sph.water.smoothing import SUPPORT, kernel_kind, kernel_slope, kernel_value, slope_scale, slope_shape
from continuum_sph.water.state import RHO, VOLUME, X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_rows, reduce_add, sqrt, zeros

NONE, FULL = 0.5, 0.8  # a level surface has 0.49 in its first row and 0.90 in its second
SPRAY, WALLED = (NONE, FULL), (0.1, 0.25)
"""The same for the gradient of density, which walls do not continue: where water may splash, and where soil encloses
it, which has 0.49 along walls and 0.27 in a corner."""
DRAWN = 1e-4
"""Strain of a lattice from which its shear modulus is taken: what is left out is of the order of its square."""
TRACE = 3
"""Column of a layer's matrix with the trace of M."""
CLUMP = 0.2
"""R of the shifting sum Σ {1 + R (W/W(spacing))⁴} V ∇W: Monaghan, J. Comput. Phys. 159 (2000) 290."""


@inline
def inverse(xx, xy, yy, none, full):
    """xx, xy, yy of L for a moment tensor M of such components, and the share of the unit tensor in it, to which it
    goes over as the smaller eigenvalue of M falls from ``full`` to ``none``."""
    half = 0.5 * (xx + yy)
    least = half - np.sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy)
    share = min(1.0, max(0.0, (least - none) / (full - none)))
    if share == 0.0:
        return 1.0, 0.0, 1.0, 1.0
    whole = share / (xx * yy - xy * xy)
    rest = 1.0 - share
    return whole * yy + rest, -whole * xy, whole * xx + rest, rest


@inline
def lattice_gradient(kind, h, spacing):
    """1/M of a square lattice: plain sums times this have gradients that are exact on it.  1.013 of Wendland's kernel
    at h = 1.375 spacings.  kind, h (m): of the kernel;  spacing, m."""
    whole = 0.0
    reach = int(SUPPORT * h / spacing) + 1
    for column in range(-reach, reach + 1):
        for line in range(-reach, reach + 1):
            x = column * spacing
            whole -= x * x * kernel_slope(kind, np.hypot(x, line * spacing) / h, h)
    return 1.0 / (whole * spacing * spacing)


def lattice_shear(kind: int, h: float, spacing: float) -> float:
    """Shear modulus over pressure of water that rests on a square lattice, with the sums that are exact on it.

    Pairs push with the stress p M/M(lattice), M = -Σ V x ⊗ ∇W.  A lattice that is drawn out by e along its rows and
    pressed by e across has M_xx = M (1 - 2 G/p e), so water that was not stirred yet is elastic, as stiff as it
    is deep, at any spacing and speed of sound: 0.103 of Wendland's kernel at h = 1.375 spacings, 0.023 at 1.5, 0.009 at
    2.  L_i makes M the unit tensor, and that nothing.  kind, h (m): of the kernel;  spacing, m.
    """
    reach = range(-int(SUPPORT * h / spacing) - 1, int(SUPPORT * h / spacing) + 2)
    places = spacing * np.array([(i, j) for i in reach for j in reach if i or j])

    def drawn(share: float) -> float:
        """M_xx of the lattice, drawn out by a ``share`` and pressed by as much across, over its volumes' share."""
        x = places * (1.0 + share, 1.0 - share)
        r = np.hypot(*x.T)
        slopes = np.array([kernel_slope(kind, distance / h, h) for distance in r])
        return -spacing * spacing * float((x[:, 0] ** 2 * slopes).sum())

    return 0.25 * (drawn(-DRAWN) - drawn(DRAWN)) / (DRAWN * drawn(0.0))


@inline
def clumping(ratio):
    """1 + R ratio⁴, the weight of a pair in the shifting sum; ratio: W/W(spacing)."""
    ratio *= ratio
    return 1.0 + CLUMP * ratio * ratio


@parallel_kernel
def neighbourhood_moments(fluid, record, near, properties, matrix, concentration, density, enclosed, spacing):
    """Overwrites, of fluid particles, ``matrix`` (fluid, 4), L and the trace of M;  ``concentration`` (fluid, 2) 1/m,
    Σ {1 + R (W/W(spacing))⁴} V ∇W, which points to where particles are fewest;  ``density`` (fluid, 2) kg/m⁴, gradient
    of density within the fluid, exact for linear fields.  The last two are None where they have no use.

    record: see `state.Layer`;  near, properties: see `bundles`;  enclosed (fluid,): whether soil fills all that a
    particle sees before walls, or None;  spacing of the particles, m.
    """
    kind, h = kernel_kind(near.kind), near.h
    whole = 1.0 / kernel_value(kind, spacing * (1.0 / h), h)
    for at in prange(fluid):
        i = row(at)
        m, own, c, b = fluid_moments(i, record, near, properties, whole)
        bounds = SPRAY if enclosed is None or not enclosed[i] else WALLED
        store_density_gradient(density, i, chosen(properties, own, m), b, bounds)
        xx, xy, yy, cx, cy = wall_moments(i, record, near, m, c, whole)
        lxx, lxy, lyy, _ = inverse(xx, xy, yy, NONE, FULL)
        matrix[i, 0] = lxx
        matrix[i, 1] = lxy
        matrix[i, 2] = lyy
        matrix[i, TRACE] = xx + yy
        store_concentration(concentration, i, cx, cy)


@inline
def fluid_moments(i, record, near, properties, whole):
    """Sums over partners of particle i in the fluids: (M: xx, xy, yy;  the same over those of its own fluid;  the
    concentration's, 1/m, x and y;  Σ V_j (ρ_j - ρ_i) ∇_i W within its fluid, kg/m⁴, x and y).

    whole: 1/W(spacing), m²;  the rest: of `neighbourhood_moments`.
    """
    kind, h = kernel_kind(near.kind), near.h
    inverse_h, scale = 1.0 / h, slope_scale(kind, h)
    turns_x, turns_y = inverse_period(near.period_x), inverse_period(near.period_y)
    xi, yi, rho = record[i, X], record[i, Y], record[i, RHO]
    mxx, mxy, myy, nxx, nxy, nyy = zeros(), zeros(), zeros(), zeros(), zeros(), zeros()
    ax, ay, bx, by = zeros(), zeros(), zeros(), zeros()
    k, end = near.start[i], near.split[i]
    while k < end:  # a particle stands for the missing end of its row, at no distance from itself
        xj, yj, _, _, rho_j, _, volume, _ = gather_rows(record, near.partner, k, end, i)
        dx, dy = nearest_image(xi - xj, near.period_x, turns_x), nearest_image(yi - yj, near.period_y, turns_y)
        q = sqrt(dx * dx + dy * dy) * inverse_h
        part = volume * scale * slope_shape(kind, q)
        px, py = part * dx, part * dy
        mxx += px * dx
        mxy += px * dy
        myy += py * dy
        weight = clumping(kernel_value(kind, q, h) * whole)
        ax += weight * px
        ay += weight * py
        same, _ = pair_fluid(properties, near.partner, k, end, i)
        px *= same
        py *= same
        nxx += px * dx
        nxy += px * dy
        nyy += py * dy
        bx += (rho_j - rho) * px
        by += (rho_j - rho) * py
        k += LANES
    m, own = (
        (-reduce_add(mxx), -reduce_add(mxy), -reduce_add(myy)),
        (-reduce_add(nxx), -reduce_add(nxy), -reduce_add(nyy)),
    )
    return m, own, (reduce_add(ax), reduce_add(ay)), (reduce_add(bx), reduce_add(by))


@inline
def wall_moments(i, record, near, m, c, whole):
    """M (xx, xy, yy) and the concentration's sums (x, y) 1/m of `fluid_moments`, with partners in walls."""
    kind, h = kernel_kind(near.kind), near.h
    inverse_h = 1.0 / h
    xx, xy, yy = m
    cx, cy = c
    for k in range(np.uint64(near.split[i]), np.uint64(near.start[i + 1])):
        j = np.uint64(near.partner[k])
        dx, dy = image(record[i, X] - record[j, X], near.period_x), image(record[i, Y] - record[j, Y], near.period_y)
        q = np.sqrt(dx * dx + dy * dy) * inverse_h
        part = record[j, VOLUME] * kernel_slope(kind, q, h)
        px = part * dx
        py = part * dy
        xx -= px * dx
        xy -= px * dy
        yy -= py * dy
        weight = clumping(kernel_value(kind, q, h) * whole)
        cx += weight * px
        cy += weight * py
    return xx, xy, yy, cx, cy


@inline
def chosen(properties, own, m):
    """``own`` of several fluids, ``m`` of one."""
    if properties is None:
        return m
    return own


@inline
def store_density_gradient(density, i, m, b, bounds):
    """Overwrites row i of ``density`` (fluid, 2) kg/m⁴, unless it is None, with the sums ``b`` corrected by M, within
    ``bounds`` of its smaller eigenvalue."""
    if density is not None:
        lxx, lxy, lyy, _ = inverse(m[0], m[1], m[2], bounds[0], bounds[1])
        density[i, 0] = lxx * b[0] + lxy * b[1]
        density[i, 1] = lxy * b[0] + lyy * b[1]


@inline
def store_concentration(concentration, i, cx, cy):
    """Overwrites row i of ``concentration`` (fluid, 2) 1/m, unless it is None."""
    if concentration is not None:
        concentration[i, 0] = cx
        concentration[i, 1] = cy
