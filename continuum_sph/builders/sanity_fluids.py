"""Densities and speeds that the fluids of a flow can have, and how fast sound goes in them."""

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.fluids import LEAST_DENSITY, Fluid, table
from porescale.common.core.types import Floats

DENSEST = 1.3
"""Of ρ0 of the first fluid: Tait pressures of half B and more; sound at Mach 0.1 needs 1.01, the hardest impacts
1.15."""
SLACK = 1e-9
"""Of a least density, that rounding may take away: kernels leave no other below it."""


def bounds(fluids: tuple[Fluid, ...]) -> tuple[Floats, Floats, Floats]:
    """Least and largest density (kg/m³) and largest speed (m/s) of each fluid, (m,).

    The largest density of the first is `DENSEST`; another, a bubble in it, may be as dense, and as it is under the
    pressure at which the first is that dense.  Speeds end at the fluid's own sound or, of others, the first's, which
    may throw them.
    """
    first, others = fluids[0].state, [fluid.state for fluid in fluids[1:]]
    most = first.pressure(np.array(DENSEST * first.density))
    dense = [DENSEST * first.density, *(max(DENSEST * it.density, float(it.density_at(most))) for it in others)]
    swift = [first.sound_speed, *(max(first.sound_speed, it.sound_speed) for it in others)]
    return (1.0 - SLACK) * table(fluids)[:, LEAST_DENSITY], np.array(dense), np.array(swift)


def sound_speeds(fluids: tuple[Fluid, ...], material: NDArray[np.int64], density: Floats) -> Floats:
    """Speed of sound (n,) m/s in particles of a ``density`` (n,) kg/m³ within `bounds`, by the law of each fluid.

    material (n,): numbers of their fluids.
    """
    found = np.zeros(len(density))
    for number, fluid in enumerate(fluids):
        own = material == number
        found[own] = fluid.state.sound_speed_at(density[own])
    return found
