"""The ensemble of a case: means over packings with their intervals, beside what a case expects, into its README.

Written from the folder of `porescale sweep cases/NAME --repeat N`, whatever of it has finished, and said so.
"""

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from porescale import open_run
from porescale.common.evidence import files
from porescale.common.record.read_card import read_card
from porescale.common.studies.ensemble_picture import Band, band

CURVES = {"front (m)": "front, cm from the left wall", "centre of mass y (m)": "centre of mass, cm over the floor"}
"""Columns over time, and what the figure calls them."""
START = {"front (m)": 0.09, "centre of mass y (m)": 0.036}
"""m, of the column as the paper draws it: 3 cm wide at the right wall of 12 cm, 7.2 cm high."""
BLUE, GREY, RED = "#2a6f97", "0.25", "#8c1c2f"


def members(folder: Path) -> tuple[list[dict[str, str]], list[Path]]:
    """Lines of ensemble.csv, and the folders of the members that finished."""
    with open(folder / "ensemble.csv", newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    names = lines[0]["members"].split() if lines else []
    there = [folder / name for name in names if (folder / name / "card.json").is_file()]
    return lines, [path for path in there if read_card(path)["outcome"] == "finished"]


def table(lines: Sequence[dict[str, str]], done: Sequence[Path], command: str) -> list[str]:
    """Lines of the README: what each row of expected.toml is over the ensemble, and what made it."""

    def four(text: str) -> str:
        """Four digits of a cell."""
        return f"{float(text):.4g}" if text else "–"

    rows = []
    for line in lines:
        half = f"{0.5 * (float(line['t high']) - float(line['t low'])):.2g}" if line["t high"] else "–"
        ends = f"{four(line['bootstrap low'])} … {four(line['bootstrap high'])}" if line["t high"] else "–"
        band_ = f"{float(line['value']):g} ± {float(line['tolerance']):g} {line['unit']}".rstrip()
        cells = [line["quantity"], band_, f"{four(line['mean'])} ± {half}", four(line["standard error"]), ends]
        rows.append([*cells, four(line["standard deviation"]), f"{line['inside']} of {line['n']}", line["verdict"]])
    header = ["row of `expected.toml`", "expected", "mean ± 95 %", "standard error", "bootstrap 95 %", "one packing ±"]
    first = read_card(done[0])
    cost = np.mean([read_card(path)["core_seconds"] for path in done])
    seed = lines[0]["members"].split()[0].partition("=")[2]
    said = (
        f"{len(done)} of {lines[0]['asked']} packings finished, seeds from {seed} on. Made on {first['started'][:10]} "
        f"at commit {open_run(done[0]).commit} by `{command}`, {cost:.0f} core-seconds a packing."
    )
    return [*files.markdown_table([*header, "packings inside", "verdict"], rows), "", said]


def curves(done: Sequence[Path], column: str) -> list[tuple[Any, Any]]:
    """Times and values of a column in every member."""
    return [(it["time (s)"], it[column]) for it in (open_run(path).series for path in done)]


def surface(done: Sequence[Path]) -> list[tuple[Any, Any]]:
    """Places (m) and heights (m) of the pile at the end of every member."""
    made = []
    for path in done:
        found = open_run(path).table("profile")
        names = [name for name in found if name.startswith("height at x = ")]
        made.append(
            (np.array([float(name.split()[4]) for name in names]), np.array([found[name][-1] for name in names]))
        )
    return made


def picture(lines: Sequence[dict[str, str]], done: Sequence[Path]) -> bytes:
    """Front, centre of mass and final surface of the ensemble, with what the paper draws and the case expects, as a
    PNG."""
    figure = files.new_figure(10.5, 3.4)
    panels = figure.subplots(1, 3)
    for axes, (column, label) in zip(panels, CURVES.items(), strict=False):
        _drawn(axes, curves(done, column))
        axes.plot(0.0, 100.0 * START[column], "s", color=RED, ms=5, clip_on=False, label="the paper's column")
        axes.set(xlabel="time, s", ylabel=label, xlim=(0.0, None), ylim=(0.0, None))
    _expected(panels, lines)
    _drawn(panels[2], surface(done), 100.0)
    panels[2].plot([0, 9, 9, 12], [0, 0, 7.2, 7.2], "--", color=RED, lw=1.0, label="the paper's column")
    panels[2].axhline(1.8, color=GREY, ls=":", lw=1.0, label="the same grains, level")
    panels[2].set(xlabel="place, cm", ylabel="height of the pile at the end, cm", xlim=(0.0, 12.0), ylim=(0.0, None))
    for axes in panels:
        axes.tick_params(labelsize=8)
        axes.legend(fontsize=6.5, frameon=False)
    return files.png(figure, 110)


def _drawn(axes: Any, found: Sequence[tuple[Any, Any]], across: float = 1.0) -> None:
    """Members thin, mean and interval; values in cm.  across : what places are multiplied by."""
    for at, values in found:
        axes.plot(across * at, 100.0 * values, color=BLUE, lw=0.4, alpha=0.35)
    it: Band | None = band(found)
    assert it is not None
    label = f"mean of {it.members}, 95 %"
    axes.plot(across * it.time, 100.0 * it.mean, color=BLUE, lw=1.4, label=label)
    axes.fill_between(
        across * it.time, 100 * (it.mean - it.half), 100 * (it.mean + it.half), color=BLUE, alpha=0.3, lw=0
    )


def _expected(panels: Sequence[Any], lines: Sequence[dict[str, str]]) -> None:
    """What expected.toml allows, where it is a place at a time."""
    style = {"fmt": "none", "ecolor": GREY, "capsize": 3, "elinewidth": 1.0, "zorder": 5, "label": "expected.toml"}
    known = {line["quantity"]: (float(line["value"]), float(line["tolerance"])) for line in lines}
    for name, at in (
        ("centre of mass at 0.25 s", 0.25),
        ("centre of mass at 0.6 s", 0.6),
        ("centre of mass at the end", 1.6),
    ):
        value, tolerance = known[name]
        panels[1].errorbar(at, 100.0 * value, yerr=100.0 * tolerance, **style)
        style["label"] = None
    value, tolerance = known["front at the left wall"]
    panels[0].errorbar(value, 0.075, xerr=tolerance, **style | {"label": "expected.toml"})
