"""The law of friction over the rate of shear: found where it is known, doubted where it is not to be seen."""

import math
import tomllib

import numpy as np
import pytest

from continuum_sph.scene.material_file import with_material
from porescale import Scene
from porescale.analysis.doubts import rate_doubts
from porescale.analysis.homogenise import specimen
from porescale.analysis.material import Known, known, tables
from porescale.analysis.shear_rate import (
    FASTEST_ANGLE,
    GROWTH,
    HALFWAY,
    ROWS,
    SHEAR,
    WARM,
    Steady,
    fit,
    handed_over,
    inertial_numbers,
    known_law,
    known_points,
    law,
    rate_table,
    settings,
    sheared,
    steady,
)
from porescale.cli.homogenise_rates import Rates, about, known_of, laws_of
from porescale.common.schema.sections import validate
from porescale.demseg.convert import toml
from tests.reference.scenes import column

RATES = (0.01, 0.03, 0.1, 0.3, 1.0)
TRUE = (0.25, 0.4, 0.3)
"""s0, Δ and I0 of the law that is to be found."""
SLOW = {"critical friction angle": Known((math.asin(0.25),) * 4, "rad")}


def packings(sines: list[float], noise: float, count: int, seed: int = 0) -> list[tuple[Steady, ...]]:
    """Tests of ``count`` packings whose sines deviate by ``noise`` from ``sines``."""
    swings = np.random.default_rng(seed).normal(0.0, noise, (count, len(RATES))) if noise else np.zeros((count, 9))
    return [
        tuple(Steady(rate, sine + float(off), 0.2, 50.0) for rate, sine, off in zip(RATES, sines, each, strict=False))
        for each in swings
    ]


def found_of(sines: list[float], noise: float = 0.003, count: int = 6, seed: int = 0) -> dict[str, Known]:
    tests = packings(sines, noise, count, seed)
    return {**SLOW, **known_points(RATES, tests), **known_law(tests)}


def said_of(found: dict[str, Known]) -> list[str]:
    return rate_doubts(found, RATES, RATES)


KNOWN = [law(rate, *TRUE) for rate in RATES]


def test_a_known_law_is_found():
    # scipy's bounded search ends within 1e-5/3 of ln I0 (its xatol) and sqrt(eps) of it: I0 to 1e-5, s0 and Δ no worse
    assert fit(np.array(RATES), np.array(KNOWN)) == pytest.approx(TRUE, rel=1e-5)
    wrong = [law(rate, 0.25, 0.4, 0.33) for rate in RATES]  # the twin that must fail
    assert fit(np.array(RATES), np.array(wrong)) != pytest.approx(TRUE, rel=1e-2)


def test_intervals_hold_the_known_law_as_often_as_they_say():
    # Of 300 draws 95 % are 285, which deviate by sqrt(300 · 0.95 · 0.05) = 3.8.  Four of that below are 270, 90 %.  The
    # law is nearly straight over noise of 0.003, and the jackknife's intervals hold as Student's do.
    true = {GROWTH: TRUE[1], HALFWAY: TRUE[2], FASTEST_ANGLE: math.asin(TRUE[0] + TRUE[1])}
    held, narrow = dict.fromkeys(true, 0), dict.fromkeys(true, 0)
    for seed in range(300):
        found = known_law(packings(KNOWN, 0.003, 6, seed))
        for name, value in true.items():
            off = abs(found[name].mean - value)
            held[name] += off <= found[name].interval
            narrow[name] += off <= 0.5 * found[name].interval  # the twin that must fail: bars half as wide
    assert min(held.values()) >= 270, held
    assert max(narrow.values()) < 270, narrow


def test_a_law_that_its_bars_resolve_leaves_nothing_to_doubt():
    found = found_of(KNOWN)
    assert handed_over(found)
    assert said_of(found) == []


@pytest.mark.parametrize(
    ("sines", "noise", "given", "said"),
    [
        ([0.25 + 0.5 * rate for rate in RATES], 0.0, False, "no law of rate is handed over"),  # a line has no I0
        ([0.5 - 0.2 * rate / (0.3 + rate) for rate in RATES], 1e-3, False, "is not resolved"),  # friction that falls
        (KNOWN, 0.1, False, "handed over"),
        ([sine - 0.45 for sine in KNOWN], 0.003, False, "not handed over"),  # all of it below the slow tests
        (KNOWN, 0.06, True, "is hardly known"),
        ([sine + 0.03 for sine in KNOWN], 0.003, True, "is not that of the slow tests"),
        ([sine + 0.03 * (-1) ** k for k, sine in enumerate(KNOWN)], 0.003, True, "off the measured sine"),
    ],
)
def test_what_is_doubtful_of_a_law_is_said(sines, noise, given, said):
    found = found_of(sines, noise)
    assert handed_over(found) is given
    lines = said_of(found)
    assert any(said in line for line in lines), lines


