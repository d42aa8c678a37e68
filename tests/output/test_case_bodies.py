"""Drawings of bodies for cases: all are there, pieces have colours, cracks lie where bonds broke."""

import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from porescale.dem.bodies.bonding import bond
from porescale.dem.bodies.frames import chain, framed, polygon
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.output.case import stage
from porescale.output.case_bodies import (
    DUST,
    LARGEST,
    PIECES,
    Shot,
    by_piece,
    draw_bodies,
    draw_cracks,
    frame,
    keep,
    pixels,
    shot,
)
from porescale.validation.dem.rock import DENSITY, law
from porescale.validation.dem.segments import OPEN

SQUARE = np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.01), (0.0, 0.01)])


def bonded():
    """Three squares in a row, a row of three discs, a disc by itself and a segment; all that touches is bonded."""
    discs = make_discs([(0.1, 0.0), (0.1199, 0.0), (0.1398, 0.0), (0.3, 0.0)], 0.01, DENSITY)
    frames = [polygon(np.add(SQUARE, (x, 0.0)), 0.001, DENSITY) for x in (0.0, 0.0119, 0.0238)]
    rod = chain([(0.0, 0.2), (0.1, 0.2)], 0.001, DENSITY)
    grains = framed(discs, [*frames, rod], law(), Box((-1.0, -1.0), (1.0, 1.0), **OPEN))
    assert bond(grains) == 6
    return grains


def test_pieces_have_colours_and_bodies_alone_are_grey():
    grains = bonded()
    colours = by_piece(grains, shot(grains))
    squares, rod = slice(4, 16), slice(16, 18)
    assert set(colours[:3] + colours[squares]) == {LARGEST, PIECES[0]}  # three bodies in each, whichever counts more
    assert len(set(colours[:3])) == len(set(colours[squares])) == 1
    assert colours[3] == DUST
    assert set(colours[rod]) == {DUST}
    broken = Shot(grains.discs.position, np.zeros_like(grains.bonds.whole))
    assert set(by_piece(grains, broken)) == {DUST}


def test_discs_polygons_and_segments_are_drawn_and_cracks_lie_where_bonds_broke():
    grains = bonded()
    at = shot(grains)
    at.whole[grains.bonds.partners(grains.segments)[:, 0] == 0] = 0
    figure, (axes,) = stage(1, 2.01, 1.99)
    draw_bodies(axes, grains, at)
    draw_cracks(axes, grains, at, 0.01)
    frame(axes, (-0.1, 0.4, -0.1, 0.3))
    ellipses, polygons, rods, cracks = axes.collections
    assert isinstance(ellipses, EllipseCollection)
    assert len(ellipses.get_offsets()) == 4
    assert isinstance(polygons, PolyCollection)
    assert len(polygons.get_paths()) == 3
    assert isinstance(rods, LineCollection)
    assert len(rods.get_segments()) == 1
    (line,) = cracks.get_segments()
    assert line.mean(axis=0) == pytest.approx((0.10995, 0.0), abs=1e-12)
    assert np.hypot(*(line[1] - line[0])) == pytest.approx(0.01)
    assert line[0, 0] == pytest.approx(line[1, 0])  # across the way between the discs
    at.position[0, 0] -= 0.05  # parted: a gap is no crack
    draw_cracks(axes, grains, at, 0.01)
    assert not axes.collections[-1].get_segments()
    image = pixels(figure)
    assert image.shape == (198, 200, 3)  # even sides


def test_a_further_picture_is_kept_beside_the_first(tmp_path):
    figure, _ = stage(1, 2.0, 2.0)
    keep(figure, tmp_path / "out" / "more.png")
    assert (tmp_path / "out" / "more.png").read_bytes().startswith(b"\x89PNG")
