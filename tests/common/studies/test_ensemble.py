"""Repeats of a run: which they are, what their mean is worth, and how it is judged."""

import csv
import json
import math
from dataclasses import replace
from itertools import permutations
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from porescale.common.cli.sweep import chosen_points, conclude
from porescale.common.core.errors import InputError
from porescale.common.core.statistics import Sample, bootstrap, equal, half_width, student
from porescale.common.record.series import run_table
from porescale.common.studies import ensemble_files, sweep_files
from porescale.common.studies.ensemble import FAIL, OPEN, PASS, Repeats, ensembles, judged, repeated
from porescale.common.studies.ensemble_picture import band
from porescale.common.studies.parameter_table import Point, read_points, varied
from porescale.common.studies.runner import Campaign, Ended
from porescale.common.studies.schedulers.local import Local
from porescale.common.studies.schedulers.task import Process
from porescale.common.studies.sweep import expected, run_points
from tests.reference.toy_package import TOY, write_series

CASES = Path(__file__).resolve().parents[3] / "cases"
SCENE = "[decay]\nrate = 3\n[noise]\nseed = 5\n[quality.fine.decay]\nstart = 2\n"
AT_END = {"name": "left", "column": "left (m)", "at": "end", "unit": "m", "value": 0.06, "tolerance": 0.05}


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path / "scene.toml"


def repeats(scene: Path, count: int | None, over: str | None = None, points: list[Point] | None = None) -> list[Point]:
    asked = Repeats(count, over)
    return repeated(TOY, scene, chosen_points(None, (), asked) if points is None else points, asked, None, ())


class Machine:
    """Runs points without processes: writes the card that a run would; some end otherwise, by name of the folder."""

    def __init__(self, outcomes: dict[str, tuple[int, str]] | None = None, stop_after: int = 1 << 30) -> None:
        self.outcomes, self.left, self.called = outcomes or {}, stop_after, list[str]()

    def __call__(self, words: list[str]) -> tuple[int, str]:
        folder = Path(words[words.index("--out") + 1])
        settings = [words[at + 1] for at, word in enumerate(words) if word == "--set"]
        self.left -= 1
        if self.left < 0:
            raise KeyboardInterrupt
        self.called.append(folder.name)
        code, outcome = self.outcomes.get(folder.name, (0, "finished"))
        made = {"decay": {"rate": 3.0, "start": 1.0}, "noise": {"seed": 5, "size": 0.1}}
        for text in settings:
            section, _, rest = text.partition(".")
            key, _, value = rest.partition("=")
            made[section][key] = json.loads(value)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "card.json").write_text(json.dumps({"scene": made, "settings": settings, "outcome": outcome}))
        write_series(folder, made)
        return code, "" if code == 0 else "grain 7 left"


def swept(scene: Path, points: list[Point], machine: Machine, out: str = "out", jobs: int = 1, **more) -> list[Ended]:
    scheduler = Local(lambda task, cores: SimpleNamespace(run=lambda: machine(task.command()), stop=lambda: None))
    campaign = Campaign("toy", scene, scene.parent / out, scheduler=scheduler, **more)
    return run_points(campaign, points, jobs, [AT_END], "toy sweep", lambda text: None)


def table(folder: Path) -> list[dict[str, str]]:
    with open(folder / "ensemble.csv") as file:
        return list(csv.DictReader(file))


def test_repeats_count_on_from_the_seed_of_the_scene(scene):
    points = repeats(scene, 3)
    assert [point.settings for point in points] == [("noise.seed=5",), ("noise.seed=6",), ("noise.seed=7",)]
    assert [point.name for point in points] == ["seed=5", "seed=6", "seed=7"]


