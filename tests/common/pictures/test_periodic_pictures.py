"""What reaches over a periodic side is seen at the other, in pictures of all kinds, whole and once."""

import json
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from porescale.builders.build import build
from porescale.common.page.page import script
from porescale.common.pictures.axes import draw
from porescale.common.pictures.look import GRAIN, Look, rgb, survey
from porescale.common.pictures.picture import Painter
from porescale.common.pictures.repeated import again
from porescale.common.record.model import Cloud, Snapshot
from porescale.output.grain_pictures import chains, numbers
from porescale.output.show import look_of_scene
from tests.reference.scenes import dry, grain

WIDTH, HEIGHT, RADIUS = 0.05, 0.03, 0.006
BOX = Look(view=(0.0, WIDTH, 0.0, HEIGHT), period=(WIDTH, HEIGHT))
MIDDLE, SIDE, CORNER = (0.025, 0.015), (0.049, 0.015), (0.002, 0.029)


def disc(at: tuple[float, float]) -> Snapshot:
    return Snapshot(0.0, 0, {}, {"grains": Cloud(np.array([at]), {"radius": np.array([RADIUS])}, {"radius": "m"})})


def square(at: tuple[float, float]) -> Snapshot:
    corners = np.array(at) + 0.7 * RADIUS * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    loop = np.array([0, 4]), np.arange(4)
    lines = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
    return Snapshot(0.0, 0, {}, {"frames": Cloud(corners, {"radius": np.full(4, 1e-4)}, {}, lines, loop)})


def area(snapshot: Snapshot, look: Look) -> int:
    """Pixels in the colour of grains."""
    image = Painter(survey([snapshot], look)).canvas.draw(snapshot)
    return int((image == rgb(GRAIN)).all(-1).sum())


@pytest.mark.parametrize("made", [disc, square])
@pytest.mark.parametrize("at", [SIDE, CORNER])
def test_the_area_that_is_painted_is_the_same_wherever_a_body_lies(made, at):
    look = Look(cloud="grains", shapes="frames", view=BOX.view, period=BOX.period)
    once = Look(cloud="grains", shapes="frames", view=BOX.view)
    whole = area(made(MIDDLE), look)
    # Rims are cut at the sides: two pixels on each of two cuts as long as the body.
    cut = 4 * 2 * np.sqrt(whole)
    assert area(made(at), look) == pytest.approx(whole, abs=cut)
    # The check that must fail: seen once, a third and more of it is lost.
    assert whole - area(made(at), once) > 2 * cut


def test_axes_have_the_images_too():
    for at, count in ((MIDDLE, 1), (SIDE, 2), (CORNER, 4)):
        axes = Figure().add_subplot()
        draw(disc(at), BOX, axes)
        assert len(axes.collections[0].get_offsets()) == count
        axes = Figure().add_subplot()
        draw(square(at), Look(cloud="", shapes="frames", view=BOX.view, period=BOX.period), axes)
        assert len(axes.collections) == 2 * count  # outlines, and strips of lines


def test_pages_show_the_images_that_pictures_show(node, tmp_path):
    (tmp_path / "page.js").write_text(script(), encoding="utf-8")
    for period in ((0.0, 0.0), (WIDTH, 0.0), (WIDTH, HEIGHT)):
        for at in (MIDDLE, SIDE, CORNER):
            corner = np.array([at])
            expected = again(corner - RADIUS, corner + RADIUS, Look(period=period))[1]
            found = node(f"images({json.dumps([*at, RADIUS, *period])[1:-1]})", tmp_path / "page.js")
            assert sorted(map(tuple, found)) == sorted(map(tuple, expected.tolist()))


def test_a_scene_says_where_it_is_periodic():
    sides = {"domain__left": "periodic", "domain__right": "periodic"}
    pair = {"density": 2500, "grain": [grain(0.0119, 0.004), grain(0.0008995, 0.004)]}
    simulation = build(dry(grains=pair, gravity=[0.0, 0.0], output__contacts=True, **sides))
    look = look_of_scene(simulation.scene.to_dict(), "pair")
    assert look.period == (0.012, 0.0)
    shown = simulation.snapshot()
    picture: Any = chains(shown, look)
    discs, lines = picture.axes[0].collections
    assert len(discs.get_offsets()) == 3
    assert len(lines.get_segments()) == 2  # the contact, from both sides
    counted: Any = numbers(shown, look)
    assert len(counted.axes[0].collections[0].get_offsets()) == 3
    assert look_of_scene(dry(grains=pair).to_dict(), "pair").period == (0.0, 0.0)
