"""Errors, costs and the front of a trade study, and what `--error` and `--budget` pick from it."""

import csv
import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.core.statistics import half_width
from porescale.common.duration.quiet import Moment
from porescale.common.schema.sections import validate
from porescale.common.studies import front as module
from porescale.common.studies import trade_files
from porescale.common.studies.ensemble import Repeats
from porescale.common.studies.front import FrontPoint, Here, begun, choose, pace_of, read_front
from porescale.common.studies.parameter_table import Point, repeats
from porescale.common.studies.quantities import curve
from porescale.common.studies.runner import Ended
from porescale.common.studies.trade import Errors, Traded, distance, front
from porescale.common.studies.trade_plan import Plan, read_plan
from tests.reference.folders import ROOT

PLAN = """
[over]
key = "grains.seed"
values = [1, 2]
[reference]
quality = "fine"
[[quantity]]
name = "end"
column = "y (m)"
scale = 2.0
[[quantity]]
name = "surface"
file = "profile"
column = "height at x = *"
scale = 1.0
[[knob]]
name = "spacing"
[[knob.point]]
label = "1"
settings = { fluid.spacing = 1 }
[[knob.point]]
label = "2"
settings = { fluid.spacing = 2 }
[[knob]]
name = "step"
[[knob.point]]
label = "as it is"
settings = { fluid.spacing = 1 }
"""


def plan(tmp_path: Path, text: str = PLAN) -> Plan:
    (tmp_path / "trade.toml").write_text(text)
    return read_plan(tmp_path / "scene.toml", None)


def ended(name: str, outcome: str = "finished", **card: Any) -> Ended:
    return Ended(Point(name, ()), Path(name), outcome, {"core_seconds": 2.0, "seconds": 3.0, "step": 10, **card})


def tables(folder: Path, name: str) -> dict[str, np.ndarray]:
    """A run called "a b" ends at a, its surface is b at both places."""
    a, b = map(float, folder.name.split())
    if name == "series":
        return {"time (s)": np.array([0.0, 1.0]), "y (m)": np.array([9.0, a])}
    places = {f"height at x = {x} m (m)": np.array([7.0, b]) for x in (1, 2)}
    return {"time (s)": np.array([0.0, 1.0]), **places}


def traded(error: float, seconds: float) -> Traded:
    """A point whose steps take nine tenths of its core-seconds."""
    return Traded("k", f"{error:g}", Point(f"{error:g}", ()), "finished", {"q": error}, error, 0.0, 0.9 * seconds, 77.0,
                  0, 1, 2.0, 0.1 * seconds, 0.5)  # fmt: skip


def test_a_plan_has_a_run_for_every_repeat_and_shares_what_two_knobs_have_in_common(tmp_path):
    made = plan(tmp_path)
    variants = made.variants()
    assert [(knob, label) for knob, label, _ in variants] == [
        ("spacing; step", "spacing 1; step as it is"), ("spacing", "spacing 2"),
    ]  # fmt: skip
    assert made.over
    runs = repeats(variants[1][2], Repeats(None, made.over.option()).choices(None, None))
    assert [point.settings for point in runs] == [
        ("fluid.spacing=2", "grains.seed=1"), ("fluid.spacing=2", "grains.seed=2"),
    ]  # fmt: skip
    assert made.reference_point() == Point("reference", (), "fine")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('[reference]\nquality = "fine"\n', "", "not every quantity is exact"),
        ('column = "y (m)"', "", "one of them says what is measured"),
        ('column = "y (m)"', 'column = "y (m)"\nfeature = "field"', "one of them says what is measured"),
        ('name = "surface"', 'name = "end"', "have one name twice"),
        ('column = "height at x = *"', 'column = "height at x = *"\nexact = 1', "is a number, what is measured a"),
        ('column = "height at x = *"', 'column = "height at x = *"\nat = "max"', "is not when to look"),
        ('column = "height at x = *"', 'column = "height at x = *"\nintegral = true', "of a column over time"),
        ('column = "y (m)"', 'column = "y (m)"\nintegral = true\nwhere = { "y (m)" = 1 }', "rows of one time"),
        ("scale = 2.0", "scale = 0", "out of range"),
        ("[over]", "[ower]", "unknown"),
    ],
)
def test_a_wrong_plan_is_said_with_its_key(tmp_path, old, new, said):
    assert old in PLAN
    with pytest.raises(InputError, match=said):
        plan(tmp_path, PLAN.replace(old, new))


