"""Boxes of discs and clumps that are shaken, pushed and pressed: what the energy book says of all that moves, in SI."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.constants import GRAVITY
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_book
from porescale.dem.motion.control import Moved, Placed, Pushed
from porescale.dem.motion.drivers import Clump
from porescale.dem.motion.time_function import Sine
from porescale.dem.steering import Steering
from porescale.validation.dem.discs_trials import DENSITY, MASS, RADIUS, STIFFNESS

Array = NDArray[np.float64]

SIDE, PAIRS = 5, 8
RATE = math.sqrt(STIFFNESS / MASS)  # rad/s, of a disc against a wall
WAVE = 0.02 * RATE / (2.0 * math.pi)  # Hz: slow against contacts
PUSH = 1e-3 * STIFFNESS * RADIUS  # N/m, a pressed overlap of 1e-3 radii
LASTS = 60.0 / RATE  # s: every disc meets some others
LAW = Linear(STIFFNESS, 200.0, 0.25 * STIFFNESS, 100.0, 0.4)

DRIVES: dict[str, Callable[[Steering], None]] = {
    "free": lambda it: None,
    "moved": lambda it: it.control(Clump(3), x=Moved(Sine(0.5, WAVE)), y=Moved(0.0)),
    "placed": lambda it: it.control(Clump(3), x=Placed(Sine(0.5 / (2.0 * math.pi * WAVE), WAVE))),
    "turned": lambda it: it.control(Clump(4), rotation=Moved(Sine(200.0, WAVE))),
    "pushed": lambda it: it.control(Clump(5), x=Pushed(Sine(PUSH, WAVE)), rotation=Pushed(Sine(PUSH * RADIUS, WAVE))),
    "disc moved": lambda it: it.control(20, x=Moved(Sine(0.5, WAVE)), y=Placed(0.0)),
    "disc pushed": lambda it: it.control(22, x=Pushed(Sine(PUSH, WAVE)), rotation=Pushed(Sine(PUSH * RADIUS, WAVE))),
    "wall moves": lambda it: it.move_wall("left", x=Sine(0.5, WAVE)),
    "wall turns": lambda it: it.move_wall("right", turn=Sine(3.0, WAVE)),
    "servo": lambda it: it.servo_wall("top", force=2.0 * PUSH, speed=0.5),
}
"""What is done to bodies and walls of the box, by name."""


def shaken(drives: tuple[str, ...], seed: int, law: Linear = LAW) -> Grains:
    """25 discs, eight of them with a smaller one bound to their side, thrown about in a box, and driven."""
    rng = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(SIDE), np.arange(SIDE)), axis=-1).reshape(-1, 2) + 0.5
    size = RADIUS * rng.uniform(0.7, 1.0, SIDE**2)
    angle = rng.uniform(0.0, 2.0 * math.pi, PAIRS)
    at = 2.4 * RADIUS * grid
    at = np.concatenate((at, at[:PAIRS] + 0.6 * RADIUS * np.column_stack((np.cos(angle), np.sin(angle)))))
    size = np.concatenate((size, 0.5 * size[:PAIRS]))
    discs = make_discs(at, size, DENSITY, rng.normal(0.0, 1.0, at.shape), rng.normal(0.0, 50.0, len(at)))
    edge = 2.4 * RADIUS * SIDE
    grains = Grains(discs, law, Box((0.0, 0.0), (edge, edge)), energy=True)
    grains.steering.bind([[k, SIDE**2 + k] for k in range(PAIRS)], DENSITY)
    for name in drives:
        DRIVES[name](grains.steering)
    return grains


def book_of(drives: tuple[str, ...], steps_per_contact: float, seed: int, law: Linear = LAW) -> dict[str, float]:
    """Energy book of a box after 60 over the rate of a contact; steps in the contact of two whole discs."""
    grains = shaken(drives, seed, law)
    dt = math.pi / (math.sqrt(2.0) * RATE * steps_per_contact)
    weights = np.column_stack((np.zeros(grains.discs.count), -GRAVITY * grains.discs.mass))
    grains.step(dt, weights, count=int(LASTS / dt))
    return energy_book(grains, (0.0, -GRAVITY))


def unaccounted(drives: tuple[str, ...], steps_per_contact: float, seeds: int = 6) -> float:
    """Mean size of the residual over the energy turned over."""
    books = [book_of(drives, steps_per_contact, seed) for seed in range(seeds)]
    return float(np.mean([abs(book["residual (J/m)"]) / book["turned over (J/m)"] for book in books]))
