"""The files of a trade study: front.json, trade.csv, trade.md and trade.png, each whole or not at all."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from porescale.common.core.statistics import LEVEL, Sample
from porescale.common.evidence import files
from porescale.common.studies import ensemble_files
from porescale.common.studies.trade import Traded, rms

FRONT = "front.json"
NAME = "trade"
FORMAT = 2
Caveats = Mapping[tuple[str | None, tuple[str, ...]], tuple[str, float]]
"""What is to be said of points, and of runs longer than what (s), by quality and settings."""


def as_dict(one: Traded, but: str = "", but_after: float = 0.0) -> dict[str, Any]:
    """A point, JSON-able: infinite errors become null.  but : what its errors do not show of runs beyond but_after."""
    made = {key: value for key, value in vars(one).items() if key not in ("point", "error", "errors", "scatter")}
    return made | {
        "name": one.point.name, "quality": one.point.quality, "settings": list(one.point.settings),
        "error": files.finite(one.error), "scatter": one.scatter, "but": but,
        "but_after": but_after,
        "errors": files.finite(one.errors),
    }  # fmt: skip


def front_json(about: Mapping[str, Any], points: Sequence[Traded], caveats: Caveats) -> str:
    """``about`` (command, version, machine, date, …) and the points, a line each, so that two can be compared."""
    lines = (as_dict(one, *caveats.get((one.point.quality, one.point.settings), ("", 0.0))) for one in points)
    return files.json_text(lines, {"format": FORMAT, **about}, "points")


def write(
    folder: Path,
    about: dict[str, Any],
    points: Sequence[Traded],
    packings: Mapping[str, float],
    caveats: Caveats | None = None,
) -> None:
    """Write the files into ``folder``;  ``about`` may hold "references", the numbers of each repeat of the reference.

    packings : how far references of different repeats are off their mean;  caveats : what errors of points do not show.
    """
    dear = about.get("reference", {}).get("core_seconds", 0.0)
    files.write_files(folder, {FRONT: front_json(about | {"packings": dict(packings)}, points, caveats or {})})
    files.write_study(
        folder, NAME, csv=csv_text(points), md=markdown(about, points, packings), png=picture(points, packings, dear)
    )


def csv_text(points: Sequence[Traded]) -> str:
    """CSV text with one line for each point, all digits."""
    names = list(points[0].errors) if points else []
    header = ["knob", "label", "outcome", "on front", "error", "scatter", "core-seconds (s)", "seconds (s)",
              "memory (B)", "steps", *names, "quality", "settings", "repeats", *ensemble_files.WORTH]  # fmt: skip
    rows = [
        [one.knob, one.label, one.outcome, int(one.on_front), one.error, one.scatter, one.core_seconds, one.seconds,
         one.peak_bytes, one.steps, *one.errors.values(), one.point.quality or "", " ".join(one.point.settings),
         len(one.each), *ensemble_files.worth(one.sample)]
        for one in points
    ]  # fmt: skip
    return files.csv_text(header, rows)


def markdown(about: dict[str, Any], points: Sequence[Traded], packings: Mapping[str, float]) -> str:
    """A table from cheap to dear, the front in bold."""
    names = list(points[0].errors) if points else []
    parts = [f"# Speed against accuracy\n\nMade by `{about.get('command', '')}`, {about.get('date', '')}, "
             f"{about.get('machine', {}).get('processor', '')}. Bold: no other point is both cheaper and better.\n\n"
             f"![front]({NAME}.png)\n"]  # fmt: skip
    rows, repeated = [], any(len(one.each) > 1 for one in points)
    for one in sorted(points, key=lambda each: each.core_seconds):
        label = f"**{one.label}**" if one.on_front else one.label
        total = f"{percent(one.error)} ± {percent(one.scatter)}" if math.isfinite(one.error) else one.outcome
        cells = [label, f"{one.core_seconds:.3g}", f"{one.peak_bytes / 2**20:.0f}", total]
        cells += [_mean(one.sample)] * repeated
        rows.append([*cells, *(percent(one.errors[name]) for name in names)])
    if packings:
        cells = ["another packing, finest", "", "", "", *[""] * repeated]
        rows.append([*cells, *(percent(packings.get(name, math.nan)) for name in names)])
    header = ["point", "core-seconds", "memory, MiB", "error ± scatter"]
    header += [f"mean error ± {100 * LEVEL:g} %"] * repeated + names
    return "\n".join([*parts, *files.markdown_table(header, rows), *_references(about)]) + "\n"


def _mean(sample: Sample) -> str:
    """A mean error with half of Student's interval, and of how many it is."""
    if not math.isfinite(sample.half):
        return f"no interval of {len(sample.values)}"
    return f"{percent(sample.mean)} ± {percent(sample.half)} of {len(sample.values)}"


