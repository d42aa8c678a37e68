"""The arrows of a field on axes."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

ARROWS = 48
"""Arrows across a picture, at most."""
REPLACED, VALID, ON_WHITE = "#d95f02", "#ffd54a", "#1f4e79"
"""Colours of replaced vectors, of valid ones over an image and without one: which differ in lightness, too."""


def draw_arrows(axes: Axes, field: Any, *, over_image: bool) -> float:
    """Arrows of a `Field`, thinned to ARROWS across, replaced ones in another colour; the speed of the longest."""
    thin = max(1, -(-max(field.u.shape) // ARROWS))
    cut = (slice(thin // 2, None, thin),) * 2
    x, y = np.meshgrid(field.x, field.y)
    fluid = ~field.solid[cut]
    speed = np.hypot(field.u, field.v)[cut][fluid]
    fast = float(np.percentile(speed, 98)) if speed.size else 1.0  # few wrong vectors shall not shrink all others
    step = abs(field.x[1] - field.x[0]) * thin if len(field.x) > 1 else 1.0
    for own, colour in ((field.valid, VALID if over_image else ON_WHITE), (field.replaced, REPLACED)):
        here = fluid & own[cut]
        axes.quiver(
            x[cut][here], y[cut][here], field.u[cut][here], field.v[cut][here], color=colour, angles="xy",
            scale_units="xy", scale=max(fast, 1e-300) / (1.2 * step), width=0.0022,
        )  # fmt: skip
    return float(speed.max()) if speed.size else 0.0
