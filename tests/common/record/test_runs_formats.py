"""Run folders of earlier versions stay readable, and those of later ones say so in one line."""

import json
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from continuum_sph.scene.sections import Scene as Ground
from porescale import Scene
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.api.run_scene import check_scene_resume
from porescale.common.cli.application import application, main
from porescale.common.cli.package import Package
from porescale.common.core.errors import InputError
from porescale.common.record.checkpoint import read_checkpoint, read_header
from porescale.common.record.open_run import open_run
from porescale.common.record.read_card import read_card
from porescale.common.schema.sections import Section, load, scene_as_dict, validate
from porescale.coupling.step import Coupled
from tests.reference.faults.spoiled import renumbered
from tests.reference.folders import SAMPLES
from tests.reference.toy_model import run_toy

BEFORE = {"damping": 0.2, "stress_diffusion": 100.0}
"""Keys of soil.numerics that the kept run had by default; today they follow from the ground where a scene is silent."""
AS_BEFORE = [
    *(f"soil.numerics.{key}={value}" for key, value in BEFORE.items()), "numerics.smoothing_ratio=1.3",
    "numerics.tension=kept",
]  # fmt: skip


@dataclass(frozen=True)
class Kept:
    """A run folder that is kept as it was written, and what the version that wrote it read there.

    rows : times of the series, s;  cloud : one of its clouds;  table : a table, one of its columns and the last number
    there;  last : last numbers of the series;  at : place of a point at the end, m;  state : parts of the checkpoint's.
    """

    package: str
    scene: type[Section]
    name: str
    steps: list[int]
    times: list[float]
    rows: list[float]
    cloud: str
    last: dict[str, float]
    at: tuple[int, list[float]]
    state: list[str]
    table: tuple[str, str, float] | None = None


KEPT = {
    "porescale": Kept(  # three grains settle in a box of 12 x 16 cells
        "porescale", Scene, "run_format_1", [0, 100, 200], [0.0, 0.004, 0.008], [k * 1e-3 for k in range(9)],
        "grains", {"front (m)": 0.0020515794892186725},
        (2, [0.0012017152318223414, 0.0021507761085947175]), ["coupled", "mass", "step", "watch"],
    ),
    "continuum-sph": Kept(  # water stands on soil and seeps into it
        "continuum-sph", Ground, "continuum_run_format_1", [0, 109, 217],
        [0.0, 0.010064542922531037, 0.020036750588892146],
        [0.0, 0.0025853871727602664, 0.005078439089350523, 0.00757149100594078, 0.010064542922531037,
         0.012557594839121293, 0.01505064675571155, 0.017543698672301843, 0.020036750588892146], "soil",
        {"mean height (m)": 0.14814649501748745, "soil: stress across over upright ()": 0.4326588524773842,
         "heat of drag (J/m)": 8.587332447798112e-06},
        (7, [0.18750095205989464, 0.012495709808497782]), ["next_step", "soil", "water"],
        ("probes", "deep pressure (Pa)", 1970.5443310824335),
    ),
}  # fmt: skip


@pytest.fixture(scope="module", params=KEPT)
def sample(request, tmp_path_factory) -> tuple[Kept, Path]:
    """A kept run of format 1 and its folder."""
    kept, folder = KEPT[request.param], tmp_path_factory.mktemp("kept")
    shutil.unpack_archive(SAMPLES / f"{kept.name}.tar.xz", folder)
    return kept, folder / "run"


@pytest.fixture
def copy(sample, tmp_path) -> Path:
    return Path(shutil.copytree(sample[1], tmp_path / "run"))


def test_a_kept_run_is_read_to_the_last_digit(sample):
    kept, folder = sample
    run = open_run(folder)
    assert run.name == kept.name
    assert run.steps.tolist() == kept.steps
    assert run.times.tolist() == kept.times
    assert run.series["time (s)"].tolist() == kept.rows
    assert {name: run.series[name][-1] for name in kept.last} == kept.last
    number, place = kept.at
    assert run.snapshot(-1).clouds[kept.cloud].position[number].tolist() == place
    state = read_checkpoint(folder / "checkpoint.h5")
    assert (state["step"], sorted(state["state"])) == (kept.steps[-1], kept.state)
    if kept.table:
        table, column, value = kept.table
        assert run.table(table)[column][-1] == value


def test_fields_of_a_kept_run_are_read_to_the_last_digit(tmp_path):
    shutil.unpack_archive(SAMPLES / "run_format_1.tar.xz", tmp_path)
    fields = open_run(tmp_path / "run").snapshot(-1).grids["fields"]
    assert fields.shape == (16, 12)
    assert fields.spacing == (2e-4, 2e-4)
    assert fields.cells["velocity"][..., 1].min() == np.float32(-0.00882512703537941)


def test_the_scene_on_a_kept_card_is_still_a_scene(sample):
    kept, folder = sample
    card = read_card(folder, kept.package)
    assert card["format"] == 1
    made = scene_as_dict(validate(kept.scene, card["scene"]))
    settings = AS_BEFORE if kept.scene is Ground else []
    assert made == scene_as_dict(load(folder / "scene.toml", kept.scene, overrides=settings))


def test_a_card_without_a_format_is_of_the_first(copy):
    card = json.loads((copy / "card.json").read_text())
    del card["format"]
    (copy / "card.json").write_text(json.dumps(card))
    assert len(open_run(copy)) == 3


