"""Rock of the tutorial's numbers: what its samples bear, over the naive estimate.

Tutorial II-4: 304 discs of 4 cm mean diameter, k_n 1e7 N/m, k_s a quarter of it, mu = tan 27 degrees, mean back tension
0.774 kN; triangles and cells of the same packing, whose sides overlap by 0.08 mm.  They stand 4 mm apart, where the
tutorial has 1 mm: with that, cells go through each other at 13 times the naive strength, short of what they bear.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs
from porescale.dem.packing import Press
from porescale.dem.rock import Curve, Kind, Rock, load, rock

COUNT = 304
DIAMETER = 0.04  # m, mean; radii 3:5
DENSITY = 2500.0  # kg/m^3
STIFFNESS = 1e7  # N/m
TENSION = 774.0  # N/m, mean back tension
GAP, PRESSED = 4e-3, 8e-5  # m
PREPARED = 0.3
"""Friction while discs are packed: the tutorial's were thrown in at random and settled, neither dense nor loose."""
LOADS = {"discs": (0.006, -0.01), "triangles": (0.006, -0.035), "cells": (0.004, -0.035)}
"""Strains that a sample is pulled and pressed to: beyond its strength or, of pressed cells, where it softens."""
RATE = 0.01  # 1/s: a wave crosses the sample some hundred times before it breaks


def law() -> Linear:
    """Of the tutorial, with dashpots at 0.3 of critical for two discs of mean size."""
    mass = 0.5 * math.pi * (0.5 * DIAMETER) ** 2 * DENSITY
    dashpot = 0.6 * math.sqrt(STIFFNESS * mass)
    return Linear(STIFFNESS, dashpot, 0.25 * STIFFNESS, 0.5 * dashpot, math.tan(math.radians(27.0)))


@cache
def packing(seed: int, count: int = COUNT, friction: float = PREPARED) -> tuple[Discs, float]:
    """Discs pressed between four walls so that contacts bear TENSION on the average, and the side of the square, m."""
    radius = np.random.default_rng(seed).uniform(0.375, 0.625, count) * DIAMETER
    side = math.sqrt(float(np.sum(np.pi * radius**2)) / 0.84)
    press = Press((0.0, 0.0), (side, side), law(), (False, False), friction, DENSITY, seed)
    # p = n F d/2 over the area of a disc, n contacts of force F a disc, packed to 0.84; n is 3.15 with the walls.
    pressure = 3.15 * 0.84 / math.pi * TENSION / DIAMETER
    return press.to_pressure(radius, pressure).grains.discs, side


def sample(kind: Kind, seed: int = 0, count: int = COUNT, friction: float = PREPARED) -> Rock:
    """A bonded sample."""
    discs, side = packing(seed, count, friction)
    return rock(kind, discs, (0.0, 0.0), (side, side), law(), DENSITY, gap=GAP, pressed=PRESSED)


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
