"""Command lines as people and scripts get them wrong: spoilt files, odd values, options that do not go together.

A line is a function of a seed.  None of them may start a long computation: scenes are checked or lead to a refusal,
runs are resumed that are finished.
"""

import random
import shutil
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from porescale.common.pictures.film import write_film
from tests.reference import grounds
from tests.reference.faults.spoiled import spoiled
from tests.reference.folders import CASES, ROOT
from tests.reference.pictures import photograph

SAMPLES = {"porescale": "run_format_1", "continuum_sph": "continuum_run_format_1"}
"""Finished runs that are kept, by package."""

ODD = (
    "", " ", "-", "--", "0", "-1", "1e400", "nan", "inf", "1e-320", "x", "\N{SNOWMAN}", "a=b", "=", "[", "{}", "None",
    "../..", "/", "/dev/null", "/proc/self/mem", "~", "a" * 300, "a/" * 200 + "b", "%s%n", "$(touch hacked)",
    "`touch hacked`", "; touch hacked", "__import__('os').system('touch hacked')", "\x1b[2J", "one\ntwo", "-q", "--x=1",
    "9" * 30, "1_0", "0x10", "true", "1,2", "1;2", ".", "..", "*", "?", "con", "\udcff",
)  # fmt: skip
"""Values that options and names may be given."""
WITHOUT_END = (
    "a." * 2000 + "b=1",
    "a=" + "[" * 5000,
    "a=" + "9" * 5000,
    f"a[{'9' * 5000}]=1",
    "a.\N{SUPERSCRIPT TWO}=1",
)
"""Settings that nest, or count, too far."""
SETTINGS = (
    "fluid.spacing", "time.end", "grains", "grains.packing", "grains.packing.diameter", "contact.stiffness", "gate.x",
    "domain.width", "output.snapshot_interval", "fluid.operator", "domain.left", "homogenise.grains", "a.b.c",
    "fluid[0]", "grains.grain[7].x", "disc[0].x", "tank.width", "numerics.spacing", "water.column[0].width",
    "soil.material", "soil.permeability", "pile.tip", "reservoir[0].level", "air.density", "title",
)  # fmt: skip
SCENES = {
    "porescale": ("permeameter", "settling_disc", "piston", "lid_driven_cavity", "lifting_gate", "towed_cylinder"),
    "continuum_sph": ("hydrostatic_column", "bubble_in_water", "soil_column_collapse", "dry_slope"),
}
TRADED = {"porescale": "column_collapse", "continuum_sph": "collapsing_water_column"}
"""Cases with what is asked of speed against accuracy, and what was found."""
DECKS = ("demseg_disc", "demseg_clump", "demseg_chain")
PARTS = ("card.json", "checkpoint.h5", "series.csv", "fields.vtkhdf", "grains.vtkhdf", "soil.vtkhdf", "probes.csv")


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
        words += ["--set", dice.choice((*ODD, *WITHOUT_END))]
    if dice.random() < 0.2:
        words += ["--quality", dice.choice(("draft", "fine", *ODD))]
    return words


