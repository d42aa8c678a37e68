"""``porescale study volume``: how large a specimen must be, and what its soil follows, one key at a time."""

from __future__ import annotations

import math
import shlex
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from cyclopts import Parameter

from porescale.cli.homogenise import homogenise
from porescale.common.api.folders import output_folder
from porescale.common.cli.options import Quality, Scene, Settings, ThreadsOfEach, require_scene, say
from porescale.common.cli.sweep import Again, Jobs, Scheduler, laid_over

if TYPE_CHECKING:
    from porescale.common.core.statistics import Sample
    from porescale.common.studies.parameter_table import Point

NAME = "volume"
USUAL = ("homogenise.grains=150,600,2400",)
SHOWN = {
    "critical_friction_angle": "critical angle, degrees", "peak_friction_angle": "peak angle, degrees",
    "porosity": "porosity", "stiffness": "stiffness, Pa", "permeability": "K, m^2",
}  # fmt: skip
"""Quantities that are compared, by their names in material files."""


class Seen(NamedTuple):
    """A quantity at one value of a key: values of the packings, by seed; half of the interval of their mean at 95 %;
    and of the same packings the mean difference from the value before it, with half of its interval (nan: none)."""

    key: str
    value: str
    name: str
    values: dict[int, float]
    half: float
    change: float = math.nan
    change_half: float = math.nan

    @property
    def sample(self) -> Sample:
        """The values of the packings."""
        from porescale.common.core.statistics import Sample

        return Sample(tuple(self.values.values()))

    @property
    def verdict(self) -> str:
        """Whether the change from the value before is told from none."""
        if math.isnan(self.change):
            return ""
        return "resolved" if abs(self.change) > self.change_half else "not resolved"


def volume(
    scene: Scene,
    /,
    *,
    vary: Annotated[list[str] | None, Parameter(help="section.key=a,b,c; repeatable: each by itself")] = None,
    quality: Quality = None,
    settings: Settings = None,
    out: Annotated[str | None, Parameter(help="folder; runs/ and the scene's name and _volume if not given")] = None,
    jobs: Jobs = None,
    threads: ThreadsOfEach = 1,
    scheduler: Scheduler = None,
    again: Again = False,
) -> int:
    """Homogenise a scene at several sizes of its specimen, or values of any key, and compare them with intervals.

    Each `--vary key=a,b,c` is a ladder of its own; without one it is homogenise.grains=150,600,2400.  Neighbours are
    compared packing by packing, on the same seeds: a change within its interval is not resolved.  volume.csv, .md and
    .png; what was stopped goes on when called again.
    """
    from porescale.common.studies.parameter_table import ladders

    start = require_scene(scene, "porescale")
    asked = ladders(vary or USUAL)
    folder = output_folder(out, f"{checked(start, asked, quality, settings or ())}_{NAME}")
    rows: list[Seen] = []
    for ladder in asked:
        before: dict[str, Seen] = {}
        for point in ladder:
            given, place = [*(settings or ()), *point.settings], folder / point.name
            say(f"{point.name}:")
            code = homogenise(
                scene, quality=quality, settings=given, out=str(place), jobs=jobs, threads=threads,
                scheduler=scheduler, again=again,
            )  # fmt: skip
            if code:
                return code
            seen = measured(point, tomllib.loads((place / "material.toml").read_text(encoding="utf-8")), before)
            rows += seen.values()
            before = seen
    varying = [word for text in vary or USUAL for word in ("--vary", text)]
    command = shlex.join(["porescale", "study", NAME, str(scene), *varying, *laid_over(quality, settings)])
    write(folder, command, rows)
    print(f"{folder / NAME}.csv, .md, .png")
    return 0


