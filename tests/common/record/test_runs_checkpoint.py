"""Checkpoints: damage is found, never returned; what cannot be held is refused."""

import json
import random

import h5py
import numpy as np
import pytest

from porescale.common.core import seal
from porescale.common.core.errors import InputError
from porescale.common.record import checkpoint
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


def refused(path, content):
    """Whether ``content`` in place of the checkpoint is refused."""
    path.write_bytes(content)
    try:
        read_checkpoint(path)
    except InputError as error:
        return error.code == 2
    return False


def edits(whole, count=150):
    """Copies in which one byte is another, everywhere in the file, and at each of its ends."""
    dice = random.Random(3)
    for place in [0, 1, len(whole) - 1, len(whole) - 33, *(dice.randrange(len(whole)) for _ in range(count))]:
        damaged = bytearray(whole)
        damaged[place] ^= 1 << dice.randrange(8)
        yield bytes(damaged)


def test_every_edit_of_a_byte_is_refused(path):
    whole = path.read_bytes()
    assert all(refused(path, damaged) for damaged in edits(whole))
    assert not refused(path, whole)


def test_without_the_seal_some_edits_would_go_unnoticed(path, monkeypatch):
    monkeypatch.setattr(checkpoint, "_unbroken", lambda path, has_seal: True)
    found = [refused(path, damaged) for damaged in edits(path.read_bytes())]
    assert 20 < sum(found) < len(found)


@pytest.mark.parametrize("change", ["attribute", "array", "more", "less"])
def test_what_another_program_changed_is_refused(path, change):
    whole = path.read_bytes()
    if change == "more":
        path.write_bytes(whole + b" ")
    elif change == "less":  # the seal is cut off
        path.write_bytes(whole[: -seal.LENGTH])
    else:
        with h5py.File(path, "r+") as file:
            array = file["arrays/00000"]
            if change == "array":
                array[17] += 1.0
            else:
                array.attrs["place"] = "state.y"
    with pytest.raises(InputError, match="its seal is broken"):
        read_checkpoint(path)


def test_a_checkpoint_from_before_there_were_seals_is_read(path):
    with h5py.File(path, "r+") as file:
        tree = json.loads(file["tree"][...].tobytes())
        del tree["sealed"], file["tree"]
        text = np.frombuffer(json.dumps(tree).encode(), np.uint8)
        file.create_dataset("tree", data=text, fletcher32=True, chunks=True)
    assert seal.sealed(path) is None
    assert same(read_checkpoint(path), STATE)


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
