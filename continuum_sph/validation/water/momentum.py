"""Momentum of a box of liquid without walls.  SI."""

import numpy as np

from continuum_sph.validation.water.setups import momentum, open_box
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()


def momentum_drift(steps: int, force: float = 0.0) -> float:
    """Change of momentum over the sum of |m v| of a box without walls; ``force`` (m/s²) acts on one particle."""
    flow = open_box(20, seed=1)
    layer = flow.layer
    scale = float((layer.mass[:, None] * np.abs(layer.v)).sum())
    before = momentum(flow)
    for _ in range(steps):
        layer.v[0, 0] += force * flow.next_step
        flow.advance()
    return float(np.abs(momentum(flow) - before).max()) / scale


@VALIDATIONS.row(
    "continuum.momentum",
    source="exact: pair forces are opposite (eqs 34, 35)",
    because="roundings of 1e-16 of a velocity, 200 steps of 25 terms and 2 kicks for each of 400 particles, add up "
    "like a random walk, √(200 · 27 · 400), over 400 velocities; six times that is never seen",
    tolerance=6.0 * (200 * 27 * 400) ** 0.5 * 1.1e-16 / 400,
)
def momentum_row() -> Measured:
    """Drift of momentum over 200 steps of a stirred periodic box."""
    return Measured.absolute(0.0, momentum_drift(200))