def test_several_seeds_are_counted_up_so_that_no_repeat_draws_with_another_ones(scene):
    def keys(**seeds):
        return [dict(it.split("=") for it in one) for one in Repeats(4).choices(program(seeds), None)]

    def program(seeds):
        return replace(TOY, seeds=lambda scene: seeds)

    assert keys(a=1, b=2) == [{"a": f"{1 + 2 * k}", "b": f"{2 + 2 * k}"} for k in range(4)]
    drawn = [seed for one in keys(a=7, b=3, c=4) for seed in one.values()]
    assert len(set(drawn)) == len(drawn)
    assert keys(a=5, b=5) == [{"a": f"{5 + k}", "b": f"{5 + k}"} for k in range(4)]  # alike in the scene: alike in all


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ('value = "0.2 m"\ntolerance = 0.1', "value is not a number"),
        ("value = nan\ntolerance = 0.1", "value is not a number"),
        ("value = 0.2\ntolerance = true", "tolerance is not a number"),
        ("value = 0.2\ntolerance = inf", "tolerance is not a number"),
        ("value = 0.2\ntolerance = -0.1", "tolerance is below 0"),
    ],
)
def test_what_a_row_expects_is_refused_in_one_line_before_anything_runs(toy, scene, words, said):
    row = f'[[expected]]\nname = "left"\ncolumn = "left (m)"\nat = "end"\n{words}\n'
    (scene.parent / "expected.toml").write_text(row)
    code, _, lines = toy("sweep", "scene.toml", "--repeat", "4")
    assert code == 2
    (line,) = lines
    assert said in line
    assert "left" in line
    assert not (scene.parent / "runs").exists()


@pytest.mark.parametrize("case", sorted(path.parent.name for path in CASES.glob("*/expected.toml")))
def test_a_sweep_reads_what_every_case_expects(case):
    assert expected(CASES / case / "scene.toml") is not None


def test_every_combination_is_repeated_on_the_same_seeds_and_named_as_if_they_were_varied(scene):
    points = repeats(scene, 2, points=varied(["decay.rate=1,2"]))
    crossed = varied(["decay.rate=1,2", "noise.seed=5,6"])
    assert [(point.name, point.settings) for point in points] == [(point.name, point.settings) for point in crossed]
    assert [one.of.settings for one in ensembles(points, ())] == [("decay.rate=1",), ("decay.rate=2",)]
    assert ensembles(crossed, ()) == []  # varied alike, but nothing says that they are repeats


def test_another_key_is_counted_up_or_has_its_values_given(scene, tmp_path):
    (tmp_path / "calm.toml").write_text("[decay]\nrate = 3\n")
    given = repeats(tmp_path / "calm.toml", None, "decay.rate=3,3.01,3.02")
    assert [point.settings for point in given] == [("decay.rate=3",), ("decay.rate=3.01",), ("decay.rate=3.02",)]
    assert [one.over for one in ensembles(given, ())] == [("decay.rate",)]
    assert repeats(scene, 2, "noise.seed") == repeats(scene, 2)
    (tmp_path / "table.csv").write_text("name,quality,decay.rate\nslow,fine,1\n")
    (slow, _) = repeats(scene, 2, points=read_points(tmp_path / "table.csv"))
    assert (slow.name, slow.quality, slow.settings) == ("slow,seed=5", "fine", ("decay.rate=1", "noise.seed=5"))


@pytest.mark.parametrize(
    ("count", "over", "vary", "said"),
    [
        (0, None, [], "--repeat = 0: is out of range"),
        (3, "decay.rate", [], "is no whole number in the scene; give its values, --over decay.rate=a,b,c"),
        (3, "decay.rat", [], "is no whole number in the scene"),
        (3, "a b", [], "is not section.key"),
        (None, "noise.seed", [], "does not say how often"),
        (3, "noise.seed=1,2", [], "contradicts the 2 values of --over"),
        (None, "noise.seed=1,,1", [], "is not section.key, or section.key=a,b,c"),
        (2, None, ["noise.seed=1,2"], "is varied by the sweep and by --repeat"),
        (9000, None, ["decay.rate=1,2"], "are too many runs"),
    ],
)  # fmt: skip
def test_what_cannot_be_repeated_is_said_in_one_line(scene, count, over, vary, said):
    with pytest.raises(InputError) as caught:
        repeats(scene, count, over, varied(vary) if vary else None)
    (fault,) = caught.value.faults
    assert said in fault.line()


@pytest.mark.parametrize("values", ["5,5", "5,5.0,6"])
def test_a_repeat_needs_a_value_of_its_own(toy, scene, values):
    # Two ways to write a value were two runs of the same bits, and the deviation that of fewer.
    code, _, (line,) = toy("sweep", "scene.toml", "--over", f"decay.rate={values}", "--vary", "decay.start=3")
    assert code == 2
    assert line.startswith("--over: decay.rate = '5")  # not the first thing that it sets
    assert line.endswith("is 5, which is given, too; leave one out")
    assert not (scene.parent / "runs").exists()


