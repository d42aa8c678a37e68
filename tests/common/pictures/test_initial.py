"""A scene before it runs: all that it has stands in the picture with a label, none upon another."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.lines import Line2D

from porescale.common.core.errors import InputError
from porescale.common.pictures.initial import Feature, Initial, Lens, initial_figure
from porescale.common.pictures.look import Look
from porescale.common.record.model import Cloud, Grid, Snapshot


def built(width: float, height: float) -> tuple[Snapshot, Look]:
    """A box of cells with one grain in its middle."""
    cell = max(width, height) / 40
    shape = max(2, round(height / cell)), max(2, round(width / cell))
    grid = Grid((0.0, 0.0), (width / shape[1], height / shape[0]), {"velocity": np.zeros((*shape, 3))})
    data = {"radius": np.array([0.2 * min(width, height)])}
    cloud = Cloud(np.array([[width / 2, height / 2]]), data)
    return Snapshot(0.0, 0, {"fields": grid}, {"grains": cloud}), Look(title="a box", view=(0, width, 0, height))


def everything(w: float, h: float) -> list[Feature]:
    """Two of each, at the same places and at other ones."""
    return [
        Feature("side", "left, right: wall", path=((0, 0), (0, h)), at=(w, h / 2)),
        Feature("open", "top: pressure 0 Pa", path=((0, h), (w, h))),
        Feature(
            "moves", "gate, rises at 0.1 m/s at 0 s", path=((w / 2, 0), (w / 2, h)), course=((w / 2, 0), (w / 2, h))
        ),
        *(Feature("measures", f"probe {k}", marks=((w * k / 7, h / 2),)) for k in range(7)),
        *(Feature("measures", f"region {k}", area=((0, 0), (w, 0), (w, h), (0, h))) for k in range(2)),
    ]


@pytest.mark.parametrize(("width", "height"), [(0.01, 0.1), (0.05, 0.1), (0.1, 0.1), (0.1, 0.02), (0.1, 0.01)])
def test_labels_stand_apart_and_within_the_picture(width, height):
    snapshot, look = built(width, height)
    features = everything(width, height)
    lens = Lens(0.001, (width / 2, height / 2), 0.4 * min(width, height), "16 cells per diameter")
    figure = initial_figure(snapshot, Initial(look, features, lens))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    extents = {it.get_text(): it.get_window_extent(canvas.get_renderer()) for it in figure.texts}
    assert {it.label for it in features} <= set(extents)
    wide, high = figure.get_size_inches() * figure.dpi
    for (one, a), (other, b) in combinations(extents.items(), 2):
        assert not a.padded(-1).overlaps(b.padded(-1)), (one, other)
    for text, box in extents.items():
        assert box.x0 >= -1, text
        assert box.x1 <= wide + 1, text
        assert box.y0 >= -1, text
        assert box.y1 <= high + 1, text


def test_leaders_end_at_what_labels_name():
    snapshot, look = built(0.1, 0.1)
    figure = initial_figure(snapshot, Initial(look, [Feature("measures", "probe", marks=((0.03, 0.02),))]))
    dot = next(line for line in figure.get_children() if isinstance(line, Line2D) and len(line.get_xdata()) == 1)
    at = figure.transFigure.transform((dot.get_xdata()[0], dot.get_ydata()[0]))
    # Axes are in cm; a dot of the figure is a hundredth of an inch.
    assert np.abs(at - figure.axes[0].transData.transform((3.0, 2.0))).max() < 0.5


def test_the_lens_has_a_line_at_every_cell():
    snapshot, look = built(0.1, 0.1)
    lens = Lens(0.0025, (0.05, 0.05), 0.04, "16 cells per diameter")
    figure = initial_figure(snapshot, Initial(look, [], lens))
    inside = figure.axes[1]
    lines = inside.collections[-1].get_segments()
    upright = sorted(line[0][0] for line in lines if line[0][0] == line[1][0])
    low, high = inside.get_xlim()
    unit = 1e2 if high - low < 20 and high > 1 and high < 20 else 1e3
    assert np.allclose(np.diff(upright), 0.0025 * unit)
    assert len(upright) == pytest.approx((high - low) / (0.0025 * unit), abs=1)


def test_a_built_scene_shows_its_sections():
    import porescale as ps

    scene = ps.Scene(
        domain={"width": 0.02, "height": 0.01, "left": {"kind": "velocity", "velocity": [0.01, 0]},
                "right": {"kind": "pressure", "pressure": 0}},
        time={"end": 0.1}, output={"snapshot_interval": 0.1, "series_interval": 0.1},
        fluid={"spacing": 5e-4, "viscosity": 1e-5, "step": 1e-3},
        disc=[{"x": 0.005, "y": 0.005, "diameter": 0.003, "velocity": [0.01, 0.0]}],
        probe=[{"name": "back", "x": 0.012, "y": 0.005}], flux=[{"start": [0.015, 0], "end": [0.015, 0.01]}],
        gravity=[0, 0],
    )  # fmt: skip
    from porescale.output.features import features_of, lens_of

    labels = [it.label for it in features_of(scene)]
    assert any(it.startswith("left: velocity (0.01, 0) m/s") for it in labels)
    assert "probe back" in labels
    assert "flux 0" in labels
    assert any("disc 0, 3 mm across, driven" in it for it in labels)
    driven = next(it for it in features_of(scene) if it.label.startswith("disc 0"))
    # 0.1 s at 1 cm/s are 1 mm.
    assert driven.course[-1] == pytest.approx((0.006, 0.005), rel=1e-12)
    simulation = ps.build(scene)
    lens = lens_of(scene, simulation.snapshot(), 5e-4)
    assert "6 cells per diameter" in lens.text
    assert scene.drawn_at_once
    picture = scene.picture()
    assert picture.pixels.std() > 10
    assert "data:image/png" in scene._repr_mimebundle_()["text/html"]


def test_a_picture_is_a_png_file():
    from pathlib import Path

    from porescale.common.cli.check import drawing

    assert drawing() == Path("scene.png")
    with pytest.raises(InputError, match=r"name it scene\.png"):
        drawing(Path("scene.svg"))


def test_a_look_at_what_is_not_recorded_is_refused():
    import porescale as ps

    tables = {
        "domain": {"width": 0.02, "height": 0.01}, "time": {"end": 0.1}, "gravity": [0, 0],
        "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
        "fluid": {"spacing": 5e-4, "viscosity": 1e-5, "step": 1e-3},
    }  # fmt: skip
    for look, said in (
        ({"field": "vorticity"}, "look.field = 'vorticity': is not recorded"), ({"limits": [2, 1]}, "look.limits"),
        ({"view": [0.02, 0.01, 0, 0.01]}, "look.view"), ({"size": 3}, "look.size"), ({"fields": "x"}, "look.fields"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=said):
            ps.Scene(**tables, look=look)
    assert ps.Scene(**tables, look={"field": "pressure", "view": ["1 cm", "2 cm", 0, 0.01]}).look.view[0] == 0.01


@pytest.mark.parametrize(("plain", "unit"), [(True, ""), (False, " (cm)")])
def test_axes_have_units_where_places_do(plain, unit):
    snapshot, look = built(0.1, 0.1)
    axes = initial_figure(snapshot, Initial(replace(look, plain=plain), [])).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == (f"x{unit}", f"y{unit}")
