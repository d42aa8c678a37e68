"""A coupled run from the command line leaves every file that it should, and each opens with the tools people have."""

import csv
import json
import os
import subprocess

import av
import cv2
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

from porescale import build, load, open_run
from porescale.common.record.checkpoint import read_checkpoint
from tests.reference.folders import ROOT, complaints_in
from tests.reference.same_run import differences, leaves
from tests.reference.scenes import COLUMN, STEPS

SNAPSHOTS = 7  # every 0.004 s from 0 to 0.024 s
FILES = {
    "card.json", "checkpoint.h5", "series.csv", "fields.vtkhdf", "grains.vtkhdf",
    "film.mp4", "report.html", "final.png", "montage.png", "streamlines.png", "profile.csv", "packing.csv",
}  # fmt: skip


def test_the_folder_holds_every_file_whole_and_no_remains(folder):
    names = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
    assert {name.replace("film.webm", "film.mp4") for name in names} == FILES
    assert all(path.stat().st_size > 0 for path in folder.iterdir() if path.name in FILES)
    assert not list(folder.glob(".*writing*"))


def test_the_card_says_what_was_run_with_what_and_how_it_ended(folder, scene):
    card = json.loads((folder / "card.json").read_text())
    assert card["scene"]["fluid"]["viscosity"] == COLUMN["fluid"]["viscosity"]
    assert card["scene"]["fluid"]["magic"] == 3 / 16  # defaults are on the card
    assert card["scene"]["contact"]["release"] == "force"
    assert card["scene"]["grains"]["hydraulic_radius_ratio"] == 0.8
    assert card["seeds"] == {"grains.packing.seed": 1}
    assert card["threads"] == 1
    assert card["scene_file"] == str(scene.resolve())
    assert {"python", "porescale", "numpy", "numba", "h5py"} <= card["versions"].keys()
    assert card["machine"]["cores"] >= 1
    root = ROOT
    if (root / ".git").exists():
        said = subprocess.run(["git", "-C", root, "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
        assert len(card["commit"]["hash"]) == len(said.stdout.strip())
        assert isinstance(card["commit"]["changed"], bool)
    assert (card["outcome"], card["step"], card["package"]) == ("finished", STEPS, "porescale")
    assert card["time"] == pytest.approx(0.024, rel=1e-12)


def test_the_scene_on_the_card_is_the_scene(folder, scene):
    from porescale import Scene
    from porescale.common.schema.sections import validate

    card = json.loads((folder / "card.json").read_text())
    assert validate(Scene, card["scene"]) == load(scene)


def steps_of(path):
    """VTK's output at every time step of a file, with its time."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for k in range(reader.GetNumberOfSteps()):
        reader.SetStep(k)
        reader.Update()
        yield reader.GetTimeValue(), reader.GetOutputDataObject(0)


def test_vtk_reads_the_fields_as_they_were_recorded(folder):
    run, seen = open_run(folder), 0
    for k, (time, image) in enumerate(steps_of(folder / "fields.vtkhdf")):
        snapshot = run.snapshot(k)
        assert time == snapshot.time == pytest.approx(0.004 * k, abs=1e-15)
        assert image.GetDimensions() == (61, 41, 1)
        assert image.GetSpacing()[:2] == (0.0002, 0.0002)
        for name in ("velocity", "pressure", "solid_fraction"):
            read = vtk_to_numpy(image.GetCellData().GetArray(name))
            assert read.tobytes() == np.ascontiguousarray(snapshot.grids["fields"].cells[name]).tobytes()
        seen += 1
    assert seen == len(run) == SNAPSHOTS
    speed = np.abs(run.snapshot(-1).grids["fields"].cells["velocity"]).max()
    assert speed > 1e-3  # they are not a comparison of zeros


def test_vtk_reads_the_grains_as_they_were_recorded(folder):
    run, seen = open_run(folder), 0
    for k, (time, points) in enumerate(steps_of(folder / "grains.vtkhdf")):
        cloud = run.snapshot(k).clouds["grains"]
        assert time == run.times[k]
        assert points.GetNumberOfPoints() == 31
        read = vtk_to_numpy(points.GetPoints().GetData())
        assert read[:, :2].tobytes() == np.ascontiguousarray(cloud.position).tobytes()
        for name in ("radius", "angle", "velocity", "spin"):
            assert vtk_to_numpy(points.GetPointData().GetArray(name)).tobytes() == cloud.data[name].tobytes()
        seen += 1
    assert seen == SNAPSHOTS
    moved = np.abs(run.snapshot(-1).clouds["grains"].position - run.snapshot(0).clouds["grains"].position).max()
    assert moved > 1e-4


def test_the_series_has_a_row_per_interval_and_units_in_its_names(folder):
    with (folder / "series.csv").open(newline="") as file:
        head, *rows = list(csv.reader(file))
    assert len(rows) == STEPS // 10 + 1
    assert all(name.endswith(")") and " (" in name for name in head)
    columns = dict(zip(head, np.array(rows, float).T, strict=True))
    assert columns["time (s)"] == pytest.approx(np.arange(61) * 4e-4, rel=1e-12)
    assert {"front (m)", "run-out (m)", "centre of mass y (m)", "Mach number ()"} <= columns.keys()
    # Every cell's collision conserves mass to round-off of its own: 2400 cells, random signs, over 600 steps.
    assert np.abs(columns["fluid mass change ()"]).max() < 1e-12
    # The row is the snapshot's: foremost edge of the grains at the end.
    last = open_run(folder).snapshot(-1).clouds["grains"]
    assert columns["front (m)"][-1] == (last.position[:, 0] - last.data["radius"]).min()
    assert columns["run-out (m)"][-1] == columns["front (m)"][0] - columns["front (m)"][-1] > 0


def test_the_profile_has_a_row_per_snapshot(folder):
    with (folder / "profile.csv").open(newline="") as file:
        head, *rows = list(csv.reader(file))
    assert len(rows) == SNAPSHOTS
    heights = np.array(rows, float)[:, 1:]
    assert heights.shape[1] == len(head) - 1
    assert heights[0].max() == pytest.approx(0.005, rel=0.3)  # the column before the gate opens
    assert heights[0, : heights.shape[1] // 2].max() == 0  # nothing before the gate


def test_the_pictures_show_something(folder):
    for name in ("final.png", "montage.png", "streamlines.png"):
        image = cv2.imread(str(folder / name))
        assert image is not None
        assert min(image.shape[:2]) > 200
        assert image.std() > 10  # a blank page has none


def test_the_film_plays_a_frame_per_snapshot_and_moves(folder):
    with av.open(str(next(folder.glob("film.*")))) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    assert len(frames) == SNAPSHOTS
    assert all(frame.shape[0] % 2 == 0 and frame.shape[1] % 2 == 0 for frame in frames)
    assert np.abs(frames[0].astype(int) - frames[-1].astype(int)).max() > 50


def test_the_checkpoint_is_the_state_of_the_simulation_at_its_end(folder, scene):
    simulation = build(load(scene))
    stored = read_checkpoint(folder / "checkpoint.h5")["state"]
    assert dict(leaves(simulation.state())) != dict(leaves(stored))
    simulation.restore(stored)
    assert dict(leaves(simulation.state())) == dict(leaves(stored))
    assert simulation.step == STEPS
    assert simulation.series() == {name: column[-1] for name, column in open_run(folder).series.items()}


@pytest.mark.usefixtures("without_pictures")
@pytest.mark.slow
def test_recording_more_often_does_not_change_the_run(folder, scene, porescale, tmp_path):
    often = tmp_path / "often"
    intervals = ("--set", "output.snapshot_interval=0.0012", "--set", "output.series_interval=4e-5")
    assert porescale("run", scene, "--out", often, "--threads", 1, "--quiet", *intervals) == 0
    assert len(open_run(often)) == 21
    assert not [it for it in differences(folder, often) if it.startswith("checkpoint")]
    one, other = open_run(folder), open_run(often)
    assert one.series["front (m)"].tobytes() == other.series["front (m)"][::10].tobytes()


@pytest.mark.usefixtures("without_pictures")
def test_another_viscosity_is_another_run(folder, scene, porescale, tmp_path):
    # The twin: a change of the scene's physics in its tenth digit shows in rows, state and every snapshot.
    other = tmp_path / "other"
    change = ("--set", "fluid.viscosity=2.000000001e-5")
    assert porescale("run", scene, "--out", other, "--threads", 1, "--quiet", *change) == 0
    found = differences(folder, other)
    assert "series.csv" in found
    assert "checkpoint.h5: /coupled/fluid/populations" in found
    assert any("velocity" in it for it in found if it.startswith("fields"))


def test_the_end_says_what_it_cost_and_where_to_look(scene, porescale, tmp_path, capsys):
    out = tmp_path / "short"
    assert porescale("run", scene, "--out", out, "--threads", 1, "--set", "time.end=0.0004") == 0
    said, warned = capsys.readouterr()
    assert "finished at t = 0.0004 s, step 10" in said
    assert f"look at {out}: " in said
    assert "card.json" in said
    assert complaints_in(warned) == []
    assert porescale("run", scene, "--out", out, "--resume", "--set", "time.end=0.0004") == 0  # nothing left to do
    assert porescale("show", out) == 0
    assert str(next(out.glob("film.*"))) in capsys.readouterr().out
    assert os.access(out / "final.png", os.R_OK)