def test_a_key_that_repeats_set_is_set_by_nothing_else(toy, scene):
    code, _, (line,) = toy("sweep", "scene.toml", "--over", "decay.rate=5,6", "--set", "decay.rate=4")
    assert code == 2
    assert line == "--set: decay.rate: is set by every repeat, too, as --over says; leave one out"
    assert not (scene.parent / "runs").exists()
    # Counted from the scene's own value it does say something.
    assert toy("sweep", "scene.toml", "--repeat", "2", "--over", "noise.seed", "--set", "noise.seed=7")[0] == 0


def test_a_scene_that_draws_nothing_is_refused_and_told_what_to_do(tmp_path):
    (tmp_path / "calm.toml").write_text("[decay]\nrate = 3\n")
    with pytest.raises(InputError, match=r"--repeat = 4: repeats the same run: .* --over section\.key=a,b,c"):
        repeats(tmp_path / "calm.toml", 4)


def test_a_line_has_the_mean_of_the_runs_and_what_it_is_worth(scene):
    ends = swept(scene, repeats(scene, 5), Machine())
    values = [run_table(ended.folder, "series")["left (m)"][-1] for ended in ends]
    (line,) = table(scene.parent / "out")
    assert (line["asked"], line["finished"], line["n"], line["over"]) == ("5", "5", "5", "noise.seed")
    assert float(line["mean"]) == pytest.approx(np.mean(values))
    assert float(line["standard error"]) == pytest.approx(np.std(values, ddof=1) / math.sqrt(5))
    assert float(line["t high"]) - float(line["mean"]) == pytest.approx(half_width(values))
    assert float(line["bootstrap low"]) < float(line["mean"]) < float(line["bootstrap high"])
    assert line["verdict"] == PASS
    with open(scene.parent / "out" / "sweep.csv") as file:
        assert [float(it["left (m)"]) for it in csv.DictReader(file)] == values
    text = (scene.parent / "out" / "sweep.md").read_text()
    assert "- as-it-is: 5 of 5 finished, over noise.seed" in text
    assert "| 5 of 5 | pass |" in text
    assert (scene.parent / "out" / "sweep.png").read_bytes().startswith(b"\x89PNG")


def test_a_stopped_ensemble_gone_on_with_ends_with_the_same_bytes_in_whatever_order_its_runs_end(scene):
    points = repeats(scene, 6, points=varied(["decay.rate=2,3"]))
    swept(scene, points, Machine(), "whole")
    whole = (scene.parent / "whole" / "ensemble.csv").read_bytes()
    with pytest.raises(KeyboardInterrupt):
        swept(scene, points, Machine(stop_after=4), "stopped")
    partly = table(scene.parent / "stopped")
    assert [line["finished"] for line in partly] == ["4", "0"]
    assert {line["verdict"] for line in partly} == {OPEN}
    rest = Machine()
    swept(scene, points, rest, "stopped", jobs=3)
    assert len(rest.called) == 8  # nothing is run twice
    assert (scene.parent / "stopped" / "ensemble.csv").read_bytes() == whole
    swept(scene, points[::-1], Machine(), "turned")  # the check that must fail: other points, another table
    assert (scene.parent / "turned" / "ensemble.csv").read_bytes() != whole


def test_runs_that_do_not_finish_are_counted_said_and_leave_the_row_open(scene):
    lost = {"seed=6": (3, "unstable"), "seed=8": (2, "refused")}
    ends = swept(scene, repeats(scene, 6), Machine(lost))
    (line,) = table(scene.parent / "out")
    assert (line["asked"], line["finished"], line["n"], line["verdict"]) == ("6", "4", "4", OPEN)
    assert line["remark"] == "4 of 6 finished (1 unstable, 1 refused)"
    assert "4 of 6 finished (1 unstable, 1 refused)" in (scene.parent / "out" / "sweep.md").read_text()
    assert conclude(ends) == 1
    lines = sweep_files.ensemble_lines(ensembles(repeats(scene, 6), ends), [AT_END], run_table)
    assert "4 of 6 finished (1 unstable, 1 refused)" in ensemble_files.printed(lines)[0]
    assert not ensemble_files.failed(lines)


def test_numbers_that_nothing_judges_are_printed_to_a_screen_s_end(scene):
    ends = swept(scene, repeats(scene, 3), Machine())
    asked = [{"name": f"q{k}", "column": "left (m)", "at": 0.01 * k} for k in range(50)]
    found = ensembles(repeats(scene, 3), ends)
    said = ensemble_files.printed(sweep_files.ensemble_lines(found, asked, run_table))
    assert said[-1] == "and 10 numbers more, in ensemble.csv"
    assert len(said) == 1 + 40 + 1
    assert "more" not in ensemble_files.printed(sweep_files.ensemble_lines(found, asked[:40], run_table))[-1]


