"""``porescale bench``: the rates of every room, and of the main job as a whole."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.workbench.benchmarks import Benchmarks

CASES = Path(__file__).resolve().parents[2] / "cases"
"""In a checkout; elsewhere there is no front to hold to its promise."""


def benchmarks() -> Benchmarks:
    """All rows, room by room."""
    from porescale.app.main import PACKAGE
    from porescale.coupling.bench import BENCHMARKS as COUPLING
    from porescale.dem.bench import BENCHMARKS as DEM
    from porescale.lbm.bench import BENCHMARKS as LBM
    from porescale.piv.bench import BENCHMARKS as PIV
    from porescale.scene.bench import BENCHMARKS as SCENE
    from porescale.workbench.benchmarks import Benchmarks
    from porescale.workbench.promise import benchmark

    rows = Benchmarks()
    for room in (LBM, COUPLING, DEM, SCENE, PIV):
        rows.include(room)
    rows.include(benchmark(PACKAGE, CASES / "column_collapse"))
    return rows
