"""Convergence of the fluid: flows with exact answers at several resolutions."""

from functools import partial

import numpy as np

from porescale.common.evidence.convergence import Ladders
from porescale.validation.lbm.channels import OTHER_MAGIC, VISCOSITIES, poiseuille, taylor_green
from porescale.validation.lbm.own_forces import kolmogorov, swinging

LADDERS = Ladders()


@LADDERS.ladder(
    "lbm.poiseuille_at_magic_1",
    title="Largest error of a parabola between walls over its peak, magic parameter 1; 3/16 is exact",
    along="cells between the walls",
    levels=(5, 10, 20, 40),
    expected=2.0,
    within=1e-10,
    because="(16/3 - 1)/H² exactly (Ginzburg & d'Humieres 2003); round-off of 1e-16 a step, kept for a viscous time of"
    " 1600 steps, 1e-13, is 1e-10 of the error at 40 cells, 2.7e-3, and less of the order",
)
def parabola(cells: float) -> float:
    """Slip of half-way bounce-back."""
    found, exact = poiseuille(int(cells), VISCOSITIES[1], OTHER_MAGIC)
    return float(np.abs(found - exact).max())


def vortices(operator: str, cells: float) -> float:
    """Error of the vortices, collisions by ``operator``."""
    return taylor_green(int(cells), operator=operator)


for name, operator, said in (
    ("lbm.taylor_green", "trt",
     "Root mean square error of velocity of vortices that a uniform flow carries, over that of the exact field"),
    ("lbm.taylor_green_central_moments", "central", "As for the vortices above, by central moments"),
):  # fmt: skip
    LADDERS.ladder(
        name,
        title=said,
        along="cells in a wave",
        levels=(16, 32, 64, 128),
        expected=2.0,
        within=0.01,
        because="diffusive scaling; the next term is of fourth order, 1.5 % of 16's own error: 0.01 of the order",
    )(partial(vortices, operator))


@LADDERS.ladder(
    "lbm.kolmogorov_flow",
    title="Error of the amplitude of the steady flow under a force a sin(k y) of every cell",
    along="cells in a wave",
    levels=(8, 16, 32, 64),
    expected=2.0,
    within=0.031,
    because="(k h)²/24 at magic 3/16; the next term is 0.1 (k h)² of it, 0.062 at 8 cells: 0.029 of the order; the one"
    " after it about 0.062²: 0.002",
)
def steady_wave(cells: float) -> float:
    """Amplitude over a/(nu k²), less 1."""
    return abs(kolmogorov(int(cells)))


@LADDERS.ladder(
    "lbm.womersley_channel",
    title="Largest error of velocity in a channel under a force that oscillates, over its largest velocity",
    along="cells between the walls",
    levels=(16, 32, 64),
    expected=2.0,
    within=0.072,
    because="the next term is of fourth order: a tenth of the error at 16 cells, 0.072 of the order",
)
def oscillating_channel(cells: float) -> float:
    """Largest error over the largest velocity, at the Womersley number 4.5."""
    return swinging(int(cells))