def test_two_runs_have_a_mean_and_no_interval_and_it_is_said(scene):
    swept(scene, repeats(scene, 2), Machine())
    (line,) = table(scene.parent / "out")
    assert line["mean"]
    assert line["standard error"]
    assert (line["t low"], line["bootstrap low"], line["verdict"]) == ("", "", OPEN)
    assert line["remark"].startswith("no interval of 2, at least 3 are needed")


def test_the_command_ends_with_one_where_a_row_fails_for_the_scene_as_it_is(toy, scene, monkeypatch):
    monkeypatch.setattr(Process, "run", lambda self: Machine()(self.task.command()))
    row = '[[expected]]\nname = "left"\ncolumn = "left (m)"\nat = "end"\nunit = "m"\nvalue = {}\ntolerance = 0.05\n'
    expected = scene.parent / "expected.toml"
    expected.write_text(row.format(0.06))
    code, out, _ = toy("sweep", "scene.toml", "--repeat", "4")
    assert code == 0
    assert "as-it-is: 4 of 4 finished\npass: left (m) 0.0" in out
    assert "ensemble.csv" in out
    expected.write_text(row.format(0.5))
    code, out, _ = toy("sweep", "scene.toml", "--repeat", "4")
    assert code == 1
    assert "fail: left (m)" in out
    (scene.parent / "levels.csv").write_text("name,quality\nfiner,fine\n")
    for words in (["--quality", "fine"], ["levels.csv"], ["--set", "decay.rate=3"]):
        code, out, _ = toy("sweep", "scene.toml", *words, "--repeat", "4", "--out", f"runs/{words[-1]}")
        assert (code, "fail: " in out) == (0, True)  # shown: the rows are meant for the level of the scene itself
    code, out, _ = toy("sweep", "scene.toml", "--vary", "decay.rate=1,2", "--repeat", "3", "--out", "varied")
    assert code == 0  # shown, and not meant for other values
    assert "fail: rate=2, left (m)" in out
    assert toy("sweep", "scene.toml", "--vary", "decay.rate=1,2", "--out", "plain")[0] == 0
    assert not (scene.parent / "plain" / "ensemble.csv").exists()  # without repeats nothing is there


@pytest.mark.parametrize(
    ("value", "tolerance", "verdict"),
    [(1.0, 0.3, PASS), (1.2, 0.4, PASS), (1.0, 0.1, OPEN), (1.3, 0.3, OPEN), (2.0, 0.5, FAIL), (0.0, 0.8, FAIL)],
)
def test_a_row_passes_or_fails_only_where_the_whole_interval_does(value, tolerance, verdict):
    values = [0.9, 1.0, 1.1, 1.0, 0.8, 1.2]  # 1.00 +- 0.15
    assert half_width(values) == pytest.approx(0.1484, abs=1e-4)
    found = judged(values, True, {"value": value, "tolerance": tolerance})
    assert found.verdict == verdict
    assert (found.needed is None) == (verdict != OPEN)
    assert judged(values, False, {"value": value, "tolerance": tolerance}).verdict == OPEN  # some did not finish
    for lost in (math.nan, math.inf):
        missing = judged([*values, lost], True, {"value": value, "tolerance": tolerance})
        assert (missing.verdict, missing.needed) == (OPEN, None)  # no number of repeats brings it


def test_what_some_never_come_to_is_open_and_what_all_never_come_to_fails():
    row = {"value": 1.0, "tolerance": 1.0}
    some = judged([1.0, 1.1, math.inf, 0.9], True, row)
    assert (some.verdict, some.never, some.sample.mean) == (OPEN, 1, pytest.approx(1.0))
    assert judged([math.inf] * 4, True, row).verdict == FAIL
    assert judged([], True, row).verdict == OPEN


def test_verdicts_are_wrong_no_more_often_than_the_interval_allows():
    """A true mean at the very edge of the band, where each wrong verdict is likeliest: 2.5 % of each."""
    draws = np.random.default_rng(4).normal(size=(4000, 6))
    row = {"value": 2.0, "tolerance": 2.0}  # the mean, 0, is on its lower edge
    found = [judged(tuple(values), True, row).verdict for values in draws]
    # binomial: four times sqrt(0.025 · 0.975/4000) = 0.0099
    assert found.count(PASS) / 4000 == pytest.approx(0.025, abs=0.0099)
    assert found.count(FAIL) / 4000 == pytest.approx(0.025, abs=0.0099)
    bare = [abs(values.mean() - 2.0) <= 2.0 for values in draws]
    assert np.mean(bare) > 0.4  # the check that must fail: a mean without its interval passes half of them


