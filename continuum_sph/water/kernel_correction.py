"""What the neighbourhood of a particle lacks: moments of its kernel sums, and the gradient corrected by them.

M_i = Σ V_j (x_j - x_i) ⊗ ∇_i W is the unit tensor when the sums are exact; its trace is 2 inside and about 1.3 on a
free surface.  L_i = M_i⁻¹ makes gradients of linear fields exact: Randles & Libersky, Comput. Methods Appl. Mech.
Eng. 139 (1996) 375; Bonet & Lok, ibid. 180 (1999) 97.  A pair uses (L_i + L_j)/2 in continuity and pressure alike,
which keeps its forces opposite and its energies in balance.  Where neighbours lie on one side only M is nearly
singular: L goes over to the unit tensor as the smaller eigenvalue of M falls from FULL to NONE.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.water.fluids import alike
from continuum_sph.water.smoothing import kernel_slope, kernel_value, slope_scale, slope_shape
from continuum_sph.water.state import RHO, VOLUME, X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, nearest, nothing, root, take_rows, take_two, total
from porescale.common.neighbors.cells import minimum_image

NONE, FULL = 0.5, 0.8  # a level surface has 0.49 in its first row and 0.90 in its second
TRACE = 3
"""Column of a layer's matrix with the trace of M."""
CLUMP = 0.2
"""R of the shifting sum Σ {1 + R (W/W(spacing))⁴} V ∇W: Monaghan, J. Comput. Phys. 159 (2000) 290."""


@inline
def inverse(xx, xy, yy):
    """xx, xy, yy of L for a moment tensor M of such components."""
    half = 0.5 * (xx + yy)
    least = half - np.sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy)
    share = min(1.0, max(0.0, (least - NONE) / (FULL - NONE)))
    if share == 0.0:
        return 1.0, 0.0, 1.0
    whole = share / (xx * yy - xy * xy)
    rest = 1.0 - share
    return whole * yy + rest, -whole * xy, whole * xx + rest


@inline
def clumping(ratio):
    """1 + R ratio⁴, the weight of a pair in the shifting sum; ratio: W/W(spacing)."""
    ratio *= ratio
    return 1.0 + CLUMP * ratio * ratio


@parallel_kernel
def surroundings(
    fluid, start, split, partner, record, traits, matrix, crowd, slant, kind, h, spacing, period_x, period_y
):  # fmt: skip
    """Overwrites, of fluid particles, ``matrix`` (fluid, 4), L and the trace of M;  ``crowd`` (fluid, 2) 1/m,
    Σ {1 + R (W/W(spacing))⁴} V ∇W, which points away from where particles crowd;  ``slant`` (fluid, 2) kg/m⁴, gradient
    of density within the material, exact for linear fields.

    start, split, partner: full list, walls from ``split[i]`` on;  record: see Layer;  traits: of `rates`, None of one
    fluid;  kind, h: smoothing;  spacing of the particles, m;  periods, m or 0, or both None.  Where crowd or slant is
    not wanted it is None.
    """
    inverse_h = 1.0 / h
    scale = slope_scale(kind, h)
    whole = 1.0 / kernel_value(kind, spacing * inverse_h, h)
    turns_x = 0.0
    turns_y = 0.0
    if period_x is not None:
        turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
        turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    for i in prange(fluid):
        xi = record[i, X]
        yi = record[i, Y]
        rho = record[i, RHO]
        mxx = nothing()
        mxy = nothing()
        myy = nothing()
        nxx = nothing()
        nxy = nothing()
        nyy = nothing()
        ax = nothing()
        ay = nothing()
        bx = nothing()
        by = nothing()
        first = start[i]
        while first < split[i]:  # a particle stands for the missing end of its row, at no distance from itself
            xj, yj, _, _, rho_j, _, volume, _ = take_rows(record, partner, first, split[i], i)
            dx = xi - xj
            dy = yi - yj
            if period_x is not None:
                dx -= period_x * nearest(dx * turns_x)
                dy -= period_y * nearest(dy * turns_y)
            q = root(dx * dx + dy * dy) * inverse_h
            part = volume * scale * slope_shape(kind, q)
            px = part * dx
            py = part * dy
            mxx += px * dx
            mxy += px * dy
            myy += py * dy
            if crowd is not None:
                weight = clumping(kernel_value(kind, q, h) * whole)
                ax += weight * px
                ay += weight * py
            if slant is not None:
                if traits is not None:
                    material_j, _ = take_two(traits, partner, first, split[i], i)
                    same = alike(traits[i, 0], material_j)
                    px *= same
                    py *= same
                    nxx += px * dx
                    nxy += px * dy
                    nyy += py * dy
                bx += (rho_j - rho) * px
                by += (rho_j - rho) * py
            first += LANES
        xx = -total(mxx)
        xy = -total(mxy)
        yy = -total(myy)
        if slant is not None:
            if traits is not None:
                lxx, lxy, lyy = inverse(-total(nxx), -total(nxy), -total(nyy))
            else:
                lxx, lxy, lyy = inverse(xx, xy, yy)
            slant[i, 0] = lxx * total(bx) + lxy * total(by)
            slant[i, 1] = lxy * total(bx) + lyy * total(by)
        cx = total(ax)
        cy = total(ay)
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            if period_x is not None:
                dx = minimum_image(dx, period_x)
                dy = minimum_image(dy, period_y)
            q = np.sqrt(dx * dx + dy * dy) * inverse_h
            part = record[j, VOLUME] * kernel_slope(kind, q, h)
            px = part * dx
            py = part * dy
            xx -= px * dx
            xy -= px * dy
            yy -= py * dy
            if crowd is not None:
                weight = clumping(kernel_value(kind, q, h) * whole)
                cx += weight * px
                cy += weight * py
        lxx, lxy, lyy = inverse(xx, xy, yy)
        matrix[i, 0] = lxx
        matrix[i, 1] = lxy
        matrix[i, 2] = lyy
        matrix[i, TRACE] = xx + yy
        if crowd is not None:
            crowd[i, 0] = cx
            crowd[i, 1] = cy
