"""A cylinder that starts at full speed in unbounded fluid: vorticity and stream function on a body-fitted grid.

Half of the symmetric flow, lengths in radii, speeds in U, times in a/U, nu = 2/Re with Re = U D/nu.  With xi = ln r
    e^(2 xi) omega_t = nu (omega_xixi + omega_thth) - (psi_th omega_xi - psi_xi omega_th),
    psi_xixi + psi_thth = -e^(2 xi) omega,   omega = sum omega_n sin(n theta),  psi likewise.
Wall psi = psi_xi = 0 and uniform flow far away ask of each mode (Collins & Dennis 1973)
    integral e^((2-n) xi) omega_n dxi = -2 if n is 1, else 0,
which stands in for the unknown wall vorticity: no splitting error, no far boundary.  The grid grows with the
layer, xi = k eta with k = 2 sqrt(nu t), and w = k omega starts as -(4/sqrt(pi)) exp(-eta^2) sin(theta), so that the
singular start is smooth in sqrt(t); from `freeze` on k is held.  Chebyshev points in eta, sines in theta
(products on 3/2 as many angles), in time backward differences of second order with products extrapolated.
Drag: friction nu omega and pressure p_th = nu omega_xi at the wall.  The impulse pi integral e^(3 xi) omega_1 dxi
(Lamb, Hydrodynamics, art. 152) must lose what the cylinder gains: a measure of the drag that never looks at the wall.

Measured: with 64-96 points, 36-80 modes and 2400-4000 steps to tU/D = 4 the drag at Re 50-500 holds to 2e-6 ... 2e-5
when points and modes are cut by a quarter and steps by half.  A wake of length x is nu/x thin in angle: far downstream
the modes, not the points, give out (Re 40 needs 48 modes to tU/D = 40; with 28 the drag rises again from 30 on).
Early drag: Collins & Dennis 1973, eqs 80-81, agree; the constant pi (9 - 15/sqrt(pi))/Re' that Bar-Lev & Yang 1975
give for the pressure disagrees with the exact linear solution, pi/Re'.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline


def chebyshev(n, length, scale):
    """Points 0 ... length (half of them below about `scale`), derivative matrix and weights of the integral."""
    angle = np.pi * np.arange(n) / (n - 1)
    x = -np.cos(angle)
    c = np.ones(n)
    c[[0, -1]] = 2
    c *= (-1.0) ** np.arange(n)
    # x_i - x_j from a product of sines: no digits cancel
    diff = 2 * np.sin((angle[:, None] + angle) / 2) * np.sin((angle[:, None] - angle) / 2) + np.eye(n)
    d = np.outer(c, 1 / c) / diff
    d -= np.diag(d.sum(1))
    b = 1 + 2 * scale / length
    eta = scale * (1 + x) / (b - x)
    slope = scale * (1 + b) / (b - x) ** 2
    # weights that integrate every Chebyshev polynomial below degree n
    degree = np.arange(n)
    moment = np.where(degree % 2 == 0, 2 / (1.0 - np.where(degree % 2 == 0, degree, 0) ** 2), 0)
    weight = np.linalg.solve(np.cos(np.outer(degree, np.pi - angle)), moment)
    return eta, d / slope[:, None], weight * slope


@dataclass
class CylinderStart:
    """March with run(); after it time (in a/U), friction, pressure (shares of Cd) and impulse hold one entry a step.

    points across the layer, modes: sines; freeze: time in a/U from which the grid is held; reach: where the grid ends,
    in eta (6: exp(-36) of the wall vorticity of a thin layer); inertia False: unsteady Stokes flow.
    """

    reynolds: float
    points: int = 64
    modes: int = 48
    freeze: float = np.inf
    reach: float = 6.0
    inertia: bool = True
    time: list = field(default_factory=list)
    friction: list = field(default_factory=list)
    pressure: list = field(default_factory=list)
    impulse: list = field(default_factory=list)  # of the vorticity, along the flow, in rho U a^2

    def __post_init__(self):
        self.nu = 2 / self.reynolds
        self.eta, self.d, self.weight = chebyshev(self.points, self.reach, self.reach / 4)
        self.d2 = self.d @ self.d
        self.n = np.arange(1, self.modes + 1)
        theta = np.pi * (np.arange(3 * self.modes // 2 + 1) + 0.5) / (3 * self.modes // 2 + 1)
        self.sine, self.cosine = np.sin(np.outer(self.n, theta)), np.cos(np.outer(self.n, theta))
        self.back = self.sine.T * 2 / len(theta)
        self.w = np.zeros((self.modes, self.points))
        self.w[0] = -4 / np.sqrt(np.pi) * np.exp(-(self.eta**2))

    def stream(self, w, k):
        """Psi = psi/k of every mode: zero at the wall, beyond the last point e^(-n xi) (+ e^xi of the far flow)."""
        a = self.d2 - (self.n * k)[:, None, None] ** 2 * np.eye(self.points)
        b = -np.exp(2 * k * self.eta) * w
        a[:, 0], b[:, 0] = np.eye(self.points)[0], 0
        a[:, -1] = self.d[-1] + (self.n * k)[:, None] * np.eye(self.points)[-1]
        b[:, -1] = np.where(self.n == 1, 2 * np.exp(k * self.reach), 0)
        return np.linalg.solve(a, b[..., None])[..., 0]

    def products(self, w, k):
        """Sines of Psi_th w_eta - Psi_eta w_th."""
        if not self.inertia:
            return np.zeros_like(w)
        psi, n = self.stream(w, k), self.n[:, None]
        across = ((n * psi).T @ self.cosine) * ((w @ self.d.T).T @ self.sine)
        along = ((psi @ self.d.T).T @ self.sine) * ((n * w).T @ self.cosine)
        return ((across - along) @ self.back).T

    def implicit(self, k, lead, spread, drift, right):
        """w with  lead w - spread e^(-2 xi) (w'' - n^2 k^2 w) - drift (w + eta w') = right  and the integral above."""
        per_area = np.exp(-2 * k * self.eta)[:, None]
        one = np.eye(self.points)
        a = (lead - drift) * one - drift * self.eta[:, None] * self.d - spread * per_area * self.d2
        a = a + spread * (self.n * k)[:, None, None] ** 2 * (per_area * one)
        b = right.copy()
        a[:, 0] = self.weight * np.exp(np.outer(2 - self.n, k * self.eta))
        b[:, 0] = np.where(self.n == 1, -2, 0)
        a[:, -1], b[:, -1] = one[-1], 0
        return np.linalg.solve(a, b[..., None])[..., 0]

    def phase(self, start, stop, steps, growing):
        """Steps of equal length in sqrt(t) while the grid grows, in t once it is held."""
        clock = np.linspace(np.sqrt(start) if growing else start, np.sqrt(stop) if growing else stop, steps + 1)
        h, held = clock[1] - clock[0], 2 * np.sqrt(self.nu * min(start, self.freeze))
        old = old_product = None
        for s in clock[:-1]:
            t0, t1 = (s**2, (s + h) ** 2) if growing else (s, s + h)
            k0, k1 = (2 * np.sqrt(self.nu * t) if growing else held for t in (t0, t1))
            # rate: what multiplies dw/dclock
            rate, spread, drift, push = ((s + h) / 2, 0.25, 0.5, t1) if growing else (1.0, self.nu / held**2, 0.0, 1.0)
            product = np.exp(-2 * k0 * self.eta) * self.products(self.w, k0)
            if old is None:
                lead, known, extrapolated = rate / h, rate / h * self.w, product
            else:
                lead, known = 1.5 * rate / h, rate / h * (2 * self.w - 0.5 * old)
                extrapolated = 2 * product - old_product
            old, old_product = self.w, product
            self.w = self.implicit(k1, lead, spread, drift, known - push * extrapolated)
            self.time.append(t1)
            self.friction.append(-np.pi * self.nu * self.w[0, 0] / k1)
            self.pressure.append(np.pi * self.nu * self.d[0] @ self.w[0] / k1**2)
            self.impulse.append(np.pi * self.weight @ (np.exp(3 * k1 * self.eta) * self.w[0]))

    def run(self, end, steps):
        """March to time `end` (a/U): `steps` while the grid grows, then steps in time as long as the last of those."""
        grown = min(end, self.freeze)
        self.phase(0.0, grown, steps, growing=True)
        if end > grown:
            self.phase(grown, end, int(np.ceil((end - grown) * steps / (2 * grown))), growing=False)
        return self

    def drag(self, time):
        """Cd = force/(rho U^2 D/2) at times in a/U."""
        total = np.array(self.friction) + np.array(self.pressure)
        # sqrt(t) Cd against sqrt(t) is smooth where Cd is not
        root = np.sqrt(self.time)
        return CubicSpline(root, root * total)(np.sqrt(time)) / np.sqrt(time)
