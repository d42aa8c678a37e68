"""One contact, slow and obvious, force by force from the papers: Hertz and Mindlin, and rolling resistance of type C.

Hertz 1882, Mindlin & Deresiewicz 1953, Tsuji, Tanaka & Ishida 1992 (damping), Thornton, Cummins & Cleary 2011 (spring
on loading and unloading), Ai, Chen, Rotter & Ooi 2011 (rolling).  It keeps forces, not springs.
"""

import math
from dataclasses import dataclass


def clipped(value: float, limit: float) -> float:
    """``value`` cut to at most ``limit`` in size."""
    return math.copysign(limit, value) if abs(value) > limit else value


@dataclass
class HertzContact:
    """Discs of radii r1, r2 and masses m1, m2, of one material; friction mu, mu_r; damping ratio h of all dashpots."""

    young: float
    poisson: float
    r1: float
    r2: float
    m1: float
    m2: float
    h: float
    mu: float
    mu_r: float = 0.0
    friction: float = 0.0  # elastic part of the tangential force, N/m
    resistance: float = 0.0  # elastic part of the rolling moment over the reduced radius, N/m
    overlap: float = 0.0

    def step(self, overlap: float, closing: float, slip: float, spin: float, dt: float) -> tuple[float, float, float]:
        """(normal, tangential, rolling force N/m) at ``overlap``; spin = w1 - w2."""
        e = 1.0 / (2.0 * (1.0 - self.poisson**2) / self.young)
        g = 1.0 / (2.0 * (2.0 - self.poisson) / (self.young / (2.0 * (1.0 + self.poisson))))
        r = 1.0 / (1.0 / self.r1 + 1.0 / self.r2)
        m = 1.0 / (1.0 / self.m1 + 1.0 / self.m2)
        before = max(overlap - closing * dt, 0.0)
        stiff_n, stiff_t = 2.0 * e * math.sqrt(r * overlap), 8.0 * g * math.sqrt(r * overlap)
        factor = 2.0 * math.sqrt(5.0 / 6.0) * self.h
        normal = 4.0 / 3.0 * e * math.sqrt(r) * overlap**1.5 + factor * math.sqrt(stiff_n * m) * closing
        normal = max(normal, 0.0)
        if overlap < before:  # unloading: the force falls with the stiffness
            self.friction *= math.sqrt(overlap / before)
            self.resistance *= math.sqrt(overlap / before)
        self.friction = clipped(self.friction - stiff_t * slip * dt, self.mu * normal)
        self.resistance = clipped(self.resistance - stiff_t * r * spin * dt, self.mu_r * normal)
        damping = factor * math.sqrt(stiff_t * m)
        return (
            normal,
            clipped(self.friction - damping * slip, self.mu * normal),
            clipped(self.resistance - damping * r * spin, self.mu_r * normal),
        )
