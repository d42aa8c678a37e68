"""The texts that a user's own law stands on: of its file and those beside it that the file imports, or of itself."""

import ast
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from types import FunctionType
from typing import Any

from porescale.common.core.errors import Fault, InputError

LIBRARIES = frozenset({"porescale", "continuum_sph", "numpy", "numba", "scipy", *sys.stdlib_module_names})
"""Packages that no file of a user's folder stands for."""


def place(file: str, line: int | None) -> str:
    """A line of a file, or of a cell of a notebook, for messages."""
    return f"{Path(file).name if Path(file).is_file() else 'notebook'}, line {line}"


def sources_of(function: FunctionType) -> dict[str, str]:
    """Text of all that a function stands on: of its file and those beside it that the file imports, by their names.

    Of a function without a file: its own text, and what its global names stand for.
    """
    path = Path(function.__code__.co_filename)
    if path.is_file():
        return texts_of(path)
    return dict(_pieces(function, set()))


def texts_of(path: Path) -> dict[str, str]:
    """Texts of a file and of those in its folder that it imports, one way or another, by their names."""
    texts: dict[str, str] = {}
    _add(path.resolve(), path.resolve().parent, texts)
    return texts


def _add(path: Path, folder: Path, texts: dict[str, str]) -> None:
    """Add to ``texts`` that of a file and of what it imports of ``folder``."""
    name = path.relative_to(folder).as_posix()
    if name in texts or not path.is_file():
        return
    texts[name] = path.read_text(encoding="utf-8-sig", errors="replace")
    try:
        tree = ast.parse(texts[name])
    except (SyntaxError, ValueError):
        return
    for module in _imported(tree):
        parts = module.split(".")
        if parts[0] in LIBRARIES:
            continue
        for length in range(1, len(parts) + 1):
            below = folder.joinpath(*parts[:length])
            _add(below.with_suffix(".py"), folder, texts)
            _add(below / "__init__.py", folder, texts)


def _imported(tree: ast.Module) -> Iterator[str]:
    """Dotted names that the imports of a file may mean."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (it.name for it in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            yield base or "."
            yield from (f"{base}.{it.name}".strip(".") for it in node.names)


def _pieces(function: FunctionType, done: set[int]) -> Iterator[tuple[str, str]]:
    """Name and text of a function without a file, and of what its global names stand for."""
    if id(function) in done:
        return
    done.add(id(function))
    try:
        yield function.__name__, inspect.getsource(function)
    except (OSError, TypeError):
        problem = "has neither a file nor a text that Python keeps"
        raise InputError(Fault(function.__name__, None, problem, repair="put it into a file, laws.py")) from None
    for name in function.__code__.co_names:
        value: Any = function.__globals__.get(name)
        inner = getattr(value, "function", getattr(value, "py_func", value))
        if isinstance(inner, FunctionType) and not Path(inner.__code__.co_filename).is_file():
            yield from _pieces(inner, done)
        elif isinstance(value, bool | int | float | complex | str | tuple):
            yield name, f"{name} = {value!r}"
