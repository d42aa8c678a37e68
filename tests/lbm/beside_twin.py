"""A fluid beside its slow twin: the same random flow, the same steps, and the same fields to round-off."""

import numpy as np

from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY
from tests.reference.lbm import lbm as twin

EPS = np.finfo(float).eps
ORDER = [twin.C.index((int(cx), int(cy))) for cx, cy in zip(CX, CY, strict=True)]
ROUND_OFF = 60 * EPS
"""Both add the same some 60 terms of size 1 (the twin's populations are whole) per cell and step, in another order;
errors of different steps add up at worst: 60 eps a step."""


def start(fluid: Fluid, other: twin.Lattice, seed: int = 1) -> tuple[Fluid, twin.Lattice]:
    """Both with the same random flow (speeds up to 0.05, density within 1 %)."""
    random = np.random.default_rng(seed)
    shape = (fluid.ny, fluid.nx)
    rho, ux, uy = 1 + 0.01 * random.uniform(-1, 1, shape), *(0.05 * random.uniform(-1, 1, (2, *shape)))
    fluid.set_flow(ux, uy, rho)
    other.f = twin.equilibrium(rho, ux, uy)
    return fluid, other


def same(fluid: Fluid, other: twin.Lattice, steps: int) -> None:
    """AssertionError where the fields, or after an even number of steps the populations, differ by more than that."""
    rho, jx, jy = other.moments()
    expected = rho, (jx + other.force[0] / 2) / rho, (jy + other.force[1] / 2) / rho
    for ours, theirs in zip(fluid.fields(), expected, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=ROUND_OFF * steps)
    if fluid.step % 2 == 0:
        whole = fluid.populations[:, 1:-1, 1:-1] + np.array(twin.W)[ORDER][:, None, None]
        np.testing.assert_allclose(whole, other.f[ORDER], rtol=0, atol=ROUND_OFF * steps)


def go(fluid: Fluid, other: twin.Lattice, steps: int = 5) -> None:
    """Both step, and are compared after each."""
    for step in range(1, steps + 1):
        fluid.advance()
        other.step()
        same(fluid, other, step)
