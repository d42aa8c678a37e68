"""A user's function as a kernel: what it calls is compiled with it, and what numba has to say comes in one line."""

import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from types import CellType, CodeType, FunctionType, ModuleType
from typing import Any

from porescale.common.compiled.jit import Kernel, compiler, inline
from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_sources import LIBRARIES, place
from porescale.common.compiled.turns import TURNS
from porescale.common.core.errors import Fault, InputError

_PLACE = re.compile(r"""(?:at |File ")(?P<file>[^"\n]+?)(?:" ?, line | \()(?P<line>\d+)""")


@lru_cache(maxsize=64)
def kernel_of(function: FunctionType) -> Kernel:
    """The function as an inline kernel; plain functions that it calls, of its file or others, are compiled with it."""
    made: Any = inline(_adopted(function, {}))
    kernel: Kernel = made
    return kernel


def _adopted(function: FunctionType, done: dict[int, Any]) -> FunctionType:
    """A copy of a function for which the plain functions that it names are kernels."""
    names = dict(function.__globals__)
    cells = tuple(CellType(_compiled(it.cell_contents, (), done)) for it in function.__closure__ or ())
    copy = FunctionType(function.__code__, names, function.__name__, function.__defaults__, cells or None)
    copy.__kwdefaults__, copy.__qualname__ = function.__kwdefaults__, function.__qualname__
    copy.__module__ = __name__  # kernels that are kept ask for a module that every process can import
    done[id(function)] = inline(copy)
    used = _names(function.__code__)
    for name in used:
        if name in names:
            names[name] = _compiled(names[name], used, done)
    return copy


def _compiled(value: Any, used: tuple[str, ...], done: dict[int, Any]) -> Any:
    """What a name stands for, as kernels call it;  used : attributes that may be taken of a module."""
    if isinstance(value, OwnLaw):
        value = value.function
    if id(value) in done:
        return done[id(value)]
    if isinstance(value, FunctionType) and _own(value.__module__):
        _adopted(value, done)
        return done[id(value)]
    if isinstance(value, ModuleType) and _own(value.__name__):
        proxy = ModuleType(value.__name__)
        done[id(value)] = proxy
        for name, it in vars(value).items():
            if name in used:
                vars(proxy)[name] = _compiled(it, used, done)
        return proxy
    return value


def _own(module: str | None) -> bool:
    """Whether a module is a user's."""
    return str(module).partition(".")[0] not in LIBRARIES


def _names(code: CodeType) -> tuple[str, ...]:
    """All names in a function and those within it."""
    inner = [name for it in code.co_consts if isinstance(it, CodeType) for name in _names(it)]
    return tuple(dict.fromkeys([*code.co_names, *inner]))


def compile_for(law: OwnLaw, *arguments: Any, count: int) -> Callable[..., Any]:
    """The law compiled for arguments like these, if it returns ``count`` numbers; else InputError in one line."""
    made = kernel_of(law.function).compiled
    try:
        result = made(*arguments)
    except compiler().numba.core.errors.NumbaError as error:
        raise InputError(Fault("", law.reference, _said(error, law), repair="correct it there")) from None
    except Exception as error:
        problem = f"{law.place}: {law.name} raises {type(error).__name__}: {error}"
        raise InputError(Fault("", law.reference, problem, repair="correct it there")) from None
    finally:
        TURNS.end()  # numba says nothing of a kernel that it gave up
    got = result if isinstance(result, tuple) else (result,)
    if len(got) != count or not all(isinstance(it, int | float) for it in got):
        what = "a number" if count == 1 else f"{count} numbers"
        shown = "nothing" if result is None else repr(result)
        problem = f"{law.place}: {law.name} returns {shown}, not {what}"
        raise InputError(Fault("", law.reference, problem, repair="write return with it")) from None
    compiled: Callable[..., Any] = made
    return compiled


def _said(error: Exception, law: OwnLaw) -> str:
    """What numba says, in one line with the place."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
    names = {Path(law.function.__code__.co_filename).name, *law.sources}
    found = [(it["file"], int(it["line"])) for it in _PLACE.finditer(text)]
    own = [(file, line) for file, line in found if Path(file).name in names] or found
    where = law.place if not own else f"{Path(own[0][0]).name}, line {own[0][1]}" if law.file else place(*own[0])
    lines = [it.strip() for it in text.splitlines()]
    told = [it for it in lines if it and not it.startswith(("Failed in", "During", "File ", "There are", "-", "["))]
    said = " ".join(told[:2]) if told and told[0].endswith(":") else (told or ["cannot be compiled"])[0]
    return f"{where}: {said}"
