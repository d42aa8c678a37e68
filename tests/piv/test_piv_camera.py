"""The virtual camera: tracers go with the flow, stay out of grains, stay dense; films of a run measure its flow."""

import shlex

import cv2
import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.record import snapshots
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.open_run import Run
from porescale.piv.estimate.measure import measure
from porescale.piv.fields.field import in_metres, in_pixels
from porescale.piv.images.camera import Shooting, fastest, frames, shooting, shot_of
from porescale.piv.images.filmed import write_frames
from porescale.piv.images.flows import Discs
from porescale.piv.images.moving import Between, instant, nearest, pushed_out
from porescale.piv.images.spots import coverage
from porescale.piv.images.synth import Camera

CELLS, SIDE = 64, 0.032  # a square of 32 mm
TURN = 2.0  # rad/s
GRAIN = (0.024, 0.008, 0.003)


def rotating(time: float, step: int, grain=GRAIN) -> Snapshot:
    """Solid rotation about the middle, with a grain on its way up, and a wall along the bottom."""
    at = (np.arange(CELLS) + 0.5) * SIDE / CELLS - SIDE / 2
    x, y = np.meshgrid(at, at)
    velocity = np.stack([-TURN * y, TURN * x, np.zeros_like(x)], -1)
    solid = np.zeros((CELLS, CELLS))
    solid[:2] = 1
    solid[np.hypot(x + SIDE / 2 - grain[0], y + SIDE / 2 - grain[1]) < grain[2]] = 1
    units = {"velocity": "m/s"}
    grid = Grid((0.0, 0.0), (SIDE / CELLS,) * 2, {"velocity": velocity, "solid_fraction": solid}, units)
    cloud = Cloud(np.array([grain[:2]]), {"radius": np.array([grain[2]])})
    return Snapshot(time, step, {"fields": grid}, {"grains": cloud})


@pytest.fixture
def run(tmp_path):
    for k in range(3):
        snapshots.write_part(tmp_path, rotating(0.1 * k, k, (GRAIN[0], GRAIN[1] + 0.002 * k, GRAIN[2])))
    return Run(tmp_path, {"name": "turning"}, snapshots.catalogue(tmp_path))


def test_tracers_of_a_rotation_go_round():
    still = instant(rotating(0.0, 0), "")
    between = Between(still, instant(rotating(1.0, 1), ""))
    x, y = between.carried(np.array([0.010]), np.array([0.020]), 0.0, 0.5)
    angle = TURN * 0.5
    dx, dy = 0.010 - SIDE / 2, 0.020 - SIDE / 2
    exact = (SIDE / 2 + dx * np.cos(angle) - dy * np.sin(angle), SIDE / 2 + dx * np.sin(angle) + dy * np.cos(angle))
    # Splines are exact where velocity is linear, but for their ends, 0.27^20 away; Runge-Kutta: 31 steps of 1/31 rad.
    assert (x[0], y[0]) == pytest.approx(exact, abs=0.01 * (1 / 31) ** 4 / 120)


def test_grains_move_straight_between_snapshots_and_push_tracers_out():
    between = Between(instant(rotating(0.0, 0), ""), instant(rotating(0.1, 1, (0.024, 0.010, 0.003)), ""))
    assert between.grains(0.05).y[0] == pytest.approx(0.009)
    grains = between.grains(0.0)
    x, y = pushed_out(np.array([0.0245, 0.004]), np.array([0.0085, 0.02]), grains)
    assert np.hypot(x[0] - 0.024, y[0] - 0.008) == pytest.approx(0.003)
    assert (x[1], y[1]) == (0.004, 0.02)
    assert between.first.solid_at(np.array([0.024]), np.array([0.0004])).all()  # the wall
    assert not between.first.solid_at(np.array([0.024]), np.array([0.008])).any()  # grains are not counted twice
    assert between.solid_at(np.array([0.024]), np.array([0.008]), 0.0).all()


