"""Discs at rest on each other: overlaps under their weight, of one material and of two.  SI."""

import math

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.validation.dem.setups import DENSITY, MASS, RADIUS, STIFFNESS, free, law_at, slowest_wave, weights

VALIDATIONS = Validations()


def stack(count: int, gravity: float = GRAVITY, decays: float = 40.0) -> Floats:
    """Overlaps (count,) m under each disc of a stack left to itself for ``decays`` of its slowest wave's
    decay times, from the top, over m g/k."""
    law = law_at(0.3)
    y = RADIUS * (2.0 * np.arange(count) + 1.0)
    grains = free(np.column_stack((np.zeros(count), y)), law, floor=True)
    dt, slowest = grains.stable_step(), slowest_wave(count)
    grains.step(dt, weights(count, gravity), None, int(decays / (slowest * dt)), 2.0 * slowest)
    height = np.concatenate(([-RADIUS], grains.discs.position[:, 1]))
    return (2.0 * RADIUS - np.diff(height))[::-1] * STIFFNESS / (MASS * gravity)


@VALIDATIONS.row(
    "dem.static_stack",
    source="overlap j from the top = j m g/k",
    because="rest is reached to exp(-20) = 2e-9; overlaps of 8e-7 m are read off positions known to 3e-17 m",
    tolerance=1e-8,
)
def static_stack() -> Measured:
    """Ten discs on a floor, overlaps in m g/k."""
    return Measured.relative(list(range(1, 11)), stack(10))


def unlike_stack() -> Floats:
    """Overlaps over m g: floor of steel under a disc of rubber, under one of steel, (2,) m/N per metre, at rest."""
    soft = 1e-3 * STIFFNESS  # of friction and rolling, which have nothing to do in a stack
    steel, rubber = (
        Linear(part * STIFFNESS, 0.0, soft, friction=0.5, rolling_friction=0.1, rolling_stiffness=soft)
        for part in (1.0, 0.1)
    )
    laws = Materials({"steel": steel, "rubber": rubber}, walls="steel")
    discs = make_discs([(0.0, RADIUS), (0.0, 3.0 * RADIUS)], RADIUS, DENSITY)
    box = Box((-1.0, 0.0), (1.0, 1.0), "open", "open", top="open")
    grains = Grains(discs, laws, box, material=[1, 0])
    dt, slowest = grains.stable_step(), 0.6 * math.sqrt(0.18 * STIFFNESS / MASS)
    grains.step(dt, weights(2, GRAVITY), None, int(60.0 / (slowest * dt)), 2.0 * slowest)
    y = discs.position[:, 1]
    return np.array([RADIUS - y[0], 2.0 * RADIUS - (y[1] - y[0])]) / (MASS * GRAVITY)


@VALIDATIONS.row(
    "dem.unlike_materials_in_contact",
    source="springs in series, 2 k1 k2/(k1 + k2); the same between discs and with a wall",
    because="rest is reached to exp(-20) = 2e-9; overlaps of 3e-6 m are read off positions known to 3e-17 m",
    tolerance=1e-8,
)
def materials() -> Measured:
    """Overlap over load (m/N per metre): a disc ten times softer than the floor and the disc on it."""
    mixed = 2.0 * 0.1 / 1.1 * STIFFNESS
    return Measured.relative((2.0 / mixed, 1.0 / mixed), unlike_stack())
