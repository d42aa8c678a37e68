"""The files of a sweep: sweep.csv, sweep.md and sweep.png, and ensemble.csv of repeats, each whole or not at all."""

import contextlib
import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.evidence import files
from porescale.common.record.columns import TIME
from porescale.common.studies import ensemble_files, ensemble_picture
from porescale.common.studies.ensemble import Ensemble, ensembles
from porescale.common.studies.parameter_table import ENSEMBLE, SWEEP, Point
from porescale.common.studies.quantities import Columns, measured, title
from porescale.common.studies.runner import FINISHED, Ended

PANELS = 12
"""Columns that a picture shows."""
ABREAST = 16
"""Columns of a table of sweep.md, about a screen; more stand in tables below it."""
ROUND_OFF = 1e-12
"""Share (of a mass, of a diameter) below which there is nothing but round-off, collected over millions of steps."""
COSTS = {"steps": "step", "seconds (s)": "seconds", "core-seconds (s)": "core_seconds", "memory (B)": "peak_bytes"}
"""Columns of what a point cost, and the keys of a run card they come from."""
Rows = Sequence[Mapping[str, Any]]
"""What is compared, as `porescale.common.studies.quantities` describes a number."""
Tables = Callable[[Path, str], Columns]
"""Gives the columns of a table of a run folder, "series" for series.csv."""


def keys_of(ends: Sequence[Ended]) -> list[str]:
    """What any of the points sets, in the order of first mention."""
    return list(dict.fromkeys(text.partition("=")[0] for ended in ends for text in ended.point.settings))


def number(ended: Ended, row: Mapping[str, Any], tables: Tables) -> float:
    """The number that ``row`` describes, of a finished point; nan where it has no such table or column."""
    try:
        return measured(tables(ended.folder, str(row.get("file", "series"))), row)
    except (KeyError, IndexError, ValueError):
        return math.nan


def line(ended: Ended, keys: Sequence[str], rows: Rows, tables: Tables) -> dict[str, Any]:
    """A point as one line of the table; numbers of points that did not finish are empty."""
    made: dict[str, Any] = {"name": ended.point.name, "quality": ended.point.quality or ""}
    made |= {key: ended.point.value(key) for key in keys}
    made |= {"outcome": ended.outcome, **{name: ended.card.get(key) for name, key in COSTS.items()}}
    for row in rows:
        found = number(ended, row, tables) if ended.outcome == FINISHED else math.nan
        made[title(row)] = found if math.isfinite(found) else None
    return made | {"problem": ended.problem}


def lines_of(ends: Sequence[Ended], rows: Rows, tables: Tables) -> list[dict[str, Any]]:
    """The lines of the table, one for each point."""
    return [line(ended, keys_of(ends), rows, tables) for ended in ends]


def write(
    folder: Path, command: str, ends: Sequence[Ended], rows: Rows, tables: Tables, points: Sequence[Point]
) -> None:
    """Write the files into ``folder``.  ends : of the points that have ended, in their order;  rows : what is compared;
    points : all of the sweep."""
    found = ensembles(points, ends)
    repeated = ensemble_lines(found, rows, tables)
    if repeated:
        files.write_files(folder, {f"{ENSEMBLE}.csv": ensemble_files.csv_text(repeated)})
    if not ends:
        return
    lines = lines_of(ends, rows, tables)
    text = markdown(command, lines, ensemble_files.markdown(repeated) if repeated else ())
    drawn = ensemble_picture.picture(found, rows, tables) if found else picture(ends, rows, tables)
    files.write_study(folder, SWEEP, csv=csv_text(lines), md=text, png=drawn)


def ensemble_lines(found: Sequence[Ensemble], rows: Rows, tables: Tables) -> list[ensemble_files.Line]:
    """The lines of the table of ensembles; [] where nothing is repeated."""
    return ensemble_files.lines_of(found, rows, lambda ended, row: number(ended, row, tables))


def csv_text(lines: Sequence[Mapping[str, Any]]) -> str:
    """One line for each point, every number with all its digits."""
    return files.csv_text(lines[0], [each.values() for each in lines])


