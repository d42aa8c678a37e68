"""What experiments with discs share: a material, discs in open boxes and on a floor, and what is read off them.  SI.

All discs of one experiment lie far apart and share a system, so that a sweep over parameters costs one run.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains

RADIUS = 0.01  # m
DENSITY = 2500.0  # kg/m^3
MASS = math.pi * RADIUS**2 * DENSITY  # kg/m
STIFFNESS = 1e7  # N/m
APART = 10.0 * RADIUS  # between discs that must not touch
TANGENTIAL: dict[str, Any] = {"tangential_stiffness": 0.25 * STIFFNESS, "friction": 0.3}


def free(discs_at: Any, law: ContactLaw, radius: ArrayLike = RADIUS, floor: bool = False) -> Grains:
    """Discs at rest in an open box, with a floor at y = 0 if wanted."""
    discs = make_discs(discs_at, radius, DENSITY)
    low, high = discs.position.min(axis=0) - 1.0, discs.position.max(axis=0) + 1.0
    box = Box(
        (float(low[0]), 0.0 if floor else float(low[1])),
        (float(high[0]), float(high[1])),
        left="open", right="open", top="open", bottom="solid" if floor else "open",
    )  # fmt: skip
    return Grains(discs, law, box)


def on_floor(law: ContactLaw | Materials, gaps: ArrayLike, **options: Any) -> Grains:
    """Discs far apart in a row, ``gaps`` (m) above a floor without sides."""
    gap = np.atleast_1d(np.asarray(gaps, float))
    places = np.column_stack((APART * np.arange(len(gap)), RADIUS + gap))
    box = Box((-1.0, 0.0), (APART * len(gap) + 1.0, 1.0), "open", "open", top="open")
    return Grains(make_discs(places, RADIUS, DENSITY), law, box, **options)


def law_at(damping_ratio: float, release: str = "force", mass: float = MASS, **tangential: float) -> Linear:
    """A law of STIFFNESS with a ``damping_ratio`` at effective ``mass`` (kg/m)."""
    return Linear(STIFFNESS, 2.0 * damping_ratio * math.sqrt(STIFFNESS * mass), release=release, **tangential)


def grows(grains: Grains, loads: Floats, dt: float, steps: int) -> bool:
    """Whether a small disturbance of a loaded equilibrium grows tenfold within ``steps`` of ``dt``."""
    discs = grains.discs
    rest = discs.position.copy()
    rng = np.random.default_rng(0)
    discs.position += 1e-7 * RADIUS * rng.uniform(-1.0, 1.0, rest.shape)
    scale = 1e-7 * RADIUS
    grains.refresh()
    for _ in range(steps // 20):
        grains.step(dt, loads, count=20)
        off = float(np.abs(discs.position - rest).max())
        if not off < 10.0 * scale * 3.0:
            return True
    return False


def stability_limit(low: float, high: float, tolerance: float, unstable: Callable[[float], bool]) -> float:
    """Step between ``low`` and ``high`` from which on it is ``unstable``, by bisection to a relative ``tolerance``."""
    while high - low > tolerance * low:
        middle = 0.5 * (low + high)
        if unstable(middle):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def first_order(residual: Callable[[Any, float], float], cases: Sequence[Any], coarse: float, fine: float) -> Measured:
    """Orders at which the ``residual`` (case, steps in a contact) falls from ``coarse`` to ``fine`` steps; the error is
    what the least lacks of one."""
    orders = [math.log(residual(case, coarse) / residual(case, fine), fine / coarse) for case in cases]
    return Measured((1.0,) * len(orders), orders, max(0.0, 1.0 - min(orders)))


def weights(count: int, gravity: float = GRAVITY) -> Floats:
    """Weights of so many discs, (count, 2) N/m."""
    return np.column_stack((np.zeros(count), np.full(count, -MASS * gravity)))


def slowest_wave(count: int) -> float:
    """Frequency, rad/s, of the slowest wave of a column of discs on a floor; drag of twice that ends it soonest."""
    return math.sqrt(STIFFNESS / MASS) * math.pi / (2.0 * count + 1.0)
