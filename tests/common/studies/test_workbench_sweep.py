"""Points of a sweep, how they are run and what becomes of those that were stopped or went wrong."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from porescale.common.cli.sweep import check_points, command, expected
from porescale.common.core.errors import InputError
from porescale.common.record.series import run_table
from porescale.common.studies import sweep, sweep_files
from porescale.common.studies.parameter_table import Point, crossed, named, read_points, varied
from porescale.common.studies.runner import Campaign, Ended
from porescale.common.studies.schedulers.local import Local
from tests.reference.toy_package import TOY, write_series

SCENE = "[decay]\nrate = 3\n[quality.fine.decay]\nstart = 2\n"


class Machine:
    """Runs points without processes: writes the card that a run would, and notes the words it was called with."""

    def __init__(self, outcomes: dict[str, str] | None = None) -> None:
        self.outcomes, self.called = outcomes or {}, list[list[str]]()

    def __call__(self, words: list[str]) -> tuple[int, str]:
        self.called.append(words)
        folder = Path(words[words.index("--out") + 1])
        settings = [words[at + 1] for at, word in enumerate(words) if word == "--set"]
        outcome = self.outcomes.get(folder.name, "finished")
        if outcome == "refused":
            return 2, "warning: something\ndecay.rate = 3: no\n"
        folder.mkdir(parents=True, exist_ok=True)
        rate = float(dict(text.split("=") for text in settings)["decay.rate"])
        card = {"scene": {"decay": {"rate": rate, "start": 1.0}}, "settings": settings, "outcome": outcome,
                "seconds": 2.0, "step": 10}  # fmt: skip
        (folder / "card.json").write_text(json.dumps(card))
        write_series(folder, card["scene"])
        return {"finished": 0, "unstable": 3, "interrupted": 130}[outcome], "" if outcome == "finished" else "grain 7"


def local(machine: Callable[[list[str]], tuple[int, str]]) -> Local:
    """This machine, with ``machine`` in place of processes."""
    return Local(lambda task, cores: SimpleNamespace(run=lambda: machine(task.command()), stop=lambda: None))


def campaign(folder: Path, machine: Machine, **more) -> Campaign:
    return Campaign("toy", folder / "scene.toml", folder / "out", scheduler=local(machine), **more)


def test_a_csv_gives_a_point_for_each_row(tmp_path):
    file = tmp_path / "table.csv"
    file.write_text('name,quality,decay.rate,domain.left\nslow,fine,1,"[0, 1]"\n,,2,\n\n')
    assert read_points(file) == [
        Point("slow", ("decay.rate=1", "domain.left=[0, 1]"), "fine"),
        Point("rate=2", ("decay.rate=2",)),
    ]


def test_toml_gives_points_as_they_are_and_every_combination(tmp_path):
    file = tmp_path / "table.toml"
    point, vary = '[[point]]\nname = "a"\n"decay.rate" = "2 1/s"\n', "decay.rate = [1, 2]\ndecay.start = [0.5, 1e-5]\n"
    file.write_text(f"{point}[vary]\n{vary}")
    points = read_points(file)
    assert points[0] == Point("a", ('decay.rate="2 1/s"',))
    assert [point.settings for point in points[1:]] == [
        ("decay.rate=1", "decay.start=0.5"), ("decay.rate=1", "decay.start=1e-05"),
        ("decay.rate=2", "decay.start=0.5"), ("decay.rate=2", "decay.start=1e-05"),
    ]  # fmt: skip
    assert points[1].value("decay.start") == "0.5"
    assert points[0].value("decay.rate") == "2 1/s"  # a text as it is, in the tables


def test_a_table_tells_of_a_text_what_it_says_whatever_gave_it():
    point = Point("", ('a="1 mm"', "b=1 mm", 'c=["x", "y"]', 'd="say \\"so\\""', "e=true"))
    assert [point.value(key) for key in "abcdef"] == ["1 mm", "1 mm", '["x", "y"]', 'say "so"', "true", ""]


def test_options_are_split_at_commas_outside_brackets_and_quotes():
    assert [point.settings for point in varied(["a=1,2", 'b=[0,1],"x,y"'])] == [
        ("a=1", "b=[0,1]"), ("a=1", 'b="x,y"'), ("a=2", "b=[0,1]"), ("a=2", 'b="x,y"'),
    ]  # fmt: skip
    both = crossed([Point("", ("a=1",), "fine"), Point("", ("a=2",))], varied(["b=3"]))
    assert [(point.settings, point.quality) for point in both] == [(("a=1", "b=3"), "fine"), (("a=2", "b=3"), None)]


def test_a_key_that_is_given_twice_is_refused():
    for wrong in (
        lambda: varied(["a=1,2", "b=3", "a=4"]),
        lambda: crossed([Point("", ("b=1", "a=2"))], varied(["a=3"])),
    ):
        with pytest.raises(InputError, match=r"^--vary: a: is given twice; give all of its values in one place$"):
            wrong()


def test_a_value_that_is_given_twice_is_refused():
    # It was run twice, to the same bits, as NAME and NAME-2.
    with pytest.raises(InputError, match=r"^--vary: a = '?2'?: is given twice; leave one out$"):
        varied(["a=1,2,2"])
    assert len(varied(["a=1,2", "b=1,2"])) == 4  # of another key it is another point


def test_names_are_folders_anywhere_and_differ():
    given = [Point("", ('a.b="x/../y"',)), *(Point(name, ()) for name in ("../up", "Same", "same", ".."))]
    assert [point.name for point in named(given)] == ["b=x_.._y", "up", "Same", "same-2", "point"]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("t.csv", "a,a\n1,2\n", "line 1"),
        ("t.csv", "a;b\n1 mm;2\n", "line 1: has semicolons between its columns; take commas"),
        ("t.csv", "a\tb\n1\t2\n", "line 1: has tabs between its columns"),
        ("t.csv", "a,b\n1\n", "line 2: has 1 cells"),
        ("t.csv", "a\n", "points: there are none"),
        ("t.csv", "a\n\xff", "is not UTF-8 text"),
        ("t.toml", "pont = 1", "pont: is unknown"),
        ("t.toml", "point = 1", "point: is not a list of tables"),
        ("t.toml", "[vary]\na = 1", "is not a list of values"),
        ("t.toml", "vary = 1", "vary: is not a table"),
        ("t.toml", "[[point]]\na = 2020-01-01", "is not a number, text, truth or list"),
        ("t.toml", "[vary]\n" + "".join(f"k{n} = {list(range(50))}\n" for n in range(4)), "too many combinations"),
        ("t.toml", "a = ", "line 1"),
    ],
)
def test_a_wrong_table_is_said_with_its_place(tmp_path, name, text, said):
    (tmp_path / name).write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError) as caught:
        read_points(tmp_path / name)
    (fault,) = caught.value.faults
    assert name in fault.line()
    assert said in fault.line()


@pytest.mark.parametrize("option", ["a", "=1", "a=", "a=1,,2"])
def test_a_wrong_option_is_said(option):
    with pytest.raises(InputError, match="is not key=a,b,c"):
        varied([option])


def test_what_is_wrong_with_any_point_is_said_before_any_runs(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    points = varied(["decay.rate=1,-1,200", "decay.tart=1"])
    with pytest.raises(InputError) as caught:
        check_points(TOY, tmp_path, points, None, ())
    lines = [fault.line() for fault in caught.value.faults]
    assert sum("decay.tart" in line for line in lines) == 1  # wrong in every point, said once
    assert any(line.startswith("rate=-1") and "> 0" in line for line in lines)
    with pytest.raises(InputError, match="stable limit"):
        check_points(TOY, tmp_path, varied(["decay.rate=200"]), None, ())
    assert check_points(TOY, tmp_path, varied(["decay.rate=1,2"]), "fine", ()) == (
        tmp_path / "scene.toml", tmp_path.name,
    )  # fmt: skip


def test_two_ways_to_write_a_value_are_one_point(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    points = varied(["decay.rate=2,120 1/min,3", "decay.start=1,4"])
    with pytest.raises(InputError, match="is 2, which is given, too") as caught:
        check_points(TOY, tmp_path, points, None, (), "--vary")
    lines = [fault.line() for fault in caught.value.faults]
    assert lines == ["--vary: decay.rate = '120 1/min': is 2, which is given, too; leave one out"]
    check_points(TOY, tmp_path, points, None, ())  # rows of a table may say what they want
    check_points(TOY, tmp_path, varied(["decay.rate=2,121 1/min"]), None, (), "--vary")


def test_two_ways_to_write_a_value_are_one_point_beside_a_table_too(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    table = tmp_path / "t.csv"
    table.write_text("decay.start\n1\n1\n4\n")  # two rows are the same, as they may be
    sweep_toy = command(TOY)
    with pytest.raises(InputError) as caught:
        sweep_toy(tmp_path, table, vary=["decay.rate=2,120 1/min"], out=tmp_path / "out")
    lines = [fault.line() for fault in caught.value.faults]
    assert lines == ["--vary: decay.rate = '120 1/min': is 2, which is given, too; leave one out"]
    points = crossed(read_points(table), varied(["decay.rate=2,121 1/min"]))
    check_points(TOY, tmp_path, points, None, (), "--vary", 2)  # the check that must fail


def test_finished_points_are_left_alone_and_begun_ones_resume(tmp_path):
    points = varied(["decay.rate=1,2,3"])
    first = Machine({"rate=2": "interrupted", "rate=3": "unstable"})
    said: list[str] = []
    ends = list(campaign(tmp_path, first).all(points, 1, said.append))
    assert [ended.outcome for ended in ends] == ["finished", "interrupted", "unstable"]
    assert ends[2].problem == "grain 7"
    assert "(3 of 3, about 0 s left)" in said[-1]
    second = Machine()
    ends = list(campaign(tmp_path, second).all(points, 2, said.append))
    assert sorted(ended.outcome for ended in ends) == ["finished", "finished", "unstable"]
    assert [words[-1] for words in second.called] == ["--resume"]
    third = Machine()
    ends = list(campaign(tmp_path, third, again=True).all(points, 1, said.append))
    assert {ended.outcome for ended in ends} == {"finished"}
    assert [words[-1] for words in third.called] == ["--overwrite"]


def test_another_run_in_a_points_folder_is_never_taken_for_its_own(tmp_path):
    list(campaign(tmp_path, Machine()).all(varied(["decay.rate=1"]), 1, print))
    other = [Point("rate=1", ("decay.rate=1.5",))]
    with pytest.raises(InputError, match="holds a run with other settings"):
        list(campaign(tmp_path, Machine()).all(other, 1, print))


def test_a_refused_point_says_why(tmp_path):
    (ended,) = campaign(tmp_path, Machine({"rate=1": "refused"})).all(varied(["decay.rate=1"]), 1, print)
    assert (ended.outcome, ended.problem) == ("refused", "decay.rate = 3: no")


@pytest.mark.parametrize(("code", "said"), [(-9, "its process was ended by signal 9"), (1, "exit code 1, no message")])
def test_a_point_whose_process_ended_without_a_word_says_how(tmp_path, code, said):
    (ended,) = campaign(tmp_path, lambda words: (code, "")).all(varied(["decay.rate=1"]), 1, print)
    assert (ended.outcome, ended.problem) == ("failed", said)


def test_an_exception_among_points_stops_the_rest(tmp_path):
    called: list[list[str]] = []

    def broken(words: list[str]) -> tuple[int, str]:
        called.append(words)
        raise OSError("gone")

    with pytest.raises(OSError, match="gone"):
        list(campaign(tmp_path, broken).all(varied(["a=1,2,3,4,5,6,7,8,9"]), 1, print))
    assert len(called) == 1


@pytest.mark.parametrize(("seldom", "written"), [(1e9, [0, 3]), (0.0, [0, 1, 2, 3])])
def test_files_of_a_sweep_that_is_soon_over_are_written_at_its_end_alone(tmp_path, monkeypatch, seldom, written):
    """The check that fails: where they may be written as often as points end they are, and not once more at the end."""
    counts: list[int] = []
    monkeypatch.setattr(sweep, "SELDOM", seldom)
    monkeypatch.setattr(sweep_files, "write", lambda folder, command, ends, *more: counts.append(len(ends)))
    points = varied(["decay.rate=1,2,3"])
    rows = [{"column": "left (m)", "at": "end"}]
    ends = sweep.run_points(campaign(tmp_path, Machine()), points, 1, rows, "toy sweep", lambda text: None)
    assert [ended.outcome for ended in ends] == ["finished"] * 3
    assert counts == written


def test_the_table_holds_what_was_set_what_it_cost_and_what_came_out(tmp_path):
    points = varied(["decay.rate=1,2"])
    ends = list(campaign(tmp_path, Machine({"rate=2": "unstable"})).all(points, 1, print))
    rows = [{"name": "half", "column": "left (m)", "at": {"first_below": 0.5}, "unit": "s"},
            {"name": "lost", "column": "nowhere", "at": "end"}]  # fmt: skip
    sweep_files.write(tmp_path / "out", "toy sweep", ends, rows, run_table, points)
    lines = list(csv.DictReader((tmp_path / "out" / "sweep.csv").open()))
    assert [line["decay.rate"] for line in lines] == ["1", "2"]
    assert float(lines[0]["half (s)"]) == pytest.approx(0.7)  # the first of the tenths beyond ln 2 = 0.693
    assert (lines[1]["half (s)"], lines[1]["problem"], lines[0]["lost"]) == ("", "grain 7", "")
    text = (tmp_path / "out" / "sweep.md").read_text()
    assert "| half (s) |" in text
    assert "lost" not in text  # an empty column
    assert (tmp_path / "out" / "sweep.png").read_bytes().startswith(b"\x89PNG")


def test_a_table_to_read_is_a_screen_wide_and_goes_on_below():
    """40 columns stood side by side."""
    names = [f"c{k} (m)" for k in range(40)]
    text = sweep_files.markdown("toy", [{"name": point} | dict.fromkeys(names, 1.0) for point in "ab"])
    heads = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| name")]
    assert [len(head) for head in heads] == [16, 16, 11]
    assert [name for head in heads for name in head[1:]] == names
    assert text.count("| a |") == text.count("| b |") == len(heads)


def test_a_picture_shows_the_columns_that_differ_and_says_how_many_it_leaves_out(tmp_path, monkeypatch):
    ends = [Ended(Point(name, ()), tmp_path / name, "finished", {}) for name in "ab"]
    names = [f"c{k} (m)" for k in range(14)]
    titles = []
    monkeypatch.setattr("matplotlib.figure.Figure.suptitle", lambda _, text, **how: titles.append(text))

    def tables(folder, file):
        # the later a column, the more the points differ in it; the last does not, and is large
        grown = 0.1 if folder.name == "b" else 0.0
        values = {name: np.array([1.0, 1.0 + grown * k]) for k, name in enumerate(names)}
        return values | {names[-1]: np.array([1e9, 1e9]), "time (s)": np.array([0.0, 1.0])}

    columns = [("series", name) for name in names]
    assert sweep_files.differing(columns, ends, tables) == columns[1:-1]
    assert sweep_files.differing(columns[:12], ends, tables) == columns[:12]
    rows = [{"name": name, "column": name, "at": "end"} for name in names]
    sweep_files.picture(ends, rows, tables)
    assert titles == ["the 12 of 14 columns that differ most; sweep.csv has how all of them end"]
    sweep_files.picture(ends, rows[:12], tables)
    assert len(titles) == 1


@pytest.mark.parametrize(("size", "unit", "chosen"), [(1e-19, "()", False), (1e-3, "()", True), (1e-19, "(J/m)", True)])
def test_a_share_that_is_only_round_off_is_no_column_that_differs(tmp_path, size, unit, chosen):
    ends = [Ended(Point(name, ()), tmp_path / name, "finished", {}) for name in "ab"]
    last = f"change {unit}"

    def tables(folder, file):
        far = 1.0 if folder.name == "b" else 0.5
        return {f"c{k} (m)": np.array([1.0, 1.0 + 0.1 * far]) for k in range(12)} | {last: np.array([0.0, size * far])}

    columns = [("series", name) for name in (*(f"c{k} (m)" for k in range(12)), last)]
    assert (("series", last) in sweep_files.differing(columns, ends, tables)) == chosen


def test_titles_of_a_picture_lie_clear_of_what_its_numbers_have_in_common(tmp_path, monkeypatch):
    """A column that differs in its ninth digit has a number of 17 characters over its axis, beside its title."""
    ends = [Ended(Point(name, ()), tmp_path / name, "finished", {}) for name in "ab"]
    column, figures = "mass of all that is there (kg/m)", []
    monkeypatch.setattr(sweep_files.files, "png", lambda figure, _: figures.append(figure) or b"")

    def tables(folder, file):
        return {column: np.full(2, 90.2231535 + 1e-6 * (folder.name == "b")), "time (s)": np.array([0.0, 1.0])}

    sweep_files.picture(ends, [{"name": "mass", "column": column, "at": "end"}], tables)
    figures[0].draw_without_rendering()
    (axes,) = figures[0].axes
    common, title = axes.yaxis.get_offset_text(), axes.title
    assert len(common.get_text()) > 10
    assert not title.get_window_extent().overlaps(common.get_window_extent())
    axes.set_title(column, fontsize=9, pad=0)  # the twin: right over the axis
    figures[0].draw_without_rendering()
    assert title.get_window_extent().overlaps(common.get_window_extent())


def test_a_number_that_cannot_be_had_is_none(tmp_path):
    write_series(tmp_path, {"decay": {"rate": 1.0, "start": 1.0}})
    ended = Ended(Point("a", ()), tmp_path, "finished", {})
    assert np.isnan(sweep_files.number(ended, {"column": "left (m)", "at": "begin"}, run_table))
    assert np.isnan(sweep_files.number(ended, {"column": "left (m)", "at": "end", "file": "lines"}, run_table))
    assert sweep_files.number(ended, {"column": "left (m)", "at": "end"}, run_table) == pytest.approx(np.exp(-1))


SOUND = ['"end"', '"min"', "0.5", "{ max_from = 6 }", "{ change_from = 0 }",
         '{ first_below = 0.5, share_of = "fall" }', "{ quantile = 0.9 }"]  # fmt: skip
TORN = ['"ends"', "nan", "true", "[1]", "{}", '{ max_from = "6" }', "{ max_from = 6, min_from = 2 }",
        "{ quantile = 9 }", '{ max_from = 6, share_of = "fall" }', '{ first_below = 1, share_of = "all" }']  # fmt: skip


def asks(folder: Path, at: str) -> list[dict[str, object]]:
    """What expected.toml asks of a sweep, beside a row without a place to read."""
    row = f'[[expected]]\nname = "n"\ncolumn = "y (m)"\nat = {at}\n[[expected]]\nname = "by a script"\nvalue = 1\n'
    (folder / "expected.toml").write_text(row)
    return expected(folder / "scene.toml")


@pytest.mark.parametrize("at", SOUND)
def test_what_is_expected_is_asked_of_every_point(tmp_path, at):
    assert [row["name"] for row in asks(tmp_path, at)] == ["n"]


@pytest.mark.parametrize("at", TORN)
def test_what_cannot_be_read_is_refused_before_anything_runs(tmp_path, at):
    with pytest.raises(InputError, match="expected 'n': at"):
        asks(tmp_path, at)


def test_an_expectation_that_is_no_table_is_refused(tmp_path):
    assert expected(tmp_path / "scene.toml") == []
    for text, said in (("expected = 3", "not a list of tables"), ("[[expected", "line 1")):
        (tmp_path / "expected.toml").write_text(text)
        with pytest.raises(InputError, match=said):
            expected(tmp_path / "scene.toml")
