"""`porescale homogenise`: from a scene to a material file that the continuum reads; whole, or not there."""

import csv
import math
import tomllib

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.analysis.material import EXPONENT, UNITS
from porescale.cli.homogenise import UNTIL
from porescale.cli.main import commands
from porescale.common.cli.application import application, main
from porescale.common.compiled import jit
from tests.reference.scenes import COLUMN, table, write

SMALL = table(COLUMN, homogenise={"pressure": 200.0, "grains": 100, "packings": 2, "strain": 0.06, "cells": 4})
CONTINUUM_SCENE = """\
[tank]
width = 1
height = 1
[[water.column]]
width = 1
height = 0.6
[soil]
material = "material.toml"
cohesion = 5
[[soil.body]]
outline = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]
[numerics]
spacing = 0.05
[time]
end = 0.1
[output]
snapshot_interval = 0.1
series_interval = 0.1
"""


@pytest.fixture
def asks(capsys):
    """Gives exit code and the lines on stderr of a command line, on one thread."""

    def ask(*words: object) -> tuple[int, list[str]]:
        capsys.readouterr()
        before = jit.threads()
        try:
            return main(commands(), [str(word) for word in words]), capsys.readouterr().err.splitlines()
        finally:
            jit.set_threads(before)

    return ask


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"grains__packing__diameter": -1}, "grains.packing.diameter"),
        ({"homogenise__packings": 1}, "homogenise.packings"),
        ({"homogenise__presure": 1}, "homogenise.presure"),
        ({"homogenise__rates": [0.1, 0.2, 0.3]}, "homogenise.rates"),
        ({"homogenise__pressure": "1 MPa"}, "homogenise.pressure"),
        ({"gravity": [0, 0], "homogenise__pressure": None}, "homogenise.pressure"),
        ({"contact": {"law": "hertz", "young": 1e7, "restitution": 0.5}}, "contact.law"),
        ({"grains": None, "contact": None, "gate": None}, "grains.packing"),
    ],
)
def test_a_scene_that_makes_no_soil_is_refused_and_nothing_is_written(tmp_path, asks, changes, said):
    file = write(tmp_path / "s.toml", table(SMALL, **changes))
    code, lines = asks("homogenise", file, "--out", tmp_path / "soil")
    assert code == 2
    assert any(said in line for line in lines)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["s.toml"]


def test_what_is_asked_must_make_sense(tmp_path, asks):
    file = write(tmp_path / "s.toml", SMALL)
    for words, said in (
        (("--jobs", 0), "--jobs"), (("--out", ""), "--out"), (("--out", file), "--out"), (("--jobs", "x"), "jobs"),
        (("--set", "homogenise.grains=ten"), "homogenise.grains"), (("--quality", "fine"), "--quality"),
        (("--scheduler", "nowhere"), "--scheduler"),
    ):  # fmt: skip
        code, lines = asks("homogenise", file, *words)
        assert code == 2, words
        assert any(said in line for line in lines), lines
    file = write(tmp_path / "s.toml", SMALL)
    for wrong in ("friction", "friction=0", "shape=2%"):
        code, lines = asks("homogenise", file, "--until", wrong)
        assert (code, len(lines)) == (2, 1)
        assert "--until" in lines[0]
    assert {EXPONENT} < set(UNTIL.values()) < set(UNITS)  # each word is a number that is measured
    code, lines = asks("homogenise", tmp_path / "none.toml")
    assert (code, len(lines)) == (2, 1)


def test_specimens_of_another_scene_are_left_alone(tmp_path, asks):
    file, other = write(tmp_path / "s.toml", SMALL), tmp_path / "soil"
    other.mkdir()
    (other / "specimen.toml").write_text("title = 'another'\n")
    code, lines = asks("homogenise", file, "--out", other)
    assert code == 2
    assert "another scene" in lines[0]
    assert [path.name for path in other.iterdir()] == ["specimen.toml"]
    assert (other / "specimen.toml").read_text() == "title = 'another'\n"