def _references(about: Mapping[str, Any]) -> list[str]:
    """A table of the numbers of the reference over its repeats; none where it has a single one."""
    found: Sequence[Mapping[str, Sequence[float]]] = about.get("references") or ()
    units = {one["name"]: one.get("unit", "") for one in about.get("quantities") or ()}
    if len(found) < 2:
        return []
    rows = []
    for name in found[0]:
        sample = Sample(tuple(float(one[name][0]) for one in found))
        shown = [ensemble_files.short(value) for value in ensemble_files.worth(sample)]
        ends = [" … ".join(pair) if all(pair) else "" for pair in (shown[3:5], shown[5:7])]
        rows.append([name, units.get(name, ""), len(sample.values), shown[0], shown[2], shown[1], *ends])
    header = ["the reference", "unit", "n", "mean", "standard error", "one run ±", f"{100 * LEVEL:g} %", "bootstrap"]
    return ["", *files.markdown_table(header, rows)] if rows else []


def percent(share: float) -> str:
    """A share in per cent, two digits; a dash for what is no number."""
    return f"{100 * share:.2g} %" if math.isfinite(share) else "–"


def picture(points: Sequence[Traded], packings: Mapping[str, float], dear: float = 0.0) -> bytes:
    """Error over core-seconds, a colour for each knob, the front as a line, as a PNG.  dear : core-seconds of the
    reference, which has no error to show; 0 where there is none."""
    figure = files.new_figure(8, 5)
    axes = figure.subplots()
    shown = [one for one in points if math.isfinite(one.error) and one.core_seconds > 0 and one.error > 0]
    for at, knob in enumerate(dict.fromkeys(one.knob for one in shown)):
        mine = [one for one in shown if one.knob == knob]
        axes.errorbar([one.core_seconds for one in mine], [100 * one.error for one in mine],
                      yerr=[100 * min(one.scatter, 0.95 * one.error) for one in mine], fmt="o", color=f"C{at % 10}",
                      capsize=2, markersize=4, linewidth=0.8, label=knob)  # fmt: skip
    best = sorted((one for one in shown if one.on_front), key=lambda one: one.core_seconds)
    axes.plot([one.core_seconds for one in best], [100 * one.error for one in best], "k-", linewidth=0.8, zorder=0,
              label="front")  # fmt: skip
    for one in shown:
        axes.annotate(one.label, (one.core_seconds, 100 * one.error), (4, 4), textcoords="offset points", fontsize=6.5,
                      color="black" if one.on_front else "grey")  # fmt: skip
    if packings:
        floor = 100 * rms(list(packings.values()))
        axes.axhline(floor, color="grey", linestyle=":", linewidth=0.9, label="another packing")
    if dear:
        axes.axvline(dear, color="grey", linestyle="--", linewidth=0.9, label="what errors are held against")
    if shown:  # without a point there is nothing to scale by
        axes.set_xscale("log")
        axes.set_yscale("log")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("{x:g}")
    axes.set_xlabel("core-seconds")
    axes.set_ylabel("error, %")
    if shown:
        axes.legend(fontsize=7, frameon=False)
    return files.png(figure, 110)
