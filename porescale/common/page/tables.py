"""Tables of a run folder as a page reads them: every CSV file, columns with their units."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.core.picked import every_so_many
from porescale.common.record.columns import TIME, missing, split

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.core.types import AnyArray

MOST_ROWS = 2000
"""Rows of a table over time that a page holds; of longer ones every so many-th, and the last."""
MOST_PLACES = 30000
"""Rows of a table with a row for each place and time."""
LISTED = 100
"""Rows of a table that is none over time."""
DIGITS = 7


def names(run: Run) -> list[str]:
    """Names of the tables of a run: those over time first."""
    over_time = run.tables
    others = sorted(path.stem for path in run.folder.glob("[!.]*.csv") if path.stem not in over_time)
    return [*over_time, *others]


def table(run: Run, name: str) -> dict[str, Any]:
    """A table: {"name", "kind", "columns": [{"name", "unit"}], "data": a list for each column, "rows": in the file,
    "every": one row in so many is held}.

    kind : "series", a row for each time; "places", a row for each time and place; "list", no numbers over time, or no
    time (its first rows).  What is no number is None.  InputError where there is none of that name.
    """
    if name in run.tables:
        return over_time(name, dict(run.series if name == "series" else run.table(name)))
    path = run.folder / f"{name}.csv"
    if name not in names(run):
        raise missing("table", name, names(run), "the run folder")
    return _listed(name, path)


def over_time(name: str, columns: dict[str, AnyArray]) -> dict[str, Any]:
    """The table of columns of numbers of which the first is time."""
    time = columns[TIME]
    rows = len(time)
    places = bool(rows > 1 and np.any(np.diff(time) == 0.0))
    every = max(1, math.ceil(rows / MOST_ROWS)) if not places else 1
    chosen = np.array(every_so_many(rows, every), int)
    if places and rows > MOST_PLACES:
        times = np.unique(time)
        every = math.ceil(rows / MOST_PLACES)
        chosen = np.flatnonzero(np.isin(time, times[::-every]))
    data = [[_short(value) for value in column[chosen].tolist()] for column in columns.values()]
    return {"name": name, "kind": "places" if places else "series", "columns": [_column(it) for it in columns],
            "data": data, "rows": rows, "every": every}  # fmt: skip


def _listed(name: str, path: Path) -> dict[str, Any]:
    """The first rows of another CSV file, as they are."""
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        lines = list(csv.reader(file))
    head, body = (lines[0], lines[1:]) if lines else ([], [])
    data = [[row[k] if k < len(row) else "" for row in body[:LISTED]] for k in range(len(head))]
    return {"name": name, "kind": "list", "columns": [_column(it) for it in head], "data": data, "rows": len(body),
            "every": 1}  # fmt: skip


def _column(text: str) -> dict[str, str]:
    """Name and unit of "front (m)"."""
    name, unit = split(text)
    return {"name": name, "unit": unit}


def _short(value: float) -> float | None:
    """A number with as many digits as a curve shows, None for none."""
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