def test_two_packings_have_a_law_without_an_interval():
    found = found_of(KNOWN, count=2)
    assert math.isnan(found[HALFWAY].interval)
    assert handed_over(found)


def test_without_rates_a_material_file_has_nothing_of_them():
    none = Rates()
    assert known_of(none) == {}
    assert about(none, {}) == ({}, [])
    assert laws_of(column(), {}) == {}
    rows = [{"porosity": 0.2, "critical friction angle": 0.3, "peak friction angle": 0.4, "peak dilatancy angle": 0.1}]
    assert "rate" not in tables(known(rows * 2), 2500.0, 300.0, {})


def test_a_material_file_with_rates_reaches_a_scene_that_asks_for_them(tmp_path):
    found = found_of(KNOWN)
    rows = [{"porosity": 0.2, "critical friction angle": 0.3, "peak friction angle": 0.4, "peak dilatancy angle": 0.1}]
    whole = tables({**known(rows * 4), **found}, 2500.0, 300.0, {}, {"rate": rate_table(found, 1.5e-3)})
    (tmp_path / "material.toml").write_text(toml(whole), encoding="utf-8")
    assert tomllib.loads(toml(whole)) == whole  # names with a dot, too
    named = {"material": "material.toml"}
    taken = with_material({"soil": {**named, "rate": {}}}, tmp_path)["soil"]
    assert taken["rate"] == whole["rate"]
    assert math.sin(taken["rate"]["friction_angle"]) == pytest.approx(
        TRUE[0] + TRUE[1], abs=0.02
    )  # three bars of 0.006
    assert "rate" not in with_material({"soil": named}, tmp_path)["soil"]


def series(sine: float, side: float = 1.1, rate: float = 2.0) -> dict[str, np.ndarray]:
    """A test of soil with sin φ whose stress along is ``side`` times that across, 300 Pa; twice as strong at first."""
    shear = np.linspace(0.0, SHEAR, ROWS)
    across = np.full(ROWS, 300.0)
    turning = np.sqrt((sine * 0.5 * (1.0 + side)) ** 2 - (0.5 * (side - 1.0)) ** 2) * 300.0
    return {
        "time (s)": shear / rate, "strain xy ()": shear, "stress xx (Pa)": side * across, "stress yy (Pa)": across,
        "shear stress (Pa)": np.where(shear < WARM, 2.0, 1.0) * turning, "solid fraction ()": np.full(ROWS, 0.8),
    }  # fmt: skip


def test_a_steady_flow_of_known_strength_is_found():
    found = steady(series(0.3), 1.5e-3, 2500.0)
    assert found.sine == pytest.approx(0.3, rel=1e-12)  # sums of 2000 rows round by 2000 · 1e-16 at most
    # γ̇ d √(ρ/p), p the mean of 330 and 300 Pa
    assert found.inertial == pytest.approx(2.0 * 1.5e-3 * math.sqrt(2500.0 / 315.0), rel=1e-12)
    assert found.porosity == pytest.approx(0.2, rel=1e-12)
    early = {name: values[: ROWS // 2] for name, values in series(0.3).items()}
    early["strain xy ()"] = early["strain xy ()"] + WARM  # the twin that must fail: the start is taken for steady
    assert steady(early, 1.5e-3, 2500.0).sine > 0.35


def test_a_sheared_specimen_has_the_inertial_number_that_is_asked():
    given = column(homogenise={"pressure": 200, "grains": 300, "rates": [0.1, 0.2, 0.4, 0.8]})
    made = validate(Scene, sheared(given, specimen(given)))
    assert made.cell.rate_xy.mean * 0.0008 * math.sqrt(2500.0 / 200.0) == pytest.approx(0.1, rel=1e-12)
    assert made.cell.stress_yy.mean == 200.0
    assert made.cell.rate_xy.mean * made.time.end == pytest.approx(SHEAR, rel=1e-12)
    laid = dict(text.split("=") for text in settings(given, 0.4))
    assert float(laid["cell.rate_xy"]) == pytest.approx(4.0 * made.cell.rate_xy.mean, rel=1e-12)
    assert float(laid["time.end"]) == pytest.approx(made.time.end / 4.0, rel=1e-12)
    plain = column(homogenise={"pressure": 200, "grains": 300})
    assert specimen(plain) == specimen(given)  # the slow tests do not know of rates
    assert inertial_numbers(packings(KNOWN, 0.0, 3)) == pytest.approx(RATES, rel=1e-15)
