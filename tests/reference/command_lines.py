"""Command lines as people and scripts get them wrong: spoilt files, odd values, options that do not go together.

A line is a function of a seed.  None of them may start a long computation: scenes are checked or lead to a refusal,
runs are resumed that are finished.
"""

from __future__ import annotations

import random
import shutil
import tarfile
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from tests.reference.spoiled import spoiled

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "cases"
SAMPLE = ROOT / "tests" / "samples" / "run_format_1.tar.xz"

ODD = (
    "", " ", "-", "--", "0", "-1", "1e400", "nan", "inf", "1e-320", "x", "\N{SNOWMAN}", "a=b", "=", "[", "{}", "None",
    "../..", "/", "/dev/null", "/proc/self/mem", "~", "a" * 300, "a/" * 200 + "b", "%s%n", "$(touch hacked)",
    "`touch hacked`", "; touch hacked", "__import__('os').system('touch hacked')", "\x1b[2J", "one\ntwo", "-q", "--x=1",
    "9" * 30, "1_0", "0x10", "true", "1,2", "1;2", ".", "..", "*", "?", "con", "\udcff",
)  # fmt: skip
"""Values that options and names may be given."""
SETTINGS = (
    "fluid.spacing", "time.end", "grains", "grains.packing", "grains.packing.diameter", "contact.stiffness", "gate.x",
    "domain.width", "output.snapshot_interval", "fluid.operator", "domain.left", "homogenise.grains", "a.b.c",
    "fluid[0]", "grains.grain[7].x", "disc[0].x", "tank.width", "numerics.spacing", "water.column[0].width",
    "soil.material", "title",
)  # fmt: skip
SCENES = {
    "porescale": ("permeameter", "settling_disc", "piston", "lid_driven_cavity", "lifting_gate", "towed_cylinder"),
    "continuum_sph": ("hydrostatic_column", "bubble_in_water", "soil_column_collapse", "dry_slope"),
}
DECKS = ("demseg_disc", "demseg_clump", "demseg_chain")
PARTS = ("card.json", "checkpoint.h5", "series.csv", "fields.vtkhdf", "grains.vtkhdf")


@dataclass(frozen=True)
class Line:
    """package : module of the command;  words : of its command line, run in the folder that has its files."""

    package: str
    words: tuple[str, ...]


def made(seed: int, folder: Path) -> Line:
    """The command line of a seed; its files are written into ``folder``, a new one."""
    dice = random.Random(seed)
    kind = dice.choice(KINDS)
    return kind(dice, folder)


def _spoil(dice: random.Random, source: Path, target: Path, sound: float = 0.3) -> Path:
    """A copy of a file, spoilt but for a share of ``sound`` ones."""
    content = source.read_bytes()
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(content if dice.random() < sound else spoiled(content, dice.randrange(1 << 30)))
    return target


def _options(dice: random.Random) -> list[str]:
    """Some settings, odd ones among them."""
    words = []
    for _ in range(dice.choice((0, 0, 0, 1, 2))):
        words += ["--set", f"{dice.choice(SETTINGS)}={dice.choice((*ODD, '1', '0.001', '1 mm'))}"]
    if dice.random() < 0.1:
        words += ["--set", dice.choice(ODD)]
    if dice.random() < 0.2:
        words += ["--quality", dice.choice(("draft", "fine", *ODD))]
    return words


def checked(dice: random.Random, folder: Path) -> Line:
    """A scene that is checked."""
    package = dice.choice(list(SCENES))
    case = dice.choice(SCENES[package])
    file = _spoil(dice, CASES / case / "scene.toml", folder / "scene.toml")
    where = dice.choice((str(file), str(folder), "scene.toml", "."))
    return Line(package, ("check", where, *_options(dice)))


def refused(dice: random.Random, folder: Path) -> Line:
    """A scene with an unknown key that is run, swept, studied or homogenised: nothing may start."""
    package = dice.choice(list(SCENES))
    file = _spoil(dice, CASES / dice.choice(SCENES[package]) / "scene.toml", folder / "scene.toml")
    wrong, out = ("--set", "title.wrong=1"), ("--out", dice.choice(("out", "out/deep", *ODD)))
    ways = [
        ("run", str(file), *wrong, *out, "--quiet"),
        ("sweep", str(file), "--vary", f"{dice.choice(SETTINGS)}={dice.choice(ODD)},2", *wrong, *out),
        ("study", "trade", str(file), *wrong, *out),
    ]
    if package == "porescale":
        ways.append(("homogenise", str(file), *wrong, *out))
    return Line(package, dice.choice(ways))


