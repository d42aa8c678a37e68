"""What follows from the force of any contact law: its tangents, the speed that it stops, and a collision."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

Force = Callable[[float, float], float]
"""Normal force (N/m) from overlap (m) and closing speed (m/s)."""
COUNT = 96
"""Overlaps at which a force is looked at, half of them spread evenly, half evenly in the logarithm."""
SHALLOWEST = 1e-6
"""The smallest overlap looked at, over the deepest."""
SPEEDS = (-1.0, -0.3, -0.01, 0.01, 0.3, 1.0)
"""Closing speeds at which dashpots are looked at, over the fastest."""
CLOSE = 1e-4
"""Distance of two overlaps between which the tangent is taken, over the overlap."""
PERIODS = 200.0
"""Half periods of its stiffest spring within which a contact ends, or never does."""


class Collision(NamedTuple):
    """seconds : from touch until the contact ends, infinite where it does not;  restitution : parting over approach
    speed, 0 then;  deepest : largest overlap, m."""

    seconds: float
    restitution: float
    deepest: float


def samples(deepest: float) -> list[float]:
    """Overlaps (m) up to the ``deepest``, ascending."""
    half = COUNT // 2
    fine = np.geomspace(SHALLOWEST, 1.0 / half, half, endpoint=False)
    return [float(deepest * share) for share in (*fine, *(np.arange(1, half + 1) / half))]


def steepest(force: Force, deepest: float, speed: float) -> tuple[float, float]:
    """Largest slopes of a force: stiffness dF/dd (N/m) up to an overlap (m), damping (N s/m) up to a ``speed`` (m/s).

    Slopes are differences between neighbouring samples, and close to each.  Where the speed is 0, the force at rest
    alone is looked at.
    """
    depths, slopes, dampings = samples(deepest), [], [0.0]
    for each in (0.0, *(share * speed for share in SPEEDS if speed > 0.0)):
        at = depths if each == 0.0 else depths[COUNT // 2 :]  # beside a dashpot shallow ones are lost in round-off
        forces = [force(depth, each) for depth in at]
        slopes += [(forces[k + 1] - forces[k]) / (at[k + 1] - at[k]) for k in range(len(at) - 1)]
        slopes += [
            (force(depth * (1.0 + CLOSE), each) - force(depth * (1.0 - CLOSE), each)) / (2.0 * CLOSE * depth)
            for depth in at
        ]
        if each != 0.0:
            dampings += [(pushed - force(depth, 0.0)) / each for depth, pushed in zip(at, forces, strict=True)]
    return max(slopes, key=_size), max(dampings, key=_size)


def _size(value: float) -> float:
    """A number to compare by: what is none is larger than any."""
    return value if math.isfinite(value) else math.inf


def impact_speed(force: Force, deepest: float, mass: float) -> float:
    """Speed (m/s) at which a reduced ``mass`` (kg/m) reaches an overlap (m) against the force at rest."""
    depths = np.array([0.0, *samples(deepest)])
    forces = np.array([0.0, *(force(float(depth), 0.0) for depth in depths[1:])])
    work = float(np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(depths)))
    if not work > 0.0:
        work = float(np.max(np.abs(forces))) * deepest
    return math.sqrt(2.0 * work / mass)


def collide(force: Force, mass: float, speed: float, stiffness: float, release: str) -> Collision:
    """A head-on collision of reduced ``mass`` (kg/m) at ``speed`` (m/s), integrated to 9 digits.

    stiffness (N/m): the largest, which sets the scale of time;  release: "force", the contact ends when the force
    vanishes, or "overlap", when the overlap does.
    """
    from scipy.integrate import solve_ivp  # takes longer to import than a scene to be judged

    unit = math.sqrt(mass / stiffness)
    length = speed * unit

    def at(state: list[float]) -> float:
        """Force at a state, N/m."""
        return force(max(state[0], 0.0) * length, state[1] * speed)

    def motion(time: float, state: list[float]) -> tuple[float, float]:
        """Rates of overlap and closing speed, in units of the impact."""
        pushed = at(state)
        return state[1], -(max(pushed, 0.0) if release == "force" else pushed) * unit / (mass * speed)

    def ends(time: float, state: list[float]) -> float:
        """Falls through 0 where the contact ends."""
        if state[1] > 0.0:  # still closing
            return 1.0
        return state[0] if release == "overlap" else min(state[0], at(state) / (stiffness * length))

    def turns(time: float, state: list[float]) -> float:
        """Falls through 0 where the overlap is largest."""
        return state[1]

    for event, terminal in ((ends, True), (turns, False)):
        vars(event).update(terminal=terminal, direction=-1.0)
    found = solve_ivp(
        motion, (0.0, PERIODS * math.pi), [0.0, 1.0], method="DOP853", events=(ends, turns), rtol=1e-10, atol=1e-12,
        max_step=0.1 * math.pi,
    )  # fmt: skip
    deepest = max([0.0, *(float(state[0]) for state in found.y_events[1]), float(np.max(found.y[0]))]) * length
    if not len(found.t_events[0]):
        return Collision(math.inf, 0.0, deepest)
    return Collision(float(found.t_events[0][0]) * unit, max(0.0, -float(found.y_events[0][0][1])), deepest)
