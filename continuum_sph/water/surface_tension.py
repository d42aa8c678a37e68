"""Surface tension between two fluids as a force on a smoothed interface, with the pressure σ/R of Young and Laplace.

The colour c, 0 and 1, is averaged over the kernel, so that normals ∇c/|∇c| are smooth; curvature κ is their divergence,
corrected (Bonet & Lok 1999) for the partners that have no normal: the interface is a strip, and plain sums take its
missing sides for curvature.  That of the strip's outer rows belongs to level lines elsewhere and is noise in the
motion of the lighter fluid, so each particle takes the mean of its neighbourhood, weighted by |∇c|⁴: by the middle row.
Source: Brackbill, Kothe & Zemach, J. Comput. Phys. 100 (1992) 335; as particles Morris, Int. J. Numer. Methods Fluids
33 (2000) 333.

The force is that on a particle from a partner in the other fluid whose pressure is higher or lower by σ κ_j, summed
as pressures are: -(σ/ρ_i) Σ V_j κ_j (m_j - m_i) ∇_i W, m the numbers of the fluids.  With the partner's κ this is
-σ{∇(κ m) - m_i ∇κ}: the first part is a gradient, which pressure takes over however wide the strip is, the second the
force of a sharp interface, both to the digit for the sums that pressure has.  A smeared σ κ ∇c instead (κ_i in the
sum, or as a force of its own) turns the strip's fluids round, the lighter one most, and its power falls short by the
strip's width over R: a drop of 10 spacings in R swung a tenth too slowly.

Both sides bear the same force: weighted by density, as is often done, it would draw the heavy side's outermost row away
from the interface.  The form of Maeda & Sakai 2004, a pull within one material (eq. 54), is `Fluid.cohesion`: it has
the range of the pressure, so it changes the equation of state and has no tension that could be set.
"""

import numpy as np

from continuum_sph.water.bundles import image
from continuum_sph.water.smoothing import kernel_slope, kernel_value
from continuum_sph.water.state import BY_TENSION, RHO, VOLUME, X, Y
from porescale.common.compiled.jit import parallel_kernel, prange

SINGULAR = 0.02  # of the square of its trace: a determinant below is that of partners on one line; 0.25 is isotropic
FAINT = 0.02  # of 1/h: gradients below have no direction to rely on; those of an interface reach 0.35


@parallel_kernel
def mark(fluid, near, material, beside):
    """Overwrites ``beside`` (fluid,): 2 of particles listed with a partner of another fluid, 1 of other partners of
    theirs, 0 of all others, for which there is no interface.

    near, material: of `colours`.  Holds for as long as the list does.
    """
    for i in prange(fluid):
        own = material[i]
        other = 0
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            other |= material[near.partner[k]] ^ own
        beside[i] = 2 if other != 0 else 0
    for i in prange(fluid):
        if beside[i] != 0:
            continue
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            if beside[near.partner[k]] == 2:
                beside[i] = 1
                break


