"""The files of validations: rows as JSON, and for each topic a table and a figure of error over tolerance.

A stored row is a `Row` as JSON keeps it with its ``topic``, and ``date`` and ``commit`` of its run.  Where lists of
``reference`` and ``measured`` keep the first numbers only, ``of`` is how many there are; where they are rounded,
``digits`` is to how many.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.core.types import Floats
from porescale.common.evidence import files

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAME = "verify"
BLUE, SKY, ORANGE, RED = "#0072B2", "#B9DDF1", "#E69F00", "#D55E00"
"""Errors; tolerances; errors near their tolerance; errors beyond it (after Okabe & Ito: distinct to the colour-blind).
Shapes tell them apart, too."""
NEAR = 0.9
"""Share of its tolerance from which on an error is drawn as near to it."""
LEAST = 1e-4
"""Smallest error over tolerance that the figure shows; smaller ones stand at the edge."""
SMALL = 1e-3
"""Departure from the reference below which the axis is linear."""
BEYOND = 0.02
"""Departure of a number from its reference from which on the numbers of a row are listed as doubtful."""
MOST = 4
"""Numbers of a list in a cell of the table."""

Stored = Mapping[str, Any]


def stored(file: Path) -> dict[str, dict[str, Any]]:
    """Rows that ``file`` keeps, by name; none where it is not there."""
    if not file.exists():
        return {}
    return {row["name"]: row for row in json.loads(file.read_text(encoding="utf-8"))}


def write(folder: Path, rows: Sequence[Stored]) -> None:
    """Write verify.json, verify.md, and a .png for each topic into ``folder``, which is made if it is not there."""
    made: dict[str, str | bytes] = {f"{NAME}.json": files.json_text(rows)}
    parts = ["# Validations"]
    for topic in dict.fromkeys(str(row["topic"]) for row in rows):
        mine = [row for row in rows if row["topic"] == topic]
        parts += ["", f"## {topic}", "", f"![Error over tolerance: {topic}]({topic}.png)", "", *table(mine)]
        made[f"{topic}.png"] = picture(mine)
    files.write_files(folder, made | {f"{NAME}.md": "\n".join(parts) + "\n"})


def number(value: object, of: int | None = None) -> str:
    """A number, a list of numbers (the first four) or a text, short.  of : how many there are, if more than given."""
    if isinstance(value, list):
        count = of or len(value)
        return ", ".join(map(number, value[:MOST])) + f" … {count} in all" * (count > MOST)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def table(rows: Sequence[Stored]) -> list[str]:
    """Lines of a Markdown table: a row each."""
    lines = []
    for row in rows:
        numbers = [number(row[key], row.get("of")) for key in ("reference", "measured", "error", "tolerance")]
        name = str(row["name"]) + ("" if row["passed"] else " **fails**")
        lines.append([name, row["source"], *numbers, f"{row['date']} {row['commit']}"])
    head = ["validation", "source", "reference", "measured", "error", "tolerance", "run"]
    return files.markdown_table(head, lines)


def doubtful(rows: Sequence[Stored]) -> list[str]:
    """Lines of a Markdown table of the rows that failed, first, whatever their numbers, and of those of which a number
    is further than BEYOND from its reference, or is none, the worst first.

    Rows that passed with an error of 0 are left out: their reference is a bound, which their numbers keep.
    """
    worst = []
    for row in rows:
        off, _ = departures(row)
        share = np.where(np.isnan(off), math.inf, off)
        most = float(share[np.abs(share).argmax()]) if off.size else math.nan
        if not row["passed"] or (row["error"] != 0 and abs(most) > BEYOND):
            worst.append((most, row))
    worst.sort(key=lambda pair: (pair[1]["passed"], -abs(pair[0]) if math.isfinite(pair[0]) else -math.inf))
    lines = []
    for most, row in worst:
        shown = f"{100 * most:+.1f} %" if math.isfinite(most) else "no number"
        name = row["name"] + ("" if row["passed"] else " **fails**")
        lines.append([name, shown, number(row["tolerance"]), row["because"]])
    return files.markdown_table(["row", "worst number, off by", "allowed", "because"], lines)


def digest(rows: Sequence[Stored]) -> str:
    """What tells whether a figure was drawn of these rows: a hash of their names, numbers and tolerances."""
    keys = ("name", "reference", "measured", "error", "tolerance", "passed")
    return files.digest([[row[key] for key in keys] for row in rows])


def departures(row: Stored) -> tuple[Floats, Floats | None]:
    """measured/reference - 1 of each number whose reference is not zero, and how far each may be off for its tolerance.

    None for the latter where the error is neither the largest relative nor the largest absolute one of the numbers,
    to one per cent or what rounding leaves, or where not all numbers are kept: the tolerance is of another measure.
    """
    known, found = (np.atleast_1d(np.asarray(row[key], np.float64)) for key in ("reference", "measured"))
    if known.size != found.size:
        known = np.resize(known, found.size) if known.size == 1 else np.resize(known, 0)
        found = found[: known.size]
    good = known != 0
    off, scale = found[good] / known[good] - 1.0, np.abs(known[good])
    if not good.all() or not off.size or row["error"] is None or row.get("of"):
        return off, None
    rounding = 10.0 ** -row["digits"] if "digits" in row and row["error"] > 1e-2 else 0.0  # less would fit anything
    for allowed in (np.full(off.size, row["tolerance"]), row["tolerance"] / scale):
        worst = float(np.max(np.abs(off) / allowed)) * row["tolerance"] if row["tolerance"] else math.inf
        if math.isclose(worst, row["error"], rel_tol=1e-2, abs_tol=10 * rounding):
            return off, allowed
    return off, None


def picture(rows: Sequence[Stored]) -> bytes:
    """Two panels as a PNG, a line for each row: error over tolerance; measured over reference with the tolerance."""
    figure = files.new_figure(10.0, 1.5 + 0.185 * len(rows))
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[1.0, 1.0])
    names = [str(row["name"]).partition(".")[2].replace("_", " ") for row in rows]
    for axes in (left, right):
        files.striped(axes, names, 7.5)
    _shares(left, rows)
    _ratios(right, rows)
    return files.png(figure, 100, digest(rows))


def _shares(axes: Axes, rows: Sequence[Stored]) -> None:
    """Error over tolerance of each row."""
    groups: dict[str, list[tuple[float, int]]] = {"": [], "near": [], "beyond": [], "at the edge": []}
    for at, row in enumerate(rows):
        share = _share(row)
        kind = "beyond" if not row["passed"] else "near" if share > NEAR else "" if share >= LEAST else "at the edge"
        groups[kind].append((min(max(share, LEAST), 3.0), at))
    looks = {
        "": ("o", BLUE, "error"),
        "near": ("D", ORANGE, f"over {NEAR:g} of the tolerance"),
        "beyond": ("X", RED, "fails"),
        "at the edge": ("<", BLUE, f"error 0, or below {LEAST:g} of the tolerance"),
    }
    for kind, points in groups.items():
        marker, colour, label = looks[kind]
        if points:
            x, y = zip(*points, strict=True)
            axes.plot(x, y, marker, color=colour, ms=5, label=label, clip_on=False, zorder=3)
    axes.axvline(1.0, color="black", lw=1.0)
    axes.axvspan(1.0, 3.0, color="#dddddd", lw=0, zorder=1)
    axes.set_xscale("log")
    axes.set_xlim(LEAST, 3.0)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.6)
    axes.set_xlabel("error / tolerance (a row passes up to 1)", fontsize=8.5)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize=7.5, frameon=False, ncols=1)


def _share(row: Stored) -> float:
    """Error over tolerance; 0 of 0 counts as 0, and no error as beyond."""
    if row["error"] is None:
        return math.inf
    if row["tolerance"] == 0:
        return 0.0 if row["error"] == 0 else math.inf
    return float(row["error"] / row["tolerance"])


def _ratios(axes: Axes, rows: Sequence[Stored]) -> None:
    """measured/reference - 1 of each number, those of a row below each other, with the tolerance around 0."""
    bands: list[tuple[float, float]] = []
    filled: list[tuple[float, float]] = []
    hollow: list[tuple[float, float]] = []
    for at, row in enumerate(rows):
        off, allowed = departures(row)
        places = at + 0.32 * np.linspace(-1.0, 1.0, off.size) if off.size > 1 else np.full(off.size, float(at))
        if allowed is not None:
            bands += zip(np.minimum(allowed, 1.0).tolist(), places.tolist(), strict=True)
        points = hollow if allowed is None else filled
        points += zip(np.clip(off, -1.0, 1.0).tolist(), places.tolist(), strict=True)
    for place, (width, y) in enumerate(bands):
        label = "within the tolerance" if place == 0 else None
        axes.plot([-width, width], [y, y], color=SKY, lw=2.2, solid_capstyle="butt", zorder=2, label=label)
    looks = ((filled, BLUE, "number"), (hollow, "none", "number; its tolerance is of something else"))
    for points, face, label in looks:
        if points:
            axes.plot(
                *zip(*points, strict=True),
                "o",
                ms=3.2,
                mec=BLUE,
                mfc=face,
                mew=0.8,
                zorder=3,
                label=label,
                clip_on=False,
            )
    axes.axvline(0.0, color="black", lw=0.8, zorder=1)
    axes.set_xscale("symlog", linthresh=SMALL, linscale=0.6)
    ticks = (-1.0, -0.1, -0.01, -0.001, 0.0, 0.001, 0.01, 0.1, 1.0)
    axes.set_xticks(ticks, [f"{100 * tick:+g}" if tick else "0" for tick in ticks])
    axes.set_xlim(-1.0, 1.0)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.6)
    axes.set_xlabel("measured / reference - 1, %", fontsize=8.5)
    if filled or hollow:  # rows whose reference is 0 have no ratio
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize=7.5, frameon=False)
