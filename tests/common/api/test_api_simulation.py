"""Simulations in Python: run in pieces, stopped, refused, and what is read of them."""

import os
import signal
from pathlib import Path

import numpy as np
import pytest

import continuum_sph
import porescale
from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.compiled import jit
from porescale.common.core.errors import InputError, Unstable
from porescale.common.duration.threads import Threads
from porescale.common.record.model import Model
from tests.common.api.small import build, scene_of
from tests.fingerprints.digest import fingerprint
from tests.reference.same_run import differences
from tests.reference.scenes import COLUMN, column, dry, refusals, table, water, write
from tests.reference.scenes_of_grains import framed

END = 0.004


def tank(**changes):
    """A column of 100 particles of water that falls."""
    return scene_of("tank", **changes)


SCENES = {"coupled": lambda: column(time__end=END), "dry": lambda: dry(time__end=END), "tank": tank}


@pytest.mark.parametrize("kind", SCENES)
def test_pieces_are_the_whole_to_the_bit(kind):
    scene = SCENES[kind]()
    end = scene.time.end
    whole, pieces = build(scene).run(until=end), build(scene)
    assert isinstance(whole, Model)
    for share in (0.3, 0.35, 1.0):
        assert pieces.run(until=share * end) is pieces
    assert whole.step == pieces.step
    assert whole.time == pytest.approx(end, abs=whole.step_seconds)
    assert fingerprint(whole.state()) == fingerprint(pieces.state())
    assert fingerprint(build(scene).run(until=0.9 * end).state()) != fingerprint(pieces.state())  # it can tell


@pytest.mark.parametrize("kind", SCENES)
def test_a_state_of_another_simulation_is_refused_in_one_line(kind):
    """It was a KeyError, a TypeError or a ValueError, of arrays within."""
    own = build(SCENES[kind]())
    others = [build(make()).state() for name, make in SCENES.items() if name != kind]
    for wrong in (*others, {}, None, [1.0], dict.fromkeys(own.state(), "x")):
        with pytest.raises(
            InputError, match=r"^state: is not that of a simulation of this scene .*; give what"
        ) as refused:
            build(SCENES[kind]()).restore(wrong)
        assert "\n" not in str(refused.value)
    build(SCENES[kind]()).restore(own.state())  # the check that must fail


def test_pieces_share_what_is_known_of_threads_while_as_many_are_allowed(monkeypatch):
    made = []
    place = "porescale.common.api.simulation.Threads"
    monkeypatch.setattr(place, lambda: made.append(Threads(jit.threads(), lambda _: None)) or made[-1])
    one = build(dry())
    for allowed, kinds in ((2, 1), (2, 1), (3, 2)):
        monkeypatch.setattr(jit, "threads", lambda allowed=allowed: allowed)
        one.run(steps=1)
        assert len(made) == kinds


def test_a_run_ends_where_it_is_said():
    one = build(dry())
    assert one.run(steps=3).step == 3
    assert one.run(seconds=2 * one.step_seconds).step == 5
    assert one.run(until=one.time).step == 5
    two = build(tank())
    two.run(until=0.01)
    assert two.time >= 0.01 * (1 - 1e-9)
    assert two.time - 0.01 < 2 * two.step_seconds  # the first step at or after it
    assert build(tank(time__end=0.002)).run().time >= 0.002 * (1 - 1e-9)


def test_times_that_are_none_are_refused_in_one_line():
    simulation = build(dry()).run(steps=5)
    assert "is past: the simulation is at" in refusals(lambda: simulation.run(until=0.0))[0]
    assert "contradicts" in refusals(lambda: simulation.run(until=1.0, steps=3))[0]
    assert "is no time" in refusals(lambda: simulation.run(until=float("nan")))[0]
    assert "is no number of steps" in refusals(lambda: simulation.run(steps=-1))[0]
    assert "is no number of steps" in refusals(lambda: simulation.run(steps=1.5))[0]
    assert simulation.step == 5


def test_a_state_that_is_none_ends_a_run():
    simulation = build(dry())
    simulation.grains.discs.velocity[3] = np.nan
    with pytest.raises(Unstable, match="grain 3"):
        simulation.run(steps=200)


def test_ctrl_c_leaves_a_whole_state(monkeypatch):
    stopped, whole = build(tank()), build(tank())
    advance = stopped.advance

    def stop_at_seven(steps):
        advance(steps)
        if stopped.step == 7:
            os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(stopped, "advance", stop_at_seven)
    with pytest.raises(KeyboardInterrupt, match="stopped at step 7"):
        stopped.run()
    whole.advance(7)
    assert fingerprint(stopped.state()) == fingerprint(whole.state())
    assert fingerprint(stopped.run().state()) == fingerprint(whole.run().state())