def markdown(command: str, lines: Sequence[Mapping[str, Any]], more: Sequence[str] = ()) -> str:
    """The same as tables to read, one where it is not too wide: four digits, empty columns left out;  more : lines that
    follow."""
    shown = [name for name in lines[0] if any(each[name] not in ("", None) for each in lines)]
    parts = [f"# Sweep\n\nMade by `{command}`; the table with all digits is {SWEEP}.csv.\n\n![curves]({SWEEP}.png)\n"]
    tables = []
    for at in range(1, len(shown), ABREAST - 1):  # each with the names of the points, which come first
        columns = [shown[0], *shown[at : at + ABREAST - 1]]
        tables += ["", *files.markdown_table(columns, [[_short(each[name]) for name in columns] for each in lines])]
    return "\n".join([*parts, *tables[1:], *more]) + "\n"


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return "" if value is None else str(value).replace("|", "/")


def picture(ends: Sequence[Ended], rows: Rows, tables: Tables) -> bytes:
    """The columns that the rows name, over time, a panel each, a curve for each finished point, as a PNG.

    Where they are more than `PANELS` those are shown that differ most, and the title says how many are not.
    """
    named = list(dict.fromkeys((str(row.get("file", "series")), str(row["column"])) for row in rows))
    columns = differing(named, ends, tables)
    across = min(3, max(1, len(columns)))
    down = max(1, -(-len(columns) // across))
    figure = files.new_figure(4.2 * across, 2.9 * down + 0.6)
    panels = figure.subplots(down, across, squeeze=False).ravel()
    for axes, (file, column) in zip(panels, columns, strict=False):
        for at, ended in enumerate(ends):
            _curve(axes, ended, file, column, tables, f"C{at % 10}")
        axes.set_title(column, fontsize=9, pad=14)  # over what the numbers beside the axis have in common
        axes.yaxis.get_offset_text().set_fontsize(7)
        axes.set_xlabel(TIME, fontsize=8)
    if len(columns) < len(named):
        words = f"the {len(columns)} of {len(named)} columns that differ most; {SWEEP}.csv has how all of them end"
        figure.suptitle(words, fontsize=9)
    for axes in panels[len(columns) :]:
        axes.set_visible(False)
    handles = dict(zip(*reversed(panels[0].get_legend_handles_labels()), strict=True))
    if handles:
        names = list(handles)[:20]
        figure.legend([handles[name] for name in names], names, loc="outside lower center", ncols=4, fontsize=7)
    return files.png(figure, 100)


def differing(columns: Sequence[tuple[str, str]], ends: Sequence[Ended], tables: Tables) -> list[tuple[str, str]]:
    """At most `PANELS` of ``columns`` (table, name), in their order: those that differ most from point to point."""
    if len(columns) <= PANELS:
        return list(columns)
    most = sorted(columns, key=lambda it: difference(it[0], it[1], ends, tables), reverse=True)[:PANELS]
    return [it for it in columns if it in most]


def difference(file: str, column: str, ends: Sequence[Ended], tables: Tables) -> float:
    """By how much a column's end, least or largest value differs between finished points, over its largest size; 0
    where fewer than two have it, and where a share is nothing but round-off, as that of the fluid's mass."""
    found = []
    for ended in ends:
        with contextlib.suppress(KeyError, ValueError, IndexError, OSError):
            values = np.asarray(tables(ended.folder, file)[column], np.float64)
            values = values[np.isfinite(values)]
            if ended.outcome == FINISHED and values.size:
                found.append((values[-1], values.min(), values.max()))
    if len(found) < 2:
        return 0.0
    size = float(np.abs(found).max())
    if column.endswith("()") and size < ROUND_OFF:
        return 0.0
    return float(np.ptp(found, axis=0).max()) / size if size > 0.0 else 0.0


def _curve(axes: Any, ended: Ended, file: str, column: str, tables: Tables, colour: str) -> None:
    """One point's column over time, if it has it."""
    try:
        found = tables(ended.folder, file)
        time, values = np.asarray(found[TIME]), np.asarray(found[column])
    except (KeyError, ValueError, IndexError, OSError):
        return
    style = "-" if ended.outcome == FINISHED else ":"
    axes.plot(time, values, style, color=colour, linewidth=1.0, label=ended.point.name)
