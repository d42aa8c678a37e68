"""Quality levels are points of the front, picked by a rule; the shipped cases keep to it."""

import json
from pathlib import Path

import pytest

from porescale.common.core.errors import InputError
from porescale.common.studies.front import read_front
from porescale.common.studies.levels import APART, apart, compared, picked
from tests.reference.folders import CASES


def front_of(folder: Path, **more):
    """Points of falling error and rising cost, the last as good as the one before; a reference 25 times the first."""

    def row(label, error, cost, but=""):
        return {"label": label, "quality": None, "settings": [], "on_front": True, "error": error, "scatter": 0.0,
                "core_seconds": cost, "besides": 0.0, "time": 1.0, "pace": 1.0, "errors": {}, "but": but}  # fmt: skip

    tried = ("rough", 0.3, 1.0), ("fair", 0.12, 2.0), ("good", 0.05, 4.0), ("dear", 0.05, 8.0)
    points = [*(row(*it) for it in tried), row("partial", 0.01, 0.5, "until the wall only")]
    table = {"format": 2, "machine": {"processor": "x"}, "date": "d", "points": points,
             "reference": row("reference", 0.0, 50.0), "packings": {"a": 0.15, "b": 0.09}}  # fmt: skip
    (folder / "front.json").write_text(json.dumps(table | more))
    return read_front(folder / "scene.toml")


def test_draft_is_the_cheapest_allowed_standard_the_best_fine_the_reference(tmp_path):
    # rms of 0.15 and 0.09 is 0.124: "fair" may be a draft, "rough" may not
    labels = {level: point.label for level, point in picked(front_of(tmp_path)).items()}
    assert labels == {"draft": "fair", "standard": "good", "fine": "reference"}


def test_a_case_may_say_how_far_off_a_draft_is_allowed_to_be(tmp_path):
    assert picked(front_of(tmp_path, draft=0.3))["draft"].label == "rough"


@pytest.mark.parametrize("more", [{"draft": 0.01}, {"reference": None}, {"packings": {}}])
def test_a_front_without_a_point_for_a_level_is_said(tmp_path, more):
    with pytest.raises(InputError, match="has no reference, or no point"):
        picked(front_of(tmp_path, **more))


def packages():
    from continuum_sph.cli import PACKAGE as continuum
    from porescale.cli.main import PACKAGE as grains

    return {"column_collapse": grains, "collapsing_water_column": continuum}


@pytest.mark.parametrize("case", ["column_collapse", "collapsing_water_column"])
def test_levels_of_the_shipped_cases_are_those_that_the_rule_picks(case):
    rows = compared(packages()[case], CASES / case / "scene.toml")
    assert [row.level for row in rows if row.wrong] == []
    assert apart(rows) >= APART


def test_a_level_that_is_something_else_is_found(tmp_path):  # the twin that must fail
    case = CASES / "column_collapse"
    for name in ("scene.toml", "front.json"):
        (tmp_path / name).write_text((case / name).read_text())
    scene = (tmp_path / "scene.toml").read_text()
    assert 'spacing = "0.1 mm"' in scene
    (tmp_path / "scene.toml").write_text(scene.replace('spacing = "0.1 mm"', 'spacing = "0.11 mm"'))
    rows = compared(packages()["column_collapse"], tmp_path / "scene.toml")
    assert [row.level for row in rows if row.wrong] == ["fine"]
    assert "fluid.spacing" in rows[-1].line()
