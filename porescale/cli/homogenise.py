"""``porescale homogenise``: what soil a packing of grains makes, as a material file that continuum-sph reads."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from porescale.cli.homogenise_rates import Rates, known_of, laws_of, sheared
from porescale.cli.homogenise_rates import about as about_rates
from porescale.common.api.folders import output_folder
from porescale.common.cli.options import (
    Quality,
    Scene,
    Settings,
    ThreadsOfEach,
    each_threads,
    require_scene,
    say,
    use_threads,
)
from porescale.common.cli.sweep import Again, Jobs, Scheduler, conclude, enlist, laid_over
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.version import VERSION

if TYPE_CHECKING:
    from porescale.analysis.material import Known
    from porescale.builders.scene import Scene as Tables
    from porescale.common.core.types import Floats
    from porescale.common.studies.runner import Campaign, Ended
    from porescale.dem.contact.linear import Linear

    Packed = tuple[Floats, Floats, tuple[float, float]]

SPECIMEN, PORES, SPRINGS = "specimen.toml", "permeability.json", "stiffness.json"
UNTIL = {
    "friction": "critical friction angle", "peak": "peak friction angle", "dilatancy": "peak dilatancy angle",
    "porosity": "porosity", "stiffness": "stiffness", "exponent": "exponent of stiffness",
    "permeability": "permeability",
}  # fmt: skip
"""Words of `--until`."""
MOST = 1000
"""Packings, as of [homogenise]."""
HEAD = """\
# What soil these grains make; a scene of continuum-sph takes it over with
#   [soil]
#   material = "material.toml"
"""


def homogenise(
    scene: Scene,
    /,
    *,
    quality: Quality = None,
    settings: Settings = None,
    until: Annotated[
        str | None, Parameter(help="friction=2%: more packings until that interval (95 %) is as small")
    ] = None,
    out: Annotated[str | None, Parameter(help="folder; runs/ and the scene's name and _soil if not given")] = None,
    jobs: Jobs = None,
    threads: ThreadsOfEach = 1,
    scheduler: Scheduler = None,
    again: Again = False,
) -> int:
    """Measure the soil that a scene's packing makes: strength, stiffness, porosity and permeability, with intervals.

    Several packings are compressed in periodic cells (biaxial tests) and flow is driven through them, as [homogenise]
    of the scene gives; with homogenise.rates they are sheared at those inertial numbers, too.  material.toml is what
    `[soil] material = "material.toml"` of a continuum-sph scene reads; homogenise.csv and .png show what it stands on.
    What was stopped goes on when called again.
    """
    each_run = each_threads(threads)
    start = require_scene(scene, "porescale")
    from porescale.analysis.homogenise import lambda_error, section_of, specimen
    from porescale.analysis.material import known
    from porescale.builders.scene import Scene as SceneType
    from porescale.cli.homogenise_specimen import specimen_file
    from porescale.common.schema.sections import load
    from porescale.common.studies.runner import Campaign
    from porescale.demseg.convert import toml

    read = load(start, SceneType, quality=quality, overrides=settings or ())
    test = specimen(read)
    request = section_of(read)
    aim = None if until is None else _aim(until)
    folder = output_folder(out, f"{read.name}_soil")
    campaign = Campaign("porescale", folder / SPECIMEN, folder / "specimens", threads=each_run, again=again)
    enlist(campaign, jobs, scheduler)
    specimen_file(folder, SPECIMEN, toml(test))
    use_threads(each_run)
    first, count = test["grains"]["packing"]["seed"], request.packings
    ends: list[Ended] = []
    while True:
        ends += _specimens(campaign, range(first + len(ends), first + count), jobs)
        if code := conclude(ends):
            say(f"no material file: finish these first, by the same command in {folder}")
            return code
        rows = _numbers(read, ends, request.cells)
        found = known(rows, lambda_error(read))
        more = 0 if aim is None else _more(found, *aim)
        if not more:
            break
        count += more
    rates = Rates()
    if request.rates:
        code, rates = sheared(read, test, campaign, range(first, first + count), jobs)
        if code:
            say(f"no material file: finish these first, by the same command in {folder}")
            return code
    words = [
        "porescale",
        "homogenise",
        str(scene),
        *laid_over(quality, settings),
        *(["--until", until] if until else []),
    ]
    print(write(folder, read, shlex.join(words), ends, rows, rates))
    return 0


def _specimens(campaign: Campaign, seeds: range, jobs: int | None) -> list[Ended]:
    """The tests of the packings of ``seeds``, in their order."""
    from porescale.common.studies.parameter_table import Point

    points = [Point(f"packing-{seed}", (f"grains.packing.seed={seed}",)) for seed in seeds]
    found = {ended.point.name: ended for ended in campaign.all(points, jobs, say)}
    return [found[point.name] for point in points]


def _aim(text: str) -> tuple[str, float]:
    """Number and share of `--until`; InputError where it is no such text."""
    from porescale.common.cli.pick import share

    word, _, small = text.partition("=")
    if word.strip() not in UNTIL:
        raise InputError(Fault("--until", text, "names no number", "", ", ".join(UNTIL), "write it as friction=2%"))
    return UNTIL[word.strip()], share("--until", small)


def _more(found: Mapping[str, Known], name: str, small: float) -> int:
    """How many packings more the interval of a number takes; 0 where it is small enough, or never will be."""
    from porescale.common.core.statistics import needed

    if name not in found:
        say(f"--until: {name} is absent, more packings do not show it")
        return 0
    it = found[name]
    aim, have = small * abs(it.mean), len(it.values)
    if it.interval <= aim:
        return 0
    if it.systematic >= aim:
        say(f"--until: {name} {it.text()}: lattice and lambda alone leave ± {it.systematic:.2g}, whatever the packings")
        return 0
    count = needed(it.values, math.sqrt(aim**2 - it.systematic**2))
    say(f"{name} {it.text()} after {have} packings; about {count:.3g} are needed")
    if have >= MOST:
        say(f"--until: stopped at {MOST} packings")
        return 0
    return int(min(max(count - have, 1), have, MOST - have))  # a deviation of few is not trusted with more than twice


def _numbers(scene: Tables, ends: Sequence[Ended], cells: int) -> list[dict[str, float]]:
    """All numbers of the finished specimens: of their tests and contacts, and of the flow through them where lambda is
    stated."""
    from porescale.analysis.biaxial import numbers
    from porescale.analysis.homogenise import law_of, pressure_of
    from porescale.common.record.series import read_series

    made = numbers([read_series(ended.folder / "series.csv") for ended in ends])
    ratio = scene.grains.hydraulic_radius_ratio if scene.grains else None
    for row, ended in zip(made, ends, strict=True):
        packed = _packed(ended.folder)
        row |= _stiffness(ended.folder, packed, law_of(scene), pressure_of(scene))
        if ratio is not None:
            row |= _pores(ended.folder, packed, ratio, cells)
    return made


def _packed(folder: Path) -> Packed:
    """Positions (n, 2) m, radii (n,) m and cell (width, height) m of a specimen before its test."""
    from porescale.common.record.open_run import open_run

    run = open_run(folder)
    box = run.card["scene"]["domain"]
    grains = run.snapshot(0).clouds["grains"]
    return grains.position, grains.data["radius"], (float(box["width"]), float(box["height"]))


def _once(path: Path, of: Mapping[str, Any], measure: Callable[[], Mapping[str, float]]) -> dict[str, float]:
    """Numbers of a specimen, kept beside it in a file at ``path`` once they are measured;  of : what they follow."""
    from porescale.common.core.atomic import write_text

    try:
        known = json.loads(path.read_text(encoding="utf-8"))
        if known["of"] == of:
            return {str(name): float(value) for name, value in known["numbers"].items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        pass  # not there, torn or of another question: measured anew
    made = dict(measure())
    write_text(path, json.dumps({"of": of, "numbers": made}, indent=1))
    return made


def _stiffness(folder: Path, packed: Packed, law: Linear, pressure: float) -> dict[str, float]:
    """E, ν and the exponent of stiffness of a specimen before its test."""
    from porescale.analysis.pressed import FURTHER, stiffness_numbers

    of = {**asdict(law), "pressure": pressure, "further": FURTHER}
    return _once(folder / SPRINGS, of, lambda: stiffness_numbers(*packed, law, pressure))


def _pores(folder: Path, packed: Packed, ratio: float, cells: int) -> dict[str, float]:
    """Numbers of the flow through a specimen before and after its test."""
    from porescale.analysis.soil_pores import STEP
    from porescale.coupling.limits import FOR_NARROW_GAPS

    of = {"lambda": ratio, "cells": cells, "step": STEP, "operator": FOR_NARROW_GAPS, "after": True}
    return _once(folder / PORES, of, lambda: _flow(folder, packed, ratio, cells))


def _flow(folder: Path, packed: Packed, ratio: float, cells: int) -> dict[str, float]:
    """The numbers of `_pores`, measured."""
    from porescale.analysis.soil_pores import flow_numbers, sheared_numbers
    from porescale.common.record.open_run import open_run
    from porescale.common.record.series import read_series

    position, radius, (width, height) = packed
    sheared = open_run(folder).snapshot(-1).clouds["grains"]
    made = flow_numbers(position, ratio * radius, (width, height), cells)
    strain = {axis: float(read_series(folder / "series.csv")[f"strain {axis} ()"][-1]) for axis in ("xx", "yy")}
    box = width * math.exp(strain["xx"]), height * math.exp(strain["yy"])
    made |= sheared_numbers(sheared.position, ratio * sheared.data["radius"], box, cells)
    say(f"{folder.name}: K = {made['permeability']:.3g} m^2 at {made['cells']:.3g} cells")
    return made


def write(
    folder: Path,
    scene: Tables,
    command: str,
    ends: Sequence[Ended],
    rows: Sequence[Mapping[str, float]],
    rates: Rates,
) -> str:
    """Write homogenise.csv, homogenise.png and, last, material.toml; gives the text to print about them."""
    from porescale.analysis.biaxial import curves
    from porescale.analysis.homogenise import lambda_error, packing_of, pressure_of
    from porescale.analysis.material import NAME, UNITS, known, tables, text
    from porescale.analysis.softening import known_softening
    from porescale.analysis.soil_pores import known_growth
    from porescale.builders.initial.contact_laws import MaterialPlan
    from porescale.cli.homogenise_picture import picture
    from porescale.common.evidence.files import write_files
    from porescale.common.record.series import read_series
    from porescale.common.studies.sweep_files import csv_text
    from porescale.demseg.convert import toml

    series = [read_series(ended.folder / "series.csv") for ended in ends]
    found, of_rates = known(rows, lambda_error(scene)), known_of(rates)
    more_of_tests = known_softening(series) | known_growth(rows)
    titles = {name: f"{name} ({unit})" if unit else name for name, unit in UNITS.items() if name in found}
    seeds = [int(ended.point.value("grains.packing.seed")) for ended in ends]
    lines = [
        {"seed": seed, **{titles[name]: row[name] for name in titles}} for seed, row in zip(seeds, rows, strict=True)
    ]
    for name in (name for name in of_rates if " at inertial number " in name):
        for line, value in zip(lines, of_rates[name].values, strict=True):
            line[name] = value
    made = about(scene, command, ends, rows, found)
    every = found | more_of_tests | of_rates
    more, doubts = about_rates(rates, every)
    made["doubts"] += doubts
    density = MaterialPlan.of(scene).density(packing_of(scene).material)
    whole = tables(every, density, pressure_of(scene), made | more, laws_of(scene, every))
    material = HEAD + toml(whole)
    write_files(
        folder,
        {
            "homogenise.csv": csv_text(lines),
            "homogenise.png": picture([curves(it) for it in series], every, rates),
            NAME: material,
        },
    )
    warned = [f"warning: {problem}" for problem in made["doubts"]]
    return "\n".join([text(every), *warned, f"{folder / NAME}, homogenise.csv, homogenise.png"])


def about(
    scene: Tables,
    command: str,
    ends: Sequence[Ended],
    rows: Sequence[Mapping[str, float]],
    found: Mapping[str, Known],
) -> dict[str, Any]:
    """Origin of the numbers: [made] of the material file."""
    from porescale.analysis.doubts import doubts as doubts_of
    from porescale.analysis.homogenise import HARD, packing_of, pressure_of, section_of, stiffness_over_pressure
    from porescale.builders.initial.contact_laws import MaterialPlan
    from porescale.common.core.machine import machine

    assert scene.grains
    packing, request, fluid = packing_of(scene), section_of(scene), scene.fluid
    commit = ends[0].card.get("commit") or {}
    hard, ratio = stiffness_over_pressure(scene), scene.grains.hydraulic_radius_ratio
    doubts = doubts_of(rows, found)
    if hard < HARD:
        doubts.append(f"contacts are {hard:.3g} times as stiff as the pressure: below {HARD:g} angles follow them")
    if ratio is None:
        doubts.append("no permeability: grains.hydraulic_radius_ratio, which it follows, is not stated")
    if not all(row.get("steady", 1.0) for row in rows):
        doubts.append("flow did not become steady in every packing: K is a bound from below")
    made: dict[str, Any] = {
        "package": "porescale", "version": VERSION, "commit": str(commit.get("hash", "")),
        "sources": str(ends[0].card.get("sources", "")), "command": command, "machine": machine()["processor"],
        "seeds": [int(ended.point.value("grains.packing.seed")) for ended in ends],
        "grains": request.grains, "diameter": packing.diameter,
        "grain_density": MaterialPlan.of(scene).density(packing.material),
        "settling_friction": packing.settling_friction,
        "settling_rolling_friction": packing.settling_rolling_friction,
        "pressure": pressure_of(scene), "stiffness_over_pressure": hard, "inertial_number": request.inertial_number,
        "strain": request.strain, "doubts": doubts,
    }  # fmt: skip
    if ratio is not None:
        made |= {"lambda": ratio, "lambda_error": request.ratio_error, "cells": rows[0]["cells"]}
    if fluid is not None:
        made |= {"fluid_density": fluid.density}
    return made