def checked(dice: random.Random, folder: Path) -> Line:
    """A scene that is checked."""
    package = dice.choice(list(SCENES))
    case = CASES / dice.choice(SCENES[package]) / "scene.toml"
    if package == "continuum_sph" and dice.random() < 0.5:
        case = folder / "sound.toml"
        case.write_text(dice.choice(list(grounds.SCENES.values())))
    file = _spoil(dice, case, folder / "scene.toml")
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
    whose = dice.choice(list(SAMPLES))
    shutil.unpack_archive(ROOT / "tests" / "samples" / f"{SAMPLES[whose]}.tar.xz", folder)
    run = folder / "run"
    parts = [part for part in PARTS if (run / part).exists()]
    _spoil(dice, run / dice.choice(parts), run / "spoilt", 0.05)
    (run / "spoilt").replace(run / dice.choice(parts))
    if whose == "continuum_sph":  # which compiles much before it resumes: end_to_end/runs/test_wrong_checkpoints.py
        return Line(
            dice.choice(list(SAMPLES)), dice.choice((("show", "run"), ("run", "run/scene.toml", "--out", "run")))
        )
    ways = [
        ("run", "run/scene.toml", "--out", "run", "--resume", "--quiet", "--threads", "1"),
        ("run", "run/scene.toml", "--out", "run", "--quiet"),
        ("run", "run/scene.toml", "--out", "run", "--resume", "--overwrite"),
        ("piv", "render", "run", "--out", "out", "--start", dice.choice(ODD), "--end", dice.choice(ODD)),
        ("piv", "render", "run", "--out", "out", "--scale", dice.choice(ODD)),
        ("piv", "render", "run", "--out", "out", "--interval", dice.choice(ODD)),
        ("show", "run"),
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
    sound = write_film(folder / "sound", (np.dstack([np.roll(image, shift)] * 3) for shift in range(3)), 10)
    film = _spoil(dice, sound, folder / f"film{sound.suffix}", 0.1)
    sound.unlink()
    films = dice.choice((("a.png", "b.png"), ("a.png",), (film.name,), (film.name,), (".",), ("*.png",), ()))
    option = (dice.choice(("--window", "--overlap", "--search", "--region", "--scale")), dice.choice(ODD))
    return Line("porescale", ("piv", "measure", *films, "--out", "out", *(option if dice.random() < 0.5 else ())))


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


TABLES = {
    "table.csv": 'name,fluid.spacing,gate.x\na,"1 mm",0.1\nb,2e-3,\n',
    "table.toml": '[[point]]\nname = "a"\nfluid.spacing = "1 mm"\n[vary]\ngate.x = [0.1, 0.2]\n',
}
"""What a sweep may be asked."""


def planned(dice: random.Random, folder: Path) -> Line:
    """A table of a sweep, spoilt, over a scene that none of its rows makes sound."""
    (folder / "scene.toml").write_text("[domain]\nwidth = 1\nheight = 1\n")
    name = dice.choice(list(TABLES))
    (folder / "sound").write_text(TABLES[name])
    _spoil(dice, folder / "sound", folder / name, 0.2)
    package = dice.choice(list(SCENES))
    return Line(package, ("sweep", "scene.toml", name, "--out", "out"))


def traded(dice: random.Random, folder: Path) -> Line:
    """A front that a run is picked from, or a plan of a study, spoilt, beside a scene that is refused."""
    package, wrong = dice.choice(list(TRADED)), ("--set", "title.wrong=1", "--out", "out")
    for name in ("front.json", "trade.toml", "scene.toml"):
        _spoil(dice, CASES / TRADED[package] / name, folder / name, 0.4)
    share = dice.choice(ODD) if dice.random() < 0.3 else dice.choice(("5%", "0.3", "1e-9"))
    time = dice.choice(ODD) if dice.random() < 0.3 else dice.choice(("3min", "90", "1e-9 s"))
    ways = [
        ("run", "scene.toml", "--error", share, *wrong, "--quiet"),
        ("run", ".", "--budget", time, *wrong, "--quiet"),
        ("run", "scene.toml", "--error", share, "--budget", time, *wrong),
        ("study", "trade", "scene.toml", *wrong),
        ("study", "trade", "scene.toml", "--plan", dice.choice(("trade.toml", "front.json", *ODD)), *wrong),
    ]
    return Line(package, dice.choice(ways))


HEAP = """\
[domain]
width = 0.1
height = 0.1
[grains]
density = 2650
[grains.circles]
{}
[contact]
stiffness = 1e5
restitution = 0.5
[time]
end = 0.001
[output]
snapshot_interval = 0.001
series_interval = 0.0005
"""
"""A scene whose grains stand in a file."""


def heaped(dice: random.Random, folder: Path) -> Line:
    """A scene of grains whose list of circles, or picture of them, is spoilt."""
    name = dice.choice(("circles.csv", "circles.png"))
    at, radius = np.array([[30.0, 20.0], [60.0, 20.0], [45.0, 60.0]]), np.full(3, 10.0)
    if name == "circles.csv":
        (folder / "sound").write_text("x,y,diameter\n" + "".join(f"{x},{y},20\n" for x, y in at))
        how = 'file = "circles.csv"\nunit = "mm"'
    else:
        cv2.imwrite(str(folder / "sound.png"), photograph(at, radius, (100, 100)))
        (folder / "sound.png").rename(folder / "sound")
        how = 'file = "circles.png"\npixel = "1 mm"\nsmallest = "15 mm"\nlargest = "25 mm"\npart = true'
    _spoil(dice, folder / "sound", folder / name, 0.2)
    (folder / "scene.toml").write_text(HEAP.format(how))
    more = ("--set", f"grains.circles.file={dice.choice(ODD)}") if dice.random() < 0.2 else ()
    return Line("porescale", ("check", "scene.toml", *more))


def grounded(dice: random.Random, folder: Path) -> Line:
    """A scene of soil whose material file is spoilt, or another file."""
    shutil.copy(CASES / "micro_to_macro" / "ground.toml", folder / "scene.toml")
    _spoil(dice, CASES / "micro_to_macro" / "material.toml", folder / "material.toml", 0.1)
    more = ("--set", f"soil.material={dice.choice(ODD)}") if dice.random() < 0.2 else ()
    return Line("continuum_sph", ("check", "scene.toml", *more))


KINDS = (checked, checked, checked, refused, refused, resumed, deck, compared, pictured, wrong_use, wrong_use, planned,
         grounded, traded, traded, heaped)  # fmt: skip
"""The more often, the more there is to get wrong."""
