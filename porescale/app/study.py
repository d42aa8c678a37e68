"""``porescale study``: where the fluid and its coupling stay stable, and where they are right."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.workbench.study import Stability


def stability() -> Stability:
    """All flows, room by room."""
    from porescale.coupling.stability import STABILITY as COUPLING
    from porescale.lbm.stability import STABILITY as LBM
    from porescale.workbench.study import Stability

    flows = Stability()
    for room in (LBM, COUPLING):
        flows.include(room)
    return flows
