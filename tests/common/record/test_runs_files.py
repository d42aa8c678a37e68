"""Files of a run: whole or absent, series that survive a kill, the card."""

import json
import math
import os
import subprocess
import sys

import numpy as np
import pytest

from porescale.common.core import atomic
from porescale.common.core.errors import InputError
from porescale.common.record import card
from porescale.common.record.record import check_changes
from porescale.common.record.series import Series, read_series
from porescale.common.schema.messages import parse_key
from porescale.common.schema.scene_file import holds


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "data.txt"
    atomic.write_text(path, "old")

    def fail():
        with atomic.whole(path) as beside:
            beside.write_text("half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_dead_process_left_is_cleaned_and_a_living_one_keeps_its_file(tmp_path):
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    stale = tmp_path / f".fields.{dead.pid}.writing.vtkhdf"
    part = tmp_path / "parts" / f".000000000041.{dead.pid}.writing"
    part.mkdir(parents=True)
    (part / "fields.vtkhdf").write_bytes(b"x")
    alive = tmp_path / f".film.{os.getppid()}.writing.mp4"
    data = tmp_path / "fields.vtkhdf"
    for path in (stale, alive, data):
        path.write_bytes(b"x")
    assert atomic.clean(tmp_path) == [stale, part]
    assert list((tmp_path / "parts").iterdir()) == []
    assert alive.exists()
    assert data.exists()


def test_a_folder_has_one_writer(tmp_path):
    with atomic.owned(tmp_path) as first, atomic.owned(tmp_path) as second:
        assert first
        assert not second
    with atomic.owned(tmp_path) as again:
        assert again


ROWS = [{"time (s)": 0.1 * k, "front (m)": math.pi * 10.0 ** (k - 300)} for k in range(5)]


def written(path, rows, keep=0):
    series = Series(path, keep)
    for row in rows:
        series.append(row)
    series.close()
    return series


def test_a_series_reads_back_bit_for_bit(tmp_path):
    written(tmp_path / "series.csv", ROWS)
    read = read_series(tmp_path / "series.csv")
    assert list(read) == ["time (s)", "front (m)"]
    for name, column in read.items():
        assert column.tobytes() == np.array([row[name] for row in ROWS]).tobytes()


def test_a_torn_last_line_is_ignored(tmp_path):
    path = tmp_path / "series.csv"
    written(path, ROWS)
    whole = path.read_bytes()
    for cut in range(len(whole)):
        path.write_bytes(whole[:cut])
        read = read_series(path)
        rows = max(0, whole[:cut].count(b"\n") - 1)
        assert all(len(column) == rows for column in read.values())
        assert all(value == ROWS[k]["front (m)"] for k, value in enumerate(read.get("front (m)", [])))


def test_a_series_cut_back_and_continued_is_the_uninterrupted_one(tmp_path):
    whole, cut = tmp_path / "whole.csv", tmp_path / "cut.csv"
    written(whole, ROWS)
    keep = written(cut, ROWS[:2]).length
    with open(cut, "ab") as file:
        file.write(b"0.2,999\n0.3,")
    written(cut, ROWS[2:], keep)
    assert cut.read_bytes() == whole.read_bytes()


def test_a_series_shorter_than_its_checkpoint_is_refused(tmp_path):
    with pytest.raises(InputError, match="the checkpoint needs 100"):
        Series(tmp_path / "series.csv", 100)


def test_a_row_with_other_columns_is_refused(tmp_path):
    series = Series(tmp_path / "series.csv")
    series.append({"time (s)": 0.0})
    with pytest.raises(InputError, match="mass"):
        series.append({"time (s)": 0.0, "mass (kg)": 1.0})
    series.close()


@pytest.mark.parametrize("content", [b"\x82\xff" * 50, b"a,b\n" + b"1,2\n" * 24])
def test_a_series_of_other_bytes_as_long_as_the_checkpoint_needs_is_refused(tmp_path, content):
    (tmp_path / "series.csv").write_bytes(content)
    with pytest.raises(InputError, match="start the run anew"):
        Series(tmp_path / "series.csv", 100).append({"time (s)": 0.0})


def test_a_card_spells_names_that_are_no_utf_8(tmp_path):
    name = os.fsdecode(b"runs/\xff")
    card.write_card(tmp_path, {"command": name})
    assert json.loads((tmp_path / "card.json").read_bytes())["command"] == name


def test_numbers_of_numpy_are_written_as_numbers(tmp_path):
    written(tmp_path / "s.csv", [{"a": np.float64(0.1), "b": np.float32(0.5), "c": np.int64(3), "d": True}])
    assert (tmp_path / "s.csv").read_text() == "a,b,c,d\n0.1,0.5,3,1\n"


def test_the_card_tells_what_ran_where_and_with_what(tmp_path):
    given = {"scene": {"a": np.float64(1.5), "b": [np.int32(2)], "c": math.inf}, "seeds": {"place": 7}}
    card.write_card(tmp_path, card.new_card(given))
    read = json.loads((tmp_path / "card.json").read_text())
    assert read["scene"] == {"a": 1.5, "b": [2], "c": "inf"}
    assert read["seeds"] == {"place": 7}
    assert {"python", "numpy", "numba", "h5py", "porescale"} <= read["versions"].keys()
    assert read["versions"]["numpy"] == np.__version__
    assert read["machine"]["cores"] >= 1
    assert read["outcome"] == "running"
    assert read["commit"] is None or len(read["commit"]["hash"]) == 40


def test_changed_keys_are_named_and_free_ones_are_not():
    old = {
        "fluid": {"viscosity": 1.0, "density": 2.0},
        "run": {"duration": 1.0},
        "output": {"series_interval": 1.0, "forces": False, "energy": False, "contacts": False, "fields": []},
        "time": {"end": 1.0, "step": 1},
    }
    new = {
        "fluid": {"viscosity": 1.5, "density": 2.0, "model": "trt"},
        "run": {"duration": 2.0},
        "output": {"series_interval": 2.0, "forces": True, "energy": True, "contacts": True, "fields": ["vorticity"]},
        "time": {"end": 2.0, "step": 2},
    }
    # What snapshots and rows hold: those of before lacked it, were left out, or made the folder unreadable.
    held = {f"output.{key}": (False, True) for key in ("energy", "contacts")} | {"output.fields": ([], ["vorticity"])}
    expected = {"fluid.viscosity": (1.0, 1.5), "fluid.model": (None, "trt"), **held, "time.step": (1, 2)}
    assert card.changed_keys(old, new) == expected
    assert "run.duration" in card.changed_keys(old, new, free=())


def test_changed_keys_of_lists_of_tables_are_those_of_the_entry():
    """All bodies were printed twice where one had another number."""
    old, new = ([{"x": 1.0, "hue": 0.0}, {"x": 2.0, "hue": hue}] for hue in (None, 3.0))
    assert card.changed_keys({"body": old}, {"body": new}) == {"body[1].hue": (None, 3.0)}
    assert card.changed_keys({"body": old}, {"body": old[:1]}) == {"body": (old, old[:1])}
    assert card.changed_keys({"body": [1, 2]}, {"body": [1, 3]}) == {"body": ([1, 2], [1, 3])}
    assert holds({"body": old}, parse_key("body[1].hue"))
    assert not holds({"body": old}, parse_key("body[2].hue"))
    assert not holds({"body": old}, parse_key("body[1].x.y"))


@pytest.mark.parametrize(
    ("began", "line"),
    [
        ({"x": 1.0, "hue": None}, "body[0].hue = 2.0: was absent; resume without it, or start another run"),
        (
            {"x": 1.0},
            "body[0].hue = 2.0: the run was begun by a version without it; leave it out to go on as that did, or start "
            "another run",
        ),
    ],
)
def test_a_key_that_a_run_had_not_is_to_be_left_out(tmp_path, began, line):
    """It was to be set to None, which no scene can say."""
    card.write_card(tmp_path, {"format": 1, "package": "toy", "scene": {"body": [began]}})
    given = {"package": "toy", "scene": {"body": [{"x": 1.0, "hue": 2.0}]}}
    with pytest.raises(InputError) as refused:
        check_changes(tmp_path, given, lambda old: {"body": [{"x": 1.0, "hue": None}]})
    assert [fault.line() for fault in refused.value.faults] == [line]