@pytest.mark.slow
def test_a_scene_becomes_a_material_that_the_continuum_reads(tmp_path, asks, capsys, monkeypatch):
    file, out = write(tmp_path / "s.toml", SMALL), tmp_path / "soil"
    assert asks("homogenise", file, "--out", out)[0] == 0
    first = (out / "material.toml").read_bytes()
    made = tomllib.loads(first.decode())
    assert "rate" not in made  # no rates are asked for: none are measured
    assert sorted(path.name for path in out.iterdir()) == [
        "homogenise.csv", "homogenise.png", "material.toml", "specimen.toml", "specimens",
    ]  # fmt: skip
    with open(out / "homogenise.csv", encoding="utf-8") as text:
        rows = list(csv.DictReader(text))
    assert [row["seed"] for row in rows] == ["1", "2"]
    values = [float(row["porosity"]) for row in rows]
    porosity = made["measured"]["porosity"]
    assert porosity["values"] == values
    assert porosity["mean"] == pytest.approx(sum(values) / 2)
    assert porosity["standard_error"] == pytest.approx(abs(values[0] - values[1]) / 2)
    assert "interval" not in porosity  # two packings have none
    assert any("no interval" in doubt for doubt in made["made"]["doubts"])
    assert made["made"]["lambda"] == 0.8
    assert 3.5 < made["made"]["cells"] < 4.5
    assert made["pores"]["permeability"] > 0
    assert math.radians(5) < made["strength"]["critical"]["friction_angle"] < math.radians(35)
    assert (out / "homogenise.png").stat().st_size > 5000
    # Called again nothing is run anew, and the same file comes out; without it, too.
    before = {path: path.stat().st_mtime_ns for path in out.rglob("card.json")}
    (out / "material.toml").unlink()
    assert asks("homogenise", file, "--out", out)[0] == 0
    assert (out / "material.toml").read_bytes() == first
    assert {path: path.stat().st_mtime_ns for path in out.rglob("card.json")} == before
    # The continuum takes it over.
    (out / "scene.toml").write_text(CONTINUUM_SCENE)
    assert main(application(CONTINUUM), ["check", str(out)]) == 0
    said = capsys.readouterr().out
    assert "measured on grains" in said
    assert "2 packings give no interval" in said


RATED = table(SMALL, homogenise__rates=[0.1, 0.2, 0.4, 0.8], grains__hydraulic_radius_ratio=None, fluid=None)


@pytest.mark.slow
def test_rates_add_to_a_material_file_and_alter_nothing_else(tmp_path, asks):
    plain, out = write(tmp_path / "plain.toml", table(RATED, homogenise__rates=None)), tmp_path / "soil"
    assert asks("homogenise", plain, "--out", out)[0] == 0
    without = tomllib.loads((out / "material.toml").read_text(encoding="utf-8"))
    file = write(tmp_path / "rated.toml", RATED)
    assert asks("homogenise", file, "--out", out)[0] == 0  # the slow tests that are there already are taken
    first = (out / "material.toml").read_bytes()
    made = tomllib.loads(first.decode())
    assert {name: made["measured"][name] for name in without["measured"]} == without["measured"]
    assert {name: made[name] for name in ("soil", "strength")} == {name: without[name] for name in ("soil", "strength")}
    assert len(list((out / "sheared").glob("packing-*/card.json"))) == 8
    sines = [made["measured"][f"sine_at_inertial_number_{rate}"]["mean"] for rate in made["made"]["rates"]]
    assert sines == sorted(sines)  # friction grows with the rate
    for asked, found in zip(made["made"]["rates"], made["made"]["inertial_numbers"], strict=True):
        assert 0.5 * asked < found < math.sqrt(2.0) * asked  # p is half of the stress across, which is held, at least
    before = {path: path.stat().st_mtime_ns for path in out.rglob("card.json")}
    assert asks("homogenise", file, "--out", out)[0] == 0
    assert (out / "material.toml").read_bytes() == first
    assert {path: path.stat().st_mtime_ns for path in out.rglob("card.json")} == before
