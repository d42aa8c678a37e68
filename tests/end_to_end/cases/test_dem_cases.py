"""Cases of grains that are scripts: each measures what its expected.toml says, and would say so if it did not."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest

from porescale.output.case import conclude, expected, missed, stage
from tests.reference.folders import CASES, script

SCRIPTS = sorted(path.stem for path in CASES.glob("*/*.py") if path.stem == path.parent.name)
MEASURED = {
    "bouncing_disc": "a disc bounces as high as its restitution says",
    "chain_pulse": "a pulse runs along a chain as Bessel functions say",
    "step_stability": "the longest step is that of lagged damping",
    "rolling_on_a_slope": "a disc rolls alike on springs a hundred times as stiff",
    "dry_column_collapse": "run-out of dry columns grows with their aspect ratio as published",
    "clump": "a clump keeps its energy and comes to rest on both discs",
    "biaxial_compression": "dense and loose specimens come to one critical state between walls",
    "simple_shear": "dense and loose cells come to one critical state without walls",
    "grain_size": "a shear box of few grains is stronger than one of many",
    "tumbling_plate": "a light plate flutters in water and a heavy one tumbles",
}
"""Cases whose script measures every row at once, and what it shows."""
QUICK = ("chain_pulse", "step_stability", "rolling_on_a_slope")
KEYS = {"name", "value", "tolerance", "unit", "because"}


@pytest.mark.parametrize("case", SCRIPTS)
def test_every_script_says_what_it_is_what_it_expects_and_shows_it(case):
    rows = expected(CASES / case)
    assert len({row["name"] for row in rows}) == len(rows) > 0
    for row in rows:
        assert row.keys() == KEYS
        assert row["tolerance"] >= 0  # 0 for what is counted
        assert len(row["because"].split()) > 2
    text = (CASES / case / "README.md").read_text(encoding="utf-8")
    assert text.startswith("# ")
    assert "## Source" in text
    assert f"python cases/{case}/{case}.py" in text
    # A clone stays small: 150 kB for plots, twice that where a picture is of fields.
    assert len((CASES / case / "picture.png").read_bytes()) < (300_000 if "piv" in case else 150_000)
    assert re.search(r"!\[.+\]\(picture\.png\)", text)


def test_a_case_is_concluded_by_table_picture_and_exit_code(tmp_path):
    (tmp_path / "expected.toml").write_text(
        '[[expected]]\nname = "a"\nvalue = 1\ntolerance = 0.1\nunit = "m"\nbecause = "so it is"\n', encoding="utf-8"
    )
    said: list[str] = []
    figure, axes = stage(2)
    assert len(axes) == 2
    assert conclude(tmp_path, {"a": 1.05}, figure, tmp_path / "out", said.append) == 0
    assert conclude(tmp_path, {"a": 1.2}, figure, tmp_path / "out", said.append) == 1
    assert said[0] == "ok      a: 1.05, expected 1 ± 0.1 m"
    assert said[2] == "MISSED  a: 1.2, expected 1 ± 0.1 m"
    assert (tmp_path / "out" / "picture.png").read_bytes().startswith(b"\x89PNG")
    assert missed(tmp_path, {"a": float("nan")}) == ["a"]  # no number is not within tolerance
    with pytest.raises(KeyError):
        missed(tmp_path, {})


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[] if case in QUICK else [pytest.mark.slow]) for case in MEASURED]
)
def test_a_case_measures_what_it_expects(case):
    assert missed(CASES / case, script(case).measure()[0]) == []


def test_a_disc_under_the_other_rule_bounces_otherwise():
    # The twin that must fail: with the tutorial's damping, a contact that never pulls does not fall to a quarter.
    case = script("bouncing_disc")
    name = "the tutorial's c, ends without overlap"
    law = replace(case.LAWS[name], release="force")
    high = case.tops(case.path(law, lasts=0.3, steps_per_contact=100)[1])
    row = next(row for row in expected(CASES / "bouncing_disc") if row["name"] == f"{name}: first height")
    assert abs(high[0] - row["value"]) > 10 * row["tolerance"]


def test_a_pulse_that_parts_the_discs_does_not(monkeypatch):
    # The twin that must fail: a kick that moves discs by more than their overlap, and springs only push.
    case = script("chain_pulse")
    monkeypatch.setattr(case, "KICK", 2000.0)
    numbers, _ = case.measure()
    assert "largest difference from the Bessel profile" in missed(CASES / "chain_pulse", numbers)


def test_the_longest_step_is_not_that_of_central_damping():
    # The twin that must fail: 2 at any damping ratio is right at none but zero.
    case = script("step_stability")
    numbers = {row["name"]: row["value"] for row in expected(CASES / "step_stability")}
    central = {name: 2.0 if name.startswith("longest") else value for name, value in numbers.items()}
    assert missed(CASES / "step_stability", central) == [f"longest step, h = {h:g}" for h in case.RATIOS[1:]]
    assert case.gains(0.45).max() > 0.1  # nor does a bounce forgive what a contact at rest does


def test_a_disc_that_slips_does_not(monkeypatch):
    # The twin that must fail: tan 20° is more than three times a friction of 0.05.
    case = script("rolling_on_a_slope")
    monkeypatch.setattr(case.roll, "__defaults__", (0.05, *case.roll.__defaults__[1:]))
    numbers, _ = case.measure()
    names = [name for name in numbers if "acceleration" in name or "spin" in name]
    assert set(missed(CASES / "rolling_on_a_slope", numbers)) >= set(names)


@pytest.mark.slow
def test_the_angle_of_repose_saturates_with_friction_and_the_energy_book_closes():
    # Three of the seven frictions: those that the rows speak of.
    case = script("angle_of_repose")
    numbers, _ = case.measure(frictions=(case.FRICTIONS[0], case.TUTORIAL, case.FRICTIONS[-1]))
    assert missed(CASES / "angle_of_repose", numbers) == []


def test_one_packing_has_no_scatter_and_says_what_it_is_worth(capsys):
    case = script("angle_of_repose")
    assert case.scatter({case.TUTORIAL: np.array([20.0])}) is None
    assert "one packing has no scatter: its angles are worth ± 1.9°" in capsys.readouterr().out
    assert case.deviation(np.array([20.0])) == case.SCATTER
    assert case.scatter({case.TUTORIAL: np.array([20.0, 22.0])}) == pytest.approx(2.0**0.5)
    # What it is worth is what the recorded run of several packings measured.
    recorded = json.loads((CASES / "angle_of_repose" / "recorded.json").read_text(encoding="utf-8"))["numbers"]
    assert pytest.approx(recorded["scatter of the angle over packings"], abs=0.05) == case.SCATTER


def test_a_number_that_the_options_left_out_is_none_and_not_missed(tmp_path):
    (tmp_path / "expected.toml").write_text('[[expected]]\nname = "a"\nvalue = 1\ntolerance = 0.1\n', encoding="utf-8")
    assert missed(tmp_path, {"a": None}) == []
    assert missed(tmp_path, {"a": math.nan}) == ["a"]  # the twin: what is no number is missed
    with pytest.raises(KeyError):
        missed(tmp_path, {})


@pytest.mark.slow
def test_a_heap_of_discs_that_cannot_turn_has_another_angle():
    # The twin that must fail: rolling is what keeps the angle of discs low.
    case = script("angle_of_repose")
    row = next(row for row in expected(CASES / "angle_of_repose") if row["name"] == "angle")
    steep = case.angle(case.heap(book=False, turning=False).grains)
    assert steep > row["value"] + 5 * row["tolerance"]


def test_a_small_column_collapses_and_what_rolled_away_does_not_count():
    case = script("dry_column_collapse")
    run = case.collapse(0.7, discs=200)
    assert abs(run.aspect - 0.7) < 0.1  # settled to within a layer of the ten that lie there
    assert run.main.sum() > 100
    at, radius = run.after[run.main], run.radius[run.main]
    assert run.run_out * run.half <= (at[:, 0] + radius).max() - (at[:, 0] - radius).min()
    assert run.run_out > 0.5
    far = run.after.copy()
    far[np.argmax(far[:, 0]), 0] += 100.0 * case.DIAMETER
    assert case.together(far, run.radius).sum() <= run.main.sum()
    assert not case.together(far, run.radius)[np.argmax(far[:, 0])]


def test_run_out_as_in_experiments_or_in_proportion_to_height_does_not():
    # The twins that must fail: the upper edge of the experiments, and tall columns that run as squat ones do.
    case = script("dry_column_collapse")

    def made(out):
        runs = [case.Collapse(a, out(a), 1.0, *(np.zeros(0),) * 4) for a in case.ASPECTS]
        return missed(CASES / "dry_column_collapse", case.fitted(runs))

    assert made(lambda a: 2.5 * a if a < case.TALL else 3.25 * a**0.7) == []
    assert set(made(lambda a: 1.8 * a if a < case.TALL else 2.3 * a ** (2.0 / 3.0))) >= {
        "squat: run-out over a", "tall: run-out over a^0.7",
    }  # fmt: skip
    assert "tall: exponent" in made(lambda a: 2.0 * a)


def test_a_clump_weighs_what_its_union_weighs_and_bounces_as_a_rigid_body():
    case = script("clump")
    numbers = {row["name"]: row["value"] for row in expected(CASES / "clump")}
    found = case.mass_properties(case.clump()[0]) | case.impact()
    assert missed(CASES / "clump", numbers | found) == []
    # The twins that must fail: discs that are added up where they overlap, and a body that does not turn.
    whole = math.pi * (case.LARGE**2 + case.SMALL**2) / case.by_strips()[0]
    assert missed(CASES / "clump", numbers | {"mass over that of the union": whole}) == ["mass over that of the union"]
    speed, made = math.sqrt(2.0 * case.GRAVITY * (0.05 - case.LARGE)), 0.7039
    name = "upward speed over that of a rigid body"
    assert missed(CASES / "clump", numbers | {name: speed / made}) == [name]


def test_a_small_dense_specimen_opens_between_sides_that_bear_their_stress():
    case = script("biaxial_compression")
    rough, smooth = (case.compress("dense", 1, friction, 100, strain=0.03) for friction in (0.5, 0.0))
    assert abs(rough.side[rough.strain > 0.005].mean() - 1.0) < 0.02  # ten contacts a side, swings of a tenth
    assert rough.volume[-1] > 0.002
    assert case.smooth(rough).max() > 1.5 * case.smooth(smooth).max()  # 24 and 9 degrees in large specimens
    assert rough.inertial < 1e-3


@pytest.mark.slow
def test_specimens_without_friction_or_not_yet_critical_do_not(monkeypatch):
    # The twins that must fail: without friction 6 degrees are left; and means that begin at the start of the test.
    case = script("biaxial_compression")
    smooth = case.numbers_of({state: [case.compress(state, 1, friction=0.0)] for state in case.STATES})
    off = set(missed(CASES / "biaxial_compression", smooth))
    assert off >= {"dense: peak friction angle", "dense: critical friction angle", "loose: critical friction angle"}
    rough = {state: [case.compress(state, 1)] for state in case.STATES}
    assert "critical solid fraction, dense less loose" not in missed(
        CASES / "biaxial_compression", case.numbers_of(rough)
    )
    monkeypatch.setattr(case, "CRITICAL", 0.0)
    assert "critical solid fraction, dense less loose" in missed(CASES / "biaxial_compression", case.numbers_of(rough))


def test_a_small_dense_cell_opens_as_it_is_sheared():
    case = script("simple_shear")
    found = case.sheared("dense", 1, 0.5, 100, shear=0.06)
    assert abs(found.across.mean() - 1.0) < 0.01
    assert found.fraction[-1] < found.fraction[0] - 0.002
    assert case.running(found, found.ratio).max() > 0.3
    assert found.inertial < 1e-3


@pytest.mark.slow
def test_cells_without_friction_do_not_come_to_that_state():
    # The twin that must fail: they shear at a tenth of the stress, as densely as they were packed.
    case = script("simple_shear")
    numbers = case.numbers_of({state: [case.sheared(state, 1, 0.0, shear=1.0)] for state in case.STATES})
    off = set(missed(CASES / "simple_shear", numbers))
    assert off >= {"dense: critical stress ratio", "dense: critical solid fraction", "loose: critical stress ratio"}


def test_grains_eight_times_as_large_do_the_same_to_the_bit(monkeypatch):
    case = script("grain_size")
    monkeypatch.setattr(case, "SHEAR", 0.01)
    small, large = case.element(1.0), case.element(8.0)
    np.testing.assert_array_equal(small[1], large[1])
    monkeypatch.setattr(case, "RATE", 4.0 * case.RATE)  # the twin that must fail: another inertial number
    assert np.abs(case.element(8.0)[1] - large[1]).max() > 1e-3


def test_a_strength_that_knows_no_grain_size_does_not():
    # The twin that must fail: the long box's strength at every size.
    case = script("grain_size")
    travel, none = np.linspace(0.0, 0.1, 50), np.zeros(0)
    same = case.Shearing(travel, np.where(travel < 0.05, 0.661, 0.368), *(none,) * 4)
    off = missed(CASES / "grain_size", case.strengths({n: [same] for n in case.ACROSS}) | {
        "largest difference of stress ratios, grains eight times as large": 0.0})  # fmt: skip
    assert off == ["peak, short boxes less long", "residual, short boxes less long"]


@pytest.mark.slow
def test_a_hanging_chain_is_a_catenary_and_breaks_at_k_overlap():
    case = script("hanging_chain")
    numbers, _ = case.measure()
    assert missed(CASES / "hanging_chain", numbers) == []
    # The twin that must fail: bonds a hundredth weaker than k δ0.
    weaker, _ = case.measure(0.99 * case.STRENGTH)
    assert "pull that breaks it over k δ0" in missed(CASES / "hanging_chain", weaker)


@pytest.mark.slow
def test_soil_pushes_a_block_off_its_base_at_the_friction_of_the_base(monkeypatch):
    case = script("block_pushed_by_soil")
    numbers, _, found = case.measure(packings=1)
    assert missed(CASES / "block_pushed_by_soil", numbers) == []
    ways = [record.gone[-1] for _, record in found.freed]
    assert ways == sorted(ways, reverse=True)
    # The twin that must fail: limit equilibrium with half of the friction that the base has.
    monkeypatch.setattr(case, "FRICTION", 0.5 * case.FRICTION)
    off = missed(CASES / "block_pushed_by_soil", case.said(found))
    assert off == [row["name"] for row in expected(CASES / "block_pushed_by_soil")[2:]]


@pytest.mark.slow
def test_rock_of_discs_bears_what_its_case_says():
    # Polygons: the rows dem.rock_of_polygons... and dem.rock_of_slender_cells_breaks of verify hold the same.
    case = script("rock")
    others = {row["name"]: row["value"] for row in expected(CASES / "rock")}
    numbers, _, tests = case.measure(sorts=("discs",))
    assert missed(CASES / "rock", others | numbers) == []
    assert case.later(tests["discs"][0][0]) <= case.MOMENTS


@pytest.mark.slow
def test_rock_of_discs_packed_without_friction_bears_more(monkeypatch):
    # The twin that must fail: the packing decides.
    case = script("rock")
    monkeypatch.setattr(case.lab.sample, "__defaults__", (0, case.lab.COUNT, 0.0, *case.lab.sample.__defaults__[3:]))
    others = {row["name"]: row["value"] for row in expected(CASES / "rock")}
    firm = case.said("discs", [case.pair("discs", seed, case.lab.COUNT) for seed in range(3)])
    off = {f"discs: {what}" for what in ("stiffness", "tensile strength", "compressive strength")}
    assert set(missed(CASES / "rock", others | firm)) >= off


@pytest.mark.slow
def test_a_plate_as_light_as_the_other_does_not_tumble(monkeypatch):
    # The twin that must fail: both as light.
    case = script("tumbling_plate")
    light = case.fall(case.LIGHT)
    monkeypatch.setattr(case, "fall", lambda density, quality: light)
    numbers, _ = case.measure()
    assert "turns of the heavy plate" in missed(CASES / "tumbling_plate", numbers)
