"""Figures and films of what is asked for; what cannot be had is refused in a line and leaves nothing behind."""

from dataclasses import replace

import av
import cv2
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from porescale.common.core.errors import InputError
from porescale.common.pictures.axes import draw
from porescale.common.pictures.choose import Wanted, with_section
from porescale.common.pictures.figure import figure_of, require_same_box, write_figure
from porescale.common.pictures.initial import Feature, Initial, initial_pixels
from porescale.common.pictures.look import PLATE, Look, rgb, round_off, scale, survey
from porescale.common.pictures.picture import Painter
from porescale.common.record import card, snapshots
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.open_run import open_run

WIDE, HIGH = 0.05, 0.03


def shot(k: int, speed: float = 1.0, width: float = WIDE) -> Snapshot:
    """Snapshot ``k``: a jet, and two grains of which the second is held."""
    velocity = np.zeros((30, 50, 3), np.float32)
    velocity[10:20, :, 0] = speed * k
    cells = {"velocity": velocity, "pressure": np.arange(1500.0).reshape(30, 50)}
    grid = Grid((0.0, 0.0), (width / 50, HIGH / 30), cells, {"velocity": "m/s", "pressure": "Pa"})
    data = {"radius": np.array([0.004, 0.004]), "velocity": np.full((2, 3), 0.1 * k), "spin": np.array([1.0, 2.0])}
    units = {"radius": "m", "velocity": "m/s", "spin": "rad/s"}
    return Snapshot(
        0.1 * k, 10 * k, {"fields": grid}, {"grains": Cloud(np.array([[0.01, 0.02], [0.03, 0.02]]), data, units)}
    )


def run_of(folder, frames=4, **changes):
    folder.mkdir(exist_ok=True)
    card.write_card(folder, {"name": folder.name, "scene": {}, "outcome": "finished"})
    for k in range(frames):
        snapshots.write_part(folder, shot(k, **changes))
    return open_run(folder), Look(
        title="a jet", cloud="grains", held=1, view=(0.0, changes.get("width", WIDE), 0.0, HIGH)
    )


@pytest.fixture
def jet(tmp_path):
    return run_of(tmp_path / "jet")


@pytest.mark.parametrize("kind", ["png", "pdf", "svg", "mp4", "gif"])
def test_every_format_is_written_whole(jet, tmp_path, kind):
    path = write_figure([jet], Wanted(format=kind, size=300, style=None), tmp_path / f"own.{kind}")
    content = path.read_bytes()
    starts = {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml", "gif": b"GIF8"}
    assert content.startswith(starts.get(kind, b""))
    if kind == "gif":
        assert Image.open(path).n_frames == 4
    if kind == "mp4":
        with av.open(str(path)) as film:
            assert sum(1 for _ in film.decode(video=0)) == 4
    if kind == "svg":
        assert b"x (cm)" in content  # letters stay letters
    assert not list(tmp_path.glob(".*writing*"))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"field": "presure"}, "pressure"),
        ({"colour": "spun"}, "spin"),
        ({"limits": (2.0, 1.0)}, "low and high; exchange them"),
        ({"limits": (1.0, 1.0)}, "low and high; give two that differ"),
        ({"limits": (1.0,)}, "limits = '1.0': must be two numbers"),
        ({"view": (0.01, 0.01, 0.0, 0.01)}, "give sides with something between them"),
        ({"limits": ("0 s", "1 s")}, "limits"),
        ({"view": (0.0, 1.0, 0.0, 0.01)}, "out of the box"),
        ({"view": (0.02, 0.01, 0.0, 0.01)}, "left, right, bottom, top"),
        ({"times": (0.1, 7.0)}, "0 to 0.3"),
        ({"times": ("soon",)}, "times"),
        ({"every": 0}, "every"),
        ({"fps": 10, "format": "svg"}, "svg is a still"),
        ({"format": "tiff"}, "png, pdf, svg, mp4, gif"),
        ({"format": "gif", "fps": 51}, "1 to 50"),
        ({"style": "poster"}, "paper, talk"),
        ({"size": 3}, "200 to 8000"),
        ({"size": "3 km"}, "size"),
        ({"arrows": -1}, "0 to 500"),
        ({"times": (0.0, 0.1, 0.2), "format": "gif"}, "first and the last"),
        ({"times": (0.0,) * 13}, "12"),
    ],
)
def test_what_cannot_be_had_is_refused_in_a_line(jet, tmp_path, words, said):
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError, match=said) as error:
        write_figure([jet], Wanted(**words))
    assert len(error.value.faults) == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_dollars_in_a_title_are_no_formula(jet):
    run, look = jet
    title = r"cost of $\frac$"  # no formula that matplotlib can read
    figure = figure_of([(run, replace(look, title=title))], Wanted(size=300))
    figure.canvas.draw()
    assert title in " ".join(it.get_text() for it in figure.texts)
    Painter(survey([run.snapshot(-1)], replace(look, title=title)))
    initial_pixels(
        run.snapshot(-1), Initial(replace(look, title=title), [Feature("side", title, path=((0, 0), (0, HIGH)))])
    )
    axes = Figure().add_subplot()
    draw(run.snapshot(-1), replace(look, title=title), axes)
    axes.figure.canvas.draw()


def test_the_ending_of_a_file_may_be_in_capitals(jet, tmp_path):
    path = write_figure([jet], Wanted(size=300, every=2), tmp_path / "own.GIF")
    assert path == tmp_path / "own.GIF"
    assert path.read_bytes().startswith(b"GIF8")


