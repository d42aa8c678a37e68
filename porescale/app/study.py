"""``porescale study``: what accuracy costs, where the fluid and its coupling stay stable, and where they are right."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.runs.model import Array
    from porescale.workbench.endurance import Endurances
    from porescale.workbench.parts import Kinds
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


def endurance() -> Endurances:
    """What runs for a million steps."""
    from porescale.coupling.endurance import ENDURANCES

    return ENDURANCES


def parts() -> Kinds:
    """Kinds of scenes, and what each is held against."""
    from porescale.scene.parts import KINDS
    from porescale.scene.parts_rest import KINDS as AT_REST
    from porescale.workbench.parts import Kinds

    kinds = Kinds([])
    for each in (KINDS, AT_REST):
        kinds.include(each)
    return kinds


def features() -> Mapping[str, Callable[[Path, float | None], Array]]:
    """What a trade study may ask of a run besides its tables."""
    from porescale.scene.features import FEATURES

    return FEATURES
