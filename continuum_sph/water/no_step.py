"""A flow without a next step: the error that names the place, for the run loop."""

import numpy as np

from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats

LEAST = 1e-4
"""Of the step that sound allows at rest: a flow whose next step is shorter is unstable.  Acceleration limits by
√(h/|a|), so it asks for that where it is 10⁸ times what crosses h as sound does."""


def no_step(seconds: float, rule: str, x: Floats, acceleration: Floats, density: Floats, step: int, time: float,
            repair: str) -> Unstable:  # fmt: skip
    """What to raise when the next step would be ``seconds`` by ``rule``: at the first particle whose acceleration
    (n, 2) m/s² or density (n,) kg/m³ is no number, else at the hardest driven or, where sound limits, the densest.

    x (n, 2) m;  step, time (s): reached;  repair: what helps.
    """
    hard = np.hypot(acceleration[:, 0], acceleration[:, 1])
    lost = ~(np.isfinite(hard) & np.isfinite(density))
    at = int(np.argmax(lost if lost.any() else density if rule == "sound" else hard))
    where = f"particle {at} at ({x[at, 0]:.4g}, {x[at, 1]:.4g}) m"
    return Unstable(
        where, "next step", seconds, "s", step, time,
        f"limited by {rule}; it is driven at {hard[at]:.4g} m/s² and has {density[at]:.4g} kg/m³; {repair}",
    )  # fmt: skip
