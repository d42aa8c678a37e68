"""A checkpoint that is cut, spoilt, of another version, scene or program is refused in one line; the run stays."""

import copy
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from porescale.common.record.checkpoint import read_checkpoint, read_header, write_checkpoint
from tests.reference.faults.spoiled import renumbered
from tests.reference.folders import ROOT
from tests.reference.programs import KINDS, Program, program
from tests.reference.same_run import differences

OTHERS = {"column": "tank", "asleep": "column", "framed": "tank", "tank": None, "seeping": "tank", "soil": "tank",
          "bubble": "tank", "air": "seeping"}  # fmt: skip
"""Whose checkpoint each is given: another program's, or another model's of the same one; None: that of the kept run."""
KEPT = ROOT / "tests" / "samples" / "run_format_1.tar.xz"
NAMES = ["tank", *(pytest.param(name, marks=pytest.mark.slow) for name in KINDS if name != "tank")]
"""Quick is what has few kernels, which other tests compile anyway."""


@dataclass(frozen=True)
class Half:
    """A run that is to go on: what runs it, its folder, and one of a run without a break."""

    one: Program
    folder: Path
    untouched: Path


@pytest.fixture(scope="module")
def halves(tmp_path_factory) -> Callable[[str], Half]:
    """Makes a run half done, once for each scene."""
    known: dict[str, Half] = {}

    def make(name: str) -> Half:
        if name not in known:
            one = program(name, tmp_path_factory.mktemp(name))
            made = Half(one, one.place / "run", one.place / "untouched")
            assert one.run(made.folder, "--set", f"time.end={0.5 * one.values['time']['end']}") == 0
            assert one.run(made.untouched) == 0
            known[name] = made
        return known[name]

    return make


def cut(left: float) -> Callable[[Path], None]:
    """Leaves a share of the file."""
    return lambda file: file.write_bytes(file.read_bytes()[: int(left * file.stat().st_size)])