def resumed(dice: random.Random, folder: Path) -> Line:
    """A finished run, spoilt in one part, that is resumed, started over without leave, or filmed."""
    with tarfile.open(SAMPLE) as packed:
        packed.extractall(folder, filter="data")
    run = folder / "run"
    _spoil(dice, run / dice.choice(PARTS), run / "spoilt", 0.05)
    (run / "spoilt").replace(run / dice.choice(PARTS))
    ways = [
        ("run", "run/scene.toml", "--out", "run", "--resume", "--quiet", "--threads", "1"),
        ("run", "run/scene.toml", "--out", "run", "--quiet"),
        ("run", "run/scene.toml", "--out", "run", "--resume", "--overwrite"),
        ("piv", "render", "run", "--out", "out", "--start", dice.choice(ODD), "--end", dice.choice(ODD)),
        ("piv", "render", "run", "--out", "out", "--scale", dice.choice(ODD)),
    ]
    return Line("porescale", dice.choice(ways))


def deck(dice: random.Random, folder: Path) -> Line:
    """A deck that becomes a scene."""
    case = dice.choice(DECKS)
    for name in ("in_gm.dat", "in_bc.dat"):
        _spoil(dice, CASES / case / name, folder / "deck" / name, 0.4)
    more = ("--units", dice.choice(("cgs", "mm-g", *ODD))) if dice.random() < 0.4 else ()
    return Line("porescale", ("demseg", "convert", "deck", "--out", "out.toml", *more))


def compared(dice: random.Random, folder: Path) -> Line:
    """Two fields, spoilt, that are compared."""
    rows = "\n".join(f"{x},{y},{1.5 + 0.01 * x},-0.5,1,0,0,0.9,0.01" for y in (8, 16, 24) for x in (8, 16, 24, 32))
    text = f"x,y,u,v,valid,replaced,solid,correlation,uncertainty\n{rows}\n"
    for name in ("a.csv", "b.csv"):
        (folder / "sound.csv").write_text(text)
        _spoil(dice, folder / "sound.csv", folder / name, 0.4)
    (folder / "sound.csv").unlink()
    return Line("porescale", ("piv", "compare", "a.csv", dice.choice(("b.csv", "nowhere", "a.csv")), "--out", "out"))


def pictured(dice: random.Random, folder: Path) -> Line:
    """Pictures and films, spoilt, that are measured; too small for windows, so that nothing is."""
    image = np.random.default_rng(1).integers(0, 255, (24, 24), dtype=np.uint8)
    for name in ("a.png", "b.png"):
        cv2.imwrite(str(folder / "sound.png"), image)
        _spoil(dice, folder / "sound.png", folder / name, 0.4)
    (folder / "sound.png").unlink()
    (folder / "film.mp4").write_bytes(dice.randbytes(300))
    films = dice.choice((("a.png", "b.png"), ("a.png",), ("film.mp4",), (".",), ("*.png",), ()))
    option = (dice.choice(("--window", "--overlap", "--search", "--region", "--scale")), dice.choice(ODD))
    return Line("porescale", ("piv", "measure", *films, "--out", "out", *option))


def wrong_use(dice: random.Random, folder: Path) -> Line:
    """Words that no command knows, and names of what is not there."""
    first = dice.choice((
        "run", "check", "show", "new", "sweep", "verify", "bench", "study", "piv", "demseg", "homogenise", "chekc",
        *ODD,
    ))  # fmt: skip
    if first in ("verify", "bench"):  # by a name that is none: with none they would all run
        return Line("porescale", (first, "no.such.row", dice.choice(ODD[1:])))
    if first == "study":
        return Line("porescale", (first, dice.choice(("trade", "stability", *ODD)), "no.such.flow"))
    if first == "new":
        return Line("porescale", ("new", dice.choice(("out", "out/mine", ""))))
    return Line("porescale", (first, *(dice.choice(ODD) for _ in range(dice.randrange(3)))))


def planned(dice: random.Random, folder: Path) -> Line:
    """A table of a sweep, spoilt, over a scene that none of its rows makes sound."""
    file = folder / "scene.toml"
    file.write_text("[domain]\nwidth = 1\nheight = 1\n")
    (folder / "sound.csv").write_text('name,fluid.spacing,gate.x\na,"1 mm",0.1\nb,2e-3,\n')
    _spoil(dice, folder / "sound.csv", folder / dice.choice(("table.csv", "table.toml")), 0.2)
    (folder / "sound.csv").unlink()
    return Line("porescale", ("sweep", "scene.toml", dice.choice(("table.csv", "table.toml")), "--out", "out"))


def grounded(dice: random.Random, folder: Path) -> Line:
    """A scene of soil whose material file is spoilt, or another file."""
    shutil.copy(CASES / "micro_to_macro" / "ground.toml", folder / "scene.toml")
    _spoil(dice, CASES / "micro_to_macro" / "material.toml", folder / "material.toml", 0.1)
    more = ("--set", f"soil.material={dice.choice(ODD)}") if dice.random() < 0.2 else ()
    return Line("continuum_sph", ("check", "scene.toml", *more))


KINDS = (checked, checked, checked, refused, refused, resumed, deck, compared, pictured, wrong_use, wrong_use, planned,
         grounded)  # fmt: skip
"""The more often, the more there is to get wrong."""