def test_two_runs_stand_beside_each_other_with_the_colours_of_both(jet, tmp_path):
    faster = run_of(tmp_path / "faster", speed=3.0)
    figure = figure_of([jet, faster], Wanted(times=(0.3,)))
    panels = [axes for axes in figure.axes if axes.images]
    assert len(panels) == 2
    ranges = {axes.images[0].get_clim() for axes in panels}
    # The faster jet has 9 m/s in a third of its cells: both are painted up to that.
    assert ranges == {(0.0, 9.0)}
    alone = figure_of([jet], Wanted(times=(0.3,)))
    assert alone.axes[0].images[0].get_clim() == (0.0, 3.0)


def test_runs_of_other_boxes_are_refused(jet, tmp_path):
    wider = run_of(tmp_path / "wider", width=0.06)
    with pytest.raises(InputError, match=r"0\.06 m x 0\.03 m.*0\.05 m x 0\.03 m"):
        write_figure([jet, wider], Wanted())
    assert not list(tmp_path.rglob("figure*"))


def test_words_and_sections_change_the_look(jet):
    run, look = jet
    made = Wanted(
        field="pressure", colour="spin", limits=("0 Pa", "1 kPa"), arrows=7, view=("1 cm", 0.02, 0, 0.01)
    ).look(look, run)
    assert (made.field, made.colour, made.limits, made.arrows) == ("pressure", "spin", (0.0, 1000.0), 7)
    assert made.view == (0.01, 0.02, 0.0, 0.01)
    table = {"field": "pressure", "colour": "", "limits": [0, 5], "colour_limits": None, "arrows": 3, "size": 500}
    said = with_section(look, table)
    assert (said.field, said.colour, said.limits, said.arrows, said.size) == ("pressure", None, (0, 5), 3, 500)
    assert with_section(look, None) is look
    of_points = with_section(look, {"field": "spin", "limits": [0, 5]}, cells=False)
    assert (of_points.field, of_points.colour, of_points.cloud_limits) == ("velocity", "spin", (0, 5))


def test_a_view_of_the_scene_is_part_of_its_box(jet, tmp_path):
    run, look = jet
    part = with_section(look, {"view": [0.0, 0.01, 0.0, 0.01]})
    assert part.view == (0.0, 0.01, 0.0, 0.01)
    assert Wanted(view=(0.0, WIDE, 0.0, HIGH)).look(part, run).view == look.view
    require_same_box([jet, (run, part)])
    with pytest.raises(InputError, match="out of the box"):  # the check that must fail
        Wanted(view=(0.0, 2 * WIDE, 0.0, HIGH)).look(part, run)
    wider = with_section(run_of(tmp_path / "wider", width=2 * WIDE)[1], {"view": [0.0, 0.01, 0.0, 0.01]})
    with pytest.raises(InputError, match="another box"):
        require_same_box([(run, part), (run, wider)])


def test_held_discs_are_no_grains(jet):
    run, look = jet
    image = Painter(survey([run.snapshot(0)], look)).paint(run.snapshot(0))
    grey = (image == rgb(PLATE)).all(-1)
    columns = np.nonzero(grey.any(0))[0]
    free = Painter(survey([run.snapshot(0)], Look(cloud="grains", view=look.view))).paint(run.snapshot(0))
    assert grey.sum() > 1000
    assert columns.min() > 0.4 * image.shape[1]  # the second disc alone, at 0.6 of the box
    assert not (free == rgb(PLATE)).all(-1).any()


@pytest.mark.parametrize("value", [0.0, 3.0, -2.0, 101325.0])
def test_a_uniform_field_is_of_one_colour_and_says_so(value):
    # Single precision stores values to 6e-8 of themselves.
    noisy = value * (1 + 6e-8 * np.random.default_rng(0).standard_normal(1000))
    found = scale("pressure", "Pa", noisy, None, "", "")
    assert found.uniform == pytest.approx(value, rel=1e-6)
    assert "uniform" in found.label
    assert len(np.unique(found.colours(noisy), axis=0)) == 1
    varied = scale("pressure", "Pa", value + np.linspace(0, 1 + abs(value), 1000), None, "", "")
    assert varied.uniform is None
    assert len(np.unique(varied.colours(value + np.linspace(0, 1, 1000)), axis=0)) > 100 / (1 + abs(value))


def test_a_fluid_at_rest_is_not_painted_by_its_round_off():
    # 1e-15 of a cell a step: what sums of populations leave; a hundred-thousandth of that speed is none of a flow.
    still = shot(1, 0.0)
    cell = still.grids["fields"].spacing[0]
    per_step = cell * still.step / still.time
    still.grids["fields"].cells["velocity"] += 1e-15 * per_step * np.random.default_rng(0).random((30, 50, 3))
    assert round_off(still, Look(), cell)["m/s"] == pytest.approx(1e-12 * per_step)
    found = survey([still], Look())
    assert found.field is not None
    assert found.field.uniform == 0.0
    slow = shot(1, 1e-9 * per_step)
    assert survey([slow], Look()).field.uniform is None
    assert not survey([still], Look(arrows=10)).fastest


def test_a_figure_in_pixels_has_them(jet, tmp_path):
    path = write_figure([jet], Wanted(size=800), tmp_path / "wide.png")
    height, width = cv2.imread(str(path)).shape[:2]
    assert 780 <= max(height, width) <= 802
    path = write_figure([jet], Wanted(size="85 mm", style="paper"), tmp_path / "column.png")
    assert cv2.imread(str(path)).shape[1] <= 85 / 25.4 * 300 + 2
