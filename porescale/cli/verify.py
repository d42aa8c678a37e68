"""``porescale verify``: the validations of every room."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.common.evidence.validations import Validations


def validations() -> Validations:
    """All rows, room by room."""
    from porescale.common.evidence.validations import Validations
    from porescale.validation.coupling.grains import VALIDATIONS as COUPLING
    from porescale.validation.dem.discs import VALIDATIONS as DEM
    from porescale.validation.homogenise import VALIDATIONS as SCENE
    from porescale.validation.lbm.channels import VALIDATIONS as LBM
    from porescale.validation.piv.pairs import VALIDATIONS as PIV

    rows = Validations()
    for room in (LBM, DEM, COUPLING, SCENE, PIV):
        rows.include(room)
    return rows
