"""Steady flows of a synthetic pair, in pixels and frame intervals, and how far they carry material exactly.

A displacement is X(+1/2) - X(-1/2) of the material at the pixel at mid time: paths are integrated, not straight.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.schema.messages import nearest

Velocity = Callable[[Floats, Floats], tuple[Floats, Floats]]

STEPS = 24
"""Runge-Kutta steps of half an interval: a turn of one radian then errs by (1/24)^5/120 a step, 3e-9 in all."""


class Discs(NamedTuple):
    """Solids of a picture.  x, y (n,) centres, px;  radius (n,) px."""

    x: Floats
    y: Floats
    radius: Floats

    def inside(self, x: Floats, y: Floats) -> NDArray[np.bool_]:
        """Whether points lie in a disc."""
        found = np.zeros(np.broadcast(x, y).shape, bool)
        for a, b, r in zip(self.x, self.y, self.radius, strict=True):
            found |= np.hypot(x - a, y - b) < r
        return found

    def distance(self, x: Floats, y: Floats) -> Floats:
        """Distance from points to the nearest rim, px, negative inside; infinite where there is no disc."""
        found = np.full(np.broadcast(x, y).shape, np.inf)
        for a, b, r in zip(self.x, self.y, self.radius, strict=True):
            np.minimum(found, np.hypot(x - a, y - b) - r, out=found)
        return found


NO_DISCS = Discs(np.empty(0), np.empty(0), np.empty(0))


@dataclass(frozen=True)
class Flow:
    """A steady flow.  velocity : (x, y) px -> (u, v) px an interval, y down;  discs : solids, where it is at rest."""

    name: str
    velocity: Velocity
    discs: Discs = NO_DISCS

    def carried(self, x: Floats, y: Floats, time: float) -> tuple[Floats, Floats]:
        """Position of the material at x, y after ``time`` intervals: Runge-Kutta of fourth order."""
        steps = max(1, round(2 * STEPS * abs(time)))
        h = time / steps
        x, y = np.array(x, float), np.array(y, float)
        for _ in range(steps):
            u1, v1 = self.velocity(x, y)
            u2, v2 = self.velocity(x + 0.5 * h * u1, y + 0.5 * h * v1)
            u3, v3 = self.velocity(x + 0.5 * h * u2, y + 0.5 * h * v2)
            u4, v4 = self.velocity(x + h * u3, y + h * v3)
            x += h / 6 * (u1 + 2 * u2 + 2 * u3 + u4)
            y += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
        return x, y

    def displacement(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """X(+1/2) - X(-1/2) of the material that is at x, y at mid time, px."""
        (ax, ay), (bx, by) = self.carried(x, y, -0.5), self.carried(x, y, 0.5)
        return bx - ax, by - ay


def uniform(u: float, v: float) -> Flow:
    """A flow of uniform displacement (u, v), px."""
    return Flow("uniform", lambda x, y: (np.full_like(x, u), np.full_like(y, v)))


def shear(size: tuple[int, int], peak: float) -> Flow:
    """u from -peak at the top row to peak at the bottom row of a picture of ``size`` (rows, columns)."""
    middle = 0.5 * (size[0] - 1)
    return Flow("shear", lambda x, y: (peak * (y - middle) / middle, np.zeros_like(x)))


def stagnation(size: tuple[int, int], peak: float) -> Flow:
    """u = k x, v = -k y from the centre; ``peak`` is reached at the sides."""
    cx, cy = 0.5 * (size[1] - 1), 0.5 * (size[0] - 1)
    rate = peak / max(cx, cy)
    return Flow("stagnation", lambda x, y: (rate * (x - cx), -rate * (y - cy)))


def _swirl(name: str, size: tuple[int, int], spin: Callable[[Floats], Floats]) -> Flow:
    """Circular paths around the picture's centre; ``spin`` gives radians an interval at a squared radius."""
    cx, cy = 0.5 * (size[1] - 1), 0.5 * (size[0] - 1)

    def velocity(x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Spin times the distance from the centre, across it."""
        dx, dy = x - cx, y - cy
        turn = spin(dx * dx + dy * dy)
        return -turn * dy, turn * dx

    return Flow(name, velocity)


def rotation(size: tuple[int, int], peak: float) -> Flow:
    """Solid rotation; speed ``peak`` half the shorter side away from the centre."""
    rate = peak / (0.5 * (min(size) - 1))
    return _swirl("rotation", size, lambda r2: np.full_like(r2, rate))


def rankine(size: tuple[int, int], peak: float, core: float) -> Flow:
    """Solid rotation within ``core`` px, speed falling as 1/r outside; ``peak`` at the core's rim."""
    return _swirl("rankine", size, lambda r2: peak * core / np.maximum(r2, core * core))


LAMB_PEAK = 1.2564312086261697
"""s at which (1 - exp(-s))/sqrt(s) is largest: exp(s) = 1 + 2 s."""


def lamb_oseen(size: tuple[int, int], peak: float, core: float) -> Flow:
    """Lamb-Oseen vortex: largest speed ``peak`` at ``core`` px from the centre (Lamb 1932, art. 334a)."""
    scale = peak * core / (1 - np.exp(-LAMB_PEAK))

    def spin(r2: Floats) -> Floats:
        """Radians an interval at a squared radius."""
        s = LAMB_PEAK * np.maximum(r2, 1e-12) / core**2
        return np.asarray(scale * LAMB_PEAK / core**2 * (-np.expm1(-s)) / s)

    return _swirl("lamb_oseen", size, spin)


def taylor_green(size: tuple[int, int], peak: float, wavelength: float) -> Flow:
    """u = peak sin(kx) cos(ky), v = -peak cos(kx) sin(ky), one wave every ``wavelength`` px (Taylor & Green 1937)."""
    k = 2 * np.pi / wavelength
    return Flow(
        "taylor_green",
        lambda x, y: (peak * np.sin(k * x) * np.cos(k * y), -peak * np.cos(k * x) * np.sin(k * y)),
    )


def past_discs(size: tuple[int, int], peak: float, discs: Discs, layer: float = 0.8) -> Flow:
    """A stream of ``peak`` px that slows to rest on every disc; exactly divergence-free.

    Stream function psi = peak (sum_k y_k w_k + y (1 - sum_k w_k)), w_k = c_k prod_(j<>k) (1 - c_j), and c_k a bell of
    the distance s from disc k: c = 1/(1 + (s/l)^2)^2, 1 inside, l = ``layer`` radii.  At a rim psi is constant and its
    slope zero, so that the flow neither enters nor slips.
    """

    def bells(x: Floats, y: Floats) -> list[tuple[Floats, Floats, Floats]]:
        """c_k and its slopes in x and y, of every disc."""
        found = []
        for a, b, r in zip(discs.x, discs.y, discs.radius, strict=True):
            dx, dy = x - a, y - b
            far = np.maximum(np.hypot(dx, dy), 1e-9)
            s = np.maximum(far - r, 0.0) / (layer * r)
            q = 1 + s * s
            slope = -4 * s / q**3 / (layer * r) / far
            found.append((1 / q**2, slope * dx, slope * dy))
        return found

    def velocity(x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Velocity (dpsi/dy, -dpsi/dx) at the points (x, y), in px per frame."""
        known = bells(x, y)
        open_, ox, oy = np.ones_like(x), np.zeros_like(x), np.zeros_like(x)  # prod (1 - c) and its slopes
        for c, cx, cy in known:
            ox, oy = ox * (1 - c) - open_ * cx, oy * (1 - c) - open_ * cy
            open_ = open_ * (1 - c)
        # Shares w_k = c_k prod_(j<k) (1 - c_j) sum to 1 - prod (1 - c), so that psi = y prod + sum y_k w_k.
        psi_x, psi_y = y * ox, open_ + y * oy
        left, lx, ly = np.ones_like(x), np.zeros_like(x), np.zeros_like(x)
        for centre, (c, cx, cy) in zip(discs.y, known, strict=True):
            psi_x = psi_x + centre * (cx * left + c * lx)
            psi_y = psi_y + centre * (cy * left + c * ly)
            lx, ly = lx * (1 - c) - left * cx, ly * (1 - c) - left * cy
            left = left * (1 - c)
        return peak * psi_y, -peak * psi_x

    return Flow("discs", velocity, discs)


def scattered_discs(size: tuple[int, int]) -> Discs:
    """Five discs apart from one another, of a tenth to a twentieth of the picture, placed as shares of it."""
    shares = np.array(
        [(0.25, 0.28, 0.085), (0.68, 0.2, 0.06), (0.48, 0.55, 0.1), (0.2, 0.75, 0.05), (0.78, 0.74, 0.075)]
    )
    return Discs(shares[:, 0] * size[1], shares[:, 1] * size[0], shares[:, 2] * min(size))


NAMES = ("uniform", "shear", "stagnation", "rotation", "rankine", "lamb_oseen", "taylor_green", "discs")


def by_name(name: str, size: tuple[int, int], peak: float = 4.0, length: float | None = None) -> Flow:
    """The flow of ``NAMES`` with largest displacement ``peak`` px.

    length : px; radius of a vortex's core (default an eighth of the picture), wavelength (a quarter of it).  InputError
    for other names.
    """
    eighth = min(size) / 8
    made: dict[str, Callable[[], Flow]] = {
        "uniform": lambda: uniform(0.8 * peak, 0.6 * peak),
        "shear": lambda: shear(size, peak),
        "stagnation": lambda: stagnation(size, peak),
        "rotation": lambda: rotation(size, peak),
        "rankine": lambda: rankine(size, peak, length or eighth),
        "lamb_oseen": lambda: lamb_oseen(size, peak, length or eighth),
        "taylor_green": lambda: taylor_green(size, peak, length or 2 * eighth),
        "discs": lambda: past_discs(size, 0.5 * peak, scattered_discs(size)),  # twice the stream between discs
    }
    if name not in made:
        raise InputError(Fault("flow", name, "no such flow", repair=nearest(name, NAMES, "flows")))
    return made[name]()