@parallel_kernel
def colours(fluid, record, near, material, beside, colour):
    """Overwrites ``colour`` (fluid,), the kernel average of the number of the fluid, 0 or 1.

    record, material: see `state.Layer`;  near: see `bundles`;  beside: of `mark`.
    """
    for i in prange(fluid):
        if beside[i] != 2:
            colour[i] = material[i]  # all its neighbours are of its own fluid
            continue
        weight = record[i, VOLUME] * kernel_value(near.kind, 0.0, near.h)
        below = weight
        above = weight * material[i]
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            weight = record[j, VOLUME] * kernel_value(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
            below += weight
            above += weight * material[j]
        colour[i] = above / below


@parallel_kernel
def normals(fluid, record, near, beside, colour, normal):
    """Overwrites ``normal`` (fluid, 3): unit normal of the interface and |∇c|, 1/m; zeros away from it.

    ∇c_i = 2 Σ V_j (c_j - c_i) ∇_i W/Σ V_j r |dW/dr|, into fluid 1.  The rest: as `colours`.
    """
    for i in prange(fluid):
        normal[i, 0] = 0.0
        normal[i, 1] = 0.0
        normal[i, 2] = 0.0
        if beside[i] == 0:
            continue
        cx = 0.0
        cy = 0.0
        below = 0.0
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            distance2 = dx * dx + dy * dy
            part = record[j, VOLUME] * kernel_slope(near.kind, np.sqrt(distance2) / near.h, near.h)
            below -= part * distance2
            part *= colour[j] - colour[i]
            cx += part * dx
            cy += part * dy
        size = np.sqrt(cx * cx + cy * cy)
        if below > 0.0 and 2.0 * size * near.h > FAINT * below:
            normal[i, 0] = cx / size
            normal[i, 1] = cy / size
            normal[i, 2] = 2.0 * size / below


@parallel_kernel
def curvatures(fluid, record, near, normal, curvature):
    """Overwrites ``curvature`` (fluid,) 1/m, the divergence of ``normal``; 0 where that has no value.

    κ = Σ V_j (n_j - n_i) · L_i ∇_i W, L_i⁻¹ = Σ V_j (x_j - x_i) ⊗ ∇_i W, over partners with a normal;  the rest: as
    `colours`.
    """
    for i in prange(fluid):
        curvature[i] = 0.0
        if normal[i, 2] == 0.0:
            continue
        xx = 0.0
        xy = 0.0
        yy = 0.0
        gxx = 0.0
        gxy = 0.0
        gyy = 0.0
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            if normal[j, 2] == 0.0:
                continue
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            part = record[j, VOLUME] * kernel_slope(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
            px = part * dx
            py = part * dy
            xx -= px * dx
            xy -= px * dy
            yy -= py * dy
            nx = normal[j, 0] - normal[i, 0]
            ny = normal[j, 1] - normal[i, 1]
            gxx += nx * px
            gxy += nx * py + ny * px
            gyy += ny * py
        whole = xx * yy - xy * xy
        if whole > SINGULAR * (xx + yy) * (xx + yy):
            curvature[i] = (yy * gxx - xy * gxy + xx * gyy) / whole


@parallel_kernel
def middle_curvatures(fluid, record, near, normal, curvature, middle):
    """Overwrites ``middle`` (fluid,) 1/m, Σ V_j W |∇c|_j⁴ κ_j/Σ V_j W |∇c|_j⁴ over what has a ``curvature``.

    0 away from the interface.  The rest: as `curvatures`.
    """
    for i in prange(fluid):
        middle[i] = 0.0
        if normal[i, 2] == 0.0:
            continue
        above = 0.0
        below = 0.0
        if curvature[i] != 0.0:
            below = record[i, VOLUME] * kernel_value(near.kind, 0.0, near.h) * (near.h * normal[i, 2]) ** 4
            above = below * curvature[i]
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            if curvature[j] == 0.0:
                continue
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            weight = record[j, VOLUME] * kernel_value(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
            weight *= (near.h * normal[j, 2]) ** 4
            above += weight * curvature[j]
            below += weight
        if below > 0.0:
            middle[i] = above / below


@parallel_kernel
def pull_interface(fluid, record, near, material, beside, middle, matrix, tension, acceleration, mass, v, power):
    """Adds -(σ/ρ_i) Σ V_j κ_j (m_j - m_i) (L_i + L_j)/2 ∇_i W to ``acceleration`` (fluid, 2) m/s²; overwrites its power
    in ``power`` (fluid, 6) W/m, None without a budget.

    beside: of `mark`;  middle: κ;  matrix: L, see Layer, None for plain gradients, as of pressures;  tension σ, N/m;
    mass (n,) kg/m;  v (n, 2) m/s;  the rest: as `colours`.
    """
    for i in prange(fluid):
        if beside[i] != 2:
            if power is not None:
                power[i, BY_TENSION] = 0.0
            continue
        ax = 0.0
        ay = 0.0
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            if material[j] == material[i]:
                continue
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            part = record[j, VOLUME] * kernel_slope(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
            part *= (material[i] - material[j]) * middle[j]
            tx = dx
            ty = dy
            if matrix is not None:
                lxy = 0.5 * (matrix[i, 1] + matrix[j, 1])
                tx = 0.5 * (matrix[i, 0] + matrix[j, 0]) * dx + lxy * dy
                ty = lxy * dx + 0.5 * (matrix[i, 2] + matrix[j, 2]) * dy
            ax += part * tx
            ay += part * ty
        ax *= tension / record[i, RHO]
        ay *= tension / record[i, RHO]
        acceleration[i, 0] += ax
        acceleration[i, 1] += ay
        if power is not None:
            power[i, BY_TENSION] = mass[i] * (ax * v[i, 0] + ay * v[i, 1])
