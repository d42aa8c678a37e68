"""Points of a sweep: what tables and options say, and what contradicts itself."""

import math

import pytest

from porescale.common.core.errors import InputError
from porescale.common.schema.scene_file import parse_setting
from porescale.common.studies.parameter_table import Point, named, read_points, varied
from porescale.common.studies.sweep import check_points
from tests.reference.toy_package import TOY


def test_no_two_points_have_one_folder_nor_one_has_that_of_a_file():
    # The third was taken for the second, which was never run, and the fifth lay where the table is written.
    names = ("a", "a", "a-2", "A-2", "sweep.csv", "Report.html", "a")
    given = [point.name for point in named([Point(name, ()) for name in names])]
    assert given == ["a", "a-2", "a-2-2", "A-2-3", "sweep.csv-2", "Report.html-2", "a-3"]


def test_a_value_that_is_given_twice_in_a_file_is_refused(tmp_path):
    # It was run twice; with --vary it was refused.
    table = tmp_path / "t.toml"
    table.write_text('[vary]\na = ["1 mm", "2 mm", "1 mm"]\n')
    with pytest.raises(InputError, match=r"t\.toml: a = '1 mm': is given twice; leave one out$"):
        read_points(table)
    table.write_text("[[point]]\na = 1\n[[point]]\na = 1\n")  # rows may say what they want
    assert len(read_points(table)) == 2


def test_a_list_of_tables_in_a_file_reads_back(tmp_path):
    # It was written as JSON, which no setting can be read from.
    (tmp_path / "t.toml").write_text('[[point]]\nb = [{ c = 1, d = "2 mm" }, { c = nan }]\n')
    (point,) = read_points(tmp_path / "t.toml")
    key, value = parse_setting(point.settings[0])
    assert (key, value[0]) == (("b",), {"c": 1, "d": "2 mm"})
    assert math.isnan(value[1]["c"])


def test_a_setting_that_every_point_has_its_own_of_is_refused(tmp_path):
    # It had no effect, without a word.
    (tmp_path / "scene.toml").write_text("[decay]\nrate = 3\n")
    with pytest.raises(InputError, match=r"^--set: decay\.rate = '?3'?: is set by every run of the sweep, too"):
        check_points(TOY, tmp_path, varied(["decay.rate=1,2"]), None, ("decay.rate=3",))
    some = [*varied(["decay.rate=1,2"]), Point("rest", ())]
    check_points(TOY, tmp_path, some, None, ("decay.rate=3",))  # the check that must fail: it holds for the last
