"""A disc in a ring, at several places in the cells: what ``verify`` measures and tests vary.  Lattice units."""

from __future__ import annotations

import numpy as np

from porescale.validation.coupling.shapes_trials import couette_torque

CENTRES = ((0.3, 0.1), (0.0, 0.0), (0.5, 0.25), (0.8, 0.6))
"""Places in a cell."""
RADII = 8.0, 16.0


def torques(
    relaxation_time: float,
    turning: str,
    *,
    radii: tuple[float, float] = RADII,
    solid_operator: str = "exact-wall",
) -> tuple[float, float]:
    """Torque on disc and ring over 4 pi mu W R1² R2²/(R2² - R1²), mean over ``CENTRES``; turning: "disc" or "ring"."""
    pairs = [
        couette_torque(*radii, relaxation_time, turning=turning, centre=centre, solid_operator=solid_operator)
        for centre in CENTRES
    ]
    disc, ring = np.mean(pairs, axis=0)
    return float(disc), float(ring)
