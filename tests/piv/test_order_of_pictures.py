"""Pictures stand in the order of the numbers in their names, and a number that is missing is said."""

import warnings
from pathlib import Path

import cv2
import numpy as np
import pytest

from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.piv import measure
from porescale.piv.images.film import open_film
from porescale.piv.images.masks import masks
from porescale.piv.images.numbered import doubt_of_order, natural


def write(folder: Path, names: list[str]) -> Path:
    """Pictures of 40 x 48 px, the grey level of each its place in ``names``."""
    folder.mkdir(exist_ok=True)
    for k, name in enumerate(names):
        cv2.imwrite(str(folder / name), np.full((40, 48), k, np.uint8))
    return folder


def levels(film) -> list[int]:
    return [int(it[0, 0]) for it in film]


COUNTED = [f"img{k}.png" for k in range(12)]


@pytest.mark.parametrize("pattern", [None, "img*.png"])
def test_pictures_of_a_folder_stand_in_the_order_of_their_numbers(tmp_path, pattern):
    folder = write(tmp_path / "film", COUNTED)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert levels(open_film([folder if pattern is None else folder / pattern])) == list(range(12))
    with pytest.warns(PorescaleWarning, match="in the order of their names. text"):
        given = open_film(sorted(folder.iterdir()))
    assert levels(given)[:3] == [0, 1, 10]  # one by one, as a shell gives them: as they were given


def test_masks_of_a_folder_stand_in_the_order_of_their_numbers(tmp_path):
    film = open_film([write(tmp_path / "film", COUNTED)])
    (tmp_path / "masks").mkdir()
    for k, name in enumerate(COUNTED):
        solid = np.zeros((40, 48), np.uint8)
        solid[:, : k + 1] = 255
        cv2.imwrite(str(tmp_path / "masks" / name), solid)
    assert [int(it[0].sum()) for it in masks(str(tmp_path / "masks"), [], film)] == list(range(1, 13))


def test_natural_order_is_that_of_whole_numbers():
    names = ["a2b10.png", "a2b9.png", "a10b1.png", "a02b10.png", "b.png"]
    assert sorted(map(Path, names), key=natural) == [
        Path(it) for it in ["a2b9.png", "a02b10.png", "a2b10.png", "a10b1.png", "b.png"]
    ]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["i1.png", "i2.png", "i4.png", "i5.png"], "jump: i2.png to i4.png; displacements there are of a longer time"),
        (["i1.png", "i10.png", "i2.png"], "in the order of their names' text (i1.png, i10.png, i2.png), not of the"),
        ([f"i{k}.png" for k in range(0, 50, 10)], ""),
        (["i1.png", "i2.png"], ""),
        (["i1.png", "i5.png", "i20.png", "i21.png"], ""),  # times rather than counts
        (["i3.png", "i2.png", "i1.png"], ""),  # backwards on purpose
        (["one.png", "two.png", "three.png"], ""),
        (["a1b1.png", "a2b2.png", "a4b4.png", "a5b5.png"], ""),
    ],
)
def test_a_jump_of_numbers_and_an_order_of_text_are_said_and_nothing_else(names, said):
    found = doubt_of_order([Path(it) for it in names])
    assert said in found
    assert bool(found) == bool(said)


def test_only_the_chosen_pictures_are_doubted_and_the_warning_is_at_the_callers_line(tmp_path):
    folder = write(tmp_path / "film", [f"img{k:03d}.png" for k in (1, 2, 3, 5, 6)])
    for image, path in enumerate(sorted(folder.iterdir())):
        cv2.imwrite(str(path), np.random.default_rng(image).integers(0, 255, (64, 64)).astype(np.uint8))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        open_film([folder], end=3)
    with pytest.warns(PorescaleWarning, match=r"img003\.png to img005\.png") as caught, pytest.raises(InputError):
        measure(folder)
    assert Path(caught[0].filename) == Path(__file__)
