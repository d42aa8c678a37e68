"""The part of `porescale homogenise` that shears its specimens at the inertial numbers of homogenise.rates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from porescale.common.cli.options import say
from porescale.common.cli.sweep import conclude

if TYPE_CHECKING:
    from porescale.analysis.material import Known
    from porescale.analysis.shear_rate import Steady
    from porescale.builders.scene import Scene as Tables
    from porescale.common.studies.runner import Campaign, Ended

SHEARED, FOLDER = "shear.toml", "sheared"


class Rates(NamedTuple):
    """asked : inertial numbers, none where a scene asks for none;  tests : of each packing, in their order."""

    asked: tuple[float, ...] = ()
    tests: tuple[tuple[Steady, ...], ...] = ()


def sheared(
    scene: Tables, specimen: dict[str, Any], of: Campaign, seeds: Sequence[int], jobs: int | None
) -> tuple[int, Rates]:
    """Exit code and what was measured: every packing of ``seeds`` at every rate, each in a run folder of its own.

    specimen : its tables;  of : the campaign of its biaxial tests, whose folder's parent gets SHEARED and FOLDER.
    """
    from porescale.analysis.homogenise import packing_of
    from porescale.analysis.shear_rate import settings, steady
    from porescale.analysis.shear_rate import sheared as tables_of
    from porescale.builders.initial.contact_laws import MaterialPlan
    from porescale.cli.homogenise_specimen import specimen_file
    from porescale.common.record.series import read_series
    from porescale.common.studies.parameter_table import Point
    from porescale.demseg.convert import toml

    assert scene.homogenise
    asked, folder = scene.homogenise.rates, of.folder.parent
    specimen_file(folder, SHEARED, toml(tables_of(scene, specimen)))
    campaign = replace(of, scene=folder / SHEARED, folder=folder / FOLDER)
    points = [
        Point(f"packing-{seed}_inertial-{rate:g}", (f"grains.packing.seed={seed}", *settings(scene, rate)))
        for seed in seeds
        for rate in asked
    ]
    ends: dict[str, Ended] = {ended.point.name: ended for ended in campaign.all(points, jobs, say)}
    if code := conclude([ends[point.name] for point in points]):
        return code, Rates()
    diameter, density = packing_of(scene).diameter, MaterialPlan.of(scene).density(packing_of(scene).material)
    found = [steady(read_series(ends[it.name].folder / "series.csv"), diameter, density) for it in points]
    every = len(asked)
    return 0, Rates(asked, tuple(tuple(found[k : k + every]) for k in range(0, len(found), every)))


def known_of(rates: Rates) -> dict[str, Known]:
    """All numbers of the rates, with their intervals; empty where none were asked for."""
    from porescale.analysis.shear_rate import known_law, known_points

    return {**known_points(rates.asked, rates.tests), **known_law(rates.tests)} if rates.asked else {}


def about(rates: Rates, found: dict[str, Known]) -> tuple[dict[str, Any], list[str]]:
    """What [made] holds of the rates, and their doubts; both empty where none were asked for."""
    from porescale.analysis.doubts import rate_doubts
    from porescale.analysis.shear_rate import SHEAR, WARM, inertial_numbers

    if not rates.asked:
        return {}, []
    inertial = inertial_numbers(rates.tests).tolist()
    few = min(it.independent for each in rates.tests for it in each)
    made = {
        "rates": list(rates.asked), "inertial_numbers": inertial, "shear": SHEAR, "shear_before_means": WARM,
        "fewest_independent_values": few,
    }  # fmt: skip
    return made, rate_doubts(found, rates.asked, inertial)


def laws_of(scene: Tables, found: dict[str, Known]) -> dict[str, dict[str, float]]:
    """[softening] and [rate] of the material file, of those laws that are handed over."""
    from porescale.analysis import shear_rate, softening
    from porescale.analysis.homogenise import packing_of

    made = {"softening": softening.softening_table(found)} if softening.handed_over(found) else {}
    if shear_rate.handed_over(found):
        made["rate"] = shear_rate.rate_table(found, packing_of(scene).diameter)
    return made
