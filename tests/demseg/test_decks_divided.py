"""volonoi: polygons of a deck's discs fill its domain, stand thick apart, and overlap by what they are pressed."""

import numpy as np
import pytest

from porescale.cli import demseg
from porescale.common.core.errors import InputError
from porescale.dem.prepare.tessellate import area
from porescale.demseg.build import Options
from porescale.demseg.deck import read_deck
from porescale.demseg.divide import divided
from porescale.demseg.run import read
from porescale.demseg.tension import tensions
from tests.reference import decks

RANDOM = "0 0 0\n1d-6 0 0\n1\n2.5 1d8 .25d8 0 0 27\n0 30 0 30 0.1\n1 2\n1\n0.5\n"
"""82 discs in a square of 30, thick 0.1."""
SIDE, GAP = 30.0, 0.1


def outlines(deck):
    """Corners (k, 2) of each polygon."""
    return [np.array(body.segments)[:, :2] for body in deck.bodies]


def made(tmp_path, name, *more):
    """The deck that the command makes, in a folder of its own."""
    folder = decks.write(tmp_path / "discs", RANDOM)
    assert demseg.volonoi(folder, out=tmp_path / "out", **dict(more)) == 0
    text = (tmp_path / "out" / f"in_gm_{name}.dat").read_text(encoding="utf-8")
    return decks.write(tmp_path / name, text)


def distance(point, one, other):
    """From a point to the line between two."""
    way = other - one
    share = np.clip((point - one) @ way / (way @ way), 0.0, 1.0)
    return np.hypot(*(one + share * way - point))


def nearest(polygons):
    """Least distance of a corner of each polygon from the sides of all others."""
    found = []
    for k, own in enumerate(polygons):
        away = [distance(p, a, b) for j, it in enumerate(polygons) if j != k
                for a, b in zip(it, np.roll(it, -1, axis=0), strict=True) for p in own]  # fmt: skip
        found.append(min(away))
    return np.array(found)


@pytest.mark.parametrize("name", ["tri", "volo"])
def test_polygons_fill_the_domain_but_for_the_gaps_between_them(tmp_path, name):
    deck = read_deck(made(tmp_path, name))
    polygons = outlines(deck)
    if name == "volo":
        assert len(polygons) == 82
    else:
        # Euler: n seeds of which h are on the sides make 2 n - 2 - h triangles; about 4 sqrt(n) are on the sides.
        assert len(polygons) == pytest.approx(2 * 82 - 2 - 4 * 82**0.5, abs=8)
    areas = np.array([area(it) for it in polygons])
    around = sum(np.hypot(*(np.roll(it, -1, axis=0) - it).T).sum() for it in polygons)
    # Each side was moved inwards by half the gap: of the domain is left all but a strip of GAP/2 along every side, but
    # for the corners, tan(half the turn) (GAP/2)^2 each, and for corners where short sides were.
    corners = sum(len(it) for it in polygons)
    assert areas.min() > 0.0
    assert areas.sum() + 0.5 * GAP * around == pytest.approx(SIDE**2, abs=corners * 4.0 * (0.5 * GAP) ** 2)
    assert abs(areas.sum() - SIDE**2) > corners * 4.0 * (0.5 * GAP) ** 2  # the gaps are seen by that
    # Round-off of places up to 30.  Where a side shorter than the gap was left out, its neighbour is further away.
    apart = nearest(polygons)
    assert apart.min() == pytest.approx(GAP, abs=1e-12)
    assert np.mean(np.abs(apart - GAP) < 1e-12) > 0.9


@pytest.mark.slow
def test_neighbours_overlap_by_what_they_are_pressed_and_stay_when_bonded(tmp_path):
    folder = made(tmp_path, "volo", ("pressed", 0.008))
    plain = read(folder, Options())
    backs = np.array([row[3] for row in tensions(plain.built)])
    # II-4.2: 0.008 between sides.  k 0.008; gap and thick round by eps 30.
    assert backs.max() == pytest.approx(1e8 * 0.008, rel=1e-9)


@pytest.mark.slow
def test_without_pressing_nothing_touches(tmp_path):  # the twin that must fail
    plain = read(made(tmp_path, "volo"), Options())
    backs = np.array([row[3] for row in tensions(plain.built)])
    assert np.abs(backs).max(initial=0.0) < 1e8 * 1e-12  # round-off of places up to 30


def test_what_cannot_be_divided_is_named(tmp_path):
    deck = read_deck(decks.write(tmp_path / "a", decks.CLUMP))
    with pytest.raises(InputError, match=r"in_gm\.dat: line 7, body 1: is no single disc"):
        divided(deck, "cells")
    with pytest.raises(InputError, match=r"in_gm\.dat: thick = 0"):
        divided(read_deck(decks.write(tmp_path / "b", decks.DISC)), "cells")
    with pytest.raises(InputError, match=r"--pressed = 0\.2"):
        demseg.volonoi(decks.write(tmp_path / "c", RANDOM), out=tmp_path / "d", pressed=0.2)
    assert not (tmp_path / "d").exists()
    single = decks.DISC.replace("10.0d0 0.0d0\n1 0 0", "10.0d0 0.1d0\n1 0 0")
    with pytest.raises(InputError, match=r"centres of discs: seeds = 1: too few"):
        divided(read_deck(decks.write(tmp_path / "e", single)), "triangles")
    demseg.volonoi(tmp_path / "c", out=tmp_path / "d")
    with pytest.raises(InputError, match="is there already"):
        demseg.volonoi(tmp_path / "c", out=tmp_path / "d")


def test_in_gm_alone_is_divided_and_named_with_its_folder(tmp_path):
    folder = decks.write(tmp_path / "deck", RANDOM)
    (folder / "in_bc.dat").unlink()
    assert demseg.volonoi(folder, out=tmp_path / "out") == 0
    assert (tmp_path / "out" / "in_gm_tri.dat").exists()
    decks.write(folder, decks.DISC.replace("10.0d0 0.0d0\n1 0 0", "10.0d0 0.1d0\n1 0 0"))
    with pytest.raises(InputError) as caught:
        demseg.volonoi(folder, out=tmp_path / "none")
    assert str(caught.value).startswith(f"{folder / 'in_gm.dat'}, centres of discs: seeds = 1: too few")
