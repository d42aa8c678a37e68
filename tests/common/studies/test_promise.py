"""What a front promises is held against a run: its time, and its error beside the answers that the front keeps."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from porescale.common.studies.budget_check import Promise, benchmark, compare, error_of, settings
from porescale.common.studies.front import Choice, FrontPoint, read_front
from tests.reference.toy_package import TOY

POINT = FrontPoint("10", None, ("numerics.spacing=0.1",), 0.05, 0.01, 1.0, 0.8, 1e-3, 1.0, {"front": 0.04})


def front_beside(folder: Path, **more):
    point = {"label": "10", "quality": None, "settings": ["numerics.spacing=0.1"], "on_front": True, "error": 0.05,
             "scatter": 0.01, "core_seconds": 1.0, "besides": 1.0, "time": 0.8, "pace": 1e-3,
             "errors": {"front": 0.04}, "but": ""}  # fmt: skip
    quantity = {"name": "front", "column": "front (m)", "at": 0.5, "scale": 2.0}
    table = {"format": 2, "machine": {"processor": "x"}, "date": "d", "quantities": [quantity], "points": [point]}
    (folder / "front.json").write_text(json.dumps(table | more))
    return read_front(folder / "scene.toml")


def test_the_error_is_the_distance_from_the_answers_that_the_front_keeps(tmp_path):
    front = front_beside(tmp_path, references=[{"front": [1.0]}])
    (tmp_path / "series.csv").write_text("time (s),front (m)\n0.0,0.0\n1.0,2.4\n")
    assert error_of(front, POINT, tmp_path) == pytest.approx((0.04, (1.2 - 1.0) / 2.0))


def test_a_front_without_answers_leaves_the_error_open(tmp_path):
    assert error_of(front_beside(tmp_path), POINT, tmp_path) == (0.05, None)


def test_a_run_within_30_per_cent_and_the_scatter_keeps_its_promise():
    kept = compare(Choice(POINT, 2.0, 1.0, 1.0), 2.5, {"core_seconds": 1.1}, 0.05, 0.06)
    assert kept.on_time
    assert kept.as_good
    assert "kept" in kept.line()


@pytest.mark.parametrize(("what", "value"), [("took", 2.7), ("took", 1.3), ("found", 0.09)])
def test_a_run_beyond_either_does_not(what, value):
    promise = replace(Promise("10", 2.0, 2.0, 1.0, 1.0, 0.05, 0.01, 0.05), **{what: value})
    assert not (promise.on_time and promise.as_good)
    assert "not kept" in promise.line()


def test_last_digits_do_not_break_the_promise_of_a_point_that_was_run_once():
    once = Promise("10", 2.0, 2.0, 1.0, 1.0, 0.05, 0.0, 0.05 * (1 + 1e-12))
    assert once.as_good
    assert not replace(once, found=0.052).as_good


def test_the_point_runs_for_as_long_as_it_was_measured():
    assert settings(POINT) == ("time.end=0.8", "numerics.spacing=0.1")


def test_a_case_without_a_front_has_no_row(tmp_path):
    assert list(benchmark(TOY, tmp_path)) == []
