"""Ensembles over time: means with their intervals, a panel for each column, a colour for each ensemble."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from porescale.common.core.statistics import LEAST, LEVEL, student
from porescale.common.core.types import Floats
from porescale.common.evidence import files
from porescale.common.record.columns import TIME
from porescale.common.studies.ensemble import Ensemble
from porescale.common.studies.quantities import Columns

Tables = Callable[[Path, str], Columns]
MOST = 12
"""Panels."""


class Band(NamedTuple):
    """A column over time in the members of an ensemble.  time (n,) s;  mean, error, half (n,): the mean, its standard
    error (nan of one member) and half of Student's interval (nan below LEAST members);  members : how many."""

    time: Floats
    mean: Floats
    error: Floats
    half: Floats
    members: int


def band(curves: Sequence[tuple[Floats, Floats]]) -> Band | None:
    """The band of curves, each times and values; None without any, or where one has no times that ascend.

    At the times of the first, as far as all have come; the others are interpolated linearly between their own.
    """
    if not curves or any(len(time) < 2 or not (np.diff(time) > 0.0).all() for time, _ in curves):
        return None
    first = curves[0][0]
    over = 0.5 * (first[-1] - first[-2])  # whole steps end a little apart: the last row stands for half a row more
    time = first[first <= min(time[-1] for time, _ in curves) + over]
    values = np.array([np.interp(time, *curve) for curve in curves])
    count = len(values)
    nothing = np.full(len(time), np.nan)
    error = values.std(axis=0, ddof=1) / np.sqrt(count) if count > 1 else nothing
    return Band(time, values.mean(axis=0), error, student(count) * error if count >= LEAST else nothing, count)


def curves_of(one: Ensemble, file: str, column: str, tables: Tables) -> list[tuple[Floats, Floats]]:
    """Times and values of a column in every finished member that has it."""
    made = []
    for ended in one.finished:
        try:
            found = tables(ended.folder, file)
            made.append((np.asarray(found[TIME], float), np.asarray(found[column], float)))
        except (KeyError, ValueError, IndexError, OSError):
            continue
    return made


def picture(found: Sequence[Ensemble], rows: Sequence[Mapping[str, Any]], tables: Tables) -> bytes:
    """The columns that the rows name, over time, as a PNG: members thin, means with Student's interval as a band, and
    as bars what expected.toml allows at a time."""
    columns = list(dict.fromkeys((str(row.get("file", "series")), str(row["column"])) for row in rows))[:MOST]
    across = min(3, max(1, len(columns)))
    down = max(1, -(-len(columns) // across))
    figure = files.new_figure(4.2 * across, 2.9 * down + 0.3 + 0.2 * len(found))
    panels = figure.subplots(down, across, squeeze=False).ravel()
    for axes, (file, column) in zip(panels, columns, strict=False):
        for at, one in enumerate(found):
            _draw(axes, one, curves_of(one, file, column, tables), f"C{at % 10}")
        for row in rows:
            if (str(row.get("file", "series")), str(row["column"])) == (file, column):
                _allowed(axes, row)
        axes.set_ylabel(column.removesuffix(" ()"), fontsize=8)
        axes.set_xlabel(TIME, fontsize=8)
        axes.tick_params(labelsize=7)
        axes.margins(x=0.01)
    for axes in panels[len(columns) :]:
        axes.set_visible(False)
    handles = {name: it for axes in panels for it, name in zip(*axes.get_legend_handles_labels(), strict=True)}
    if handles:
        figure.legend(
            handles.values(), handles, loc="outside lower center", ncols=2 if len(handles) > 1 else 1, fontsize=8
        )
    return files.png(figure, 100)


def _draw(axes: Any, one: Ensemble, curves: Sequence[tuple[Floats, Floats]], colour: str) -> None:
    """The members of an ensemble, their mean and its band."""
    for curve in curves:
        axes.plot(*curve, color=colour, linewidth=0.4, alpha=0.35)
    it = band(curves)
    if it is None:
        return
    bar = (
        f"mean of {it.members} with its {100 * LEVEL:g} % interval" if it.members >= LEAST else f"mean of {it.members}"
    )
    axes.plot(it.time, it.mean, color=colour, linewidth=1.4, label=f"{one.of.name}: {bar}")
    axes.fill_between(it.time, it.mean - it.half, it.mean + it.half, color=colour, alpha=0.3, linewidth=0)


def _allowed(axes: Any, row: Mapping[str, Any]) -> None:
    """What a row allows, where it is at a time, or the time at which a level is passed."""
    at = row.get("at")
    if not {"value", "tolerance"} <= row.keys() or row.keys() & {"minus", "where", "integral"}:
        return
    style = {"fmt": "none", "ecolor": "0.25", "capsize": 3, "elinewidth": 1.0, "zorder": 5, "label": "expected.toml"}
    if isinstance(at, int | float):
        axes.errorbar(at, row["value"], yerr=row["tolerance"], **style)
    elif isinstance(at, Mapping) and "share_of" not in at:
        level = next((at[key] for key in ("first_below", "first_above", "last_above") if key in at), None)
        if level is not None:
            axes.errorbar(row["value"], level, xerr=row["tolerance"], **style)
