"""The files of a convergence study: convergence.json, .md, and a picture for each topic, each whole or not at all."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.evidence import files
from porescale.common.evidence.convergence import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAME = "convergence"
BLUE, GREY, RED = "#0072B2", "#777777", "#D55E00"
"""Measured errors; the reference slope; an order that does not hold (Okabe & Ito's colours)."""
COLUMNS = 3

Stored = Mapping[str, Any]
"""A row as JSON keeps it: the fields of `Row`, and ``date`` and ``commit`` of its run."""


def stored(folder: Path) -> dict[str, Stored]:
    """Rows that ``folder`` keeps, by name; none where the file is not there, InputError where it is torn."""
    return dict(files.stored_rows(folder / f"{NAME}.json", lambda row: (Row.of(row).name, row)))


def write(folder: Path, about: Mapping[str, Any], rows: Sequence[Stored]) -> None:
    """Write the files into ``folder``, which is made if it is not there.  about : what made them."""
    known = [Row.of(row) for row in rows]
    made: dict[str, str | bytes] = {
        f"{NAME}.json": files.json_text(rows, about),
        f"{NAME}.md": markdown(str(about["command"]), rows),
    }
    for topic in topics(known):
        made[f"{topic}.png"] = picture([row for row in known if row.topic == topic])
    files.write_files(folder, made)


def topics(rows: Sequence[Row]) -> list[str]:
    """The topics of rows, each once, in their order."""
    return list(dict.fromkeys(row.topic for row in rows))


def number(value: float | None) -> str:
    """Two decimals; a dash for None."""
    return "–" if value is None else f"{value:.2f}"


def table(rows: Sequence[Stored]) -> list[str]:
    """Lines of a Markdown table: what is refined, errors, measured and expected order, when and by which commit."""
    lines = []
    for row in rows:
        error = [math.nan if it is None else it for it in row["errors"]]
        steps = ", ".join(f"{level:.4g}: {off:.3g}" for level, off in zip(row["levels"], error, strict=True))
        expected = number(row["expected"])
        if row["expected"] is not None:
            expected = f"{row['expected']:g}, at least {row['expected'] - row['within']:.3g}"
        verdict = " **fails**" if row["holds"] is False else ""
        lines.append([
            row["name"] + verdict, row["title"], row["along"], steps, number(row["measured"]), expected, row["because"],
            f"{row['date']} {row['commit']}",
        ])  # fmt: skip
    head = ["ladder", "error", "refined", "level: error", "order", "expected", "because", "measured at"]
    return files.markdown_table(head, lines)


def markdown(command: str, rows: Sequence[Stored]) -> str:
    """A section for each topic, with its picture and table."""
    parts = [f"# Convergence\n\nMade by `{command}`. Order: least-squares slope of log error against log resolution.\n"]
    for topic in topics([Row.of(row) for row in rows]):
        mine = [row for row in rows if str(row["name"]).startswith(f"{topic}.")]
        parts += [f"\n## {topic}\n", f"![Error over resolution: {topic}]({topic}.png)\n", *table(mine)]
    return "\n".join(parts) + "\n"


def picture(rows: Sequence[Row]) -> bytes:
    """A panel for each row, three in a line: error over resolution, both logarithmic, and the expected slope."""
    across = min(COLUMNS, len(rows))
    down = math.ceil(len(rows) / across)
    figure = files.new_figure(3.6 * across, 3.1 * down)
    panels = list(figure.subplots(down, across, squeeze=False).flat)
    for axes in panels[len(rows) :]:
        axes.set_visible(False)
    for axes, row in zip(panels, rows, strict=False):
        panel(axes, row)
    return files.png(figure, 110, digest(rows))


def digest(rows: Sequence[Row]) -> str:
    """What tells whether a picture was drawn of these rows: a hash of what it shows of them."""
    keys = ("name", "along", "levels", "errors", "measured", "expected", "holds")
    return files.digest([[row.as_dict()[key] for key in keys] for row in rows])


def panel(axes: Axes, row: Row) -> None:
    """Draw a row: its errors over its levels, and the slope of the order that is expected."""
    from matplotlib.ticker import NullFormatter, NullLocator

    good = [(x, y) for x, y in zip(row.levels, row.errors, strict=True) if math.isfinite(y) and y > 0]
    axes.set_xscale("log")
    axes.set_yscale("log")
    if good:
        x, y = zip(*good, strict=True)
        if row.expected is not None:
            line = [y[-1] * (x[-1] / at) ** row.expected for at in (x[0], x[-1])]
            axes.plot((x[0], x[-1]), line, "--", color=GREY, lw=1.2, label=f"order {row.expected:g}")
        measured = "no order" if row.measured is None else f"measured, order {row.measured:.2f}"
        colour = RED if row.holds is False else BLUE
        axes.plot(x, y, "o-", color=colour, lw=1.5, ms=5, label=measured)
        low, high = map(math.log10, axes.get_ylim())
        if math.floor(high) - math.ceil(low) < 1:  # fewer than two powers of ten: an axis without a scale
            axes.set_ylim(10.0 ** math.floor(low), 10.0 ** math.ceil(high))
        axes.legend(fontsize=7.5, frameon=False, loc="best")
    axes.set_xticks(row.levels, [f"{level:g}" for level in row.levels], fontsize=8)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="y", labelsize=8)
    axes.set_xlabel(row.along, fontsize=8)
    axes.set_ylabel("error", fontsize=8)
    axes.set_title(row.name.partition(".")[2].replace("_", " "), fontsize=9, loc="left")
    axes.grid(True, which="major", color="#e5e5e5", lw=0.6)
    axes.spines[["top", "right"]].set_visible(False)
