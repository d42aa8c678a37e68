"""Checkpoints: damage is found, never returned; what cannot be held is refused."""

import random

import h5py
import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.record.checkpoint import read_checkpoint, read_header, write_checkpoint

STATE = {"step": 3, "state": {"x": np.arange(4000.0).reshape(-1, 4), "on": True, "name": "a/b.c"}}


def same(one, other):
    return (
        one["step"] == other["step"]
        and one["state"]["x"].tobytes() == other["state"]["x"].tobytes()
        and one["state"]["name"] == other["state"]["name"]
        and one["state"]["on"] is other["state"]["on"]
    )


@pytest.fixture
def path(tmp_path):
    """A checkpoint of STATE."""
    write_checkpoint(tmp_path / "checkpoint.h5", STATE)
    return tmp_path / "checkpoint.h5"


def test_no_flipped_bit_goes_unnoticed(path):
    whole = bytearray(path.read_bytes())
    dice, found = random.Random(3), 0
    for _ in range(150):
        damaged, place = bytearray(whole), dice.randrange(len(whole))
        damaged[place] ^= 1 << dice.randrange(8)
        path.write_bytes(damaged)
        try:
            read = read_checkpoint(path)
        except InputError as error:
            found += error.code == 2
        else:
            assert same(read, STATE)
    # 32 000 of about 40 000 bytes are data: of 150 flips at random places most hit one.
    assert found > 75


def test_without_checksums_flips_would_go_unnoticed(tmp_path):
    # The twin: the same array stored plainly comes back wrong and nobody says so.
    path = tmp_path / "plain.h5"
    with h5py.File(path, "w") as file:
        file["x"] = STATE["state"]["x"]
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    with h5py.File(path, "r") as file:
        assert file["x"][...].tobytes() != STATE["state"]["x"].tobytes()


@pytest.mark.parametrize("size", [0, 1, 100, 5000])
def test_a_cut_file_is_named_in_one_line(path, size):
    path.write_bytes(path.read_bytes()[:size])
    for read in (read_checkpoint, read_header):
        with pytest.raises(InputError, match=r"checkpoint\.h5.*damaged") as caught:
            read(path)
        assert len(str(caught.value).splitlines()) == 1


def test_a_missing_checkpoint_is_named(tmp_path):
    with pytest.raises(InputError, match="there is none"):
        read_checkpoint(tmp_path / "checkpoint.h5")


def test_the_header_comes_without_the_state(path):
    assert read_header(path) == {"step": 3}


@pytest.mark.parametrize("bad", [object(), {1: 2}, np.array([None]), {"deep": {"er": print}}])
def test_what_it_cannot_hold_is_refused_and_the_old_one_kept(path, bad):
    with pytest.raises(TypeError, match=r"state\.odd"):
        write_checkpoint(path, {"odd": bad})
    assert same(read_checkpoint(path), STATE)


@pytest.mark.parametrize("kind", ["PCG64", "MT19937", "Philox", "SFC64"])
def test_a_generator_goes_on_where_it_was(tmp_path, kind):
    generator = np.random.Generator(getattr(np.random, kind)(5))
    generator.normal(size=3)
    write_checkpoint(tmp_path / "c.h5", {"random": generator.bit_generator.state})
    expected = generator.normal(size=10)
    other = np.random.Generator(getattr(np.random, kind)(6))
    other.bit_generator.state = read_checkpoint(tmp_path / "c.h5")["random"]
    assert other.normal(size=10).tobytes() == expected.tobytes()


def test_records_and_foreign_byte_orders_keep_their_types(tmp_path):
    record = np.zeros(3, [("a", "<f8"), ("b", [("c", ">i4", (2,))])])
    record["b"]["c"] = 7
    content = {"record": record, "big": np.arange(3, dtype=">f8"), "text": np.array(["ab", "c"]), "empty": np.array("")}
    write_checkpoint(tmp_path / "c.h5", content)
    read = read_checkpoint(tmp_path / "c.h5")
    for key, array in content.items():
        assert (read[key].dtype, read[key].shape) == (array.dtype, array.shape)
        assert read[key].tobytes() == array.tobytes()
