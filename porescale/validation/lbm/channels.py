"""Validations of the fluid: channels and vortices with exact answers here, the others in files of their own."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.validation.lbm import cavity as verify_cavity
from porescale.validation.lbm import channels_flows as lab
from porescale.validation.lbm import open_sides as verify_open
from porescale.validation.lbm import operators as verify_operators

VALIDATIONS = Validations()

HEIGHT = 10  # cells between the walls
VISCOSITIES = (1 / 30, 1 / 6, 1.0)  # tau 0.6, 1, 3.5
OTHER_MAGIC = 1.0
ROUND_OFF = float(np.finfo(float).eps)
FORGETTING = (
    "round-off: nine roundings of a step, all one way, remembered for H²/(pi² nu) steps, are eps H²/nu of the peak;"
    " the error is given in units of H²/nu"
)


@VALIDATIONS.row(
    "lbm.poiseuille_walls_midway_at_magic_3_16",
    source="exact parabola; Ginzburg, Verhaeghe & d'Humieres 2008",
    because=FORGETTING,
    tolerance=ROUND_OFF,
)
def poiseuille() -> Measured:
    """Largest deviation of the profile from the parabola, tau 0.6, 1 and 3.5."""
    worst, centre, exact = 0.0, [], []
    for viscosity in VISCOSITIES:
        found, parabola = lab.poiseuille(HEIGHT, viscosity)
        worst = max(worst, float(np.abs(found - parabola).max()) * viscosity / HEIGHT**2)
        centre.append(float(found[HEIGHT // 2]))
        exact.append(float(parabola[HEIGHT // 2]))
    return Measured(exact, centre, worst)


@VALIDATIONS.row(
    "lbm.poiseuille_slip_at_another_magic",
    source="slip of half-way bounce-back, (16 L/3 - 1)/H² of the peak (Ginzburg & d'Humieres 2003)",
    because="relative; round-off of the profile, eps H²/nu, over the slip, (16/3 - 1)/H²: eps H^4/(4 nu)",
    tolerance=ROUND_OFF * HEIGHT**4 / (4 * VISCOSITIES[1]),
)
def slip() -> Measured:
    """How far magic 1 lifts the whole profile, over its peak."""
    found, parabola = lab.poiseuille(HEIGHT, VISCOSITIES[1], OTHER_MAGIC)
    exact = (OTHER_MAGIC / MAGIC_MIDWAY_WALL - 1) / HEIGHT**2
    lifted = found - parabola
    return Measured(exact, float(lifted.mean()), float(np.abs(lifted / exact - 1).max()))


@VALIDATIONS.row(
    "lbm.couette",
    source="exact: linear between the walls, at any magic parameter",
    because=FORGETTING,
    tolerance=ROUND_OFF,
)
def couette() -> Measured:
    """Largest deviation of the profile from the straight line, tau 0.6, 1 and 3.5, magic 1."""
    worst, top, exact = 0.0, [], []
    for viscosity in VISCOSITIES:
        found, line = lab.couette(HEIGHT, viscosity, OTHER_MAGIC)
        worst = max(worst, float(np.abs(found - line).max()) * viscosity / HEIGHT**2)
        top.append(float(found[-1]))
        exact.append(float(line[-1]))
    return Measured(exact, top, worst)


@VALIDATIONS.row(
    "lbm.taylor_green_order",
    source="Taylor & Green 1937, vortices that a uniform flow carries; diffusive scaling",
    because="the next term of the error is fourth order: (16/32)² of 1.5 % of 16's own error, 0.01; 0.1 asked for",
    tolerance=0.1,
)
def taylor_green() -> Measured:
    """Order of convergence over 16, 32 and 64 cells."""
    found = lab.order([lab.taylor_green(cells) for cells in (16, 32, 64)])
    return Measured(2.0, found, abs(found - 2.0))


for others in (verify_open, verify_cavity, verify_operators):
    VALIDATIONS.include(others.VALIDATIONS)
