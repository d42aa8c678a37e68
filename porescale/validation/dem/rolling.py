"""Friction and rolling: a disc that slides until it rolls, inclines, with and without rolling resistance.  SI."""

import math
from dataclasses import replace

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.validation.dem.setups import MASS, RADIUS, STIFFNESS, law_at, on_floor

VALIDATIONS = Validations()


def rubbing(friction: float) -> Linear:
    """A law with a quarter of the normal stiffness and damping along the contact."""
    law = law_at(0.2, tangential_stiffness=0.25 * STIFFNESS, friction=friction)
    return replace(law, tangential_damping=0.25 * law.damping)


def leaning(slope: float) -> Floats:
    """Weight of a disc on an incline of ``slope`` (rad), along it and across, (1, 2) N/m."""
    return MASS * GRAVITY * np.array([[math.sin(slope), -math.cos(slope)]])


def released(law: Linear, weight: Floats, wait: float) -> tuple[float, float]:
    """(acceleration, m/s^2; angular acceleration, rad/s^2) of a disc let go on a floor that bears its ``weight`` (1, 2)
    N/m, from ``wait`` (s) on for four times as long."""
    grains = on_floor(law, weight[0, 1] / STIFFNESS)
    dt = grains.stable_step(steps_per_contact=20.0)
    steps = int(wait / dt)
    grains.step(dt, weight, count=steps)
    first = float(grains.discs.velocity[0, 0]), float(grains.discs.spin[0])
    grains.step(dt, weight, count=4 * steps)
    span = 4 * steps * dt
    return (
        (float(grains.discs.velocity[0, 0]) - first[0]) / span,
        -(float(grains.discs.spin[0]) - first[1]) / span,
    )


def slide_to_roll(friction: float) -> tuple[float, float]:
    """A disc set sliding on a floor at 1 m/s without spin: (time when it stops slipping, s; final speed, m/s)."""
    law = rubbing(friction)
    grains = on_floor(law, -MASS * GRAVITY / STIFFNESS)
    weight = np.array([[0.0, -MASS * GRAVITY]])
    expected = 1.0 / (3.0 * friction * GRAVITY)
    dt = grains.stable_step(steps_per_contact=20.0)
    discs = grains.discs
    discs.velocity[0, 0] = 1.0
    slipping = 0.0
    steps = int(1.5 * expected / dt)
    for _ in range(steps):
        grains.step(dt, weight)
        if slipping == 0.0 and discs.velocity[0, 0] + discs.spin[0] * RADIUS <= 0.0:
            slipping = grains.time
    return slipping, float(discs.velocity[0, 0])


@VALIDATIONS.row(
    "dem.sliding_turns_into_rolling",
    source="t* = u0/(3 mu g), u = 2/3 u0 (rigid disc, Coulomb)",
    because="t* is read to a step of T_c/20 = 2.6e-4 t*, and the lever arm is short by the overlap, 7.7e-5 r",
    tolerance=4e-4,
)
def sliding_to_rolling() -> Measured:
    """A disc set sliding at 1 m/s without spin, mu = 0.2: when it rolls, and how fast."""
    return Measured.relative((1.0 / (3.0 * 0.2 * GRAVITY), 2.0 / 3.0), slide_to_roll(0.2))


def incline(slope: float, friction: float, wait: float = 0.02) -> tuple[float, float]:
    """`released`: a disc on an incline of ``slope`` (rad)."""
    return released(rubbing(friction), leaning(slope), wait)


def incline_exact(slope: float, friction: float) -> tuple[float, float]:
    """The same for the lever arm b = r - m g cos/k: rolling  m a = m g sin - f,  I w' = f b,  a = b w', or f = mu N."""
    arm = RADIUS - MASS * GRAVITY * math.cos(slope) / STIFFNESS
    along = GRAVITY * math.sin(slope) / (1.0 + 0.5 * (RADIUS / arm) ** 2)
    rub = GRAVITY * math.sin(slope) - along  # friction over mass that rolling takes
    if rub <= friction * GRAVITY * math.cos(slope):
        return along, along / arm
    rub = friction * GRAVITY * math.cos(slope)
    return GRAVITY * math.sin(slope) - rub, 2.0 * rub * arm / RADIUS**2