def run_of(package: Package, run: Path, out: Path, *words: str) -> int:
    """Exit code of a run of the scene in the folder ``run`` into ``out``, without pictures."""
    with patch.object(sys.modules[package.show.__module__], "show", lambda folder: []):
        given = ["run", str(run / "scene.toml"), "--out", str(out), "--quiet", "--threads", "1", *words]
        return main(application(package), given)


@pytest.fixture
def kept_run(tmp_path) -> Callable[[str], Path]:
    """A copy of a kept run that may go on."""

    def unpacked(name: str) -> Path:
        shutil.unpack_archive(SAMPLES / f"{name}.tar.xz", tmp_path)
        return tmp_path / "run"

    return unpacked


def test_a_kept_run_goes_on_as_if_it_were_of_today(kept_run, tmp_path):
    run, later = kept_run("run_format_1"), "time.end=0.012"
    assert run_of(PORESCALE, run, run, "--resume", "--set", later) == 0
    # It began with fluid at rest inside the disc that spins; that of today spins with it.
    with patch.object(Coupled, "set_free_apart", lambda coupled, velocity: False):
        assert run_of(PORESCALE, run, tmp_path / "new", "--set", later) == 0
    old, new = open_run(run), open_run(tmp_path / "new")
    assert old.times.tolist() == [0.0, 0.004, 0.008, 0.012]
    # Another version may round otherwise: eps over the speed of the water, 2e-3 cells a step, in each of 300 steps.
    near = 300 * np.finfo(float).eps / 2e-3
    for name in ("front (m)", "highest grain (m)", "kinetic energy of grains (J/m)"):
        assert old.series[name] == pytest.approx(new.series[name], rel=near)
    # Speeds in covered cells are read halfway through a step; the version of the kept rows read them before it.
    later_rows = old.series["time (s)"] > 0.008
    name = "largest fluid speed (m/s)"
    assert 3 < later_rows.sum() < len(later_rows)
    assert old.series[name][later_rows] == pytest.approx(new.series[name][later_rows], rel=near)
    assert old.series[name][~later_rows] != pytest.approx(new.series[name][~later_rows], rel=1e-3)


def test_a_kept_run_without_a_key_of_today_says_which_value_is_as_before(kept_run, capsys):
    run, later = kept_run("continuum_run_format_1"), ("--resume", "--set", "time.end=0.03")
    before = {file: file.read_bytes() for file in run.iterdir()}
    assert run_of(CONTINUUM, run, run, *later) == 2
    assert capsys.readouterr().err.splitlines() == [
        *(
            f"soil.numerics.{key} = 'absent': was {it}; resume with {it}, or start another run"
            for key, it in BEFORE.items()
        ),
        "numerics.smoothing_ratio = 1.375: was 1.3; resume with 1.3, or start another run",
        "numerics.noise_floor = 0.001: the run was begun by a version without it; set it to 0.0 to go on as that did, "
        "or start another run",
        "numerics.tension = 'cut': was 'kept'; resume with 'kept', or start another run",
    ]
    # As that it would go on, but soil of that version knows neither mean pressure nor crowd of its surroundings.
    as_before = [word for it in ("numerics.noise_floor=0", *AS_BEFORE) for word in ("--set", it)]
    assert run_of(CONTINUUM, run, run, *later, *as_before) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "does not fit this model (soil.flow.soil.spread: (32, 5) in place of (32, 7)); start the run anew" in line
    assert {file: file.read_bytes() for file in run.iterdir() if file.name != ".lock"} == before


def test_keys_that_came_later_are_no_change_where_they_do_nothing_new(kept_run):
    run = kept_run("continuum_run_format_1")
    scene = scene_as_dict(load(run / "scene.toml", Ground, overrides=["numerics.noise_floor=0", *AS_BEFORE]))
    card = {"package": "continuum-sph", "scene": scene, "scene_file": str(run / "scene.toml")}
    check_scene_resume(CONTINUUM, run, card)
    scene["numerics"]["courant"] = 0.2  # the twin that must fail: a key that the run had
    with pytest.raises(InputError, match=r"was 0\.25; resume with 0\.25, or start another run"):
        check_scene_resume(CONTINUUM, run, card)


def card_of(folder: Path, number: object) -> None:
    card = json.loads((folder / "card.json").read_text())
    (folder / "card.json").write_text(json.dumps({**card, "format": number}))


def checkpoint_of(folder: Path, number: object) -> None:
    renumbered(folder / "checkpoint.h5", number)


def snapshots_of(folder: Path, number: object) -> None:
    for part in folder.glob("*.vtkhdf"):
        with h5py.File(part, "r+") as file:
            file["porescale"].attrs["format"] = number


PARTS: dict[str, tuple[Callable[[Path, object], None], Callable[[Path], object]]] = {
    "card.json": (card_of, open_run),
    "checkpoint.h5": (checkpoint_of, lambda folder: read_checkpoint(folder / "checkpoint.h5")),
    "checkpoint.h5 ": (checkpoint_of, lambda folder: read_header(folder / "checkpoint.h5")),
    ".vtkhdf": (snapshots_of, lambda folder: open_run(folder).snapshot(0)),
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
