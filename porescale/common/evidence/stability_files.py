"""The files of a stability map: stability.json, .csv, .md and .png, each whole or not at all."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.report import shown
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.version import VERSION
from porescale.common.evidence import files
from porescale.common.evidence.stability import RIGHT, STABLE, UNSTABLE, Flow, Row, holds_up_to

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAME = "stability"
SIGNS = {RIGHT: "●", STABLE: "○", UNSTABLE: "×"}
"""Sign of each verdict in the table."""
COLOURS = {RIGHT: "#2c7fb8", STABLE: "#fec44f", UNSTABLE: "#a50f15"}
"""A verdict in the picture: three hues that stay apart without colour, too."""


def write(folder: Path, command: str, flows: Sequence[Flow], rows: Sequence[Row], quick: bool) -> None:
    """Write the four files into ``folder``, which is made if it is not there."""
    rows = [row for flow in flows for row in rows if row.flow == flow.name]
    about = {"command": command, "version": VERSION, "quick": quick, "flows": [as_dict(it, quick) for it in flows]}
    files.write_study(
        folder,
        NAME,
        json=files.json_text([row.as_dict() for row in rows], about),
        csv=csv_text(rows),
        md=markdown(command, flows, rows, quick),
        png=picture(flows, rows, quick),
    )


def stored(folder: Path, flows: Iterable[Flow], quick: bool) -> list[Row]:
    """Rows of a map that ``folder`` holds already, of those ``flows`` whose laws and values are still the same.

    Raises InputError where its file is torn.
    """
    rows = files.stored_rows(folder / f"{NAME}.json", _row)
    found: list[Row] = []
    for flow in flows:
        mine = [row for row in rows if row.flow == flow.name]
        wanted = {(law, x, y) for law in flow.laws(quick) for x in flow.x.chosen(quick) for y in flow.y.chosen(quick)}
        found += mine if {(row.law, row.x, row.y) for row in mine} == wanted else []
    return found


def require_quick(folder: Path) -> None:
    """InputError where ``folder`` holds a map of all laws and values, of which `--quick` would leave nothing."""
    file = folder / f"{NAME}.json"
    if files.stored_rows(file, _row) and not json.loads(file.read_text(encoding="utf-8")).get("quick"):
        problem, repair = f"would replace the whole map in {folder}", "name another folder by --out"
        raise InputError(Fault("--quick", None, problem, repair=repair))


def _row(row: dict[str, Any]) -> Row:
    """A row as JSON keeps it; its missing numbers are nan."""
    return Row(**row | {"numbers": {name: math.nan if it is None else it for name, it in row["numbers"].items()}})


def as_dict(flow: Flow, quick: bool) -> dict[str, Any]:
    """Description of a flow for JSON."""
    x, y = ({"name": axis.name, "values": axis.chosen(quick)} for axis in (flow.x, flow.y))
    return {
        "name": flow.name, "title": flow.title, "x": x, "y": y, "laws": list(flow.laws(quick)), "right": flow.right,
        "because": flow.because, "limit": flow.limit,
    }  # fmt: skip


def csv_text(rows: Sequence[Row]) -> str:
    """CSV text of the map, one line for each try."""
    names = sorted({name for row in rows for name in row.numbers})
    lines = []
    for row in rows:
        error = "" if row.error is None else f"{row.error:.4g}"
        more = [f"{row.numbers[name]:.4g}" if name in row.numbers else "" for name in names]
        lines.append([row.flow, row.law, f"{row.x:g}", f"{row.y:g}", row.verdict, error, int(row.ran), *more])
    return files.csv_text(["flow", "law", "x", "y", "verdict", "error", "ran", *names], lines)


def markdown(command: str, flows: Sequence[Flow], rows: Sequence[Row], quick: bool) -> str:
    """A table for each flow: laws down, x across, and in each place a sign for each y."""
    verdict = {(row.flow, row.law, row.x, row.y): row.verdict for row in rows}
    legend = ", ".join(f"{SIGNS[name]} {text}" for name, text in _LEGEND.items())
    parts = [
        f"# Where it stays stable, and where it is right\n\nMade by `{command}`. {legend}.\n\n![map]({NAME}.png)\n"
    ]
    for flow in flows:
        xs, ys = flow.x.chosen(quick), flow.y.chosen(quick)
        parts.append(f"\n## {flow.name}\n\n{flow.title}. Right: {flow.because}.\n")
        inside = f"in each place {_values(flow, ys)} from left to right" if len(ys) > 1 else _values(flow, ys)
        parts.append(f"Across {flow.x.name}; {inside}.\n")
        more = [f"{flow.limit}: holds up to", "fails from"] if flow.limit else []
        table = []
        for law in flow.laws(quick):
            cells = ["".join(SIGNS[verdict[flow.name, law, x, y]] for y in ys) for x in xs]
            mine = [row for row in rows if (row.flow, row.law) == (flow.name, law)]
            cells += [_edge(value) for value in holds_up_to(mine, flow.limit)] if flow.limit else []
            table.append([law, *cells])
        parts += files.markdown_table(["law", *map(shown, xs), *more], table)
    return "\n".join(parts) + "\n"


def _edge(value: float) -> str:
    return f"{value:.3g}" if math.isfinite(value) else "–"


_LEGEND = {RIGHT: "stable and right", STABLE: "stable", UNSTABLE: "unstable"}


def _values(flow: Flow, ys: Sequence[float]) -> str:
    return f"{flow.y.name} {', '.join(map(shown, ys))}"


def picture(flows: Sequence[Flow], rows: Sequence[Row], quick: bool) -> bytes:
    """A panel for each flow, as a PNG: laws down, each with a strip for each y, x across; many in two columns."""
    from matplotlib.patches import Patch

    columns = _columns(flows, quick)
    tallest = max(sum(_height(flow, quick) for flow in column) for column in columns)
    figure = files.new_figure(9.5 * len(columns), 1.0 + tallest)
    parts = figure.subfigures(1, len(columns), squeeze=False)[0]
    for part, column in zip(parts, columns, strict=True):
        ratios = [_height(flow, quick) for flow in column]
        for flow, axes in zip(
            column, part.subplots(len(column), 1, squeeze=False, height_ratios=ratios)[:, 0], strict=True
        ):
            _panel(axes, flow, rows, quick)
    patches = [Patch(color=COLOURS[name], label=text) for name, text in _LEGEND.items()]
    figure.legend(handles=patches, loc="outside upper center", ncols=len(patches), frameon=False)
    return files.png(figure, 100)


def _height(flow: Flow, quick: bool) -> float:
    """Height of the panel of ``flow``, inches."""
    return 1.4 + 0.09 * flow.count(quick)


def _columns(flows: Sequence[Flow], quick: bool) -> list[Sequence[Flow]]:
    """Flows in one column, or more than two in the two, one after the other, that differ least in height."""
    if len(flows) < 3:
        return [flows]
    heights = [_height(flow, quick) for flow in flows]
    cut = min(range(1, len(flows)), key=lambda k: abs(sum(heights[:k]) - sum(heights[k:])))
    return [flows[:cut], flows[cut:]]


def _panel(axes: Axes, flow: Flow, rows: Sequence[Row], quick: bool) -> None:
    laws, xs, ys = list(flow.laws(quick)), flow.x.chosen(quick), flow.y.chosen(quick)
    for row in rows:
        if row.flow == flow.name:
            strip = laws.index(row.law) * (len(ys) + 0.6) + ys.index(row.y)
            at = xs.index(row.x)
            axes.broken_barh([(at - 0.48, 0.96)], (strip, 0.92), color=COLOURS[row.verdict])
    axes.set_xticks(range(len(xs)), [shown(x) for x in xs])
    axes.set_yticks([k * (len(ys) + 0.6) + len(ys) / 2 for k in range(len(laws))], laws, fontsize=8)
    axes.set_xlim(-0.6, len(xs) - 0.4)
    axes.invert_yaxis()
    axes.set_xlabel(flow.x.name)
    axes.set_title(f"{flow.title}\n{_values(flow, ys)}{' downwards' * (len(ys) > 1)}", loc="left", fontsize=9)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
