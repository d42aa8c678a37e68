"""docs/trade.md: what a decade of core-seconds buys in each case that has a front, read from the front.json files."""

from collections.abc import Mapping
from pathlib import Path

from matplotlib.ticker import LogLocator

from porescale.common.evidence import files
from porescale.common.studies.front import Front, FrontPoint, read_front
from tests.architecture.sources import ROOT

SCENES = {"micro_to_macro": "column.toml"}
"""Scene files of fronts, where they are not scene.toml."""
DECADES = (1.0, 10.0, 100.0)
"""Core-seconds of steps up to which the best point is looked for."""


def fronts(cases: Path = ROOT / "cases") -> dict[str, Front]:
    """The front of each case that has one, by the case's name."""
    return {file.parent.name: read_front(file.parent / "scene.toml") for file in sorted(cases.glob("*/front.json"))}


def table(found: Mapping[str, Front]) -> list[tuple[str, ...]]:
    """A row of cells for each case: what is best up to each decade of core-seconds, and what the whole front spans."""
    rows = []
    for name, front in found.items():
        known = [_within(front, most) for most in DECADES]
        shown = [
            "–" if one is None else "the same" if at and one is known[at - 1] else _point(one)
            for at, one in enumerate(known)
        ]  # fmt: skip
        dear = front.reference.core_seconds if front.reference else None
        rows.append((
            f"[{name}](../cases/{name})", *shown, _bought(front), "exact values" if dear is None else f"{dear:.3g} s",
            front.date,
        ))  # fmt: skip
    return rows


HEADER = (
    "case", *(f"up to {most:g} s" for most in DECADES), "cheapest to best point", "held against", "measured",
)  # fmt: skip


def lines(found: Mapping[str, Front]) -> list[str]:
    """The table as lines of Markdown, with the machines it was measured on."""
    machines = ", ".join(dict.fromkeys(front.machine for front in found.values()))
    return [*files.markdown_table(HEADER, table(found)), "", f"On {machines}, one core each."]


def picture(found: Mapping[str, Front]) -> bytes:
    """Error over core-seconds of every front, as a PNG."""
    figure = files.new_figure(8.0, 5.0)
    axes = figure.subplots()
    for at, (name, front) in enumerate(found.items()):
        seconds = [point.core_seconds for point in front.points]
        errors = [100 * point.error for point in front.points]
        axes.plot(seconds, errors, "o-", color=f"C{at % 10}", ms=5, lw=1.2, label=name.replace("_", " "))
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(LogLocator(subs=(2, 5)))
        axis.set_minor_formatter("{x:g}")
    axes.grid(True, color="#d8d8d8", lw=0.6)
    axes.set_xlabel("core-seconds of steps (PIV: of a pair)")
    axes.set_ylabel("error, %")
    axes.legend(fontsize=8, frameon=False)
    return files.png(figure, 110, files.digest(drawn(found)))


def drawn(found: Mapping[str, Front]) -> dict[str, list[list[float]]]:
    """What the picture shows: core-seconds and error of each point."""
    return {name: [[point.core_seconds, point.error] for point in front.points] for name, front in found.items()}


def _within(front: Front, most: float) -> FrontPoint | None:
    """The most accurate point that takes at most ``most`` core-seconds."""
    return min((it for it in front.points if it.core_seconds <= most), key=lambda it: it.error, default=None)


def _point(point: FrontPoint) -> str:
    return f"{100 * point.error:.2g} %: {point.label}"


def _bought(front: Front) -> str:
    """By what the error is divided and core-seconds are multiplied from the cheapest point to the best."""
    first, last = front.points[0], front.points[-1]
    if first is last:
        return "one point is both"
    return f"error / {first.error / last.error:.3g}, core-seconds × {last.core_seconds / first.core_seconds:.2g}"
