"""The pass over pairs written as its equations read: one particle after another, all others beside it, dense numpy."""

import numpy as np

from continuum_sph.water.density import HYDROSTATIC, LINEAR
from continuum_sph.water.state import BY_SHIFTING, BY_WALLS, COMPRESSIBILITY, DIFFUSIVE, RHO, VISCOUS, VOLUME, VX, X
from continuum_sph.water.state import P as PRESSURE


def wendland(r, h):
    """W (1/m²) and (1/r) dW/dr (1/m⁴) within 2h."""
    rest = np.maximum(1.0 - 0.5 * r / h, 0.0)
    return 7.0 / (4.0 * np.pi * h**2) * rest**4 * (1.0 + 2.0 * r / h), -35.0 / (4.0 * np.pi * h**4) * rest**3


def seen_in_walls(layer, law, x, u, dx, walls):
    """Velocity of a particle at ``x`` relative to each of the ``walls``, ``u``, as eqs 50 and 51 have it (n, 2)."""
    point, normal = layer.facing[walls, :2], layer.facing[walls, 2:]
    wall = layer.record[walls, X : X + 2]
    behind = ((point - wall) * normal).sum(axis=1)
    before = ((wall + dx - point) * normal).sum(axis=1)
    beta = np.where(before > behind, 1.0 + behind / np.where(before > behind, before, 1.0), 2.0)
    if law.sticky:
        return beta[:, None] * u
    return u + ((beta - 1.0) * (u * normal).sum(axis=1))[:, None] * normal


def pair_sums(flow, half):
    """(acceleration, rate, XSPH's velocity, power) of fluid particles from records, matrix, slant and drift as they
    are;  half : of the step that ends, s."""
    layer, law, n = flow.layer, flow.law, flow.layer.fluid
    assert law.smoothing.name == "wendland"
    record, g = layer.record, np.array(law.gravity)
    acceleration, rate, smoothed, power = np.zeros((n, 2)), np.zeros(n), np.zeros((n, 2)), np.zeros((n, 6))
    several = len(law.fluids) > 1
    period = np.array(flow.pairs.period)
    mu = np.array([fluid.viscosity for fluid in law.fluids])[layer.material[:n] if several else np.zeros(n, int)]
    matrix = layer.matrix if law.corrected else np.tile([law.lattice, 0.0, law.lattice, 2.0], (layer.count, 1))
    brake_by = 1.0 if law.corrected else law.lattice  # of artificial viscosity, which goes along the distance
    one = [np.array([[xx, xy], [xy, yy]]) for xx, xy, yy, _ in matrix]
    for i in range(n):
        apart = record[i, X : X + 2] - record[:, X : X + 2]
        apart -= period * np.round(apart / np.where(period > 0.0, period, 1.0))
        h = (
            0.5 * (layer.lengths[i, 0] + layer.lengths[:, 0])
            if law.varied
            else np.full(layer.count, law.smoothing.length)
        )
        near = np.flatnonzero((np.hypot(*apart.T) < 2.0 * h) & (np.arange(layer.count) != i))
        j, walls = near[near < n], near[near >= n]
        rho, p, fluid = record[i, RHO], record[i, PRESSURE], law.fluids[layer.material[i] if several else 0]
        # partners in the fluid
        dx, u, hij = apart[j], record[i, VX : VX + 2] - record[j, VX : VX + 2], h[j]
        r2, approach = (dx**2).sum(axis=1), (u * dx).sum(axis=1)
        value, slope = wendland(np.sqrt(r2), hij)
        volume, mass = record[j, VOLUME], record[j, VOLUME] * record[j, RHO]
        same = layer.material[j] == layer.material[i] if several else np.full(len(j), True)
        mean = [0.5 * (one[i] + one[k]) for k in j]
        along = np.array([a @ b for a, b in zip(mean, dx, strict=True)]).reshape(-1, 2)
        change = (rho * volume * (u * along).sum(axis=1) * slope).sum()
        wanted = np.zeros(len(j))
        if law.noise == HYDROSTATIC:
            wanted = -0.5 * (record[i, COMPRESSIBILITY] + record[j, COMPRESSIBILITY]) * (dx @ g)
        elif law.noise == LINEAR:
            wanted = -0.5 * ((flow.density_gradient[i] + flow.density_gradient[j]) * dx).sum(axis=1)
        brisk = (
            np.minimum(1.0, np.abs(approach) / (law.smoothing.length * law.noise_speed))
            if law.noise_speed > 0.0
            else 1.0
        )
        strength = 2.0 * law.diffusion * law.smoothing.length * fluid.state.sound_speed
        spread = (same * strength * brisk * (rho - record[j, RHO] + wanted) * volume * slope).sum()
        both = 0.5 * (rho + record[j, RHO])
        mu_ij = hij * np.minimum(approach, 0.0) / (r2 + law.softening * hij**2)
        damp = (law.beta * mu_ij**2 - law.alpha * fluid.state.sound_speed * mu_ij) / both * mass * slope * brake_by
        braking = slope * np.array([0.5 * np.trace(a) for a in mean])
        if several:
            joint = 2.0 * mu[i] * mu[j] / np.maximum(mu[i] + mu[j], 1e-300)
            rub = (4.0 * 2.0 * joint * volume / rho * braking * approach / r2)[:, None] * dx
        else:
            rub = (2.0 * mu[i] * volume / rho * braking)[:, None] * u
        rubbed = (rub - damp[:, None] * dx).sum(axis=0)
        pull = same * 2.0 * fluid.cohesion / layer.mass[i] ** 2 * mass
        pushed = -((((p + record[j, PRESSURE]) / rho * volume - pull) * slope)[:, None] * along).sum(axis=0)
        smoothed[i] = -(law.xsph * mass / both * value) @ u
        # walls
        dx, u, mine = apart[walls], record[i, VX : VX + 2] - record[walls, VX : VX + 2], one[i]
        r2 = (dx**2).sum(axis=1)
        _, slope = wendland(np.sqrt(r2), h[walls])
        rubbing = record[i, VX : VX + 2] - layer.ghost[walls] if law.sticky and not law.images else u
        if law.images:
            u = rubbing = seen_in_walls(layer, law, record[i, X : X + 2], u, dx, walls)
        volume, along = record[walls, VOLUME], dx @ mine.T
        swept = (rho * volume * (u * along).sum(axis=1) * slope).sum()
        by_walls = -(((p + record[walls, PRESSURE]) / rho * volume * slope)[:, None] * along).sum(axis=0)
        if law.sticky:
            brake = (layer.material[walls] == 0) * 2.0 * mu[i] * volume / rho * slope * 0.5 * np.trace(mine)
            if several:
                rubbing = (4.0 * (rubbing * dx).sum(axis=1) / r2)[:, None] * dx
            rubbed += brake @ rubbing
        moved = layer.drift[i] @ flow.density_gradient[i] if law.shifting > 0.0 else 0.0
        acceleration[i] = pushed + by_walls + rubbed + g
        rate[i] = change + swept + moved + spread
        v = record[i, VX : VX + 2] + half * acceleration[i]
        work = layer.mass[i] / rho**2 * (p - half * rho / record[i, COMPRESSIBILITY] * rate[i])
        power[i, VISCOUS], power[i, DIFFUSIVE] = -layer.mass[i] * (rubbed @ v), -work * spread
        power[i, BY_WALLS] = work * swept + layer.mass[i] * (by_walls @ v)
        power[i, BY_SHIFTING] = work * moved - (layer.mass[i] * (g @ layer.drift[i]) if law.shifting > 0.0 else 0.0)
    return acceleration, rate, smoothed, power
