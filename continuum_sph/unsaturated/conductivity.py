"""Relative permeability of pores that are not full.

    k_r = S_e^l [1 - (1 - S_e^{1/m})^m]²

Source: Mualem, Water Resour. Res. 12 (1976) 513, with the retention of van Genuchten, Soil Sci. Soc. Am. J. 44 (1980)
892, eq. 8; l = 0.5 fits most soils.  It is none at the residual saturation, so water stays there.
"""

from porescale.common.compiled.jit import inline

CONNECTIVITY = 0.5
"""l of Mualem 1976."""


@inline
def relative_permeability(effective, connectivity, m):
    """k_r at an ``effective`` saturation S_e between 0 and 1;  connectivity l;  m of the retention."""
    closed = (1.0 - effective ** (1.0 / m)) ** m
    return effective**connectivity * (1.0 - closed) * (1.0 - closed)