def test_no_plan_and_no_front_are_said(tmp_path):
    with pytest.raises(InputError, match="is no file"):
        read_plan(tmp_path / "scene.toml", None)
    with pytest.raises(InputError, match=f"no front was measured.*study trade {tmp_path}, and"):
        read_front(tmp_path / "scene.toml")
    with pytest.raises(InputError, match=f"study trade {tmp_path}/other.toml, and"):
        read_front(tmp_path / "other.toml")


def test_the_error_of_a_point_is_its_distance_from_the_reference_of_the_same_repeat(tmp_path):
    errors = Errors(plan(tmp_path), tables, {}, [ended("4 1"), ended("6 1")])
    point = errors.trade("k", "l", Point("p", ()), [ended("5 1"), ended("6 4")])
    # repeat 1: end off by 1/2, surface by 0; repeat 2: end by 0, surface by 3
    assert point.errors == pytest.approx({"end": math.sqrt(0.25 / 2), "surface": math.sqrt(9 / 2)})
    each = [math.sqrt(0.25 / 2), math.sqrt(9 / 2)]
    assert point.error == pytest.approx(math.sqrt((0.25 + 9) / 4))
    assert point.scatter == pytest.approx(np.std(each, ddof=1))
    assert (point.core_seconds, point.seconds, point.steps) == (2.0, 3.0, 10)
    # 4 and 6 are 1 off their mean, half a scale, and two of them tell it with one degree of freedom
    assert errors.packings() == pytest.approx({"end": math.sqrt(2) / 2, "surface": 0.0})


def test_another_repeat_for_reference_would_give_another_error(tmp_path):  # the twin that must fail
    swapped = Errors(plan(tmp_path), tables, {}, [ended("6 1"), ended("4 1")])
    point = swapped.trade("k", "l", Point("p", ()), [ended("5 1"), ended("6 4")])
    assert point.errors["end"] != pytest.approx(math.sqrt(0.25 / 2))


def test_a_point_that_did_not_finish_is_infinitely_wrong_and_never_on_the_front(tmp_path):
    errors = Errors(plan(tmp_path), tables, {}, [ended("4 1"), ended("6 1")])
    point = errors.trade("k", "l", Point("p", ()), [ended("4 1"), ended("6 1", "unstable")])
    assert (point.outcome, point.error) == ("unstable", math.inf)
    assert not front([point])[0].on_front


def test_a_quantity_without_a_number_is_said_in_one_line(tmp_path):
    # At a time beyond the end of the runs it was a traceback of JSON, after all of them; the picture was another.
    late = plan(tmp_path, PLAN.replace('column = "y (m)"', 'column = "y (m)"\nat = 50.0'))
    errors = Errors(late, tables, {}, [ended("4 1")])
    with pytest.raises(InputError, match=r"^quantity 'end': at = '50\.0': the reference has no number there"):
        errors.answers()
    trade_files.write(tmp_path / "out", {}, [errors.trade("k", "l", Point("p", ()), [ended("5 1")])], {})
    assert "| l | 2 | 0 | finished | – | 0 % |" in (tmp_path / "out" / "trade.md").read_text()


def test_a_point_has_the_mean_of_its_repeats_with_what_it_is_worth(tmp_path):
    errors = Errors(plan(tmp_path), tables, {}, [ended("4 1"), ended("6 1"), ended("8 1")])
    point = errors.trade("k", "l", Point("p", ()), [ended("5 1"), ended("6 4"), ended("8 2")])
    assert len(point.each) == 3
    assert point.error == pytest.approx(math.sqrt(np.mean(np.square(point.each))))  # as fronts have it: the rms
    assert point.scatter == pytest.approx(np.std(point.each, ddof=1))
    trade_files.write(tmp_path / "out", {"references": errors.answers()}, [point], {})
    with open(tmp_path / "out" / "trade.csv") as file:
        (line,) = csv.DictReader(file)
    assert line["repeats"] == "3"
    assert float(line["mean"]) == pytest.approx(np.mean(point.each))
    assert float(line["t high"]) - float(line["mean"]) == pytest.approx(half_width(point.each))
    text = (tmp_path / "out" / "trade.md").read_text()
    assert "mean error ± 95 %" in text
    assert "| the reference | unit | n | mean |" in text
    two = errors.trade("k", "l", Point("p", ()), [ended("5 1"), ended("6 4")])
    trade_files.write(tmp_path / "two", {}, [two], {})
    assert "no interval of 2" in (tmp_path / "two" / "trade.md").read_text()
    lost = errors.trade("k", "l", Point("p", ()), [ended("5 1"), ended("6 4"), ended("8 2", "unstable")])
    assert lost.problem.startswith("2 of 3 repeats finished")


