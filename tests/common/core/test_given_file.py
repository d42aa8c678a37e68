"""Files that people name are read whole only if that ends, and fits."""

import os

import pytest

from porescale.common.core.errors import InputError
from porescale.common.core.given_file import LARGEST, given_bytes, given_text, require_finite
from porescale.common.schema.scene_file import read as read_toml
from porescale.common.studies.parameter_table import read_points
from porescale.dem.prepare.compaction import read_circles
from porescale.demseg.numbers import Reader
from porescale.demseg.state import read_state
from porescale.piv.fields.field import read as read_field
from porescale.piv.images.film import open_film, picture

READERS = {
    "scene.toml": read_toml, "table.csv": read_points, "table.toml": read_points, "in_gm.dat": Reader,
    "in_cf.dat": read_state, "circles.csv": read_circles, "field.csv": read_field, "a.png": picture,
}  # fmt: skip


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("kind", ["pipe", "device", "huge"])
def test_what_reading_would_not_end_of_is_refused(tmp_path, name, kind):
    path = tmp_path / name
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        with path.open("wb") as file:
            file.truncate(LARGEST + 1)  # of nothing: takes no room
    with pytest.raises(InputError, match="is too large" if kind == "huge" else "is no regular file"):
        READERS[name](path)


def test_a_film_from_a_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / "film.mp4")
    with pytest.raises(InputError, match="is no regular file"):
        list(open_film([tmp_path / "film.mp4"]))


def test_a_file_of_the_largest_size_is_read(tmp_path):  # the twin
    path = tmp_path / "file"
    path.write_bytes(b"\xef\xbb\xbf" + "Körner\n".encode())
    assert (given_text(path), len(given_bytes(path))) == ("Körner\n", 11)
    require_finite(path, 11)
    with pytest.raises(OSError, match="is too large: 0 MiB"):
        require_finite(path, 10)
