"""Momentum and angular momentum of a cloud of colliding, spinning discs.  SI."""

import math
from dataclasses import replace

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import angular_momentum, momentum
from porescale.validation.dem.hertz import HERTZ
from porescale.validation.dem.setups import RADIUS, STIFFNESS, TANGENTIAL, free, law_at

VALIDATIONS = Validations()


def cloud(count: int = 60, seed: int = 1, friction: float = 0.5) -> Grains:
    """Discs of radii 1:2 thrown at each other and spinning, in an open box."""
    rng = np.random.default_rng(seed)
    side = math.ceil(math.sqrt(count))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
    law = law_at(0.1, tangential_stiffness=0.25 * STIFFNESS, friction=friction, tangential_damping=50.0)
    grains = free((grid - 0.5 * side) * 2.2 * RADIUS, law, RADIUS * rng.uniform(0.5, 1.0, count))
    discs = grains.discs
    discs.velocity[:] = -40.0 * discs.position + rng.normal(0.0, 1.0, (count, 2))
    discs.spin[:] = rng.normal(0.0, 100.0, count)
    return grains


def momentum_drift(grains: Grains, steps: int) -> tuple[float, float]:
    """Change of momentum and of angular momentum over ``steps``, relative to sum m |v| and sum m |x| |v|."""
    discs = grains.discs
    start, turn = momentum(discs), angular_momentum(discs)
    speed = np.hypot(*discs.velocity.T)
    scale = float(np.sum(discs.mass * speed))
    lever = float(np.sum(discs.mass * speed * np.hypot(*discs.position.T)))
    grains.step(grains.stable_step(), count=steps)
    return (
        float(np.hypot(*(momentum(discs) - start))) / scale,
        abs(angular_momentum(discs) - turn) / lever,
    )


@VALIDATIONS.row(
    "dem.momentum_and_angular_momentum",
    source="Newton's third law; lever arms that meet on the chord of the overlap",
    because="60 discs, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=1e-13,
)
def momenta() -> Measured:
    """A cloud of spinning, rubbing discs colliding in free space: relative drift of both."""
    return Measured.absolute((0.0, 0.0), momentum_drift(cloud(), 5000))


@VALIDATIONS.row(
    "dem.angular_momentum_with_rolling_resistance",
    source="Newton's third law: equal and opposite torques on both bodies",
    because="60 discs, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=1e-13,
    slow=True,
)
def rolling_momenta() -> Measured:
    """A cloud of spinning discs that resist rolling, linear and Hertz: relative drift of both momenta."""
    drifts: list[float] = []
    for law in (
        replace(law_at(0.1, **TANGENTIAL), rolling_friction=0.2, rolling_stiffness=STIFFNESS, rolling_damping=50.0),
        replace(HERTZ, damping_ratio=0.1, friction=0.3, rolling_friction=0.2, deepest=0.1),
    ):
        grains = cloud()
        grains.set_law(law)
        drifts += momentum_drift(grains, 5000)
    return Measured.absolute((0.0,) * 4, drifts)
