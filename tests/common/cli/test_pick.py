"""What `--error` and `--budget` pick, refuse and warn of."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from porescale.cli.main import PACKAGE
from porescale.common.cli.pick import _seconds, beyond, pick, share
from porescale.common.core.errors import InputError
from porescale.common.studies import trade_files
from porescale.common.studies.front import Here, read_front
from porescale.common.studies.parameter_table import Point
from porescale.common.studies.trade import Traded, front
from tests.reference.folders import ROOT
from tests.reference.toy_package import TEMPLATE, TOY


def traded(error: float, seconds: float) -> Traded:
    """A point whose steps take all of its core-seconds."""
    point = Point(f"{error:g}", ())
    return Traded("k", f"{error:g}", point, "finished", {"q": error}, error, 0.0, seconds, 77.0, 0, 1, 2.0, 0.0, 0.5)


def written(tmp_path: Path, points: list[Traded]) -> None:
    about = {"command": "toy study trade", "machine": {"processor": "abacus"}, "date": "2001-01-01"}
    trade_files.write(tmp_path, about, front(points), {})


@pytest.fixture
def toy_front(tmp_path, monkeypatch):
    """A front of the toy, measured with decay.start = 1; gives what `pick` says of settings, on stderr."""
    (tmp_path / "scene.toml").write_text(TEMPLATE)
    reference = replace(traded(0.0, 50.0), point=Point("r", ("decay.start=2",)))
    about = {"command": "toy study trade . --set decay.start=1.5", "machine": {"processor": "abacus"}, "date": "d",
             "reference": trade_files.as_dict(reference)}  # fmt: skip
    trade_files.write(tmp_path, about, front([traded(0.2, 5.0)]), {})
    monkeypatch.setattr("porescale.common.studies.front.begun", lambda *given: Here(1.0, 1.0))
    return tmp_path / "scene.toml"


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (["decay.start=1.5"], ""),
        (["decay.start=1.6"], "decay.start = 1.6, there 1.5"),
        ([], "decay.start = 1.0, there 1.5"),
        (["decay.start=1.5", "decay.rate=4"], "decay.rate = 4.0, there 3.0"),
    ],
)
def test_a_front_knows_the_settings_it_was_measured_with(toy_front, capsys, settings, said):
    pick(TOY, toy_front, "50%", None, settings, quiet=False)
    warned = [line for line in capsys.readouterr().err.splitlines() if line.startswith("warning")]
    assert len(warned) == bool(said)
    assert said in "".join(warned)


def test_an_edited_scene_is_not_that_of_the_front(toy_front, capsys):
    table = json.loads(toy_front.with_name("front.json").read_text())
    base = {"decay": {"rate": 3.0, "start": 1.5}, "duration": 2.0, "trouble": ""}
    for rate, warned in ((3.0, 0), (2.0, 1)):
        toy_front.with_name("front.json").write_text(
            json.dumps(table | {"scene": base | {"decay": {"rate": rate, "start": 1.5}}})
        )
        pick(TOY, toy_front, "50%", None, ["decay.start=1.5"], quiet=False)
        assert capsys.readouterr().err.count("warning") == warned


def test_a_key_that_is_newer_than_the_front_changes_nothing_until_it_is_given(toy_front, capsys):
    table = json.loads(toy_front.with_name("front.json").read_text())
    older = {"decay": {"rate": 3.0, "start": 1.5}, "duration": 2.0}  # without `trouble`
    toy_front.with_name("front.json").write_text(json.dumps(table | {"scene": older}))
    for more, warned in (([], 0), (['trouble="late"'], 1)):
        pick(TOY, toy_front, "50%", None, ["decay.start=1.5", *more], quiet=False)
        assert capsys.readouterr().err.count("warning") == warned


def test_a_run_beyond_the_time_of_its_front_is_warned_of():
    scene = ROOT / "cases" / "column_collapse" / "scene.toml"
    found = read_front(scene)
    beyond_it = [line for line in beyond(PACKAGE, scene, found, found.points[0], ["time.end=1"]) if "goes on" in line]
    assert beyond_it == [
        f"{found.file} was measured until 0.5 s, the run goes on to 1 s: its errors say nothing of later"
    ]
    assert beyond(PACKAGE, scene, found, found.points[0], ["time.end=0.5", "grains.packing.seed=7"]) == []


def test_a_refused_error_names_the_quality_that_has_it(toy_front):
    with pytest.raises(InputError, match=r"takes 0.2; --quality fine is what errors are held against, 50 core-seconds"):
        pick(TOY, toy_front, "1%", None, (), quiet=True)


def test_what_was_given_is_said_as_it_was_given(tmp_path, monkeypatch):
    written(tmp_path, [traded(0.2, 5.0), traded(0.1041, 10.0)])
    scene = tmp_path / "scene.toml"
    scene.write_text(TEMPLATE)
    monkeypatch.setattr("porescale.common.studies.front.begun", lambda *given: Here(1.0, 1.0))
    with pytest.raises(InputError, match=r"^--budget = '1 s': is not enough"):
        pick(TOY, scene, None, "1 s", (), quiet=True)
    with pytest.raises(InputError, match=r"^--error = '10.4%': is below .* \(allowed: >= 10.5%\); --error 10.5% takes"):
        pick(TOY, scene, "10.4%", None, (), quiet=True)
    assert pick(TOY, scene, "10.5%", None, (), quiet=True).point.error == 0.1041  # what the line names is accepted


def test_shares_and_times_are_read_as_people_write_them():
    assert share("--error", "5%") == share("--error", "5 %") == share("--error", "0.05") == 0.05
    assert _seconds("3min") == 180.0
    assert _seconds("90") == 90.0
    assert _seconds("2 h") == 7200.0
    for wrong in ("", "5%%", "-1%", "nan", "inf", "0"):
        with pytest.raises(InputError):
            share("--error", wrong)
    with pytest.raises(InputError, match=r"^--until: has no share \(allowed: > 0\); write one, as 5% or 0\.05$"):
        share("--until", "")
    assert share("--error", "250%") == 2.5  # as it is written; a bare number beyond 1 is per cent without the sign
    assert share("--error", "1") == 1.0
    with pytest.raises(InputError, match=r"^--error = '10': is 1000 % \(allowed: <= 1\); write it as 10%$"):
        share("--error", "10")
    for wrong in ("", "3 apples", "-1 s", "0", "3 m"):
        with pytest.raises(InputError):
            _seconds(wrong)
