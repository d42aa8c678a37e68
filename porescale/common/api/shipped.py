"""Cases that come with the packages, found by name from any folder: scenes, scripts, and decks of DEMseg.

In a checkout they lie in ``cases`` beside the packages, in an installed wheel in ``porescale_cases``.  Pictures and
recorded numbers are not installed.
"""

from __future__ import annotations

import os
import shlex
import tomllib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

from porescale.common.core.errors import Fault, InputError

INSTALLED, CHECKOUT = "porescale_cases", "cases"
"""Folder of the cases beside the packages, in a wheel and in a checkout."""
SCENE, DECK = "scene.toml", "in_gm.dat"
"""Files that make a folder a scene, and a deck."""
BESIDE = ("expected.toml", "trade.toml", "material.toml")
"""TOML files of cases that are no scenes."""
LEFT_OUT = ("README.md", "recorded.json", "*.png", "__pycache__", "runs")
"""What lies in the folder of a case and is not needed to run it."""


@dataclass(frozen=True)
class Case:
    """A case that comes with the packages.

    name : of its folder;  title : one line;  package : the command it belongs to, "porescale" or "continuum-sph";
    kind : "scene", "deck" (of DEMseg) or "script";  path : its folder;  scenes : names of its scene files, as they can
    be loaded from any folder.
    """

    name: str
    title: str
    package: str
    kind: Literal["scene", "deck", "script"]
    path: Path
    scenes: tuple[str, ...]

    @property
    def command(self) -> str:
        """The command line that runs it, from this folder."""
        if self.kind == "scene":
            return f"{self.package} run {self.name}"
        if self.kind == "deck":
            return f"porescale demseg run {self.name}"
        return f"python {_from_here(self.path / f'{self.name}.py')}"

    def as_dict(self) -> dict[str, Any]:
        """JSON-able, with the command."""
        return {**asdict(self), "path": str(self.path), "scenes": list(self.scenes), "command": self.command}


def cases_folder() -> Path | None:
    """The folder that holds a folder for each case; None where they were not installed."""
    beside = Path(__file__).resolve().parents[3]
    if (beside / INSTALLED).is_dir():
        return beside / INSTALLED
    checkout = (beside / "pyproject.toml").is_file() and (beside / CHECKOUT).is_dir()
    return beside / CHECKOUT if checkout else None


@cache
def cases() -> tuple[Case, ...]:
    """All cases that come with the packages, by name; empty where they were not installed.

    One is loaded by its name, from any folder, and `Case.command` is the command line that runs it.
    """
    folder = cases_folder()
    return tuple(_cases(folder)) if folder else ()


def find_case(name: str | Path) -> Path | None:
    """What a case is loaded from: its folder, where it holds scene.toml, else its scene file, where it has only one.

    name : of a case, or of a scene file or folder in it, such as ``clump/clump.toml``.  None where there is no such
    case; the folder of a case without scenes.
    """
    folder, parts = cases_folder(), Path(name).parts
    if folder is None or not parts or Path(name).is_absolute() or ".." in parts or parts[0] == ".":
        return None
    place = folder.joinpath(*parts)
    try:
        if not (folder / parts[0]).is_dir() or parts[0].startswith((".", "__")):
            return None
        if len(parts) > 1 or (place / SCENE).is_file():
            return place if place.exists() else None
        scenes = _scene_files(place)
    except (OSError, ValueError):  # a name too long, or of no file
        return None
    return scenes[0] if len(scenes) == 1 else place


