"""A mask marks solids whatever its two values are, fits whole pictures, and is never without effect in silence."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from porescale.common.core.errors import InputError
from porescale.piv import measure
from porescale.piv.images import flows
from porescale.piv.images.film import open_film
from porescale.piv.images.masks import bitmap, masks
from porescale.piv.images.synth import Camera, pair

SIZE = (64, 80)
SOLID = np.zeros(SIZE, bool)
SOLID[10:30, 20:50] = True


@pytest.fixture(scope="module")
def frames() -> list[np.ndarray]:
    made = pair(flows.uniform(2.0, 1.0), Camera(SIZE), 1)
    return [made.first, made.second, made.first]


def saved(path: Path, image: np.ndarray) -> str:
    Image.fromarray(image).save(path)
    return str(path)


@pytest.mark.parametrize(
    "white", [np.uint8(1), np.uint8(100), np.uint8(200), np.uint8(255), np.uint16(255), np.uint16(65535), np.float32(1)]
)
def test_a_bitmap_of_two_values_is_solid_at_the_larger(tmp_path, frames, white):
    film = open_film([saved(tmp_path / f"{k}.png", it) for k, it in enumerate(frames)])
    name = saved(tmp_path / "mask.tif", SOLID.astype(white.dtype) * white)
    for found in masks(name, [], film):
        assert np.array_equal(found, SOLID)


def test_a_bitmap_of_many_values_is_solid_above_half_of_white():
    soft = np.where(SOLID, 250, 3).astype(np.uint8)
    soft[30, 20:50] = 120
    soft[31, 20:50] = 130
    whole = SOLID.copy()
    whole[31, 20:50] = True
    assert np.array_equal(bitmap(soft), whole)
    assert not bitmap(np.zeros(SIZE, np.uint8)).any()
    assert bitmap(np.full(SIZE, 255, np.uint8)).all()


@pytest.mark.parametrize(
    ("image", "said"),
    [
        (cv2.blur(SOLID.astype(np.uint16) * 255, (3, 3)), "no pixel above half of white: 0 to 255 of 65535"),
        (np.full(SIZE, 1, np.uint8), "no pixel above half of white: 1 to 1 of 255"),
    ],
)
def test_a_bitmap_that_would_mask_nothing_is_refused(tmp_path, frames, image, said):
    name = saved(tmp_path / "mask.png", image)
    with pytest.raises(InputError, match=said) as caught:
        measure(*frames[:2], mask=name)
    (fault,) = caught.value.faults
    assert (fault.key, fault.value) == ("mask", name)


@pytest.mark.parametrize("region", [None, (10, 10, 74, 62)])
@pytest.mark.parametrize("shape", [(60, 80), (64, 90), (128, 160)])
@pytest.mark.parametrize("key", ["mask", "reject"])
def test_a_mask_is_of_the_size_of_the_whole_pictures(tmp_path, frames, region, shape, key):
    wrong = np.zeros(shape, bool)
    wrong[:20, :20] = True
    for given in (wrong, saved(tmp_path / "mask.png", wrong.astype(np.uint8) * 255)):
        for pictures in (frames, frames[:2]):
            with pytest.raises(InputError, match=rf"^{key} = '{shape[1]}x{shape[0]} and 80x64': .*pictures' size"):
                measure(pictures, **{key: given}, region=region)


def test_a_mask_of_the_right_size_is_cut_to_the_region(frames):
    one, part = (measure(frames[:2], mask=SOLID, region=it) for it in (None, (8, 8, 72, 56)))
    assert one.solid.any()
    for y, row in zip(part.y, part.solid, strict=True):
        for x, solid in zip(part.x, row, strict=True):
            assert solid == SOLID[int(y), int(x)]


@pytest.mark.parametrize("count", [2, 4])
def test_masks_are_as_many_as_frames(tmp_path, frames, count):
    (tmp_path / "masks").mkdir()
    for k in range(count):
        saved(tmp_path / "masks" / f"{k}.png", SOLID.astype(np.uint8) * 255)
    with pytest.raises(InputError, match=rf"has {count} masks.*; give one for every frame"):
        measure(frames, mask=tmp_path / "masks")
    saved(tmp_path / "masks" / "2.png", SOLID.astype(np.uint8) * 255)
    (tmp_path / "masks" / "3.png").unlink(missing_ok=True)
    assert len(measure(frames, mask=tmp_path / "masks")) == 2
