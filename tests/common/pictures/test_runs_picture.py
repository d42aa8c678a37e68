"""Pictures and films show what is there, the right way up, to scale, and nothing else."""

import sys
from dataclasses import replace

import av
import cv2
import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.pictures.film import encoder, painted, write_film
from porescale.common.pictures.look import GRAIN, WALL, Look, length_unit, rgb, scale, survey, time_text
from porescale.common.pictures.picture import Painter, paint
from porescale.common.record import card, snapshots
from porescale.common.record.model import Cloud, Grid, Snapshot
from tests.reference.waiting import done

NY, NX, DX = 30, 50, 1e-3


def flow(speed: float = 1.0, time: float = 0.0, step: int = 0, **clouds: Cloud) -> Snapshot:
    """Flow in the upper half only, to the right."""
    velocity = np.zeros((NY, NX, 3), np.float32)
    velocity[NY // 2 :, :, 0] = speed
    pressure = np.linspace(-1, 1, NX)[None, :] * np.ones((NY, 1))
    solid = np.zeros((NY, NX), np.float32)
    solid[:5] = 1
    cells = {"velocity": velocity, "pressure": pressure, "solid": solid}
    grid = Grid((0.0, 0.0), (DX, DX), cells, {"velocity": "m/s", "pressure": "Pa"})
    return Snapshot(time, step, {"fields": grid}, dict(clouds))


def grain(x: float, y: float, radius: float, angle: float | None = None) -> Cloud:
    data = {"radius": np.array([radius])}
    if angle is not None:
        data["angle"] = np.array([angle])
    return Cloud(np.array([[x, y]]), data, {"radius": "m"})


def inside(snapshot: Snapshot, **changes) -> np.ndarray:
    """The inside of a picture."""
    look = Look(**changes)
    return Painter(survey([snapshot], look)).canvas.draw(snapshot)


def covered(image: np.ndarray, colour: str) -> np.ndarray:
    """Where an image has a colour."""
    return (image == rgb(colour)).all(-1)


def test_up_is_up():
    image = inside(flow())
    tall = image.shape[0]
    fast, slow = image[tall // 4], image[3 * tall // 4]
    # viridis ends in yellow and begins in violet: green against blue tells which is which.
    assert (fast[:, 1] > 200).all()
    assert (slow[:, 1] < 10).all()


def test_a_disc_lies_where_it_is_and_has_its_size():
    x, y, radius = 0.012, 0.021, 0.004
    image = inside(flow(0.0, grains=grain(x, y, radius)))
    tall, wide = image.shape[:2]
    per_metre = wide / (NX * DX)
    rows, columns = np.nonzero(covered(image, GRAIN))
    # The rim takes 2 pixels, antialiasing one more on either side.
    assert abs((columns.mean() + 0.5) / per_metre - x) < 0.5 / per_metre
    assert abs(NY * DX - (rows.mean() + 0.5) / per_metre - y) < 0.5 / per_metre
    assert 0 < radius * per_metre - np.ptp(columns) / 2 < 4
    assert abs(wide / tall - NX / NY) < 0.01


def test_a_spoke_turns_counterclockwise():
    def spoke(angle):
        image = inside(flow(0.0, grains=grain(0.025, 0.015, 0.01, angle)))
        plain = inside(flow(0.0, grains=grain(0.025, 0.015, 0.01)))
        rows, columns = np.nonzero((image != plain).any(-1))
        return columns.mean() - image.shape[1] / 2, image.shape[0] / 2 - rows.mean()

    for angle in (0.0, 1.0, 2.5, -2.0):
        right, up = spoke(angle)
        # The spoke's middle lies 0.4 radii out, about 70 pixels: half a pixel is 0.007 rad.
        assert abs(np.angle(np.exp(1j * (np.arctan2(up, right) - angle)))) < 0.03


def test_pictures_of_different_fields_differ_and_of_equal_ones_do_not():
    look = Look(limits=(0.0, 1.0))
    assert (paint(flow(1.0), look) == paint(flow(1.0), look)).all()
    assert (paint(flow(1.0), look) != paint(flow(0.9), look)).any()


def test_walls_lines_arrows_and_kinds_are_drawn():
    plain = inside(flow())
    assert covered(inside(flow(), walls="solid"), WALL)[-20:, 50:-50].all()
    line = inside(flow(), lines=(((0.02, 0.0), (0.02, 0.03)),))
    assert (line != plain).any(-1).mean() == pytest.approx(6 / plain.shape[1], rel=0.7)
    moving = inside(flow(time=0.5), lines=lambda snapshot: [((snapshot.time * 0.1, 0.0), (0.05, 0.03))])
    assert (moving != plain).any()
    arrows = (inside(flow(), arrows=20) != plain).any(-1)
    half = len(arrows) // 2
    assert arrows[:half].mean() > 0.02
    assert not arrows[half + 30 :].any()
    dots = Cloud(np.array([[0.01, 0.01], [0.03, 0.01]]), {"kind": np.array([0, 1])})
    kinds = {0: ("soil", "#aa0000"), 1: ("water", "#0000aa")}
    image = inside(Snapshot(0.0, 0, {}, {"p": dots}), colour="kind", kinds=kinds, dot=0.002)
    wide = image.shape[1]
    assert covered(image, "#aa0000")[:, : wide // 2].any()
    assert not covered(image, "#aa0000")[:, wide // 2 :].any()
    assert covered(image, "#0000aa")[:, wide // 2 :].any()


def test_streamlines_only_follow_what_moves():
    snapshot = flow()
    painter = Painter(survey([snapshot], Look()))
    changed = (painter.streamlines(snapshot) != painter.paint(snapshot)).any(-1)
    middle = painter.y + painter.height // 2
    assert changed[:middle].any()
    assert not changed[middle + 15 :].any()
    whole = snapshot.grids["fields"]
    column = {name: it[:, :1] for name, it in whole.cells.items()}  # one cell wide: no lines beside each other
    narrow = replace(snapshot, grids={"fields": replace(whole, cells=column)})
    painter = Painter(survey([narrow], Look()))
    assert (painter.streamlines(narrow) == painter.paint(narrow)).all()


@pytest.mark.parametrize("shape", [(4, 60), (60, 4), (20, 20), (700, 900)])
def test_any_shape_gives_an_even_picture_of_about_the_size_asked_for(shape):
    grid = Grid((0, 0), (1e-3, 1e-3), {"velocity": np.random.default_rng(0).random((*shape, 3))})
    image = paint(Snapshot(0, 0, {"fields": grid}), size=800)
    assert image.dtype == np.uint8
    assert all(side % 2 == 0 for side in image.shape[:2])
    assert 780 <= max(image.shape[:2]) <= 820


def test_an_outlier_does_not_darken_the_film_and_signs_get_two_colours():
    values = np.linspace(0, 1, 100_000)
    values[0] = 1e6
    found = scale("velocity", "m/s", values, None, "", "")
    assert found.low == 0
    # The 99.5th percentile of a ramp to 1.
    assert found.high == pytest.approx(0.995, abs=1e-3)
    signed = scale("pressure", "Pa", values - 0.5, None, "", "")
    assert signed.low == -signed.high
    assert signed.map_name != found.map_name
    assert scale("velocity", "m/s", np.zeros(3), None, "", "").high > 0
    assert scale("velocity", "m/s", values * 1e-3, None, "", "").label == "speed (mm/s)"


def test_what_is_no_number_is_left_white():
    found = scale("pressure", "Pa", np.array([1.0, 2.0]), None, "", "")
    assert found.colours(np.array([np.nan, 1.5])).tolist()[0] == [255, 255, 255]


def test_axes_and_times_have_handy_units():
    assert length_unit((0, 0.01, 0, 0.01)) == (1e3, "mm")
    assert length_unit((0, 0.5, 0, 0.1)) == (1e2, "cm")
    assert length_unit((0, 50, 0, 10)) == (1.0, "m")
    assert [time_text(t, 0.05) for t in (0, 0.05)] == ["t = 0.0 ms", "t = 50.0 ms"]
    assert time_text(0.25, 2.0) == "t = 0.25 s"
    assert time_text(0.0, 0.0) == "t = 0.00 s"
    assert length_unit((0, 0.01, 0, 0.01), plain=True) == (1.0, "")
    assert time_text(0.05, 0.05, plain=True) == "t = 0.0500"


def a_run(folder, frames=12):
    card.write_card(folder, {"name": "half a channel", "scene": {}, "outcome": "finished"})
    for k in range(frames):
        at = grain(0.01 + 0.002 * k, 0.01, 0.003, 0.1 * k)
        snapshots.write_part(folder, flow(0.1 * k, 0.05 * k, k, grains=at))
    return folder


def decoded(path):
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def test_a_film_plays_frame_by_frame_what_the_painter_painted(tmp_path):
    path = painted(a_run(tmp_path), size=500)[-1]
    frames = decoded(path)
    assert len(frames) == 12
    assert path.stat().st_size > 5000
    run = snapshots.catalogue(tmp_path)
    look = Look(size=500, title="half a channel")
    painter = Painter(survey((snapshots.load(entry, step) for step, entry in run.items()), look))
    images = [painter.paint(snapshots.load(entry, step)) for step, entry in run.items()]
    apart = np.array([[np.abs(f.astype(int) - p).mean() for p in images] for f in frames])
    # Compression and halved colour resolution cost a few grey levels; another frame is further away.
    assert (apart.argmin(1) == np.arange(12)).all()
    assert np.diag(apart).max() < 4
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.pix_fmt == "yuv420p"
        assert stream.codec_context.name in ("h264", "vp9", "libvpx-vp9")


def test_a_film_can_be_played_while_it_is_loaded(tmp_path):
    path = painted(a_run(tmp_path, 3), size=300)[-1]
    content = path.read_bytes()
    assert path.suffix == ".webm" or content.index(b"moov") < content.index(b"mdat")


def test_without_h264_a_film_is_webm(tmp_path, monkeypatch):
    monkeypatch.setattr(av, "codecs_available", {"libvpx-vp9"})
    assert encoder()[1] == ".webm"
    images = [np.full((64, 96, 3), 20 * k, np.uint8) for k in range(5)]
    path = write_film(tmp_path / "film", images, 5)
    assert path.suffix == ".webm"
    assert len(decoded(path)) == 5


def test_pictures_are_whole_png_files(tmp_path):
    *made, film = painted(a_run(tmp_path), size=600, streamlines=True)
    assert [path.name for path in made] == ["final.png", "montage.png", "streamlines.png"]
    assert film.stem == "film"
    for path in made:
        image = cv2.imread(str(path))
        assert image is not None
        assert image.std() > 10
    assert not list(tmp_path.glob(".*writing*"))


def test_a_run_without_snapshots_is_told_so(tmp_path):
    card.write_card(tmp_path, {"name": "empty", "scene": {}})
    with pytest.raises(InputError, match="no snapshots"):
        painted(tmp_path)


def test_painting_needs_no_display():
    words = (
        "from porescale.common.pictures.picture import Painter; import sys; print('matplotlib.pyplot' in sys.modules)"
    )
    assert done([sys.executable, "-c", words]).stdout.strip() == "False"