def test_exact_values_need_no_reference_and_features_are_compared_number_by_number(tmp_path):
    asked = {"quantity": [{"name": "e", "column": "y (m)", "scale": 1.0, "exact": 3.0}],
             "knob": [{"name": "k", "point": [{"label": "a"}]}]}  # fmt: skip
    point = Errors(validate(Plan, asked), tables, {}).trade("k", "a", Point("p", ()), [ended("5 0")])
    assert point.error == 2.0
    asked["quantity"] = [{"name": "f", "feature": "flow", "scale": 2.0}]
    asked["reference"] = {}
    features = {"flow": lambda folder, at: np.array([float(folder.name[0]), 1.0])}
    errors = Errors(validate(Plan, asked), tables, features, [ended("1")])
    assert errors.trade("k", "a", Point("p", ()), [ended("5")]).error == pytest.approx(math.sqrt(4 / 2))


def test_what_cannot_be_compared_is_infinitely_far():
    assert distance(np.zeros(2), np.zeros(3), 1.0) == math.inf
    assert distance(np.array([np.nan]), np.zeros(1), 1.0) == math.inf
    assert distance(np.zeros(0), np.zeros(0), 1.0) == math.inf


def test_the_front_is_what_nobody_beats():
    tried = ((0.1, 10.0), (0.2, 5.0), (0.2, 6.0), (0.05, 10.0), (0.3, 5.0), (0.0, 90.0))
    points = [traded(*it) for it in tried]
    assert [one.on_front for one in front(points)] == [False, True, False, True, False, True]
    same = front([traded(0.1, 1.0), traded(0.1, 1.0)])
    assert all(one.on_front for one in same)  # neither beats the other


def written(tmp_path: Path, points: list[Traded]) -> Path:
    about = {"command": "toy study trade", "machine": {"processor": "abacus"}, "date": "2001-01-01"}
    trade_files.write(tmp_path, about, front(points), {"q": 0.02})
    return tmp_path / "scene.toml"


def test_the_files_hold_every_point_and_say_which_are_on_the_front(tmp_path):
    worse = replace(traded(0.3, 9.0), outcome="unstable", error=math.inf, errors={"q": math.inf})
    scene = written(tmp_path, [traded(0.1, 10.0), traded(0.2, 5.0), worse])
    text = (tmp_path / "trade.md").read_text()
    assert "| **0.1** | 9 |" in text
    assert "| 0.3 | 8.1 | 0 | unstable |" in text
    assert "another packing" in text
    assert (tmp_path / "trade.png").read_bytes().startswith(b"\x89PNG")
    assert len((tmp_path / "trade.csv").read_text().splitlines()) == 4
    found = read_front(scene)
    assert [point.label for point in found.points] == ["0.2", "0.1"]  # from cheap to dear
    assert (found.machine, found.points[0].pace, found.points[0].errors) == ("abacus", 0.5, {"q": 0.2})


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"format": 2, "points": 3}', '{"format": 7}', "\x00"])
def test_a_damaged_front_is_said(tmp_path, content):
    (tmp_path / "front.json").write_text(content)
    with pytest.raises(InputError, match=r"damaged|format"):
        read_front(tmp_path / "scene.toml")


