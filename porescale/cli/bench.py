"""``porescale bench``: the rates of every room, and of the main job as a whole."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.common.evidence.benchmarks import Benchmarks

CASES = Path(__file__).resolve().parents[2] / "cases"
"""In a checkout; elsewhere there is no front to hold to its promise."""


def benchmarks() -> Benchmarks:
    """All rows, room by room."""
    from porescale.benchmarks.column import BENCHMARKS as SCENE
    from porescale.benchmarks.dem import BENCHMARKS as DEM
    from porescale.benchmarks.lbm import BENCHMARKS as LBM
    from porescale.benchmarks.piv import BENCHMARKS as PIV
    from porescale.benchmarks.psm import BENCHMARKS as COUPLING
    from porescale.cli.main import PACKAGE
    from porescale.common.evidence.benchmarks import Benchmarks
    from porescale.common.studies.budget_check import benchmark

    rows = Benchmarks()
    for room in (LBM, COUPLING, DEM, SCENE, PIV):
        rows.include(room)
    rows.include(benchmark(PACKAGE, CASES / "column_collapse"))
    return rows
