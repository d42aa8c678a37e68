"""What a script measured of its options has the files of `study trade`, and a front that is read as one."""

import json

import pytest

from porescale.common.studies.front import read_front
from porescale.output import Tried, trade


def tried(label, error, seconds, other=None):
    """Two repeats of two quantities; the second quantity is right but for ``other``."""
    errors = [{"far": error, "near": other or 0.0}, {"far": error, "near": 0.0}]
    return Tried("window", label, (f"window={label}",), errors, seconds, 4)


def test_errors_are_rms_over_quantities_and_repeats_and_core_seconds_those_of_one(tmp_path):
    trade(tmp_path, "python windows.py", [tried("8", 0.2, 40.0), tried("16", 0.4, 4.0), tried("32", 0.6, 8.0)])
    front = read_front(tmp_path / "scene.toml")
    assert [(one.label, one.core_seconds) for one in front.points] == [("window 16", 1.0), ("window 8", 10.0)]
    assert front.points[1].error == pytest.approx(0.2 / 2**0.5)
    assert front.points[1].errors == {"far": pytest.approx(0.2), "near": 0.0}
    assert front.points[1].settings == ("window=8",)
    table = json.loads((tmp_path / "front.json").read_text())
    assert (table["command"], [it["name"] for it in table["quantities"]]) == ("python windows.py", ["far", "near"])
    assert {it.name for it in tmp_path.iterdir()} == {"front.json", "trade.csv", "trade.md", "trade.png"}


def test_an_error_of_one_repeat_changes_both_error_and_scatter(tmp_path):  # the check that must fail
    trade(tmp_path, "", [tried("8", 0.2, 40.0, other=0.3)])
    (point,) = read_front(tmp_path / "scene.toml").points
    assert point.error != pytest.approx(0.2 / 2**0.5)
    assert point.scatter > 0.0
