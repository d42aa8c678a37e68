"""Fluids of a flow: each a state law, a viscosity and what else its particles obey, as one row of a table of numbers.

A layer's particles carry the number of their fluid, their material; kernels read its row.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.eos import Gas, Tait
from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import greater, lesser

Floats = NDArray[np.float64]

DENSITY, SOUND, STIFFNESS, EXPONENT, PRINTED, THINNEST, VISCOSITY, COHESION, LIQUID = range(9)
"""Columns of the table: ρ0 kg/m³, c0 m/s, B Pa, γ, 1 for eq. 39 and 0 for powers, least density kg/m³, μ Pa s, a,
1 for a liquid and 0 for a gas."""

LIQUID_FLOOR = 0.8  # of ρ0: least density, far below any that water at Mach 0.1 has
GAS_FLOOR = 0.01  # of ρ0: a bubble that has left the water keeps spreading; pressures stay numbers


@dataclass(frozen=True)
class Fluid:
    """state : law of its pressure;  viscosity : μ, Pa s;  cohesion : a of eq. 54, Pa m⁴: a pull of the pressure -a
    ρ²/m² between particles of mass m, kg per metre."""

    state: Tait | Gas
    viscosity: float = 0.0
    cohesion: float = 0.0

    def row(self) -> Floats:
        """Its line of the table, (9,)."""
        state = self.state
        gas = isinstance(state, Gas)
        floor = (GAS_FLOOR if gas else LIQUID_FLOOR) * state.density
        printed = float(isinstance(state, Gas) and state.printed)
        stiffness, exponent = state.stiffness, state.exponent
        return np.array(
            [
                state.density,
                state.sound_speed,
                stiffness,
                exponent,
                printed,
                floor,
                self.viscosity,
                self.cohesion,
                float(not gas),
            ]
        )


def table(fluids: tuple[Fluid, ...]) -> Floats:
    """The table of all fluids, (m, 9)."""
    return np.array([fluid.row() for fluid in fluids])


@inline
def alike(number, other):
    """1 where particles have fluids of one number, else 0, so that sums need no branch; the numbers as floats."""
    return 1.0 - lesser(greater(number - other, other - number), 1.0)
