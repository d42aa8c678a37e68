"""Whatever is wrong with a file, it is read, or refused in clear lines; no other error, nothing written elsewhere."""

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.builders.initial.circles import grains_of
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.cli.sweep import expected
from porescale.common.core.errors import Fault, InputError
from porescale.common.pictures.film import write_film
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.common.record.open_run import open_run
from porescale.common.record.read_card import read_card
from porescale.common.schema.sections import load
from porescale.common.studies.front import read_front
from porescale.common.studies.parameter_table import read_points
from porescale.common.studies.trade_plan import read_plan
from porescale.dem.prepare.compaction import read_circles, read_packing, write_packing
from porescale.demseg.deck import read_deck
from porescale.piv.fields.field import read as read_field
from porescale.piv.images.film import open_film, picture
from porescale.scene.circles import Circles
from tests.reference import grounds
from tests.reference.faults.spoiled import spoiled
from tests.reference.folders import CASES
from tests.reference.pictures import photograph
from tests.reference.toy_model import run_toy

TIMES = int(os.environ.get("PORESCALE_SPOILED", "25"))
"""How often each file is spoilt in the quick test; forty times as often in the slow one."""

Read = Callable[[Path], object]


def scene_of(package) -> Read:
    """Opens a scene and reports it, as `check` does, in any of its qualities."""

    def read(file: Path) -> object:
        return package.report(load(file, package.scene()))

    return read


def whole_run(folder: Path) -> object:
    """A run and all that it holds."""
    run = open_run(folder)
    return [run.snapshot(k) for k in range(len(run))], run.series, run.table("beads")


GREY = np.arange(64 * 64, dtype=np.uint8).reshape(64, 64)
TEXTS = {
    "circles.csv": "x,y,radius\n0.1,0.2,0.01\n0.3,0.2,0.01\n",
    "field.csv": "x,y,u,v,valid,replaced,solid,correlation,uncertainty\n"
    + "\n".join(f"{x},{y},1.5,-0.5,1,0,0,0.9,0.01" for y in (8, 16) for x in (8, 16, 24)) + "\n",
    "field.txt": "# x y u v flags mask\n" + "".join(f"{x} {y} 1 2 0 0\n" for y in (8, 16) for x in (8, 16)),
    "points.csv": 'name,fluid.spacing,gate.x\na,"1 mm",0.1\nb,2e-3,\n',
    "points.toml": '[[point]]\nname = "a"\nfluid.spacing = "1 mm"\n[vary]\ngate.x = [0.1, 0.2]\n',
    "trade.toml": '[[quantity]]\nname = "e"\ncolumn = "y"\nscale = 1\nexact = 2\n[[knob]]\nname = "k"\n'
                  '[[knob.point]]\nlabel = "1"\nsettings = { a.b = 1 }\n',
    "front.json": '{"format": 2, "machine": {"processor": "p"}, "date": "d", "points": [{"label": "a","on_front": true,'
                  '"error": 0.1, "scatter": 0, "core_seconds": 1, "besides": 1, "time": 1, "pace": 1,'
                  '"errors": {}, "but": "","quality": null,"settings": ["a.b=1"]}]}',
}  # fmt: skip
"""Files of text, by name."""
WRITERS: dict[str, Read] = {
    "packing.h5": lambda file: write_packing(file, np.array([[0.1, 0.2], [0.3, 0.2]]), np.array([0.01, 0.02])),
    "checkpoint.h5": lambda file: write_checkpoint(
        file, {"step": 3, "time": 0.5, "seconds": 1.0, "state": {"x": np.arange(7.0), "name": "a"}}
    ),
    "picture.png": lambda file: cv2.imwrite(str(file), GREY),
    "circles.png": lambda file: cv2.imwrite(
        str(file), photograph(np.array([[30.0, 20.0], [60.0, 20.0], [45.0, 60.0]]), np.full(3, 10.0), (80, 90))
    ),
    "film.mp4": lambda file: write_film(
        file.with_name("film"), (np.dstack([np.roll(GREY, k)] * 3) for k in range(4)), 10
    ).rename(file),
    "expected.toml": lambda file: shutil.copy(CASES / "lifting_gate" / "expected.toml", file),
}
"""Other files, by name."""


def made(folder: Path, name: str) -> Path:
    """A valid file, or folder with one, of each kind; the part after the colon names what is spoilt in it."""
    kind, _, part = name.partition(":")
    file = folder / part
    if kind == "scene":
        shutil.copytree(CASES / part, folder / part)
        return folder / part / "scene.toml"
    if kind == "deck":
        case, _, part = part.partition("/")
        return Path(shutil.copytree(CASES / case, folder / case)) / part
    if kind == "ground":
        file.write_text(grounds.SCENES[file.stem])
    elif part == "material.toml":
        shutil.copy(CASES / "micro_to_macro" / "ground.toml", folder / "scene.toml")
        shutil.copy(CASES / "micro_to_macro" / part, file)
    if kind == "run":
        run_toy(folder / "run", duration=0.04)
        return folder / "run" / part
    if part in TEXTS:
        file.write_text(TEXTS[part])
    elif part in WRITERS:
        WRITERS[part](file)
    return file


