"""A sweep from Python: the runs and numbers of the command, as a DataFrame, the same messages; goes on where it was."""

import csv
import math
from pathlib import Path

import numpy as np
import pandas
import pytest

import porescale
from porescale.common.api.sweep import points_of
from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.common.record import card as cards
from porescale.common.record.series import Series
from porescale.common.studies.parameter_table import varied
from porescale.common.studies.schedulers.task import Process

SCENE = """
[domain]
width = 0.01
height = 0.01
[time]
end = 0.01
[output]
snapshot_interval = 0.01
series_interval = 0.01
[contact]
stiffness = 1e5
tangential_stiffness = 5e4
friction = 0.3
restitution = 0.5
[grains]
density = 2500
grain = [{ x = 0.005, y = 0.004, diameter = 0.001 }]
"""


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "falling").mkdir()
    file = tmp_path / "falling" / "scene.toml"
    file.write_text(SCENE)
    return file


@pytest.fixture
def ran(monkeypatch):
    """Points without processes: writes what a run would; friction 9 goes unstable."""
    called: list[list[str]] = []

    def one(self: Process) -> tuple[int, str]:
        words = self.task.command()
        called.append(words)
        folder = Path(words[words.index("--out") + 1])
        settings = [words[k + 1] for k, word in enumerate(words) if word == "--set"]
        value = float(next(it for it in settings if "friction" in it).partition("=")[2])
        card = cards.new_card({"package": "porescale", "scene": {}, "settings": settings})
        unstable = value == 0.9
        cards.write_card(folder, card | {"outcome": "unstable" if unstable else "finished", "seconds": 1.0})
        series = Series(folder / "series.csv")
        for k in range(3):
            series.append({"time (s)": 0.005 * k, "front (m)": value * k})
        series.close()
        return (3, "unstable at step 7") if unstable else (0, "")

    monkeypatch.setattr(Process, "run", one)
    return called


VARY = {"contact.friction": [0.2, 0.5], "contact.stiffness": [1e5, 2e5]}


def test_the_table_is_that_of_the_files(scene, ran, tmp_path):
    table = porescale.sweep(scene, VARY, tmp_path / "out")
    assert table["contact.friction"].tolist() == [0.2, 0.2, 0.5, 0.5]
    assert table["contact.stiffness"].tolist() == [1e5, 2e5, 1e5, 2e5]
    assert table["front (m)"].tolist() == [0.4, 0.4, 1.0, 1.0]
    assert set(table.outcome) == {"finished"}
    with open(tmp_path / "out" / "sweep.csv") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == list(table)
    assert [float(row["front (m)"]) for row in rows] == table["front (m)"].tolist()
    assert [row["name"] for row in rows] == table.name.tolist()
    assert len(porescale.open_run(Path(table.attrs["folder"]) / table.name[2]).series["front (m)"]) == 3
    # The check that must fail: other values are another table.
    assert porescale.sweep(scene, {"contact.friction": [0.3]}, tmp_path / "else")["front (m)"].tolist() != [0.4]


def test_a_scene_as_an_object_gives_the_same_and_goes_on_where_it_was(scene, ran, tmp_path):
    loaded = porescale.load(scene)
    by_path = porescale.sweep(scene, VARY, tmp_path / "path")
    table = porescale.sweep(loaded, VARY, tmp_path / "object")
    assert table.drop(columns="name").equals(by_path.drop(columns="name"))
    assert porescale.load(tmp_path / "object" / "falling.toml") == loaded
    count = len(ran)
    again = porescale.sweep(loaded, VARY, tmp_path / "object")
    assert len(ran) == count
    assert again.equals(table)
    more = porescale.sweep(loaded, VARY | {"contact.friction": [0.2, 0.5, 0.7]}, tmp_path / "object")
    assert len(ran) == count + 2
    assert len(more) == 6
    with pytest.raises(InputError, match="holds a sweep of another scene; name another folder"):
        porescale.sweep(loaded.with_({"time.end": 0.02}), VARY, tmp_path / "object")


def test_files_that_an_object_is_varied_by_lie_beside_its_scene(scene, ran, tmp_path):
    for name in ("a.csv", "b.csv"):
        (scene.parent / name).write_text("x,y,diameter\n0.005,0.004,0.001\n")
    loaded = porescale.load(scene).with_({"grains.grain": None, "grains.circles.file": "a.csv"})
    vary = {"grains.circles.file": ["a.csv", "b.csv"], "contact.friction": [0.2]}
    table = porescale.sweep(loaded, vary, tmp_path / "out")
    assert table["grains.circles.file"].tolist() == [str(scene.parent / name) for name in ("a.csv", "b.csv")]
    with pytest.raises(InputError, match=r"c\.csv"):
        porescale.sweep(loaded, vary | {"grains.circles.file": ["c.csv"]}, tmp_path / "none")


