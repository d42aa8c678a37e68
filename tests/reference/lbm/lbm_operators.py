"""Collision operators, slow and obvious: dense matrices, one cell after another, whole populations in tests' order.

An operator is a change of basis M (9, 9), which may depend on the velocity, rates s (9,), equilibria and sources of the
basis:   f* = f + M^-1 (-s (M f - m_eq) + (1 - s/2) R).
MRT: Lallemand & Luo 2000 and Guo, Zheng & Shi 2002.  Central moments: De Rosis 2017, Fei & Luo 2017; equilibria and
sources from the integrals over Maxwell's distribution.  Eddy viscosity: Hou, Sterling, Chen & Doolen 1996.
"""

import math

import numpy as np

from tests.reference.lbm.lbm import C, W, equilibrium, guo

CX, CY = np.array(C, float).T
ONE, CC = np.ones(9), CX**2 + CY**2
LALLEMAND_LUO = np.array(
    [ONE, 3 * CC - 4, 4.5 * CC**2 - 10.5 * CC + 4, CX, (3 * CC - 5) * CX, CY, (3 * CC - 5) * CY, CX**2 - CY**2, CX * CY]
)
ORDERS = [(0, 0), (1, 0), (0, 1), (2, 0), (0, 2), (1, 1), (2, 1), (1, 2), (2, 2)]


def odd_rate(even, magic):
    return 1 / (0.5 + magic / (1 / even - 0.5))


def relax(f, matrix, rates, equilibria, sources):
    """One cell, (9,)."""
    change = -rates * (matrix @ f - equilibria) + (1 - rates / 2) * sources
    return f + np.linalg.solve(matrix, change)


def trt(f, rho, ux, uy, fx, fy, rate, magic):
    """The even and the odd half of every pair (Ginzburg, Verhaeghe & d'Humieres 2008) as a matrix of ones."""
    turn = np.array([[float(c == (-d[0], -d[1])) for d in C] for c in C])
    odd = odd_rate(rate, magic)
    halves = rate * (np.eye(9) + turn) / 2 + odd * (np.eye(9) - turn) / 2
    return f - halves @ (f - equilibrium(rho, ux, uy)) + guo(ux, uy, fx, fy, rate, odd)


def bgk(f, rho, ux, uy, fx, fy, rate, magic):
    return f - rate * (f - equilibrium(rho, ux, uy)) + guo(ux, uy, fx, fy, rate, rate)


def mrt(f, rho, ux, uy, fx, fy, rate, magic):
    odd = odd_rate(rate, magic)
    rates = np.array([0, 1.64, 1.54, odd, odd, odd, odd, rate, rate])
    jx, jy, uu, uf = rho * ux, rho * uy, ux**2 + uy**2, ux * fx + uy * fy
    equilibria = [
        rho, rho * (3 * uu - 2), rho * (1 - 3 * uu), jx, -jx, jy, -jy, rho * (ux**2 - uy**2), rho * ux * uy,
    ]  # fmt: skip
    sources = [0, 6 * uf, -6 * uf, fx, -fx, fy, -fy, 2 * (ux * fx - uy * fy), ux * fy + uy * fx]
    return relax(f, LALLEMAND_LUO, rates, np.array(equilibria), np.array(sources))


def central(f, rho, ux, uy, fx, fy, rate, magic):
    """Basis: central moments of ORDERS, with k_20 and k_02 replaced by their sum and difference."""
    about = {(m, n): (CX - ux) ** m * (CY - uy) ** n for m, n in ORDERS}
    basis = [about[order] for order in ORDERS]
    basis[3:5] = about[2, 0] + about[0, 2], about[2, 0] - about[0, 2]
    rates = np.array([1, 1, 1, 1, rate, rate, 1, 1, 1])
    equilibria = np.array([rho, 0, 0, 2 * rho / 3, 0, 0, 0, 0, rho / 9])
    sources = np.array([0, fx, fy, 0, 0, 0, fy / 3, fx / 3, 0])
    return relax(f, np.array(basis), rates, equilibria, sources)


OPERATORS = {"trt": trt, "mrt": mrt, "central": central, "bgk": bgk}


def eddy_rate(f, rho, ux, uy, tau, smagorinsky):
    """1/tau with the eddies of the non-equilibrium stress."""
    rest = f - equilibrium(rho, ux, uy)
    stress = np.einsum("i,ia,ib->ab", rest, np.array(C), np.array(C))
    size = math.sqrt((stress**2).sum())
    return 1 / (tau + 0.5 * (math.sqrt(tau**2 + 18 * math.sqrt(2) * smagorinsky**2 * size / rho) - tau))


def collided(name, f, tau, force, magic, smagorinsky=0.0):
    """Populations (9, ny, nx) after collision."""
    out = np.empty_like(f)
    fx, fy = force
    for at in np.ndindex(f.shape[1:]):
        cell = f[(slice(None), *at)]
        rho = cell.sum()
        ux, uy = (cell @ CX + fx / 2) / rho, (cell @ CY + fy / 2) / rho
        rate = eddy_rate(cell, rho, ux, uy, tau, smagorinsky)
        out[(slice(None), *at)] = OPERATORS[name](cell, rho, ux, uy, fx, fy, rate, magic)
    return out


def random_populations(ny, nx, seed=1, size=0.05):
    """Weights changed by up to ``size`` of themselves: far from any equilibrium."""
    random = np.random.default_rng(seed)
    return np.array(W)[:, None, None] * (1 + size * random.uniform(-1, 1, (9, ny, nx)))