@pytest.mark.parametrize("key", ["pace", "besides", "core_seconds", "time", "error", "label"])
def test_a_point_without_a_number_is_damage(tmp_path, key):
    scene = written(tmp_path, [traded(0.1, 10.0)])
    table = json.loads((tmp_path / "front.json").read_text())
    table["points"][0][key] = "x"
    if key == "label":
        del table["points"][0][key]
    (tmp_path / "front.json").write_text(json.dumps(table))
    with pytest.raises(InputError, match="damaged"):
        read_front(scene)


@pytest.fixture
def measured_front(tmp_path):
    points = [traded(0.2, 5.0), traded(0.1, 10.0), traded(0.01, 100.0)]
    return read_front(written(tmp_path, points))


def twice(point: FrontPoint) -> Here:
    """A machine half as fast as the one of the front."""
    return Here(2.0 * point.pace, 2.0 * point.pace)


def test_an_error_picks_the_cheapest_point_that_is_as_good(measured_front):
    choice = choose(measured_front, 0.15, None, twice)
    assert (choice.point.label, choice.seconds, choice.slowness) == ("0.1", 20.0, 2.0)
    assert choose(measured_front, 0.1, 20.0, twice).point.label == "0.1"
    assert "picked 0.1" in choice.line(measured_front)
    longer = choose(measured_front, 0.15, None, lambda point: replace(twice(point), end=3.0 * point.time))
    assert (longer.seconds, longer.slowness) == (60.0, 2.0)  # three times the time simulated, on the same machine
    later = choose(measured_front, 0.15, None, lambda point: replace(twice(point), start=7.0))
    assert (later.seconds, later.core_seconds) == (27.0, 18.0)  # start-up is said as it took here
    with pytest.raises(InputError, match="below the best"):
        choose(measured_front, 0.001, None, twice)
    with pytest.raises(InputError, match="is not enough for an error"):
        choose(measured_front, 0.1, 19.0, twice)


def test_a_budget_picks_the_best_point_that_takes_no_longer_here(measured_front):
    assert choose(measured_front, None, 1000.0, twice).point.label == "0.01"
    assert choose(measured_front, None, 100.0, twice).point.label == "0.1"
    assert choose(measured_front, None, 20.0, twice).point.label == "0.2"  # 20 s are all of the budget, to the last
    with pytest.raises(InputError, match="the cheapest point"):
        choose(measured_front, None, 9.0, twice)


def test_a_shared_machine_makes_a_run_longer_but_not_dearer_and_two_threads_hasten_steps_alone(measured_front):
    for slower, seconds in ((3.0, 30.0), (0.5, 0.5 * 9.0 + 1.0)):
        choice = choose(measured_front, 0.15, None, lambda point, by=slower: Here(by * point.pace, point.pace))
        assert (choice.seconds, choice.core_seconds) == (seconds, 9.0)


def test_a_pace_is_that_of_steps_without_the_first_ones():
    class Slow:
        step = 0

        def advance(self, steps: int) -> None:
            self.step += steps

    model = Slow()
    wall, core = pace_of(model)
    assert 0.0 < core <= 1.01 * wall < 1e-3  # clocks tick apart
    assert model.step > 8
    here = begun(Slow, 3.0)
    assert here.end == 3.0
    assert 0.0 < here.start < 1.0


def test_the_age_of_the_command_counts_and_grows_with_every_try(measured_front):
    clock = [3.0]

    def slow_try(point: FrontPoint) -> Here:
        """Half as fast, and seven seconds to find out."""
        clock[0] += 7.0
        return twice(point)

    choice = choose(measured_front, 0.15, None, slow_try, lambda: clock[0])
    assert choice.seconds == 10.0 + 20.0
    clock[0] = 3.0
    assert choose(measured_front, None, 60.0, slow_try, lambda: clock[0]).point.label == "0.1"  # 3 + 14 + 20
    clock[0] = 3.0
    late = choose(measured_front, None, 38.0, slow_try, lambda: clock[0])
    assert (late.point.label, late.seconds) == ("0.2", 17.0 + 10.0)  # 37 s are beyond 0.95 · 38: the try is paid for


