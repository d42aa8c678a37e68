"""Run folders of earlier versions stay readable, and those of later ones say so in one line."""

from __future__ import annotations

import json
import shutil
import tarfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from porescale.ground.card import read_card
from porescale.ground.check import InputError
from porescale.runs.checkpoint import read_checkpoint, read_header
from porescale.runs.open_run import open_run
from porescale.scene.sections import Scene
from porescale.workbench.sections import load, scene_as_dict, validate
from tests.reference.toy_model import run_toy

SAMPLES = Path(__file__).resolve().parents[1] / "samples"


@pytest.fixture(scope="module")
def kept(tmp_path_factory) -> Path:
    """The run folder of format 1 that is kept, as it was written: three grains settle in a box of 12 x 16 cells."""
    folder = tmp_path_factory.mktemp("kept")
    with tarfile.open(SAMPLES / "run_format_1.tar.xz") as packed:
        packed.extractall(folder, filter="data")
    return folder / "run"


@pytest.fixture
def copy(kept, tmp_path) -> Path:
    return Path(shutil.copytree(kept, tmp_path / "run"))


def test_a_kept_run_is_read_to_the_last_digit(kept):
    # Numbers as the version that wrote the folder read them.
    run = open_run(kept)
    assert run.name == "run_format_1"
    assert run.steps.tolist() == [0, 100, 200]
    assert run.times.tolist() == [0.0, 0.004, 0.008]
    assert run.series["time (s)"].tolist() == [k * 1e-3 for k in range(9)]
    assert run.series["front (m)"][-1] == 0.0020515794892186725
    last = run.snapshot(-1)
    assert last.clouds["grains"].position[2].tolist() == [0.0012017152318223414, 0.0021507761085947175]
    fields = last.grids["fields"]
    assert fields.shape == (16, 12)
    assert fields.spacing == (2e-4, 2e-4)
    assert fields.cells["velocity"][..., 1].min() == np.float32(-0.00882512703537941)
    state = read_checkpoint(kept / "checkpoint.h5")
    assert (state["step"], sorted(state["state"])) == (200, ["coupled", "mass", "step", "watch"])


def test_the_scene_on_a_kept_card_is_still_a_scene(kept):
    card = read_card(kept, "porescale")
    assert card["format"] == 1
    made = scene_as_dict(validate(Scene, card["scene"]))
    assert made == scene_as_dict(load(kept / "scene.toml", Scene))


def test_a_card_without_a_format_is_of_the_first(copy):
    card = json.loads((copy / "card.json").read_text())
    del card["format"]
    (copy / "card.json").write_text(json.dumps(card))
    assert len(open_run(copy)) == 3


def card_of(folder: Path, number: object) -> None:
    card = json.loads((folder / "card.json").read_text())
    (folder / "card.json").write_text(json.dumps({**card, "format": number}))


def checkpoint_of(folder: Path, number: object) -> None:
    with h5py.File(folder / "checkpoint.h5", "r+") as file:
        tree = json.loads(file["tree"][...].tobytes())
        del file["tree"]
        text = json.dumps({**tree, "format": number})
        file.create_dataset("tree", data=np.frombuffer(text.encode(), np.uint8), fletcher32=True, chunks=True)


def snapshots_of(folder: Path, number: object) -> None:
    with h5py.File(folder / "grains.vtkhdf", "r+") as file:
        file["porescale"].attrs["format"] = number


PARTS: dict[str, tuple[Callable[[Path, object], None], Callable[[Path], object]]] = {
    "card.json": (card_of, open_run),
    "checkpoint.h5": (checkpoint_of, lambda folder: read_checkpoint(folder / "checkpoint.h5")),
    "checkpoint.h5 ": (checkpoint_of, lambda folder: read_header(folder / "checkpoint.h5")),
    "grains.vtkhdf": (snapshots_of, lambda folder: open_run(folder).snapshot(0)),
}


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize(
    ("number", "said"),
    [(2, "was written by a newer version (format 2)"), (0, "of no known format"), ("one", "of no known format")],
)
def test_another_format_is_one_clear_line(copy, part, number, said):
    spoil, read = PARTS[part]
    read(copy)  # it is fine as it is
    spoil(copy, number)
    with pytest.raises(InputError) as caught:
        read(copy)
    (fault,) = caught.value.faults
    line = fault.line()
    assert said in line
    assert part.strip() in line
    assert "allowed: format 1" in line
    assert len(line.splitlines()) == 1


def test_runs_of_today_say_their_format(tmp_path):
    run_toy(tmp_path / "run", duration=0.02)
    assert read_card(tmp_path / "run")["format"] == 1
    with h5py.File(tmp_path / "run" / "fields.vtkhdf") as file:
        assert file["porescale"].attrs["format"] == 1