@VALIDATIONS.row(
    "dem.rolling_down_an_incline",
    source="a = 2/3 g sin, alpha = a/r for tan < 3 mu; else a = g(sin - mu cos), alpha = 2 mu g cos/r",
    because="lever arms are short by the static overlap over the radius, 7.7e-5",
    tolerance=1.0e-4,
)
def incline_row() -> Measured:
    """Below (0.3 rad, mu 0.5) and above (0.8 rad, mu 0.1) the angle at which a disc begins to slip."""
    roll = 2.0 / 3.0 * GRAVITY * math.sin(0.3)
    exact = (
        roll, roll / RADIUS,
        GRAVITY * (math.sin(0.8) - 0.1 * math.cos(0.8)), 0.2 * GRAVITY * math.cos(0.8) / RADIUS,
    )  # fmt: skip
    return Measured.relative(exact, (*incline(0.3, 0.5), *incline(0.8, 0.1)))


@VALIDATIONS.row(
    "dem.rolling_with_its_own_lever_arm",
    source="m a = m g sin - f, I alpha = f b, a = b alpha with b = r - m g cos/k; f = mu N beyond the limit",
    because="the specification: 1e-10; springs have come to rest to exp(-h w0 t) = exp(-43) = 2e-19 after 0.06 s, and"
    " 3e4 steps round the speed, all one way: 3e4 eps = 7e-12",
    tolerance=1e-10,
)
def incline_arm() -> Measured:
    """Acceleration and angular acceleration on the same inclines."""
    exact = (*incline_exact(0.3, 0.5), *incline_exact(0.8, 0.1))
    return Measured.relative(exact, (*incline(0.3, 0.5, wait=0.06), *incline(0.8, 0.1, wait=0.06)))


def resisted_incline(slope: float, resistance: float, wait: float = 0.05) -> float:
    """Acceleration (m/s^2) of a disc that resists rolling on an incline of ``slope`` (rad), from ``wait`` s on."""
    law = replace(rubbing(0.9), rolling_friction=resistance, rolling_stiffness=0.25 * STIFFNESS)
    law = replace(law, rolling_damping=0.25 * law.damping)
    return released(law, leaning(slope), wait)[0]


def resisted_acceleration(slope: float, resistance: float) -> float:
    """What it must be, with the lever arm a = r - m g cos/k: m a' = m g sin - f, I w' = f a - mu_r r N, a' = a w'."""
    reach = 1.0 - MASS * GRAVITY * math.cos(slope) / (STIFFNESS * RADIUS)  # a/r
    drive = GRAVITY * (math.sin(slope) - resistance * math.cos(slope) / reach)
    return max(drive, 0.0) / (1.0 + 0.5 / reach**2)


@VALIDATIONS.row(
    "dem.rolling_resistance_on_an_incline",
    source="at rest for tan < mu_r; else a = (g sin - mu_r g cos r/a)/(1 + r^2/2a^2), a = r less the static overlap",
    because="rest: the rolling spring creeps until dashpots have taken its motion, exp(-h w0 t) after 0.05 s; rolling:"
    " the limit is exact, round-off of 4e5 steps",
    tolerance=1e-5,
)
def rolling_incline() -> Measured:
    """Acceleration over g at tan = 0.09 and 0.31 with mu_r = 0.1."""
    exact = [resisted_acceleration(slope, 0.1) / GRAVITY for slope in (0.09, 0.3)]
    return Measured.absolute(exact, [resisted_incline(slope, 0.1) / GRAVITY for slope in (0.09, 0.3)])
