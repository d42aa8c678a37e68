"""Scripts of cases use public names alone, and every public name is there, described, and imported when first used.

A module is public where its folder has an ``__init__.pyi``, and that list holds its public names.
"""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any

import pytest

from tests.architecture.sources import PACKAGES, exports
from tests.reference.folders import ROOT

PUBLIC = exports()
SCRIPTS = sorted((ROOT / "cases").rglob("*.py"))
EXAMPLES = [(module, name) for module, names in PUBLIC.items() for name in names]
HEAVY = ("numba", "pydantic", "matplotlib", "h5py", "scipy")

Public = Mapping[str, Mapping[str, str]]


def _own(name: str) -> bool:
    return name.split(".")[0] in PACKAGES


def not_public(text: str, public: Public = PUBLIC) -> Iterator[str]:
    """Names of the packages that a script takes and that no public module has, wherever the import stands."""
    modules: dict[str, str] = {}  # what a script calls public modules
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in (it for it in node.names if _own(it.name)):
                if alias.name not in public:
                    yield alias.name
                modules[alias.asname or alias.name.split(".")[0]] = alias.name if alias.asname else ""
        elif isinstance(node, ast.ImportFrom) and not node.level and _own(node.module or ""):
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                if whole in public:
                    modules[alias.asname or alias.name] = whole
                elif alias.name not in public.get(node.module or "", {}):
                    yield whole
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            way = ast.unparse(node).split(".")
            if way[0] in modules:
                holder = ".".join([modules[way[0]] or way[0], *way[1:-1]])
                whole = f"{holder}.{way[-1]}"
                if holder in public and whole not in public and way[-1] not in {*public[holder], "__version__"}:
                    yield whole
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("import_module", "__import__")):
            yield ast.unparse(node)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_of_a_case_uses_public_names_alone(script: object) -> None:
    assert list(not_public(script.read_text(encoding="utf-8"))) == []  # type: ignore[attr-defined]


def test_there_are_scripts_and_public_modules() -> None:
    assert len(SCRIPTS) > 40
    assert {"porescale", "continuum_sph", "porescale.dem", "continuum_sph.soil"} < set(PUBLIC)


@pytest.mark.parametrize(
    "text",
    [
        "from porescale.dem.grains import Grains",
        "from porescale.dem import PairForces",
        "def f():\n    from porescale.common.record.drive import drive",
        "import porescale.dem.grains",
        "import porescale.dem.grains as grains",
        "from porescale import builders",
        "import porescale as ps\nps.builders.build.build",
        "import porescale\nporescale.dem.grains.Grains",
        "from porescale import dem\ndem.grains",
        "from importlib import import_module\nimport_module('porescale.dem.grains')",
    ],
)
def test_a_wrong_script_is_found(text: str) -> None:
    assert list(not_public(text))


@pytest.mark.parametrize(
    "text",
    [
        "import numpy.linalg\nfrom scipy.special import jv\nfrom variants import VARIANTS",
        "from porescale.dem import Grains, Linear",
        "import porescale as ps\nps.load('x').domain.width\nps.dem.Grains",
        "import porescale.dem\nporescale.dem.Grains",
        "from porescale import dem\ndem.Grains.step",
        "from continuum_sph.validation.water import flows\nflows.anything",
    ],
)
def test_a_right_script_passes(text: str) -> None:
    assert list(not_public(text)) == []


@pytest.mark.parametrize("module", sorted(PUBLIC))
def test_the_list_of_a_public_module_is_what_it_has(module: str) -> None:
    made = import_module(module)
    names = {*PUBLIC[module], "__version__"} if "." not in module else {*PUBLIC[module]}
    assert set(made.__all__) == names
    assert set(dir(made)) | {"__version__"} == names | {"__version__"}
    stub = ast.parse((ROOT / module.replace(".", "/") / "__init__.pyi").read_text(encoding="utf-8"))
    listed = {it.asname for node in stub.body if isinstance(node, ast.ImportFrom) for it in node.names}
    assert listed | {"__version__"} == names | {"__version__"}, "what type checkers read: `name as name`"
    assert made.__doc__


def tabled(text: str) -> set[str]:
    """Modules that the table of public modules names."""
    part = text.partition("## Public modules")[2].partition("\n## ")[0]
    rows = [line.split("|")[1] for line in part.splitlines() if line.startswith("| `")]
    return {name for row in rows for name in re.findall(r"`([\w.]+)`", row)}


def test_the_page_of_python_names_every_public_module() -> None:
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    assert tabled(text) == set(PUBLIC)
    assert tabled(text.replace("`porescale.dem`", "`porescale.den`")) != set(PUBLIC)  # the twin: it would be seen


def test_the_example_of_public_modules_runs() -> None:
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8").partition("## Public modules")[2]
    code = text.partition("```python\n")[2].partition("```")[0]
    assert list(not_public(code)) == []
    names: dict[str, Any] = {}
    exec(code, names)
    assert names["grains"].steps == 1000


def undescribed(made: object, name: str) -> bool:
    """Whether a class, function or module has no description of its own."""
    if not (inspect.isclass(made) or inspect.isroutine(made) or isinstance(made, ModuleType)):
        return False  # a constant or an annotation
    text = vars(made).get("__doc__") if inspect.isclass(made) else inspect.getdoc(made)
    return not text or text.startswith(f"{name}(")  # what dataclass makes


@pytest.mark.parametrize(("module", "name"), EXAMPLES)
def test_a_public_name_is_there_and_described(module: str, name: str) -> None:
    assert not undescribed(getattr(import_module(module), name), name)


def test_what_is_not_described_is_found() -> None:
    class Bare:
        pass

    def bare() -> None: ...

    assert undescribed(Bare, "Bare")
    assert undescribed(bare, "bare")
    with pytest.raises(AttributeError):
        _ = import_module("porescale.dem").nothing_of_this_name


def loaded_by(code: str) -> set[str]:
    """Which of HEAVY a fresh interpreter has loaded after ``code``."""
    end = f"\nimport sys; print(*[it for it in {HEAVY} if it in sys.modules])"
    asked = subprocess.run(
        [sys.executable, "-c", code + end], capture_output=True, text=True, check=True, cwd=ROOT, timeout=120
    )
    return set(asked.stdout.split())


def test_public_modules_load_nothing_until_a_name_is_used() -> None:
    assert loaded_by("\n".join(f"import {it}" for it in PUBLIC)) == set()
    assert "matplotlib" in loaded_by("from porescale.output import conclude")