def checked(start: Path, ladders: Sequence[Sequence[Point]], quality: str | None, settings: Sequence[str]) -> str:
    """Name of the scene; InputError with what is wrong with any of the points, before the first of them is made."""
    from porescale.analysis.homogenise import specimen
    from porescale.builders.scene import Scene as SceneType
    from porescale.common.core.errors import Fault, InputError
    from porescale.common.schema.sections import load

    for text in settings:
        key, _, value = text.partition("=")
        if any(key == point.settings[-1].partition("=")[0] for ladder in ladders for point in ladder):
            raise InputError(Fault(key, value, "is varied, too", repair="leave one out", file="--set"))
    for point in (point for ladder in ladders for point in ladder):
        try:
            read = load(start, SceneType, quality=quality, overrides=(*settings, *point.settings))
            specimen(read)
        except InputError as error:
            places = [f"{point.name}, {it.file}" if it.file else point.name for it in error.faults]
            faults = [replace(it, file=place) for it, place in zip(error.faults, places, strict=True)]
            raise InputError(faults) from None
    return read.name


def measured(point: Point, material: dict[str, Any], before: dict[str, Seen]) -> dict[str, Seen]:
    """What is shown of a material file, beside the same at the value before."""
    from porescale.common.core.statistics import Sample

    key, _, value = point.settings[-1].partition("=")
    made = {}
    for name in SHOWN:
        found = material["measured"].get(name)
        if found is None:
            continue
        scale = math.degrees(1.0) if found["unit"] == "rad" else 1.0
        values = {seed: scale * it for seed, it in zip(material["made"]["seeds"], found["values"], strict=True)}
        seen = Seen(key, value, name, values, scale * found.get("interval", math.nan))
        if name in before:
            old = before[name].values
            changes = [values[seed] - old[seed] for seed in values if seed in old]
            sample = Sample(tuple(changes))
            if math.isfinite(sample.half):
                seen = seen._replace(change=sample.mean, change_half=sample.half)
        made[name] = seen
    return made


def write(folder: Path, command: str, rows: Sequence[Seen]) -> None:
    """volume.csv, volume.md and volume.png."""
    from porescale.common.evidence.files import csv_text, markdown_table, write_study

    header = ["key", "value", "quantity", "packings", "mean", "interval", "one packing", "change", "its interval", ""]
    lines = [
        [it.key, it.value, SHOWN[it.name], len(it.values), it.sample.mean, it.half, it.sample.deviation, it.change,
         it.change_half, it.verdict]
        for it in rows
    ]  # fmt: skip
    shown = [[f"{cell:.4g}" if isinstance(cell, float) and math.isfinite(cell) else "–" if isinstance(cell, float) else
              cell for cell in line] for line in lines]  # fmt: skip
    text = (
        f"# How large a specimen must be\n\nMade by `{command}`. Intervals are half of those at 95 % (Student's t; "
        "of K with the lattice and λ); a change is that from the row before of the same quantity, packing by "
        "packing.\n\n"
        f"![specimens]({NAME}.png)\n\n" + "\n".join(markdown_table(header, shown)) + "\n"
    )
    write_study(folder, NAME, csv=csv_text(header, lines), md=text, png=picture(rows))


def picture(rows: Sequence[Seen]) -> bytes:
    """Every quantity over every ladder, packings as dots, means with their intervals, as a PNG."""
    from porescale.common.evidence.files import new_figure, png

    keys = list(dict.fromkeys(it.key for it in rows))
    names = [name for name in SHOWN if any(it.name == name for it in rows)]
    figure = new_figure(2.6 * len(names), 2.4 * len(keys))
    axes = figure.subplots(len(keys), len(names), squeeze=False)
    for line, key in zip(axes, keys, strict=True):
        for place, name in zip(line, names, strict=True):
            ladder = [it for it in rows if (it.key, it.name) == (key, name)]
            for at, it in enumerate(ladder):
                place.plot([at] * len(it.values), list(it.values.values()), ".", color="#9fb8c8", ms=4)
                half = it.half if math.isfinite(it.half) else 0.0
                place.errorbar(at, it.sample.mean, yerr=half, fmt="o", color="#8c1c2f", ms=4, capsize=4)
            place.set_xticks(range(len(ladder)), [it.value for it in ladder], fontsize=7)
            place.set_xlim(-0.5, len(ladder) - 0.5)
            place.set_title(SHOWN[name], fontsize=8)
            place.set_xlabel(key, fontsize=8)
            place.tick_params(labelsize=7)
    return png(figure, 100)
