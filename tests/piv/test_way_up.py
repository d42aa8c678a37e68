"""Pictures and films that lie on their sides in their files are read the way up that every viewer shows them."""

import struct
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from porescale.piv.images.film import open_film, picture

SHOWN = np.add.outer(40 * np.arange(4), 9 * np.arange(5)).astype(np.uint8)
STORED = {
    1: SHOWN, 2: SHOWN[:, ::-1], 3: SHOWN[::-1, ::-1], 4: SHOWN[::-1], 5: SHOWN.T, 6: np.rot90(SHOWN),
    7: SHOWN[::-1, ::-1].T, 8: np.rot90(SHOWN, -1),
}  # fmt: skip
"""What a file holds of the picture by its orientation (Exif 2.32, tag 274)."""


@pytest.mark.parametrize("orientation", STORED)
@pytest.mark.parametrize("kind", ["png", "tif"])
def test_a_picture_is_read_the_way_up_that_its_file_says(tmp_path: Path, orientation: int, kind: str) -> None:
    stored, said = Image.fromarray(np.ascontiguousarray(STORED[orientation])), Image.Exif()
    said[274] = orientation
    stored.save(tmp_path / f"a.{kind}", exif=said)
    np.testing.assert_array_equal(picture(tmp_path / f"a.{kind}"), SHOWN)


@pytest.mark.parametrize("deep", [np.uint8, np.uint16])
def test_grey_levels_of_any_depth_and_the_luminance_of_colours_stay(tmp_path: Path, deep: type) -> None:
    levels = SHOWN.astype(deep) * (1 if deep == np.uint8 else 200)
    Image.fromarray(levels).save(tmp_path / "a.png")
    np.testing.assert_array_equal(picture(tmp_path / "a.png"), levels)
    Image.fromarray(np.dstack([SHOWN] * 3 + [np.full_like(SHOWN, 9)]), "RGBA").save(tmp_path / "b.png")
    np.testing.assert_array_equal(picture(tmp_path / "b.png"), SHOWN)


SIZE = 64, 96
"""Rows and columns of the film's pictures as stored."""
ACROSS = {0: (1, 0, 0, 1), 90: (0, 1, -1, 0), 180: (-1, 0, 0, -1), 270: (0, -1, 1, 0)}
"""a, b, c, d of the matrix in the header of a track (ISO 14496-12) by the degrees it turns with the clock."""


@pytest.mark.parametrize("degrees", ACROSS)
def test_a_film_of_a_phone_is_read_the_way_up_that_its_file_says(tmp_path: Path, degrees: int) -> None:
    stored = np.add.outer(2 * np.arange(SIZE[0]), np.arange(SIZE[1])).astype(np.uint8)
    path = tmp_path / "film.mp4"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("mpeg4", rate=25, options={"flags": "+qscale", "global_quality": "118"})
        stream.height, stream.width, stream.pix_fmt = *SIZE, "yuv420p"
        for frame in [av.VideoFrame.from_ndarray(stored, format="gray")] * 2 + [None]:
            for packet in stream.encode(frame):
                container.mux(packet)
    whole = path.read_bytes()
    at = whole.index(b"tkhd") + 44  # its matrix, after times, number, length, layer and volume
    a, b, c, d = (0x10000 * it for it in ACROSS[degrees])
    path.write_bytes(whole[:at] + struct.pack(">5i", a, b, 0, c, d) + whole[at + 20 :])
    seen = list(open_film([path]))
    shown = np.rot90(stored, -degrees // 90)
    assert [it.shape for it in seen] == [shown.shape] * 2
    # Levels come back within two from compression at the least loss; turned otherwise they differ by tens.
    assert np.abs(seen[0] - shown.astype(float)).max() <= 3
