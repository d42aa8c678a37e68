"""What every weight B of a partially saturated cell provides.

A weight is one file of this folder: its law, a flat NamedTuple in the dtype of the populations; a body of ``weight``
for that law; and its row in the register, ``WEIGHTING = Weighting(...)``, which choose.py finds (entry.py).

B follows from the solid area fraction e (Noble & Torczynski 1998): 0 where e = 0, 1 where e = 1.  tau in it is the
molecular relaxation time: with an eddy viscosity the geometry must not breathe with the flow.  Grains that share a cell
have B of min(1, sum of e), split in proportion to e; summing B(e) would make contacts porous.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel, law_function


class WeightLaw(Protocol):
    """The contract of a law of weight: a function of one cell, compiled into the sweeps of psm_kernels.py."""

    @staticmethod
    def weight(solid: Any, theta: Any, slip_x: Any, slip_y: Any, law: Any) -> Any:
        """B of a cell with summed solid fraction ``solid`` >= 0, in which fluid slips past solid at (slip_x, slip_y).

        theta: softness of the rim (coverage/soft_rim.py).
        """


weight = law_function(WeightLaw.weight)


@kernel
def _weights(solid, zero, law, out):
    """B of cells (ny, nx) without slip into ``out``."""
    for y in range(solid.shape[0]):
        for x in range(solid.shape[1]):
            out[y, x] = weight(solid[y, x], zero, zero, zero, law)


def weights_of(solid: NDArray[np.floating], law: Any) -> NDArray[np.floating]:
    """B of cells with summed solid fractions (ny, nx) without slip, in the precision of ``solid``."""
    out = np.empty_like(solid)
    _weights(solid, solid.dtype.type(0), law, out)
    return out