@pytest.mark.parametrize("kind", SCENES)
def test_what_is_read_is_a_copy(kind):
    simulation = build(SCENES[kind]())
    before = fingerprint(simulation.state())
    count = len(simulation.positions)
    for name in ("positions", "velocities", "radii", "masses"):
        values = getattr(simulation, name)
        assert len(values) == count
        values[:] = np.nan
    assert fingerprint(simulation.state()) == before
    start = simulation.positions
    simulation.run(steps=20)
    assert (simulation.positions != start).any()


def test_grains_that_there_are_not_are_refused():
    simulation = build(water())
    for name in ("positions", "velocities", "radii", "spins"):
        assert "this scene has no grains" in refusals(lambda name=name: getattr(simulation, name))[0]


def test_where_the_corners_of_polygons_are_had_is_said_where_there_are_no_grains():
    square = {"corners": [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]], "at": [[2e-3, 2e-3]], "thickness": 5e-5}
    simulation = build(framed(polygon=[square]))
    for name in ("positions", "velocities", "radii", "masses", "spins"):
        said = refusals(lambda name=name: getattr(simulation, name))[0]
        assert said.startswith("positions: this scene has no grains, but 1 body of segments; read self.snapshot().")
        assert "fields" not in said  # a scene without fluid has none
    corners = simulation.snapshot().clouds["frames"].position[:, :2]
    np.testing.assert_allclose(np.ptp(corners, axis=0), 1e-3, rtol=1e-9)  # as they are given, to round-off of places


def test_a_run_from_python_is_that_of_the_command(tmp_path, request):
    scene = write(tmp_path / "scene.toml", table(COLUMN, time__end=END))
    assert main(commands(), ["run", str(scene), "--out", str(tmp_path / "typed"), "--quiet", "--threads", "1"]) == 0
    run = porescale.run(porescale.load(scene), tmp_path / "called", progress=False)
    assert run.folder == tmp_path / "called"
    assert not differences(tmp_path / "typed", tmp_path / "called")
    assert {it.name for it in (tmp_path / "typed").iterdir()} == {it.name for it in (tmp_path / "called").iterdir()}
    one = porescale.build(porescale.load(scene)).run()
    assert fingerprint(one.state())[0] == fingerprint(porescale.build(porescale.load(scene)).run(until=END).state())[0]
    request.getfixturevalue("without_pictures")  # the two above have the same, by their names
    other = porescale.run(porescale.load(scene, settings=["contact.friction=0.4"]), tmp_path / "other", progress=False)
    assert differences(tmp_path / "typed", other.folder)  # it can tell


@pytest.mark.usefixtures("without_pictures")
def test_a_folder_that_is_in_use_is_named_as_python_has_it(tmp_path):
    scene = tank(time__end=0.002)
    continuum_sph.run(scene, tmp_path / "one", progress=False)
    line = refusals(lambda: continuum_sph.run(scene, tmp_path / "one"))[0]
    assert "out = " in line
    assert "resume=True" in line
    assert "--" not in line
    assert (
        "contradicts overwrite=True"
        in refusals(lambda: continuum_sph.run(scene, tmp_path / "one", resume=True, overwrite=True))[0]
    )
    assert "holds no run to resume" in refusals(lambda: continuum_sph.run(scene, tmp_path / "two", resume=True))[0]
    assert not (tmp_path / "two").exists()
    assert "is no scene of porescale" in refusals(lambda: porescale.run(scene, tmp_path / "two"))[0]
    moved = continuum_sph.build(scene).run(steps=1)
    assert "no longer at time 0" in refusals(lambda: continuum_sph.run(moved, tmp_path / "two"))[0]


@pytest.mark.usefixtures("without_pictures")
@pytest.mark.parametrize("kind", ["tank", "dry"])
def test_a_scene_made_in_python_is_gone_on_with(kind, tmp_path, monkeypatch):
    package = porescale if kind == "dry" else continuum_sph
    scene = SCENES[kind]()
    short = scene.model_copy(update={"time": scene.time.model_copy(update={"end": 0.5 * scene.time.end})})
    package.run(short, tmp_path / "pieces", progress=False)
    package.run(scene, tmp_path / "pieces", resume=True, progress=False)
    whole = package.run(package.build(scene), tmp_path / "whole", progress=False)
    assert not differences(tmp_path / "pieces", whole.folder)
    assert whole.card["scene"]["time"]["end"] == scene.time.end
    monkeypatch.chdir(tmp_path)
    assert package.run(short, progress=False).folder == Path("runs/scene")


@pytest.mark.parametrize("given", ["rough", "peak"])
def test_a_level_that_there_is_not_is_one_fault_and_what_it_would_give_is_not_missed(given):
    with pytest.raises(InputError, match="no such level") as raised:
        porescale.load("column_collapse", quality=given)
    assert len(raised.value.faults) == 1


def test_threads_that_there_are_not_are_refused():
    with pytest.raises(InputError, match=r"^threads = 0: is out of range"):
        porescale.set_threads(0)
