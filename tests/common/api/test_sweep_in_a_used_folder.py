"""A sweep or study in a folder that holds runs already: its own go on, those of other points or another scene are
refused."""

import json
import subprocess
import sys

import pytest

import porescale
from porescale.common.core.errors import InputError

SCENE = """
domain = {width = 0.01, height = 0.01}
time = {end = 1e-4}
output = {snapshot_interval = 1e-4, series_interval = 1e-4, report = false}
contact = {stiffness = 1e5, tangential_stiffness = 5e4, restitution = 0.5}
quality_default = "draft"
[quality.draft.contact]
friction = 0.1
[quality.fine.contact]
friction = 0.9
[grains]
density = 2500
grain = [{x = 0.005, y = 0.004, diameter = 0.001}]
"""
POINTS = {"grains.density": [2500, 2600]}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A scene's file and the folder of a sweep of it."""
    folder = tmp_path_factory.mktemp("swept")
    (folder / "fall.toml").write_text(SCENE)
    porescale.sweep(folder / "fall.toml", POINTS, folder / "out")
    return folder / "fall.toml", folder / "out"


def refused(*given, **options):
    """The lines of the error."""
    with pytest.raises(InputError) as caught:
        porescale.sweep(*given, **options)
    return str(caught.value).splitlines()


def whole(folder):
    """What is in the files of a folder of a sweep."""
    return {it: it.read_bytes() for it in folder.rglob("*") if it.is_file()}


def test_the_same_sweep_and_one_with_more_points_go_on(swept):
    scene, out = swept
    before = {it: it.stat().st_mtime_ns for it in out.glob("*/card.json")}
    table = porescale.sweep(scene, POINTS, out)
    assert table.outcome.tolist() == ["finished"] * 2
    more = porescale.sweep(scene, {"grains.density": [2500, 2600, 2700]}, out)
    assert more["grains.density"].tolist() == [2500, 2600, 2700]
    assert {it: it.stat().st_mtime_ns for it in before} == before  # none was run again
    assert len(list(out.glob("*/card.json"))) == 3


def test_runs_of_another_sweep_are_refused_and_nothing_is_written(swept):
    scene, out = swept
    here = whole(out)
    line = refused(scene, {"contact.friction": [0.3]}, out)[0]
    assert line.startswith(f"out = '{out}': holds runs of other points: density=2500 density=2600")
    assert line.endswith("; name another folder, or remove what is there")
    assert "density=2600" in refused(scene, {"grains.density": [2500]}, out)[0]
    words = ["porescale", "sweep", str(scene), "--vary", "contact.friction=0.3", "--out", str(out)]
    done = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True, timeout=120)
    assert done.returncode == 2
    assert done.stderr.startswith(f"--out = '{out}': holds runs of other points: density=2500 ")
    assert len(done.stderr.splitlines()) == 1
    assert whole(out) == here


def test_runs_of_the_scene_before_a_change_are_not_taken_for_those_of_today(swept, tmp_path):
    """Names and settings of the points are the same; the scene is not."""
    scene, out = swept
    points = {"grains.density": [json.loads((it / "card.json").read_text())["scene"]["grains"]["density"]
                                 for it in sorted(out.iterdir()) if it.is_dir()]}  # fmt: skip
    points["grains.density"] = [int(it) for it in points["grains.density"]]
    changed = tmp_path / "fall.toml"
    changed.write_text(SCENE.replace("restitution = 0.5", "restitution = 0.6"))
    here = whole(out)
    line = refused(changed, points, out)[0]
    assert line == (f"{out / 'density=2500'}: contact.restitution = 0.6: was 0.5; name another folder, or remove what "
                    "is there")  # fmt: skip
    assert "contact.friction = 0.9: was 0.1" in refused(scene, points, out, quality="fine")[0]
    assert whole(out) == here
    changed.write_text(SCENE + "# the check that fails: the same scene in another file\n")
    porescale.sweep(changed, points, out)


PLAN = """
[[quantity]]
name = "fall"
column = "kinetic energy of grains (J/m)"
exact = 1e-6
scale = 1e-6
"""
KNOB = """
[[knob]]
name = "density"
"""


def test_runs_of_an_earlier_plan_are_refused_and_those_of_a_longer_one_go_on(tmp_path):
    """A study of two points; then of one of them, which is refused; then of both and a third."""
    (tmp_path / "fall.toml").write_text(SCENE)
    out = tmp_path / "out"

    def study(*densities):
        """The study of a plan with these points."""
        points = [f'[[knob.point]]\nlabel = "{it}"\nsettings = {{ grains.density = {it} }}\n' for it in densities]
        (tmp_path / "trade.toml").write_text(PLAN + KNOB + "".join(points))
        words = ["porescale", "study", "trade", str(tmp_path / "fall.toml"), "--out", str(out)]
        return subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True, timeout=300)

    assert study(2500, 2600).returncode == 0
    here = whole(out)
    shorter = study(2500)
    assert shorter.returncode == 2
    assert shorter.stderr.startswith(f"--out = '{out / 'runs'}': holds runs of other points: ")
    assert shorter.stderr.count("\n") == 1
    assert whole(out) == here
    assert study(2500, 2600, 2700).returncode == 0
    runs = {it: it.read_bytes() for it in out.glob("runs/*/card.json")}
    assert len(runs) == 3
    assert all(here[it] == runs[it] for it in runs if it in here)  # none was run again
