"""All rows of ``continuum-sph verify``."""

from __future__ import annotations

from continuum_sph.scene import (
    verify,
    verify_air,
    verify_flows,
    verify_fluids,
    verify_levee,
    verify_levels,
    verify_pile,
    verify_seepage,
    verify_soil,
    verify_soil_wet,
)
from porescale.workbench.validations import Validations

VALIDATIONS = Validations()
for room in (
    verify,
    verify_flows,
    verify_fluids,
    verify_seepage,
    verify_levels,
    verify_levee,
    verify_pile,
    verify_soil,
    verify_soil_wet,
    verify_air,
):
    VALIDATIONS.include(room.VALIDATIONS)