def test_repeats_give_members_and_what_their_mean_is_worth(scene, ran, tmp_path):
    table = porescale.sweep(scene, None, tmp_path / "out", over="contact.friction=0.2,0.3,0.4")
    assert table["front (m)"].tolist() == pytest.approx([0.4, 0.6, 0.8])
    (line,) = table.attrs["ensembles"]
    assert (line["asked"], line["n"], line["over"]) == (3, 3, "contact.friction")
    assert line["mean"] == pytest.approx(0.6)
    assert line["t high"] - line["mean"] == pytest.approx(4.3027 * 0.2 / math.sqrt(3.0), rel=1e-4)
    with open(tmp_path / "out" / "ensemble.csv") as file:
        assert float(next(csv.DictReader(file))["mean"]) == line["mean"]
    each = porescale.sweep(scene, {"contact.stiffness": [1e5, 2e5]}, tmp_path / "two", over="contact.friction=0.2,0.3")
    assert len(each) == 4
    assert [it["name"] for it in each.attrs["ensembles"]] == ["stiffness=100000.0", "stiffness=200000.0"]
    with pytest.raises(
        InputError, match=r"^repeat = 3: repeats the same run: .*; name a key .* over section.key=a,b,c"
    ):
        porescale.sweep(scene, repeat=3)  # a single grain where it is given: nothing is drawn


def test_what_expected_toml_beside_the_scene_asks_for_is_compared(scene, ran, tmp_path):
    text = '[[expected]]\nname = "how far"\ncolumn = "front (m)"\nat = 0.005\nunit = "m"\nvalue = 0\ntolerance = 1\n'
    (scene.parent / "expected.toml").write_text(text)
    for given in (scene, porescale.load(scene)):
        table = porescale.sweep(given, {"contact.friction": [0.2]}, tmp_path / type(given).__name__)
        assert table["how far (m)"].tolist() == [0.2]
        assert "front (m)" not in table


def test_points_as_rows_and_from_a_file(scene, ran, tmp_path):
    rows = [{"contact.friction": 0.2, "contact.stiffness": 1e5}, {"contact.friction": 0.5}]
    table = porescale.sweep(scene, rows, tmp_path / "rows")
    assert table["contact.friction"].tolist() == [0.2, 0.5]
    assert math.isnan(table["contact.stiffness"][1])
    (tmp_path / "table.csv").write_text("contact.friction\n0.2\n0.5\n")
    assert porescale.sweep(scene, tmp_path / "table.csv", tmp_path / "file")["front (m)"].tolist() == [0.4, 1.0]
    # Points have the names that the command gives them: its folders and those of Python are the same.
    assert [it.name for it in points_of({"contact.friction": [0.2, 0.5]})] == [
        it.name for it in varied(["contact.friction=0.2,0.5"])
    ]


def test_a_run_that_does_not_finish_is_a_warning_and_a_row(scene, ran, tmp_path):
    with pytest.warns(PorescaleWarning, match="unstable at step 7"):
        table = porescale.sweep(scene, {"contact.friction": [0.2, 0.9]}, tmp_path / "out")
    assert table.outcome.tolist() == ["finished", "unstable"]
    assert math.isnan(table["front (m)"][1])


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ({}, "sweep: varies nothing"),
        ({"contact.frction": [1.0]}, "did you mean 'friction'?"),
        ({"contact.friction": 0.5}, "vary.contact.friction = '0.5': is not a list of values"),
        ({"contact.friction": []}, "vary.contact.friction = '[]': holds no value"),
        ({"contact.friction": np.array(0.5)}, "vary.contact.friction = '0.5': is not a list of values"),
        (pandas.DataFrame({"contact.friction": [0.5]}), 'of a DataFrame, its to_dict("records")'),
        ({"contact.friction": [-1.0, -2.0]}, "contact.friction = -1"),
        ({"contact.friction": [0.5, 0.5]}, "vary: contact.friction = '0.5': is given twice"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(scene, ran, tmp_path, vary, said):
    for given in (scene, porescale.load(scene)):
        with pytest.raises(InputError) as caught:
            porescale.sweep(given, vary, tmp_path / "out")
        assert said in str(caught.value)
        assert "/tmp" not in str(caught.value).replace(str(tmp_path), "")
    assert ran == []
    assert not (tmp_path / "out").exists()


def test_wrong_options_are_named(scene, tmp_path):
    for options, said in (
        ({"jobs": 0}, "jobs = 0: is out of range"), ({"jobs": "2"}, "jobs = '2': is no number"),
        ({"threads": 0}, "threads = 0"), ({"threads": True}, "threads = 'True': is no number"),
        ({"repeat": 2.5}, "repeat = 2.5: is no whole number"), ({"repeat": 2, "over": {}}, "over = .*: is no text"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=said):
            porescale.sweep(scene, VARY, tmp_path / "out", **options)
    with pytest.raises(InputError, match="scene = 'int': is no scene of porescale"):
        porescale.sweep(3, VARY)
    with pytest.raises(InputError, match="quality = 'fine': is for scenes by path or name; give it to load"):
        porescale.sweep(porescale.load(scene), VARY, quality="fine")
