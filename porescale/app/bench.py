"""``porescale bench``: the rates of every room, and of the main job as a whole."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.workbench.benchmarks import Benchmarks


def benchmarks() -> Benchmarks:
    """All rows, room by room."""
    from porescale.coupling.bench import BENCHMARKS as COUPLING
    from porescale.dem.bench import BENCHMARKS as DEM
    from porescale.lbm.bench import BENCHMARKS as LBM
    from porescale.piv.bench import BENCHMARKS as PIV
    from porescale.scene.bench import BENCHMARKS as SCENE
    from porescale.workbench.benchmarks import Benchmarks

    rows = Benchmarks()
    for room in (LBM, COUPLING, DEM, SCENE, PIV):
        rows.include(room)
    return rows
