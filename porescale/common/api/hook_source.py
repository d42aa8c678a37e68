"""What a hook is, so that a run is gone on with by the same one: its source text, and a hash of what it uses."""

import ast
import hashlib
import inspect
import textwrap
from collections.abc import Callable, Iterator
from contextlib import suppress
from types import CodeType, FunctionType
from typing import Any

import numpy as np

DIGITS = 16
"""Hex digits of a hash on a card."""
DEEP = 8
"""Functions within functions, and values within values, that are followed."""


def source_of(function: Callable[..., Any]) -> str:
    """The text of a function from its ``def`` on, without decorators; "" where it cannot be read."""
    try:
        text = textwrap.dedent(inspect.getsource(function))
        node = ast.parse(text).body[0]
    except (OSError, TypeError, SyntaxError, IndexError):
        return ""
    lines = text.splitlines()[node.lineno - 1 :] if isinstance(node, ast.FunctionDef) else text.splitlines()
    return "\n".join(lines).rstrip() + "\n"


def hash_of(function: Callable[..., Any]) -> str:
    """Hash of the source of a function and of what it uses: defaults, values of closures and globals, and functions and
    classes of its own module, theirs too.

    Of modules, and of functions and classes from elsewhere, only the names count, as of objects of any other kind.
    """
    whole = hashlib.sha256()
    for part in _described(function, set(), 0):
        whole.update(part.encode())
        whole.update(b"\0")
    return whole.hexdigest()[:DIGITS]


def _described(function: Callable[..., Any], seen: set[int], depth: int) -> Iterator[str]:
    """Texts that tell a function from another one."""
    seen.add(id(function))
    plain = inspect.unwrap(function)
    if not isinstance(plain, FunctionType):
        yield f"{type(function).__module__}.{type(function).__qualname__}"
        return
    yield source_of(plain) or repr(_compiled(plain.__code__))
    yield from _value("defaults", [plain.__defaults__, plain.__kwdefaults__], plain, seen, depth)
    names = _names(plain.__code__)
    known = {name: plain.__globals__[name] for name in names if name in plain.__globals__}
    for name, value in sorted({**known, **_enclosed(plain)}.items()):
        yield from _value(name, value, plain, seen, depth)


def _enclosed(function: FunctionType) -> dict[str, Any]:
    """Names that a function has from those about it, and their values; without those that have none yet, as its own
    name has none while it is decorated."""
    found = {}
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        with suppress(ValueError):  # of a cell that is empty
            found[name] = cell.cell_contents
    return found


def _names(code: CodeType) -> set[str]:
    """Names of globals in a function and in those within it."""
    inner = (it for it in code.co_consts if isinstance(it, CodeType))
    return {*code.co_names, *(name for it in inner for name in _names(it))}


def _compiled(code: CodeType) -> list[Any]:
    """What tells a function from another one whose source cannot be read: instructions, names, constants."""
    constants = [_compiled(it) if isinstance(it, CodeType) else it for it in code.co_consts]
    return [code.co_code.hex(), code.co_names, code.co_varnames, constants]


def _value(name: str, value: Any, of: FunctionType, seen: set[int], depth: int) -> Iterator[str]:
    """Texts that tell a value, which ``of`` uses as ``name``, from another one."""
    if value is None or isinstance(value, bool | int | float | complex | str | bytes):
        yield f"{name} = {value!r}"
    elif isinstance(value, np.ndarray | np.generic) and value.dtype != object:
        array = np.ascontiguousarray(value)
        yield f"{name} = {array.dtype.str}{array.shape}{hashlib.sha256(array.tobytes()).hexdigest()}"
    elif id(value) in seen or depth > DEEP:
        yield f"{name} again"
    elif isinstance(value, list | tuple | dict | set | frozenset):
        seen.add(id(value))
        listed = sorted(value, key=repr) if isinstance(value, set | frozenset) else value
        pairs = value.items() if isinstance(value, dict) else enumerate(listed)
        yield f"{name} = {type(value).__name__} of {len(value)}"
        for key, item in pairs:
            yield from _value(f"{name}[{key!r}]", item, of, seen, depth + 1)
    elif isinstance(value, FunctionType) and value.__module__ == of.__module__:
        yield name
        yield from _described(value, seen, depth + 1)
    elif isinstance(value, type) and value.__module__ == of.__module__:
        yield f"{name} = {_class_source(value)}"
    else:
        kind = value if isinstance(value, type | FunctionType) else type(value)
        yield f"{name} = {getattr(value, '__name__', '')} {kind.__module__}.{kind.__qualname__}"


def _class_source(kind: type) -> str:
    """The text of a class, its name where it cannot be read."""
    try:
        return inspect.getsource(kind)
    except (OSError, TypeError):
        return kind.__qualname__
