"""Water among grains, written as its derivation reads: sums over all pairs, dense numpy."""

import numpy as np


def spline(r, h):
    """Cubic spline W, 1/m²."""
    s = r / h
    inner = 2.0 / 3.0 - s**2 + 0.5 * s**3
    outer = (2.0 - s) ** 3 / 6.0
    return 15.0 / (7.0 * np.pi * h**2) * np.where(s < 1.0, inner, np.where(s < 2.0, outer, 0.0))


def separation(a, b, period):
    """Vectors from each of b (m, 2) to each of a (n, 2) in a box of ``period`` (2,), nearest image: (n, m, 2)."""
    d = a[:, None] - b[None]
    return d - period * np.round(d / period)


def shares(x, soil_x, grains, h, period):
    """ψ (n, m): share of grains that each soil particle has at each water particle; no walls."""
    d = separation(x, soil_x, period)
    return spline(np.hypot(d[..., 0], d[..., 1]), h) * grains


def wendland_gradient(d, h):
    """∇_i W (n, m, 2) of Wendland C2 for separations d (n, m, 2)."""
    q = np.hypot(d[..., 0], d[..., 1]) / h
    slope = -35.0 / (4.0 * np.pi * h**4) * np.maximum(0.0, 1.0 - 0.5 * q) ** 3
    return slope[..., None] * d


def mixture(x, v, mass, rho, p, soil_v, psi, h, period):
    """(porosity (n,), dρ_f/dt (n,), acceleration of water (n, 2), force on soil (m, 2)) of pressure alone."""
    n = 1.0 - psi.sum(axis=1)
    volume = mass / (n * rho)
    q = n[:, None] * v + psi @ soil_v
    slope = wendland_gradient(separation(x, x, period), h)
    difference = q[:, None] - q[None]
    divergence = -np.einsum("j,ija,ija->i", volume, difference, slope)
    f = -volume[:, None] * np.einsum("j,ij,ija->ia", volume, p[:, None] + p[None], slope)
    return n, -rho / n * divergence, n[:, None] * f / mass[:, None], psi.T @ f


def drag(
    v, acceleration, mass, rho, n, soil_v, soil_acceleration, soil_mass, psi, grains, inside, k, n0, gravity, seconds
):
    """Velocities of both layers after the drag of ``seconds``, one water particle after another, constant k;
    inside: share of grains of each soil particle by its own density."""
    v, soil_new = v.copy(), soil_v.copy()
    for i in range(len(v)):
        share = psi[i] / k
        resist = share.sum()
        if resist == 0.0:
            continue
        volume = mass[i] / (n[i] * rho[i])
        chi = (psi[i] / inside).sum()
        sharp = min(1.0, max(0.0, (chi - 0.2) / 0.6)) / chi
        if sharp == 0.0:
            continue
        beta = rho[i] * gravity * n[i] ** 2 * resist * sharp / (1.0 - n0)
        soil_density = (psi[i] / grains * soil_mass).sum()
        w = v[i] - share @ soil_v / resist
        a = acceleration[i] - share @ soil_acceleration / resist
        light = 1.0 / (n[i] * rho[i]) + 1.0 / soil_density
        kappa = beta * light
        after = w * np.exp(-kappa * seconds) + a * (1.0 - np.exp(-kappa * seconds)) / kappa
        impulse = volume / light * (w + a * seconds - after)
        v[i] -= impulse / mass[i]
        soil_new += np.outer(share / resist / soil_mass, impulse)
    return v, soil_new


def excess(x, volume, water, soil_x, bulk, room, h, period, let, inside):
    """e (n,) of water with ``volume`` (n,) where ``water`` (n,) is True: how much more than full of it the room about
    the soil near it is, less ``let``, 0 at least."""
    d = separation(x, soil_x, period)
    near = spline(np.hypot(d[..., 0], d[..., 1]), h)
    full = (near * np.where(water, volume, 0.0)[:, None]).sum(axis=0) / room - 1.0
    return np.where(water & (near @ bulk > inside), np.maximum(0.0, near @ (bulk * full) - let), 0.0)
