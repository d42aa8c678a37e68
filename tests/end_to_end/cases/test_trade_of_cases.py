"""What accuracy costs in the shipped cases: plans that their scenes accept, exact values, and fronts of these plans."""

import json
import math
import tomllib
from itertools import pairwise

import numpy as np
import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as GRAINS
from porescale.common.core.constants import GRAVITY
from porescale.common.schema.sections import load
from porescale.common.studies.front import read_front
from porescale.common.studies.trade_plan import read_plan
from porescale.output.case import expected
from tests.evidence.fronts import SCENES
from tests.reference.folders import CASES, script

PLANS = sorted(CASES.glob("*/trade.toml"))
FRONTS = sorted(CASES.glob("*/front.json"))


@pytest.mark.parametrize("plan", PLANS, ids=lambda path: path.parent.name)
def test_every_point_of_a_plan_is_a_scene_and_the_front_has_all_of_them(plan):
    front = json.loads((plan.parent / "front.json").read_text(encoding="utf-8"))
    package = {it.name: it for it in (GRAINS, CONTINUUM)}[front["package"]]
    scene = plan.parent / SCENES.get(plan.parent.name, "scene.toml")
    planned = read_plan(scene, None)
    points = [point for _, _, point in planned.variants()]
    reference = planned.reference_point()
    for point in [*points, *([reference] if reference else [])]:
        load(scene, package.scene(), quality=point.quality, overrides=point.settings)
    kept = {(row["quality"], tuple(row["settings"])) for row in front["points"]}
    assert kept == {(point.quality, point.settings) for point in points}  # else: study trade, and its front.json
    assert [it["name"] for it in front["quantities"]] == [it.name for it in planned.quantity]


@pytest.mark.parametrize("front", FRONTS, ids=lambda path: path.parent.name)
def test_every_front_can_be_picked_from(front):
    points = read_front(front.parent / "scene.toml").points  # core-seconds as recorded: nothing is timed here
    assert all(one.core_seconds < two.core_seconds and one.error > two.error for one, two in pairwise(points))


def series(z: float, time: float, stiffness: float) -> tuple[float, float]:
    """Excess pressure at z over the weight of the layer of cases/consolidation, and settlement there (m), by Terzaghi.

    stiffness : of the water, K_w, Pa; E of the soil is 7.43 MPa, Poisson's ratio 0.3, k 1 mm/s, n 0.4, H 1 m.
    """
    modulus, porosity = 7.43e6 * (1.0 - 0.3) / ((1.0 + 0.3) * (1.0 - 2.0 * 0.3)), 0.4
    weight = (1.0 - porosity) * (2650.0 - 1000.0) * GRAVITY
    spread = 1e-3 / (1000.0 * GRAVITY * (1.0 / modulus + porosity / stiffness))
    wave = math.pi * (np.arange(4000) + 0.5)
    left = np.exp(-(wave**2) * spread * time)
    settled = z - z * z / 2.0 - float(np.sum(2.0 / wave**3 * np.sin(wave * z) * left))
    return float(np.sum(2.0 / wave**2 * np.cos(wave * z) * left)), weight / modulus * settled


def exact(stiffness: float = 2.2e9) -> dict[str, float]:
    """The exact value of each quantity of cases/consolidation/trade.toml, with the water of nature."""
    weight = 0.6 * 1650.0 * GRAVITY
    made = {}
    for time in (0.06, 0.12, 0.3, 0.6):
        for name, z in (("pressure at the floor", 0.0), ("pressure in the middle", 0.5)):
            made[f"{name} at {time:g} s"] = 1000.0 * GRAVITY * (1.0 - z) + weight * series(z, time, stiffness)[0]
        made[f"settlement at {time:g} s"] = series(0.975, time, stiffness)[1]  # of the uppermost of 20 rows
    return made


def test_the_exact_values_of_consolidation_are_those_of_the_series():
    rows = tomllib.loads((CASES / "consolidation" / "trade.toml").read_text(encoding="utf-8"))["quantity"]
    known, soft = exact(), exact(stiffness=20 * 0.4 * 1e7)
    for row in rows:
        last_digit = 1.0 if row["unit"] == "Pa" else 1e-7  # what the file rounds to
        assert abs(row["exact"] - known[row["name"]]) <= 0.51 * last_digit
        assert abs(row["exact"] - soft[row["name"]]) > last_digit  # the check that must fail: water 20 n M stiff


def test_the_exact_values_of_the_dam_are_those_that_it_expects():
    folder = CASES / "rectangular_dam"
    rows = {it["name"]: it for it in expected(folder)}
    for row in tomllib.loads((folder / "trade.toml").read_text(encoding="utf-8"))["quantity"]:
        assert row["exact"] == rows[row["name"]]["value"]


@pytest.fixture(scope="module")
def windows():
    return script("piv_synthetic", "windows")


def test_wide_windows_lose_small_vortices_and_straight_lines_between_few_vectors_do(windows):
    made = windows.pair(*windows.lab.TABLE["taylor_green_64"], 0)
    usual, wide, few = (windows.error(made, windows.Settings(**it))[0] for it in ({}, {"window": 48}, {"overlap": 0.0}))
    assert usual < 0.5 * wide
    assert usual < few
