"""Validations of open sides."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.lbm import open_sides_flows as lab

VALIDATIONS = Validations()

HEIGHT, LENGTH = 10, 20
DROP = 1e-4
VISCOSITIES = (1 / 30, 1 / 6, 1.0)
SPEED, STEPS = 0.05, 1000
MASS_ROUND_OFF = 9 * 0.05 * float(np.finfo(float).eps) * HEIGHT * LENGTH * STEPS


@VALIDATIONS.row(
    "lbm.poiseuille_between_pressures",
    source="exact parabola, walls midway at magic 3/16; u rho is the same in every section",
    because="density, and with it 1/u, changes by half the drop to either side; the same again for its convection",
    tolerance=DROP,
)
def pressure_channel() -> Measured:
    """Largest deviation from the parabola in any section over the peak, tau 0.6, 1 and 3.5."""
    worst, peaks = 0.0, []
    for viscosity in VISCOSITIES:
        found, parabola = lab.pressure_channel(HEIGHT, LENGTH, viscosity, DROP)
        worst = max(worst, float(np.abs(found - parabola[:, None]).max()))
        peaks.append(float(found.max()))
    return Measured([float(parabola.max())] * len(VISCOSITIES), peaks, worst)


@VALIDATIONS.row(
    "lbm.plug_balances",
    source="mass: what enters at one speed and leaves at another",
    because="round-off: nine populations of size 0.05 of each cell in each step, all one way",
    tolerance=MASS_ROUND_OFF,
)
def plug() -> Measured:
    """Mass gained in 1000 steps when as much leaves as enters, and in 20 when a tenth less leaves."""
    even, none = lab.plug(LENGTH, HEIGHT, SPEED, SPEED, STEPS)
    more, expected = lab.plug(LENGTH, HEIGHT, SPEED, 0.9 * SPEED, 20)
    return Measured([none, expected], [even, more], max(abs(even - none), abs(more - expected)))
