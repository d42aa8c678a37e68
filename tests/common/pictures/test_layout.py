"""No text of a picture lies upon another or out of it, and the inside is to scale, whatever the box's shape."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from porescale.common.pictures.axes import draw
from porescale.common.pictures.layout import STYLES, kinds_of, round_length, screen, stage
from porescale.common.pictures.look import MARKED, Look, survey
from porescale.common.record.model import Cloud, Grid, Snapshot

ASPECTS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
SMALL_OR_FINE = (screen(400), STYLES["paper"], STYLES["talk"])


def box(aspect: float, longest: float = 0.0837) -> Snapshot:
    """Flow of random speeds and a grain in a box of that aspect, whose sides are no round numbers."""
    width, height = (longest * aspect, longest) if aspect < 1 else (longest, longest / aspect)
    nx, ny = max(4, round(60 * width / longest)), max(4, round(60 * height / longest))
    velocity = np.random.default_rng(1).random((ny, nx, 3))
    grid = Grid((0.0, 0.0), (width / nx, height / ny), {"velocity": velocity}, {"velocity": "m/s"})
    data = {"radius": np.array([0.2 * min(width, height)]), "velocity": np.array([[0.1, 0.0, 0.0]])}
    return Snapshot(0.5, 10, {"fields": grid}, {"grains": Cloud(np.array([[width / 2, height / 2]]), data)})


def texts(figure) -> list[tuple[str, object]]:
    """Every text that is seen, with where it is."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    found = []
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            slack = 1e-9 * (high - low)
            ticks = zip(axis.get_ticklabels(), axis.get_ticklocs(), strict=False)
            found += [label for label, at in ticks if low - slack <= at <= high + slack]
            found += [axis.label, axis.get_offset_text()]
        found += [axes.title, axes._left_title, axes._right_title]
    found += [it for it in figure.texts if isinstance(it, Text)]
    for legend in figure.legends:
        found += legend.get_texts()
    return [(it.get_text(), it.get_window_extent(renderer)) for it in found if it.get_visible() and it.get_text()]


def overlapping(figure) -> list[tuple[str, str]]:
    """Pairs of texts of which one lies upon the other, by more than a dot: the size of a rounded extent."""
    shown = [(text, extent.padded(-1.0)) for text, extent in texts(figure)]
    return [(one, other) for (one, a), (other, b) in combinations(shown, 2) if a.overlaps(b)]


@pytest.mark.parametrize(
    ("style", "aspect"),
    [*((screen(1000), it) for it in ASPECTS), *((style, it) for style in SMALL_OR_FINE for it in (0.1, 0.5, 10.0))],
)
def test_no_text_lies_upon_another_at_any_aspect(style, aspect):
    look = Look(title="A disc settles in a long box with a long name, λ = 0.8", colour="velocity", label="speed of it")
    found = survey([box(aspect)], look)
    for headers in (["t = 0.500 s"], [f"({k}) t = 0.{k}00 s" for k in range(4)]):
        figure = stage(found, headers, style).figure
        assert overlapping(figure) == []
        width, height = figure.get_size_inches() * figure.dpi
        for text, extent in texts(figure):
            assert extent.x0 > -1, text
            assert extent.x1 < width + 1, text
            assert extent.y0 > -1, text
            assert extent.y1 < height + 1, text


@pytest.mark.parametrize("letters", ["x" * 300, "é" * 140, "short " + "y" * 200])
def test_a_title_without_blanks_makes_no_picture_wider(letters):
    drawn = [stage(survey([box(2.0)], Look(title=it)), [""], screen(1000)).figure for it in ("a box", letters)]
    plain, long = (it.get_size_inches() for it in drawn)
    assert long[0] == plain[0]
    assert long[1] > plain[1]


@pytest.mark.parametrize("aspect", ASPECTS)
def test_panels_are_to_scale_and_the_figure_is_no_larger_than_it_may_be(aspect):
    style = STYLES["paper"]
    made = stage(survey([box(aspect)], Look()), ["a", "b", "c"], style)
    for _, _, width, height in made.boxes:
        # Sides are whole dots, half a dot off at the most.
        assert abs(width - aspect * height) <= 0.5 + 0.5 * aspect
    assert made.full[0] <= style.width * style.dpi + 2
    assert made.full[1] <= style.height * style.dpi + 2


def test_every_axis_has_two_ticks_where_there_is_room():
    made = stage(survey([box(1.0)], Look()), ["a"], screen(1000))
    for axis in (made.panels[0].xaxis, made.panels[0].yaxis):
        low, high = axis.get_view_interval()
        assert sum(low <= it <= high for it in axis.get_majorticklocs()) >= 2


def test_overlapping_ticks_are_found():
    # The check that must fail: ticks twenty times as dense.
    figure = stage(survey([box(0.1)], Look()), ["a"], screen(400)).figure
    axes = figure.axes[0]
    axes.set_xticks(np.linspace(*axes.get_xlim(), 20))
    assert overlapping(figure)


def test_the_scale_bar_is_as_long_as_it_says():
    found = survey([box(2.0)], Look())
    made = stage(found, ["a"], STYLES["paper"])
    bar = next(it for it in made.figure.axes if it.get_label() == "scale bar")
    per_metre = made.boxes[0][2] / (found.view[1] - found.view[0])
    # A third of 8.37 cm is 2.79 cm: 2 cm are the largest round length below.
    assert bar.get_window_extent().width == pytest.approx(0.02 * per_metre, rel=1e-6)
    assert "2 cm" in [text for text, _ in texts(made.figure)]
    assert [round_length(it) for it in (0.9, 1.0, 2.1, 49.0)] == [0.5, 1.0, 2.0, 20.0]


@pytest.mark.parametrize("aspect", [0.1, 1.0, 10.0])
def test_axes_of_the_user_have_ticks_apart(aspect):
    from matplotlib.figure import Figure

    figure = Figure((6, 5), layout="constrained")
    draw(box(aspect), Look(title="a box"), figure.add_subplot())
    assert overlapping(figure) == []


def test_a_legend_names_what_the_snapshots_have_and_no_more():
    """Every picture of a levee named dry soil and a phreatic line, whether there were any or not."""
    kinds = {0: ("water", "#00a"), 1: ("dry soil", "#a00"), 2: ("wet soil", "#0a0"), MARKED: ("phreatic", "#f00")}
    at = np.array([[0.1, 0.1], [0.2, 0.1]])
    frames = [Snapshot(0.1 * k, k, {}, {"p": Cloud(at, {"layer": np.array([0, 2 * k])})}) for k in range(2)]

    def named(snapshots, **more):
        look = Look(cloud="p", colour="layer", kinds=kinds, dot=0.01, **more)
        return [it.get_label() for it in kinds_of(survey(snapshots, look))]

    assert named(frames[:1]) == ["water"]
    assert named(frames) == ["water", "wet soil"]
    assert named(frames, marks=lambda _: [((0.0, 0.0), (0.1, 0.1))]) == ["water", "wet soil", "phreatic"]
