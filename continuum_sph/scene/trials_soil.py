"""Small bodies of soil that validations and tests set up and watch.  SI."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.boundary import tank_walls
from continuum_sph.boundary_paper import facing
from continuum_sph.smoothing import SUPPORT, Smoothing
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.soil.walls import HOLDING, SLIPPING
from porescale.ground.constants import GRAVITY
from porescale.particles import PairList

Floats = NDArray[np.float64]
RATIO = 1.3  # smoothing length over spacing
SKIN = 0.15  # of the smoothing length


def geostatic(depth: Floats, material: Material, gravity: float = GRAVITY, rest: float | None = None) -> Floats:
    """Stress (n, 4) Pa at a ``depth`` (n,) m below level ground, σ_xx = K0 σ_yy."""
    weight = material.density * gravity * np.maximum(depth, 0.0)
    k0 = material.rest if rest is None else rest
    across = material.poisson * (1.0 + k0) * weight
    return np.column_stack((k0 * weight, weight, np.zeros_like(weight), across))


def in_tank(
    x: Floats,
    stress: Floats,
    tank: tuple[float, float],
    spacing: float,
    material: Material,
    *,
    gravity: float = GRAVITY,
    floor: str = "hold",
    sides: str = "slip",
    **law: Any,
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m with ``stress`` (n, 4) Pa in a tank (width, height), m, lower left corner at the origin.

    floor, sides : "hold" the soil or let it "slip", sides "none": endless soil, periodic across.
    """
    width, height = tank
    smoothing = Smoothing("wendland", RATIO * spacing)
    layers = math.ceil(SUPPORT * RATIO - 0.5 - 1e-9)
    closed = sides != "none"
    walls = tank_walls(width, height, spacing, layers, sides=closed)
    n, count = len(x), len(x) + len(walls)
    number = np.zeros(count, np.int64)
    beside = (walls[:, 0] < 0.0) | (walls[:, 0] > width)
    below = walls[:, 1] < 0.0
    # In a corner both walls reverse what they meet, which is what a wall that holds does.
    slips = {"hold": HOLDING, "slip": SLIPPING}
    kinds = np.where(beside, slips.get(sides, HOLDING), slips[floor])
    number[n:] = np.where(beside & below, HOLDING, kinds)
    soil = Soil(
        n,
        np.concatenate((x, walls)),
        np.zeros((count, 2)),
        np.full(count, material.density * spacing**2),
        np.full(n, material.density),
        np.concatenate((stress, np.zeros((len(walls), 4)))),
        number,
    )
    margin = layers * spacing
    lower, upper = (0.0, 0.0) if closed else (-math.inf, 0.0), (width, math.inf) if closed else (math.inf, math.inf)
    soil.facing[n:] = facing(walls, lower, upper)
    box = ((-margin, -margin), (width + margin, height + margin)) if closed else ((0.0, -margin), (width, height))
    pairs = PairList(count, SKIN * smoothing.length, *box, (not closed, False), full=True)
    flow = SoilFlow(soil, SoilLaw(smoothing, spacing, (material,), (0.0, -gravity), **law), pairs)
    flow.lower[:], flow.upper[:] = lower, upper
    flow.start()
    return flow


def run_until(flow: SoilFlow, time: float, each: Callable[[SoilFlow], None] | None = None) -> SoilFlow:
    """Advance ``flow`` to ``time`` (s) or just beyond, calling ``each`` after every step."""
    while flow.time < time:
        flow.advance()
        if each is not None:
            each(flow)
    return flow