@pytest.mark.parametrize("room", [0.05, 0.03, 0.004])
def test_as_many_repeats_as_are_said_to_be_needed_resolve_a_row_and_two_percent_fewer_do_not(room):
    values = np.random.default_rng(5).normal(1.0, 0.1, 6)
    mean, error = values.mean(), stats.sem(values)
    found = judged(list(values), True, {"value": mean, "tolerance": room})
    assert found.verdict == OPEN
    assert found.needed > len(values)

    def resolved(count):
        """Whether the interval of as many values with this mean and deviation lies within the band."""
        low, high = stats.t.interval(0.95, count - 1, mean, error * math.sqrt(len(values) / count))
        return mean - room <= low and high <= mean + room

    assert resolved(found.needed)
    # counts are tried 2 % apart, rounded: the one before is at most this much below, and at least one
    assert not resolved(min(found.needed - 1, math.floor((found.needed - 0.5) / 1.02)))


def test_values_that_are_equal_but_for_rounding_have_no_deviation_and_pass_without_room():
    third = 0.1 * 3 / 3
    assert third != 0.1
    for values in ([0.1] * 3, [third, 0.1, 0.1], [-1e9] * 7):
        sample = Sample(tuple(values))
        assert (sample.mean, sample.deviation, sample.half) == (min(values), 0.0, 0.0)
        assert judged(values, True, {"value": min(values), "tolerance": 0.0}).verdict == PASS
        assert bootstrap(tuple(values)) == (min(values), min(values))
    assert Sample((0.1, 0.1, 0.1 * (1 + 1e-14))).deviation > 0.0  # 45 eps apart: no rounding
    assert not equal([1.0, math.inf])
    assert not equal([1.0, math.nan])


COVERED = {  # of normal and of exponential values, in shares of draws whose interval holds the mean: Student, bootstrap
    5: ((0.95, 0.85), (0.88, 0.80)),
    10: ((0.95, 0.90), (0.91, 0.87)),
    20: ((0.95, 0.93), (0.92, 0.91)),
}


@pytest.mark.parametrize("count", COVERED)
def test_intervals_hold_the_mean_as_often_as_is_said(count):
    many = 400
    for which, draw in enumerate(("normal", "standard_exponential")):
        draws = getattr(np.random.default_rng(6), draw)(size=(many, count))
        mean = float(which)
        students = np.mean([abs(Sample(tuple(it)).mean - mean) <= half_width(it) for it in draws])
        ends = np.array([bootstrap.__wrapped__(tuple(it), resamples=299) for it in draws])
        boots = np.mean((ends[:, 0] <= mean) & (mean <= ends[:, 1]))
        # four times sqrt(0.9 · 0.1/400) = 0.06
        assert students == pytest.approx(COVERED[count][which][0], abs=0.06)
        assert boots == pytest.approx(COVERED[count][which][1], abs=0.06)
        assert boots < 0.95 - (0.05 if count == 5 else 0.0)  # why Student's interval judges


def test_the_bootstrap_is_the_same_in_whatever_order_the_runs_ended():
    values = (0.3, 0.1, 0.4, 0.15)
    ends = bootstrap(values)
    assert all(bootstrap(order) == ends for order in permutations(values))
    assert bootstrap((0.3, 0.1, 0.4, 0.16)) != ends
    assert bootstrap((0.2, 0.2, 0.2)) == (0.2, 0.2)
    assert all(map(math.isnan, bootstrap((0.2, 0.3))))


def test_a_band_is_that_of_the_members_at_each_time_as_far_as_all_have_come():
    time = np.linspace(0.0, 1.0, 11)
    found = band([(time, time), (time, 3.0 * time), (time[:6], 2.0 * time[:6])])
    assert found is not None
    assert found.time.tolist() == time[:6].tolist()
    assert found.mean == pytest.approx(2.0 * time[:6])
    assert found.error == pytest.approx(time[:6] / math.sqrt(3.0))
    assert found.half == pytest.approx(student(3) * time[:6] / math.sqrt(3.0))
    assert np.isnan(band([(time, time), (time, 2.0 * time)]).half).all()
    assert band([]) is None
    assert band([(np.zeros(3), np.zeros(3))]) is None  # a row for each place: no curve over time
