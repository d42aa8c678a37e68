"""A height of water over time: one for ever, or a table of times and heights."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated

from porescale.common.core.errors import Fault
from porescale.common.schema.quantity import Quantity

Row = tuple[
    Annotated[float, Quantity("s", ge=0, help="time from the start")],
    Annotated[float, Quantity("m", ge=0, le=1e5, help="height at a time")],
]


def rows_of(constant: float | None, rise: tuple[Row, ...]) -> tuple[Row, ...]:
    """Rows of time (s) and height (m): a ``constant`` for ever, or those of ``rise``."""
    return rise if constant is None else ((0.0, constant),)


def rise_faults(key: str, name: str, constant: float | None, rise: Sequence[Row]) -> list[Fault]:
    """What is wrong with a height of a section at a ``key``, its ``constant``, whose key is ``name``, or ``rise``."""
    found = []
    if (constant is None) == (not rise):
        found.append(Fault(key, None, f"needs a {name} or a rise, and not both", repair="give one of them"))
    if any(later <= earlier for (earlier, _), (later, _) in pairwise(rise)):
        found.append(Fault(f"{key}.rise", [time for time, _ in rise], "has times that do not rise", "s"))
    return found