@pytest.mark.parametrize("speed", [0.02, None])
def test_a_grain_that_crosses_a_periodic_side_leaves_there_and_comes_in_at_the_other(speed):
    def snapshot(time, x):
        shot = rotating(time, 0, (x, 0.008, 0.003))
        if speed is not None:
            shot.clouds["grains"].data["velocity"] = np.array([[speed, 0.0, 0.0]])
        return shot

    between = Between(instant(snapshot(0.0, 0.031), ""), instant(snapshot(0.1, 0.001), ""))
    half = between.grains(0.05)
    assert sorted(half.x) == pytest.approx([0.0, SIDE])  # both sides of the picture, and not its middle
    assert half.y == pytest.approx([0.008, 0.008])
    assert half.radius == pytest.approx([0.003, 0.003])
    assert sorted(between.grains(0.1).x) == pytest.approx([0.001, SIDE + 0.001])
    assert not between.solid_at(np.array([0.016]), np.array([0.008]), 0.05).any()
    assert between.solid_at(np.array([0.001, 0.031]), np.array([0.008] * 2), 0.05).all()


def test_a_grain_as_fast_as_it_goes_far_stays_in_the_picture():
    def snapshot(time, x):
        shot = rotating(time, 0, (x, 0.008, 0.003))
        shot.clouds["grains"].data["velocity"] = np.array([[-0.3, 0.0, 0.0]])
        return shot

    between = Between(instant(snapshot(0.0, 0.029), ""), instant(snapshot(0.1, 0.004), ""))
    assert between.grains(0.05).x == pytest.approx([0.0165])  # three quarters of the width, in 0.1 s at 0.3 m/s


def test_the_nearest_rim_is_that_of_all_grains():
    random = np.random.default_rng(0)
    grains = Discs(*random.uniform(0, 1, (2, 30)), random.uniform(0.02, 0.04, 30))
    x, y = random.uniform(0, 1, (2, 50))
    far, which = nearest(x, y, grains)
    rims = np.hypot(x[:, None] - grains.x, y[:, None] - grains.y) - grains.radius
    assert np.allclose(far - grains.radius[which], rims.min(1))


def test_discs_cover_their_area():
    share = np.zeros((60, 70))
    coverage(Discs(np.array([30.3]), np.array([25.8]), np.array([12.5])), share)
    # The rim is taken as straight within a pixel: it bends off by 1/(8 r), on average a third of that.
    assert share.sum() == pytest.approx(np.pi * 12.5**2, rel=2 / (24 * 12.5**2) + 0.002)


def shot(run, **changes):
    chosen = {"scale": SIDE / 160, "interval": 0.02, "start": 0.0, "end": 0.08, "seed": 1, **changes}
    return shooting(run, Shooting(Camera(noise=1.0), **chosen))


def test_a_film_of_a_rotation_measures_it(run):
    found = list(frames(run, shot(run)))
    assert [it.time for it in found] == pytest.approx([0.0, 0.02, 0.04, 0.06, 0.08])
    assert found[0].picture.shape == (160, 160)
    field = in_metres(in_pixels(measure(found[0].picture, found[1].picture, found[0].solid)), 160, SIDE / 160, 0.02)
    x, y = np.meshgrid(field.x - SIDE / 2, field.y - SIDE / 2)
    far = ~field.solid & (np.hypot(x, y) < 0.3 * SIDE) & (y > -0.3 * SIDE)
    # A twentieth of a pixel, 0.05 SIDE/160/0.02 s: three times what smooth flows with lost pairs leave.
    for own, exact in ((field.u, -TURN * y), (field.v, TURN * x)):
        assert np.sqrt(np.mean((own - exact)[far] ** 2)) < 0.05 * SIDE / 160 / 0.02