def scene_path(given: str | Path, program: str = "") -> Path:
    """``given`` where there is such a file or folder, else the scene of the case with this name.

    program : name of the command that is to run it.  InputError where the case is of another program or has no scene,
    where a folder holds a deck, and where a name is near to that of a case; any other path is given back as it is.
    """
    path = Path(given)
    case_here = _named(path)  # a case by its path is what it is by its name
    if _there(path) and not case_here:
        _refuse_deck(given, path)
        return path
    name = Path(case_here or path)
    found = find_case(name)
    if found is None:
        near = "" if _there(path.with_name(f"{path.name}.toml")) else nearest_case(given)
        if near:
            repair = f"did you mean the case {near!r}? `porescale cases` lists all"
            raise InputError(Fault(str(given), problem="no scene here and no case of that name", repair=repair))
        return path
    folder = cases_folder()
    assert folder is not None
    case = _case(folder / name.parts[0])
    if case is not None and found == case.path and case.kind != "scene":
        others = f"; its scenes: {', '.join(case.scenes)}" if case.scenes else ""
        repair = f"run it with `{case.command}`{others}"
        raise InputError(Fault(str(given), problem=f"is the {case.kind} of a case, no scene", repair=repair))
    if case is not None and program not in ("", case.package) and case.kind == "scene":
        problem = f"is a case of {case.package}, not of {program}"
        raise InputError(Fault(str(given), problem=problem, repair=f"run it with `{case.command}`"))
    _refuse_deck(given, found)
    return found


def _named(path: Path) -> str:
    """The name of the case whose folder, without scene.toml, lies at ``path``; "" where there is none."""
    try:
        its = path.is_dir() and not (path / SCENE).is_file() and path.resolve().parent == cases_folder()
    except (OSError, ValueError):  # a folder that may not be looked into
        return ""
    return path.resolve().name if its else ""


def _refuse_deck(given: str | Path, path: Path) -> None:
    """InputError where the folder ``path``, which ``given`` leads to, holds a deck of DEMseg and no scene."""
    try:
        deck = (path / DECK).is_file() and not (path / SCENE).is_file()
    except (OSError, ValueError):
        return
    if deck:
        repair = f"run it with `porescale demseg run {shlex.quote(str(given))}`"
        raise InputError(Fault(str(given), problem="is a deck of DEMseg, no scene", repair=repair))


def nearest_case(given: str | Path) -> str:
    """The name of the case that ``given`` is near to, "" if to none."""
    import difflib

    close = difflib.get_close_matches(str(given), [it.name for it in cases()], n=1, cutoff=0.6)
    return close[0] if close else ""


def _cases(folder: Path) -> Iterator[Case]:
    """The cases in ``folder``, by name."""
    for path in sorted(folder.iterdir()):
        if case := _case(path):
            yield case


def _case(path: Path) -> Case | None:
    """The case in a folder: one that has a README."""
    page = path / "README.md"
    if not page.is_file():
        return None
    with page.open(encoding="utf-8") as lines:
        title = lines.readline().lstrip("#").strip()
    kind: Literal["scene", "deck", "script"] = "script"
    if (path / SCENE).is_file():
        kind = "scene"
    elif (path / DECK).is_file():
        kind = "deck"
    names = tuple(f"{path.name}/{it.name}" if it.name != SCENE else path.name for it in _scene_files(path))
    return Case(path.name, title, _package(path), kind, path, names)


def _scene_files(folder: Path) -> list[Path]:
    """The scene files directly in the folder of a case."""
    return [path for path in sorted(folder.glob("*.toml")) if path.name not in BESIDE]


def _package(folder: Path) -> str:
    """The command that a case belongs to: its scene has a tank, or its script uses continuum_sph."""
    scenes = _scene_files(folder)
    if (folder / SCENE).is_file():
        scenes = [folder / SCENE]
    elif scripts := list(folder.glob("*.py")):
        used = any("continuum_sph" in path.read_text(encoding="utf-8") for path in scripts)
        return "continuum-sph" if used else "porescale"
    tanks = any("tank" in tomllib.loads(path.read_text(encoding="utf-8")) for path in scenes)
    return "continuum-sph" if tanks else "porescale"


def _there(path: Path) -> bool:
    """Whether there is a file or folder, or something that cannot be looked into."""
    try:
        return path.exists()
    except OSError:  # a name too long, a folder that may not be looked into: said where it is read
        return True
    except ValueError:
        return False


def _from_here(path: Path) -> str:
    """``path`` as it is named from this folder, where it lies in it."""
    try:
        return str(path.relative_to(os.getcwd()))
    except (ValueError, OSError):
        return str(path)