def test_what_is_besides_takes_as_much_longer_beside_others_as_the_steps(monkeypatch):
    # A quarter of a core: 4 s of a quiet machine are 16 s here.
    moments = iter((Moment(0.0, 0.0, 0.0), Moment(8.0, 2.0, 6.0)))
    monkeypatch.setattr(module, "moment", lambda: next(moments))
    monkeypatch.setattr(module, "pace_of", lambda _: (1.0, 1.0))
    assert module.begun(object, besides=4.0).besides == pytest.approx(16.0, rel=1e-12)
    monkeypatch.setattr(module, "moment", lambda: Moment(0.0, 0.0, 0.0))
    assert module.begun(object, besides=4.0).besides == 4.0  # the twin: alone
    assert module.begun(object).besides is None


def test_what_is_besides_is_what_it_takes_here_where_that_is_known(measured_front):
    choice = choose(measured_front, 0.15, None, lambda point: replace(twice(point), end=1.0, besides=4.0))
    assert choice.seconds == pytest.approx(0.5 * 18.0 + 4.0)  # half of the time simulated; pictures do not halve
    assert f"{choice.seconds / 5.0:.2g} times the 5 core-seconds" in choice.line(measured_front)  # of half the time


def test_a_point_whose_remark_applies_is_none_of_the_front(tmp_path):
    scene = written(tmp_path, [traded(0.2, 5.0), traded(0.1, 10.0), traded(0.05, 8.0)])
    table = json.loads((tmp_path / "front.json").read_text())
    row = next(row for row in table["points"] if row["label"] == "0.05")
    row |= {"but": "only until the impact", "but_after": 1.5}
    (tmp_path / "front.json").write_text(json.dumps(table))
    assert [point.label for point in read_front(scene).points] == ["0.2", "0.1"]
    assert [point.label for point in read_front(scene, 2.0).points] == ["0.2", "0.1"]
    assert [point.label for point in read_front(scene, 1.5).points] == ["0.2", "0.05"]  # which beats 0.1


def test_a_curve_is_read_from_long_and_from_wide_tables():
    long = {"time (s)": np.array([0, 0, 1, 1.0]), "x (m)": np.array([1, 2, 2, 1.0]), "y": np.array([5, 6, 7, 8.0])}
    places, values = curve(long, {"column": "y", "along": "x (m)", "at": "end"})
    assert (places.tolist(), values.tolist()) == ([1, 2], [8, 7])
    places, values = curve(long, {"column": "y", "along": "x (m)", "at": 0.1})
    assert values.tolist() == [5, 6]
    wide = {"time (s)": np.array([0.0, 1.0]), "h at 1": np.array([1.0, 2.0]), "h at 2": np.array([3.0, 4.0])}
    assert curve(wide, {"column": "h at *", "at": "end"})[1].tolist() == [2, 4]
    with pytest.raises(KeyError):
        curve(wide, {"column": "g at *", "at": "end"})
    for table, asked in ((long, {"column": "y", "along": "x (m)"}), (wide, {"column": "h at *"})):
        # Beyond the end it was the last row; whole steps end a little off the prescribed time.
        assert np.isfinite(curve(table, asked | {"at": 1.4})[1]).all()
        assert np.isnan(curve(table, asked | {"at": 1.5})[1]).all()


def test_a_column_that_no_run_has_is_said_with_those_that_there_are(tmp_path):
    wrong = ("y (m)", "z (m)", "series"), ("height at", "depth at", "profile"), ('"profile"', '"x"', "x")
    for old, new, file in wrong:
        made = plan(tmp_path, PLAN.replace(old, new))
        errors = Errors(made, lambda folder, name: {} if name == "x" else tables(folder, name), {}, [ended("1 2")])
        with pytest.raises(InputError, match=rf"^quantity '\w+': column = '.*': is not in {file}\.csv") as caught:
            errors.trade("k", "1", Point("1 2", ()), [ended("1 2")])
        assert ("(allowed: time (s), " in str(caught.value)) == (file != "x")


def test_errors_that_the_pages_ask_for_can_be_had():
    asked = []
    for page in [ROOT / "README.md", *ROOT.glob("docs/*.md"), *ROOT.glob("cases/*/README.md")]:
        asked += re.findall(r"cases/(\w+)\s+--error (\d+)%", page.read_text(encoding="utf-8"))
    assert len(asked) >= 3
    for case, error in asked:
        points = read_front(ROOT / "cases" / case / "scene.toml").points
        assert min(point.error for point in points) <= int(error) / 100, case
