"""Convergence of water in unsaturated soil: the columns of `columns.py`, one ladder each."""

from continuum_sph.validation.unsaturated.columns import (
    DRAINED,
    DRAINING,
    RISEN,
    RISING,
    SINKING,
    SPACINGS,
    SUNK,
    Soaking,
    errors,
)
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()
FRONT = 0.25
"""Of the order: a front's place within its row changes a mean error by up to half of it, log2(1.5) = 0.6 over two
doublings, 0.3 of each; rounded down."""


def _column(name: str, title: str, given: Soaking, seconds: float, because: str) -> None:
    """The ladder of a column."""

    @LADDERS.ladder(
        f"unsaturated.{name}",
        title=f"Mean error of the effective saturation over the height {title}",
        along="rows of particles",
        levels=SPACINGS,
        expected=1.0,
        within=FRONT,
        because=because,
    )
    def error(rows: float) -> float:
        """Against finite differences on 300 cells."""
        return errors(given, seconds)[SPACINGS.index(int(rows))]


FIRST = "a front is known to a row: first order; its place within a row decides a quarter of the order"
_column("capillary_rise", "as water rises for 120 s over a water table", RISING, RISEN, FIRST)
_column("infiltration", "as water sinks in for 60 s", SINKING, SUNK, FIRST)
_column(
    "drainage",
    "as full soil drains for 300 s",
    DRAINING,
    DRAINED,
    "first order at least: without a front, rows next to the sides decide",
)
