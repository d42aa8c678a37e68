"""Imports point down, and rooms on a floor are strangers (shared design: the floors)."""

from __future__ import annotations

import ast

import pytest
from sources import Source, sources, written

TOP = 6
FLOORS = {
    "porescale.common.core": 0,
    "porescale.common.neighbors": 1,
    "porescale.common.record": 1,
    "porescale.common": 1,
    "porescale.lbm": 2,
    "porescale.dem": 2,
    "porescale.piv": 2,
    "continuum_sph": 2,
    "porescale.coupling": 3,
    "porescale.scene": 4,
    "porescale.demseg": 4,
    "continuum_sph.scene": 4,
    "porescale.cli": 5,
    "continuum_sph.cli": 5,
    "porescale.__main__": TOP,
    "continuum_sph.__main__": TOP,
    "porescale": TOP,
}
WITHOUT_PHYSICS = ("porescale.common.core", "porescale.common.neighbors", "porescale.common.record", "porescale.common")


def room(name: str) -> str:
    """The room a dotted name lies in: the longest one that it begins with."""
    parts = name.split(".")
    two = ".".join(parts[:2])
    return two if two in FLOORS else parts[0]


def wrong_doors(modules: list[Source]) -> list[str]:
    """Imports that point up or into a room on the same floor, and modules that lie in no room."""
    found = []
    for source in modules:
        here = room(source.module)
        facade = source.module in ("porescale", "continuum_sph")  # a package's __init__ offers its Python API
        if here == "porescale" and not facade:
            found.append(f"{source.path}: {source.module} lies on no floor")
            continue
        floor = TOP if facade else FLOORS[here]
        for node, name in source.imports():
            there = room(name)
            if there not in FLOORS or there == here or _asks_for_the_version(source, name):
                continue
            strangers = there.split(".")[0] != here.split(".")[0] and there not in WITHOUT_PHYSICS
            if FLOORS[there] >= floor or strangers:
                found.append(f"{source.at(node)}: {here} imports {name}")
    return found


def _asks_for_the_version(source: Source, name: str) -> bool:
    """Whether an import of the whole package serves nothing but its ``__version__``."""
    if name == "porescale.__version__":
        return True
    if name != "porescale":
        return False
    uses = [n for n in ast.walk(source.tree) if isinstance(n, ast.Attribute) and isinstance(n.value, ast.Name)]
    return all(use.attr == "__version__" for use in uses if use.value.id == "porescale")


def test_imports_point_down_and_rooms_are_strangers() -> None:
    assert wrong_doors(sources()) == []


def test_there_is_something_to_check() -> None:  # the twin of a check that passes because it sees nothing
    modules = sources()
    assert len(modules) > 20
    assert sum(name.startswith("porescale.common.core") for source in modules for _, name in source.imports()) > 20


@pytest.mark.parametrize(
    ("module", "text"),
    [
        ("porescale.common.core.units", "import porescale.common.record"),
        ("porescale.common.record.drive", "from porescale.common.cli.report import Report"),
        ("porescale.common.record.drive", "from porescale import workbench"),
        ("porescale.lbm.step", "def f():\n    from porescale.dem import bodies"),
        ("porescale.lbm.step", "from ..dem import bodies"),
        ("porescale.dem.step", "if TYPE_CHECKING:\n    from porescale.coupling.step import Step"),
        ("porescale.coupling.step", "from porescale.build.build import build"),
        ("porescale.build.build", "import porescale.cli.main"),
        ("porescale.build.build", "import continuum_sph.soil"),
        ("porescale.common.record.card", "import porescale\nporescale.load('x')"),
        ("porescale.common.record.card", "from porescale import Simulation"),
        ("porescale.extra.thing", ""),
        ("continuum_sph.soil", "from porescale.dem import bodies"),
        ("continuum_sph.soil", "from continuum_sph.scene import Scene"),
        ("continuum_sph.soil", "from . import app"),
        ("continuum_sph.cli", "from porescale.cli import main"),
        ("continuum_sph.cli", "from porescale.coupling import step"),
        ("continuum_sph", "from porescale.scene import build"),
    ],
)
def test_a_wrong_door_is_found(module: str, text: str) -> None:
    assert len(wrong_doors([written(module, text)])) == 1


@pytest.mark.parametrize(
    ("module", "text"),
    [
        (
            "porescale.common.record.drive",
            "from porescale.common.core.errors import Fault\nfrom porescale.common.record import card",
        ),
        ("porescale.common.record.card", "import porescale\nprint(porescale.__version__)"),
        ("porescale.coupling.step", "from porescale.lbm import step\nfrom porescale.dem import bodies"),
        ("porescale.cli.main", "from porescale import __version__\nimport porescale.build.build, numpy"),
        ("porescale.__main__", "from porescale.cli.main import main"),
        ("continuum_sph.soil", "from porescale.common.neighbors import pairs\nfrom . import eos"),
        ("continuum_sph.scene", "from continuum_sph.soil import Soil\nimport porescale.common.schema.sections"),
        ("continuum_sph.cli", "from continuum_sph.scene import Scene"),
        ("continuum_sph", "from continuum_sph.scene import Scene"),
        ("porescale", "from porescale.build.build import Simulation"),
    ],
)
def test_a_right_door_is_open(module: str, text: str) -> None:
    assert wrong_doors([written(module, text)]) == []
