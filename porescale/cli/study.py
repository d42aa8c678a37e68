"""``porescale study``: what accuracy costs, where the fluid and its coupling stay stable, and where they are right."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.common.evidence.endurance import Endurances
    from porescale.common.evidence.overhead import Kinds
    from porescale.common.evidence.stability import Stability
    from porescale.common.record.model import Array


def stability() -> Stability:
    """All flows, room by room."""
    from porescale.benchmarks.stability_lbm import STABILITY as LBM
    from porescale.benchmarks.stability_psm import STABILITY as COUPLING
    from porescale.common.evidence.stability import Stability

    flows = Stability()
    for room in (LBM, COUPLING):
        flows.include(room)
    return flows


def endurance() -> Endurances:
    """What runs for a million steps."""
    from porescale.benchmarks.endurance import ENDURANCES

    return ENDURANCES


def parts() -> Kinds:
    """Kinds of scenes, and what each is held against."""
    from porescale.benchmarks.overhead import KINDS
    from porescale.benchmarks.overhead_at_rest import KINDS as AT_REST
    from porescale.common.evidence.overhead import Kinds

    kinds = Kinds([])
    for each in (KINDS, AT_REST):
        kinds.include(each)
    return kinds


def features() -> Mapping[str, Callable[[Path, float | None], Array]]:
    """What a trade study may ask of a run besides its tables."""
    from porescale.analysis.features import FEATURES

    return FEATURES
