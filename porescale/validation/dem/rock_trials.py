"""Rock of the tutorial's numbers: what its samples bear, over the naive estimate.

Tutorial II-4: 304 discs of 4 cm mean diameter, k_n 1e7 N/m, k_s a quarter of it, mean back tension 0.774 kN; triangles
and cells of the same packing, whose sides overlap by 0.08 mm.  Friction (tan 27 degrees, as in its part I), the packing
and the sample's shape it does not give; the case cases/rock says what each of them is worth.

Triangles stand 1 mm apart, as there; cells 4 mm, since at 1 mm a corner goes through the opposite side at an overlap of
1.08 mm, 13.5 times what bonds bear, and cells bear more before they break.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs
from porescale.dem.measures.network import stiffness
from porescale.dem.prepare.compaction import Press
from porescale.dem.prepare.rock import Curve, Kind, Rock, load, rock

COUNT = 304
DIAMETER = 0.04  # m, mean; radii 3:5
DENSITY = 2500.0  # kg/m^3
STIFFNESS = 1e7  # N/m
TENSION = 774.0  # N/m, mean back tension
GAP, PRESSED = 4e-3, 8e-5  # m
GAPS: dict[Kind, float] = {"discs": 0.0, "triangles": 1e-3, "cells": GAP}
"""The tutorial's 1 mm, but for cells, see above."""
PREPARED = 0.2
"""Friction while discs are packed: the tutorial's were thrown in at random and settled, neither dense nor loose."""
SLENDER = 2.0
"""Length over height of samples in which a plane of shear, 58 degrees steep, can pass between the plates."""
LOADS = {"discs": (0.006, -0.01), "triangles": (0.006, -0.035), "cells": (0.004, -0.035)}
"""Strains that a sample is pulled and pressed to: beyond its strength; pressed cells have none unless slender."""
RATE = 0.01  # 1/s: a wave crosses the sample some hundred times before it breaks


def law() -> Linear:
    """Of the tutorial, with dashpots at 0.3 of critical for two discs of mean size."""
    mass = 0.5 * math.pi * (0.5 * DIAMETER) ** 2 * DENSITY
    dashpot = 0.6 * math.sqrt(STIFFNESS * mass)
    return Linear(STIFFNESS, dashpot, 0.25 * STIFFNESS, 0.5 * dashpot, math.tan(math.radians(27.0)))


@cache
def packing(
    seed: int, count: int = COUNT, friction: float = PREPARED, shape: float = 1.0
) -> tuple[Discs, tuple[float, float]]:
    """Discs pressed between four walls so that contacts bear TENSION on the average, and length and height of the
    rectangle, m; ``shape``: one over the other."""
    radius = np.random.default_rng(seed).uniform(0.375, 0.625, count) * DIAMETER
    height = math.sqrt(float(np.sum(np.pi * radius**2)) / (0.84 * shape))
    size = (shape * height, height)
    press = Press((0.0, 0.0), size, law(), (False, False), friction, DENSITY, seed)
    # p = n F d/2 over the area of a disc, n contacts of force F a disc, packed to 0.84; n is 3.15 with the walls.
    pressure = 3.15 * 0.84 / math.pi * TENSION / DIAMETER
    return press.to_pressure(radius, pressure).grains.discs, size


def sample(
    kind: Kind, seed: int = 0, count: int = COUNT, friction: float = PREPARED, shape: float = 1.0,
    gap: float | None = None, rule: str = "outline",
) -> Rock:  # fmt: skip
    """A bonded sample, see packing and rock;  gap : m, default GAPS."""
    discs, size = packing(seed, count, friction, shape)
    apart = GAPS[kind] if gap is None else gap
    return rock(kind, discs, (0.0, 0.0), size, law(), DENSITY, gap=apart, pressed=PRESSED, rule=rule)


def curves_of(kind: Kind, seed: int = 0, count: int = COUNT, rate: float = RATE) -> tuple[Rock, Curve, Curve]:
    """A sample, how it is pulled and how another of its kind is pressed, until they fail."""
    curves = []
    for strain in LOADS[kind]:
        made = sample(kind, seed, count)
        curves.append(load(made, strain, abs(strain) / rate))
    return made, curves[0], curves[1]


def strengths(kind: Kind, seed: int = 0, count: int = COUNT, rate: float = RATE) -> tuple[float, float, float]:
    """(tensile, compressive strength over the naive one, stiffness when pulled over the contact's)."""
    made, pulled, pressed = curves_of(kind, seed, count, rate)
    naive = made.naive_strength
    return pulled.strength() / naive, pressed.strength() / naive, pulled.stiffness() / STIFFNESS


def stiffness_by_motion(kind: Kind, seed: int, count: int, strain: float = 1e-5) -> tuple[float, float]:
    """Stiffness of a sample pulled so little that nothing slides, and of its springs by statics, over the contact's."""
    made = sample(kind, seed, count)
    found = stiffness(made)
    return load(made, strain, 0.2, moments=20).stiffness(1.0) / STIFFNESS, found / STIFFNESS


def left_when_pressed(shape: float, count: int, rate: float, strain: float = 0.04) -> float:
    """Stress that cells bear once pressed to ``strain``, mean of the last tenth, over the largest."""
    curve = load(sample("cells", 0, count, shape=shape), -strain, strain / rate)
    return -float(curve.stress[-len(curve.stress) // 10 :].mean()) / curve.strength()