SIZES = {"pixel": 1e-3, "smallest": 0.015, "largest": 0.025}
"""Of the discs in a picture, m."""
READERS: dict[str, Read] = {
    "scene:column_collapse": scene_of(PORESCALE),
    "scene:lifting_gate": scene_of(PORESCALE),
    "scene:permeameter": scene_of(PORESCALE),
    "scene:bubble_in_water": scene_of(CONTINUUM),
    "scene:trapped_air": scene_of(CONTINUUM),
    "ground:pile.toml": scene_of(CONTINUUM),
    "ground:air.toml": scene_of(CONTINUUM),
    "ground:bubble.toml": scene_of(CONTINUUM),
    "of ground:material.toml": lambda file: scene_of(CONTINUUM)(file.parent / "scene.toml"),
    "deck:demseg_chain/in_gm.dat": lambda file: read_deck(file.parent),
    "deck:demseg_chain/in_bc.dat": lambda file: read_deck(file.parent),
    "run:card.json": lambda file: read_card(file.parent),
    "run:series.csv": lambda file: whole_run(file.parent),
    "run:beads.csv": lambda file: whole_run(file.parent),
    "run:fields.vtkhdf": lambda file: whole_run(file.parent),
    "run:grains.vtkhdf": lambda file: whole_run(file.parent),
    "of grains:circles.csv": lambda file: read_circles(file, "m"),
    "of grains:packing.h5": read_packing,
    "of grains:circles.png": lambda file: grains_of(Circles(file=file.name, **SIZES), file.parent),
    "of a run:checkpoint.h5": read_checkpoint,
    "of film:field.csv": read_field,
    "of film:field.txt": read_field,
    "of film:picture.png": picture,
    "of film:film.mp4": lambda file: list(open_film([file])),
    "of a sweep:points.csv": read_points,
    "of a sweep:points.toml": read_points,
    "of a sweep:expected.toml": lambda file: expected(file.parent / "scene.toml"),
    "of a study:trade.toml": lambda file: read_plan(file.parent / "scene.toml", None),
    "of a study:front.json": lambda file: read_front(file.parent / "scene.toml"),
}


def everything(folder: Path) -> dict[str, tuple[int, int, int]]:
    """Every file below a folder: which it is, how long, and when it was last written."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            if name != ".lock":
                file = os.stat(f"{place}/{name}")
                found[f"{place}/{name}"] = (file.st_ino, file.st_size, file.st_mtime_ns)
    return found


def faults_of(read: Callable[[], object]) -> list[Fault]:
    """What reading said was wrong."""
    try:
        read()
    except InputError as error:
        return list(error.faults) or [Fault("", None, "")]
    return []


def judged(file: Path, read: Read, content: bytes, seed: int) -> bool:
    """Whether a spoilt file is read; else it is refused, in lines of one line each."""
    file.write_bytes(spoiled(content, seed))
    before = everything(file.parent)
    faults = faults_of(lambda: read(file))
    for fault in faults:
        said = fault.line()
        assert said.strip()
        assert len(said.splitlines()) == 1, said
        assert len(said) < 2000, said
    assert everything(file.parent) == before
    return not faults


def spoil(name: str, folder: Path, seeds: range) -> None:
    file, verdicts = made(folder, name), set()
    content = file.read_bytes()
    READERS[name](file)  # it is fine as it is
    for seed in seeds:
        try:
            verdicts.add(judged(file, READERS[name], content, seed))
        except Exception as error:
            error.add_note(f"{name}, seed {seed}")
            raise
    assert False in verdicts  # some of it was noticed


@pytest.mark.parametrize("name", READERS)
def test_a_spoilt_file_is_read_or_refused(tmp_path, name):
    spoil(name, tmp_path, range(TIMES))


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
def test_files_spoilt_in_many_ways_are_read_or_refused(tmp_path, name):
    spoil(name, tmp_path, range(1000, 1000 + 40 * TIMES))


def test_a_reader_that_writes_is_caught(tmp_path):  # the twin that must fail
    (tmp_path / "other.txt").write_text("kept")
    for name in ("other.txt", "new.txt"):
        with pytest.raises(AssertionError):
            judged(tmp_path / "n.txt", lambda path, name=name: path.with_name(name).write_text("lost"), b"1.5", 1)


def test_a_reader_that_lets_other_errors_out_is_caught(tmp_path):  # the twin that must fail
    with pytest.raises(ValueError, match="float"):
        judged(tmp_path / "n.txt", lambda path: float(path.read_text("latin-1") + "x"), b"1.5", 1)