def test_no_tracer_shines_in_solids_and_none_is_missing_elsewhere(run):
    camera = Camera(noise=0.0, disc=0.0, background=0.0)
    film = list(frames(run, shooting(run, Shooting(camera, SIDE / 160, 0.04, 0.0, 0.2, seed=2))))
    for frame in film:
        inner = cv2.erode(frame.solid.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
        assert not frame.picture[inner].any()
        fluid = ~frame.solid
        light = [part.mean() for part in (frame.picture[:80][fluid[:80]], frame.picture[80:][fluid[80:]])]
        # Squares hold 13 tracers, between a half and one and a half of that; halves hold fifty squares.
        assert light[1] == pytest.approx(light[0], rel=0.5)
    assert film[0].solid.sum() > np.pi * 14**2


def test_an_open_shutter_draws_streaks(run):
    sharp, blurred = (next(iter(frames(run, shot(run, interval=0.08, exposure=it)))).picture[:90] for it in (0.0, 1.0))
    assert np.percentile(blurred, 99) < 0.8 * np.percentile(sharp, 99)


def test_frames_are_written_and_the_same_for_the_same_seed(run, tmp_path):
    for name in ("a", "b"):
        assert write_frames(run, shot(run, end=0.02), tmp_path / name) == 2
    one, other = ((tmp_path / name / "frames" / "00001.png").read_bytes() for name in ("a", "b"))
    assert one == other
    assert (tmp_path / "a" / "film.mp4").exists() or (tmp_path / "a" / "film.webm").exists()
    assert cv2.imread(str(tmp_path / "a" / "masks" / "00000.png"), 0).max() == 255


def test_what_cannot_be_filmed_is_refused(run):
    for changes, words in (
        ({"scale": 1.0}, r"1 x 1|0 x 0 px, and 32 to 4096 a side are allowed \(allowed: .* m\)"),
        ({"scale": 1e-320}, "--scale"),
        ({"interval": 1e-320}, "more than"),
        ({"end": 0.0}, "--interval"),
        ({"interval": 0.081}, r"leaves fewer than two frames between --start and --end \(allowed: above 0 to 0.08 s\)"),
        ({"seed": -1}, "--seed = -1: is out of range"),
        ({"exposure": 2.0}, "--exposure"),
    ):
        with pytest.raises(InputError, match=words):
            shot(run, **changes)
    assert len(list(frames(run, shot(run, interval=0.08)))) == 2  # as long as the time that is filmed
    assert shot_of(run, Camera(), scale=SIDE / 64, end=0.04).interval == 0.04  # less than 4 px in all of it
    pixel, speed = fastest(run, 0.0, 0.2)
    assert pixel == pytest.approx(SIDE / 1024)
    assert speed == pytest.approx(TURN * np.hypot(1, 1) * SIDE / 2 * (1 - 1 / CELLS))


def test_the_command_films_and_says_how_to_measure(run, tmp_path, monkeypatch, capsys):
    from porescale.cli.main import commands
    from porescale.common.cli.application import main

    monkeypatch.setattr("porescale.common.record.open_run.open_run", lambda folder: run)
    given = ["piv", "render", str(run.folder), "--out", str(tmp_path / "f g"), "--scale", "0.2 mm", "--end", "0.05 s"]
    assert main(commands(), [*given, "--interval", "25 ms", "--grains", "dark"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("3 frames of 160 x 160 px")
    words = shlex.split(said.partition("measure with: ")[2])  # of a folder with a blank in its name
    frames, masks = (str(tmp_path / "f g" / part) for part in ("frames", "masks"))
    assert words[:6] == ["porescale", "piv", "measure", frames, "--mask", masks]
    assert len(list((tmp_path / "f g" / "frames").glob("*.png"))) == 3
    assert main(commands(), ["piv", "measure", str(tmp_path / "f g"), "--out", str(tmp_path / "out")]) == 2
    (line,) = capsys.readouterr().err.splitlines()  # its folder has none itself: the same words lead to them
    assert line.endswith(f"0 pictures there; those of `piv render` are measured with {shlex.join(words[3:])}")
    assert main(commands(), [*words[1:], "--out", str(tmp_path / "out")]) == 0
    capsys.readouterr()
    for spoil in ("no shot", "no frames"):  # the check that fails: a folder without pictures that is none of them
        other = tmp_path / spoil
        (other / "frames").mkdir(parents=True)
        (other / "shooting.json").write_text("{}" if spoil == "no shot" else '{"scale": 1, "interval": 1, "start": 0}')
        if spoil == "no frames":
            (other / "frames").rmdir()
        assert main(commands(), ["piv", "measure", str(other), "--out", str(tmp_path / "out")]) == 2
        assert capsys.readouterr().err.strip().endswith("0 pictures there; give two or more")
    for wrong in (["--start", "0.3"], ["--scale", "1 s"], ["--interval", "-1"]):
        assert main(commands(), [*given, *wrong]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1
