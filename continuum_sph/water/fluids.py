"""Fluids of a flow: each a state law, a viscosity and its other parameters, as one row of a table of numbers.

A layer's particles carry the number of their fluid, their material; kernels read its row.
"""

from dataclasses import dataclass

import numpy as np

from continuum_sph.water.eos.law import StateLaw
from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import gather_two, maximum, minimum
from porescale.common.core.types import Floats

DENSITY, SOUND, LEAST_DENSITY, VISCOSITY, COHESION, LIQUID = range(6)
"""Columns of the table: ρ0 kg/m³, c0 m/s, least density kg/m³, μ Pa s, a, 1 for a liquid and 0 for a gas."""


@dataclass(frozen=True)
class Fluid:
    """state : law of its pressure;  viscosity : μ, Pa s;  cohesion : a of eq. 54, Pa m⁴: a pull of the pressure -a
    ρ²/m² between particles of mass m, kg per metre."""

    state: StateLaw
    viscosity: float = 0.0
    cohesion: float = 0.0

    def row(self) -> Floats:
        """The fluid's row of the table that kernels take, (6,)."""
        state = self.state
        return np.array(
            [
                state.density,
                state.sound_speed,
                state.least_density,
                self.viscosity,
                self.cohesion,
                float(not state.gas),
            ]
        )


def table(fluids: tuple[Fluid, ...]) -> Floats:
    """The table of all fluids, (m, 6)."""
    return np.array([fluid.row() for fluid in fluids])


@inline
def fluid_number(properties, i):
    """Number of the fluid of particle i;  properties: see `bundles.Fluids`."""
    if properties is None:
        return 0
    return int(properties[i, 0])


@inline
def same_fluid(number, other):
    """1 where particles have fluids of one number, else 0, so that sums need no branch; the numbers as floats."""
    return 1.0 - minimum(maximum(number - other, other - number), 1.0)


@inline
def pair_fluid(properties, partner, k, end, i):
    """(1 where partners are of the fluid of particle i, else 0;  their viscosities, Pa s);  1 and 0 of one fluid."""
    if properties is None:
        return 1.0, 0.0
    number, viscosity = gather_two(properties, partner, k, end, i)
    return same_fluid(properties[i, 0], number), viscosity
