"""``porescale verify``: the validations of every room."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.workbench.validations import Validations


def validations() -> Validations:
    """All rows, room by room."""
    from porescale.coupling.verify import VALIDATIONS as COUPLING
    from porescale.dem.verify import VALIDATIONS as DEM
    from porescale.lbm.verify import VALIDATIONS as LBM
    from porescale.piv.verify import VALIDATIONS as PIV
    from porescale.scene.verify import VALIDATIONS as SCENE
    from porescale.workbench.validations import Validations

    rows = Validations()
    for room in (LBM, DEM, COUPLING, SCENE, PIV):
        rows.include(room)
    return rows
