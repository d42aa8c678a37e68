"""All rows of ``continuum-sph verify``."""

from __future__ import annotations

from continuum_sph.validation import (
    air as verify_air,
)
from continuum_sph.validation import (
    flows as verify_flows,
)
from continuum_sph.validation import (
    fluids as verify_fluids,
)
from continuum_sph.validation import (
    levee as verify_levee,
)
from continuum_sph.validation import (
    levels as verify_levels,
)
from continuum_sph.validation import (
    pile as verify_pile,
)
from continuum_sph.validation import (
    seepage as verify_seepage,
)
from continuum_sph.validation import (
    soil as verify_soil,
)
from continuum_sph.validation import (
    soil_wet as verify_soil_wet,
)
from continuum_sph.validation import (
    water as verify,
)
from porescale.common.evidence.validations import Validations

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
