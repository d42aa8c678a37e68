"""Eddy viscosity of Smagorinsky, for any operator (Hou, Sterling, Chen & Doolen 1996; Feng, Han & Owen 2010).

tau_t = (sqrt(tau0² + 18 sqrt(2) C² sqrt(P:P)/rho) - tau0)/2  is added to the molecular tau0; P is the non-equilibrium
part of the second moments, C the Smagorinsky constant with the cell as filter width.
"""

from collections import namedtuple
from typing import Any

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.lbm.collision.law import numbers, shear_rate, stress

CONSTANT = 0.1
"""Smagorinsky constant C used where a scene gives none."""


def eddy_version(law: Any) -> Any:
    """The type of a law with one more field, ``strain_factor`` 18 sqrt(2) C², whose shear rate is that of the eddies.

    To be bound to the name Eddy + name of the law in the law's own module, where pickled kernels look for it.
    """
    fields = (*law._fields, "strain_factor")
    version = namedtuple(f"Eddy{law.__name__}", fields, module=law.__module__)  # type: ignore[misc]
    shear_rate.of(version)(_eddy_rate)
    return version


@inline
def _eddy_rate(f, m, law):
    """Rate of molecular and eddy viscosity together."""
    c = numbers(law.rate)
    xx, yy, xy = stress(f, m)
    size = np.sqrt(xx * xx + yy * yy + c.two * xy * xy)
    tau = c.one / law.rate
    return c.two / (tau + np.sqrt(tau * tau + law.strain_factor * size * (c.one / (c.one + m.d))))
