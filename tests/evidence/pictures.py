"""Figures of docs/evidence drawn of what others keep: recorded runs of cases, OpenPIV beside ours, endurance."""

import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

from porescale.common.evidence import files
from porescale.common.evidence.validation_files import BLUE, NEAR, ORANGE, RED
from tests.architecture.sources import ROOT

PAIRS = ROOT / "cases" / "piv_synthetic" / "README.md"
"""Has the table of errors beside OpenPIV, which its script writes."""


def records(root: Path = ROOT) -> dict[str, list[tuple[str, float]]]:
    """(recorded - expected)/tolerance of each number of each case that has a recorded run, with its name."""
    found: dict[str, list[tuple[str, float]]] = {}
    for file in sorted((root / "cases").glob("*/recorded.json")):
        expected: list[dict[str, Any]] = tomllib.loads((file.parent / "expected.toml").read_text("utf-8"))["expected"]
        numbers = json.loads(file.read_text("utf-8"))["numbers"]
        found[file.parent.name] = [
            (row["name"], (numbers[row["name"]] - row["value"]) / row["tolerance"] if row["tolerance"] else 0.0)
            for row in expected
            if row["name"] in numbers
        ]
    return found


def cases_picture(found: dict[str, list[tuple[str, float]]]) -> bytes:
    """A line for each case, a dot for each of its numbers, in two columns, as a PNG."""
    names = list(found)
    half = math.ceil(len(names) / 2)
    figure = files.new_figure(10.0, 1.0 + 0.2 * half)
    columns = figure.subplots(1, 2)
    for axes, mine in zip(columns, (names[:half], names[half:]), strict=True):
        files.striped(axes, [name.replace("_", " ") for name in mine] + [""] * (half - len(mine)), 7.5)
        for at, name in enumerate(mine):
            for _, share in found[name]:
                size = abs(share)
                marker, colour = ("o", BLUE) if size <= NEAR else ("D", ORANGE) if size <= 1 else ("X", RED)
                axes.plot(max(-1.3, min(1.3, share)), at, marker, color=colour, ms=4, mew=0, alpha=0.85, zorder=3)
        for edge in (-1.0, 1.0):
            axes.axvline(edge, color="black", lw=1.0)
            axes.axvspan(edge, 1.35 * edge, color="#dddddd", lw=0, zorder=1)
        axes.axvline(0.0, color="#999999", lw=0.8, zorder=1)
        axes.set_xlim(-1.35, 1.35)
        axes.set_xlabel("(recorded - expected) / tolerance", fontsize=8.5)
    return files.png(figure, 100, files.digest(found))


Pairs = list[tuple[str, list[float]]]


def pairs(text: str) -> Pairs:
    """Rows of the table of errors: name; px, px of OpenPIV, stated px, seconds, seconds of OpenPIV (those that are)."""
    found = []
    for line in re.findall(r"^\| (.+?) \|\s*$", text, re.MULTILINE):
        name, *cells = (cell.strip() for cell in line.split("|"))
        if len(cells) == 5 and re.fullmatch(r"[\d.]+", cells[1]):
            found.append((name, [float(cell) for cell in cells if cell]))
    return found


def peers_picture(rows: Pairs) -> bytes:
    """Errors and times of both, a line for each pair, as a PNG."""
    figure = files.new_figure(10.0, 1.3 + 0.24 * len(rows))
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[1.6, 1.0])
    looks = (("o", BLUE, "porescale"), ("s", ORANGE, "OpenPIV 0.26.1"))
    for axes, columns in ((left, (0, 1)), (right, (3, 4))):
        files.striped(axes, [name for name, _ in rows], 8)
        for at, (_, numbers) in enumerate(rows):
            if len(numbers) > max(columns):
                values = [numbers[column] for column in columns]
                axes.plot(values, [at, at], color="#999999", lw=1.0, zorder=2)
                for value, (marker, colour, label) in zip(values, looks, strict=True):
                    axes.plot(value, at, marker, color=colour, ms=6, zorder=3, label=label if at == 0 else None)
        axes.grid(True, axis="x", color="#d8d8d8", lw=0.6)
    left.set_xscale("log")
    left.set_xlabel("rms error of a component, px (log scale)", fontsize=8.5)
    right.set_xlim(0, None)
    right.set_xlabel("processor time of a pair, s", fontsize=8.5)
    left.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize=8, frameon=False, ncols=2)
    return files.png(figure, 100, files.digest(dict(rows)))


Lasting = list[tuple[str, float, float]]


def lasting(root: Path = ROOT) -> Lasting:
    """Name, largest change and what is allowed of each quantity of both endurance studies, but for what was found
    wrong, which is a count."""
    found = []
    for folder in ("endurance", "endurance_continuum"):
        file = root / "docs" / folder / "endurance.json"
        for line in json.loads(file.read_text(encoding="utf-8"))["lines"]:
            if not line["quantity"].startswith("found wrong"):
                found.append((f"{line['flow']}: {line['quantity'].removesuffix(' ()')}", line["off"], line["allowed"]))
    return found


def endurance_picture(rows: Lasting) -> bytes:
    """A line for each quantity, its largest change over what is allowed, as a PNG; where none is allowed 0 is 0."""
    figure = files.new_figure(9.0, 1.0 + 0.19 * len(rows))
    axes = figure.subplots()
    least = 1e-6
    files.striped(axes, [name for name, _, _ in rows], 7.5)
    for at, (_, off, allowed) in enumerate(rows):
        share = off / allowed if allowed else math.inf if off else 0.0
        marker, colour = ("<", BLUE) if share < least else ("o", BLUE) if share <= 1 else ("X", RED)
        axes.plot(min(max(share, least), 5.0), at, marker, color=colour, ms=5, zorder=3, clip_on=False)
    axes.axvline(1.0, color="black", lw=1.0)
    axes.axvspan(1.0, 5.0, color="#dddddd", lw=0, zorder=1)
    axes.set_xscale("log")
    axes.set_xlim(least, 5.0)
    axes.set_xlabel(f"largest change / allowed (triangle: none, or less than {least:g})", fontsize=8.5)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.6)
    return files.png(figure, 100, files.digest({"rows": rows}))


def write(folder: Path) -> None:
    """Write cases.png, peers.png and endurance.png into ``folder``."""
    (folder / "endurance.png").write_bytes(endurance_picture(lasting()))
    (folder / "cases.png").write_bytes(cases_picture(records()))
    (folder / "peers.png").write_bytes(peers_picture(pairs(PAIRS.read_text(encoding="utf-8"))))