def flip(name: str) -> Callable[[Path], None]:
    """Turns a bit round in the middle of a dataset, the largest array where none is named."""

    def spoil(file: Path) -> None:
        with h5py.File(file) as opened:
            arrays = list(opened["arrays"].values())
            found = opened[name] if name else max(arrays, key=lambda it: it.size * it.dtype.itemsize)
            piece = found.id.get_chunk_info(0)
        content = bytearray(file.read_bytes())
        content[piece.byte_offset + piece.size // 2] ^= 4
        file.write_bytes(content)

    return spoil


def changed(change: Callable[[dict[str, Any]], object]) -> Callable[[Path], None]:
    """A whole file that says something else."""

    def spoil(file: Path) -> None:
        content = copy.deepcopy(read_checkpoint(file))
        change(content)
        write_checkpoint(file, content)

    return spoil


def arrays(part: dict[str, Any]) -> Iterator[tuple[dict[str, Any], str]]:
    """Where arrays of numbers are in a state: the tables that hold them and their names."""
    for key, value in part.items():
        if isinstance(value, dict):
            yield from arrays(value)
        elif isinstance(value, np.ndarray) and value.dtype.kind == "f":
            yield part, key


def replaced(by: Callable[[np.ndarray], np.ndarray], every: bool = False) -> Callable[[Path], None]:
    """The largest array of the state, or ``every`` one, is another."""

    def change(content: dict[str, Any]) -> None:
        found = sorted(arrays(content["state"]), key=lambda it: it[0][it[1]].size)
        for part, key in found if every else found[-1:]:
            part[key] = by(part[key])

    return changed(change)


def lists(part: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The lists of neighbours of a state."""
    if "partner" in part:
        yield part
    for value in part.values():
        if isinstance(value, dict):
            yield from lists(value)


def listed(change: Callable[[dict[str, Any]], object]) -> Callable[[Path], None]:
    """A list of neighbours is another; its checksums are right."""
    return changed(lambda content: [change(rows) for rows in lists(content["state"])])


def put(rows: dict[str, Any], name: str, value: int, at: int = -1) -> None:
    """Writes into a list."""
    assert rows[name].flags.writeable
    rows[name][at] = value


def folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


def another(name: str, halves: Callable[[str], Half], place: Path) -> Path:
    """The folder of a run whose checkpoint is not that of ``name``."""
    other = OTHERS[name]
    if other is not None:
        return halves(other).folder
    shutil.unpack_archive(KEPT, place)
    return place / "run"


WAYS: dict[str, Callable[[Path], object]] = {
    "nothing in it": cut(0.0),
    "cut to a half": cut(0.5),
    "cut by a byte": cut(1.0 - 1e-9),
    "a bit of the state": flip(""),
    "a bit of the tree": flip("tree"),
    "a newer version": lambda file: renumbered(file, 2),
    "no version": lambda file: renumbered(file, None),
    "a text": lambda file: file.write_text("# nothing here\n"),
    "noise": lambda file: file.write_bytes(np.random.default_rng(1).bytes(4000)),
    "a folder": folder,
    "a run's card": lambda file: shutil.copy(file.with_name("card.json"), file),
    "a snapshot": lambda file: shutil.copy(next(file.parent.glob("*.vtkhdf")), file),
    "a list": lambda file: write_checkpoint(file, [1, 2]),  # type: ignore[arg-type]
    "another table": lambda file: write_checkpoint(file, {"x": np.arange(3.0)}),
    "no state": changed(lambda content: content.pop("state")),
    "a state of nothing": changed(lambda content: content.update(state={})),
    "a word for a state": changed(lambda content: content.update(state="fine")),
    "no record": changed(lambda content: content.pop("record")),
    "no seconds": changed(lambda content: content.pop("seconds")),
    "no schedules": changed(lambda content: content.update(schedules={})),
    "rows that were never written": changed(lambda content: content["record"].update(series_bytes=1 << 40)),
    "words for steps": changed(lambda content: content.update(step="many")),
    "an array of one": replaced(lambda it: it.reshape(-1)[:1]),
    "a longer array": replaced(lambda it: np.concatenate((it, it))),
    "an array of words": replaced(lambda it: np.full(it.shape, "one")),
    "an array of truths": replaced(lambda it: np.ones(it.shape, bool)),
    "a neighbour that is none": listed(lambda rows: put(rows, "partner", -1)),
    "a neighbour beyond all": listed(lambda rows: put(rows, "partner", len(rows["start"]) - 1)),
    "a neighbour far beyond all": listed(lambda rows: put(rows, "partner", 1 << 30)),
    "rows of neighbours that end too late": listed(lambda rows: put(rows, "start", 1 << 40)),
    "rows of neighbours that begin too late": listed(lambda rows: put(rows, "start", 1, 0)),
    "rows of neighbours that go back": listed(lambda rows: put(rows, "start", -7, len(rows["start"]) // 2)),
    "rows of fewer points": listed(lambda rows: rows.update(start=rows["start"][[0, -1]])),
    "neighbours that are broken numbers": listed(lambda rows: rows.update(partner=rows["partner"] + 0.5)),
    "neighbours of too many bits": listed(lambda rows: rows.update(partner=rows["partner"].astype(np.int64))),
    "neighbours in a square": listed(lambda rows: rows.update(partner=rows["partner"][:, None])),
    "neighbours that are a word": listed(lambda rows: rows.update(partner="all")),
    "a table that is a number": changed(lambda content: content["state"].update(dict.fromkeys(content["state"], 1))),
    "numbers of half the bits": replaced(lambda it: it.astype(np.float32)),
    "one row more": replaced(lambda it: np.concatenate((it, it[:1]))),
    "axes exchanged": replaced(lambda it: np.ascontiguousarray(np.moveaxis(it, -1, 0))),
    "no number in it": replaced(lambda it: np.full_like(it, np.nan), every=True),
}


def files(place: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(place.rglob("*")) if path.is_file() and path.name != ".lock"}


def refused(half: Half, run: Path, complaints: Callable[[], list[str]], builds: bool = True) -> str:
    """The one line that a run says which does not go on, and leaves all as it is.  builds: whether it may build."""
    before = files(run)
    complaints()
    code = half.one.run(run, "--resume", builds=builds)
    lines = complaints()
    assert (code, len(lines)) == (2, 1), (code, lines)
    assert files(run) == before
    return lines[0]


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_wrong_checkpoint_is_one_line_and_nothing_is_lost(tmp_path, complaints, halves, name):
    half = halves(name)
    other = another(name, halves, tmp_path / "other")
    of_another = {"another run's": lambda file: shutil.copy(other / file.name, file)}
    for way, spoil in (WAYS | of_another).items():
        run = Path(shutil.copytree(half.folder, tmp_path / "run"))
        spoil(run / "checkpoint.h5")
        try:
            said = refused(half, run, complaints)
        except BaseException as error:
            error.add_note(way)
            raise
        assert "checkpoint" in said, (way, said)
        assert str(run) in said, (way, said)
        assert len(said) < 500, (way, said)
        shutil.rmtree(run)


def pointed(table: str, name: str, at: tuple[int, int], value: int) -> Callable[[Path], None]:
    """An index of the segments or bonds is another; its checksums are right."""

    def change(content: dict[str, Any]) -> None:
        content["state"]["grains"][table][name][at] = value
        if name == "ends":
            content["state"]["grains"][table][name][at[0], 2] = at[1] == 1  # of a segment

    return changed(change)


def rowed(**rows: int) -> Callable[[Path], None]:
    """So many rows of which discs are held, and what that took."""

    def change(content: dict[str, Any]) -> None:
        grains = content["state"]["grains"]
        grains.update({name: np.zeros((count, 3), grains[name].dtype) for name, count in rows.items()})

    return changed(change)


OF_FRAMES: dict[str, tuple[Callable[[Path], None], str]] = {
    "more held than there are": (rowed(held=500, withheld=500), "held: (500, 3) for none or all of "),
    "held without what it takes": (rowed(withheld=0), "withheld: (0,) rows for "),
    "a segment far beyond all": (pointed("segments", "near", (0, 1), 1 << 40), f"near = {1 << 40}: is none of 13"),
    "the segment after the last": (pointed("segments", "near", (-1, 1), 13), "segments.near = 13: is none of 13"),
    "a disc far beyond all": (pointed("segments", "near", (0, 0), 1 << 40), f"segments.near: {1 << 40} is none of "),
    "a corner far beyond all": (pointed("segments", "corner", (0, 1), 1 << 40), f"corner: {1 << 40} is none of "),
    "a bond to a segment far beyond all": (pointed("bonds", "ends", (0, 1), 1 << 40), f"= {1 << 40}: is none of 13"),
    "a bond of a disc far beyond all": (pointed("bonds", "ends", (0, 0), 1 << 40), f"ends: {1 << 40} is none of "),
}
"""What is wrong with the tables that only frames and bonds have, and how it is said."""


@pytest.mark.parametrize("way", OF_FRAMES)
def test_indices_of_frames_and_bonds_are_checked(tmp_path, complaints, halves, way):
    half, (spoil, words) = halves("framed"), OF_FRAMES[way]
    run = Path(shutil.copytree(half.folder, tmp_path / "run"))
    grains = read_checkpoint(run / "checkpoint.h5")["state"]["grains"]
    assert all(len(grains[table][name]) for table, name in (("segments", "near"), ("bonds", "ends")))
    assert len(grains["held"]) == len(grains["discs"]["radius"])
    spoil(run / "checkpoint.h5")
    said = refused(half, run, complaints)
    assert "checkpoint" in said
    assert words in said


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_sound_one_goes_on_to_the_same_bits(tmp_path, halves, name):  # the twin that must not fail
    half = halves(name)
    run = Path(shutil.copytree(half.folder, tmp_path / "run"))
    assert 0 < read_header(run / "checkpoint.h5")["time"] < 0.75 * half.one.values["time"]["end"]
    assert differences(run, half.untouched) != []
    assert half.one.run(run, "--resume") == 0
    assert differences(run, half.untouched) == []


@pytest.mark.parametrize("name", NAMES, scope="module")
def test_a_wrong_one_is_refused_before_a_model_is_built(tmp_path, complaints, halves, name):
    half = halves(name)
    run = Path(shutil.copytree(half.folder, tmp_path / "run"))
    for way in ("a neighbour far beyond all", "a bit of the state", "no state", "words for steps", "no number in it"):
        shutil.copy(half.folder / "checkpoint.h5", run)
        WAYS[way](run / "checkpoint.h5")
        assert "checkpoint" in refused(half, run, complaints, builds=False)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["column", "tank"])
def test_a_run_of_the_other_program_is_named(tmp_path, complaints, halves, name):
    run = Path(shutil.copytree(another(name, halves, tmp_path / "other"), tmp_path / "run"))
    said = refused(halves(name), run, complaints)
    assert "holds a run of" in said
