"""What a compiled kernel was made from, as one hash: the name under which it is kept on disk.

numba compiles into a kernel every function that it calls, the values of the constants that they name, and the body of
each law that they are given.  The key is taken from these objects themselves, and from nothing else: comments,
docstrings, other functions of the same file and the rest of the program leave it as it is.  The same content in another
folder has the same key.

What cannot be followed (`Unknown`) has no key: the kernel is then compiled anew by each process, never kept.
"""

import dis
import hashlib
import sys
from collections.abc import Callable, Iterator
from functools import cache
from types import BuiltinFunctionType, CodeType, EllipsisType, FunctionType, ModuleType
from typing import Any, cast

import numpy as np

from porescale.common.compiled.jit import Kernel, body_for

LIBRARIES = frozenset({*sys.stdlib_module_names, "numpy", "numba", "llvmlite"}) - {"__main__"}
"""Packages whose functions and types are known by their names; their versions belong to ``surroundings``."""

_PLAIN = (bool, int, float, complex, str, bytes, type(None), EllipsisType, np.generic, np.dtype)
_HAS_CONSTANT = frozenset(dis.hasconst)
_GLOBAL, _MORE = dis.opmap["LOAD_GLOBAL"], dis.opmap["EXTENDED_ARG"]


class Unknown(TypeError):
    """Something that a kernel names and that cannot be hashed by content; the text says what."""


def key_of(function: FunctionType, options: Any, given: Any, surroundings: str, own: dict[str, tuple[Any, ...]]) -> str:
    """Key (40 hex digits) of a function compiled with ``options`` for arguments of the types ``given``.

    ``given`` describes types by text, numbers and classes.  surroundings : what every kernel depends on.  ``own`` :
    objects of jit.py that kernels name, and numba's for them, under their common name.  Raises Unknown.
    """
    content = _Content({id(it): name for name, objects in own.items() for it in objects})
    content.add(surroundings, given)
    content.follow(function, options)
    content.close()
    return hashlib.sha256("\0".join(content.words).encode()).hexdigest()[:40]


class _Content:
    """Everything that is compiled into one kernel, each thing once, in the order in which it is come to.

    words : what is hashed;  functions : those followed so far;  laws : NamedTuple classes that may be given to a
    function that depends on the law;  choices : bodies by law of such functions.
    """

    def __init__(self, own: dict[int, str]) -> None:
        self.own = own
        self.words: list[str] = []
        self.functions: dict[FunctionType, int] = {}
        self.laws: dict[type, None] = {}
        self.choices: dict[int, dict[type, Any]] = {}

    def put(self, *words: object) -> None:
        """Hash these words, each with its length: where one ends counts."""
        self.words.extend(f"{len(word)}:{word}" for word in map(str, words))

    def follow(self, function: FunctionType, options: Any) -> None:
        """A function that is compiled: its code, and all that the code names."""
        if function in self.functions:
            self.put("again", self.functions[function])
            return
        self.functions[function] = len(self.functions)
        code, names, attributes = _read(function.__code__)
        self.put("function", function.__module__, function.__qualname__, code)
        self.add(options, function.__defaults__, function.__kwdefaults__)
        self.cells(function)
        for name in names:
            if name in function.__globals__:  # else one of Python's own, known by its name in the code
                self.put(name)
                self.named(function.__globals__[name], attributes)

    def named(self, value: Any, attributes: tuple[str, ...]) -> None:
        """What a global name stands for; of a module, what the code may take from it."""
        if not isinstance(value, ModuleType):
            self.add(value)
            return
        self.put("module", value.__name__)
        for name in attributes:
            if name in vars(value):
                self.put(name)
                self.named(vars(value)[name], attributes)

    def cells(self, function: FunctionType) -> None:
        """What a function made within another one has from it."""
        for cell in function.__closure__ or ():
            try:
                content = cell.cell_contents
            except ValueError:  # nothing in it yet
                self.put("empty")
            else:
                self.add(content)

    def add(self, *values: Any) -> None:
        """Add constants, functions and types to the hash."""
        for value in values:
            if id(value) in self.own:
                self.put("own", self.own[id(value)])
            elif isinstance(value, Kernel):
                self.follow(cast(FunctionType, value.py_func), value.options)
            elif isinstance(value, _PLAIN):
                self.put(type(value).__name__, repr(value))
            elif isinstance(value, np.ndarray) and not value.dtype.hasobject:
                self.put("array", value.dtype.descr, value.shape, value.strides, _hash(value.tobytes()))
            elif isinstance(value, tuple | list | dict):
                self.gathered(value)
            elif isinstance(value, FunctionType) and "meaning" in vars(value):
                self.by_meaning(value, vars(value)["meaning"])
            elif isinstance(value, type):
                self.kind(value)
            else:
                self.by_name(value)

    def gathered(self, values: Any) -> None:
        """Several values: a tuple, also one with named fields, a list, or a dict."""
        if hasattr(values, "_fields"):
            self.kind(type(values))
        self.put(type(values).__name__, len(values))
        self.add(*([part for pair in values.items() for part in pair] if isinstance(values, dict) else values))

    def by_meaning(self, function: FunctionType, meaning: Any) -> None:
        """A function of jit.py that compiling.py makes from ``meaning``: bodies by law, or numbers."""
        self.put("meaning", function.__module__, function.__name__)
        if isinstance(meaning, dict) and all(isinstance(it, Kernel) for it in meaning.values()):
            self.choices[id(meaning)] = meaning
        else:
            self.add(meaning)

    def kind(self, kind: type) -> None:
        """A type: a law by its fields, one of a library and an error by its name."""
        self.put("type", kind.__module__, kind.__qualname__)
        if issubclass(kind, tuple) and hasattr(kind, "_fields"):
            found: Any = sys.modules.get(kind.__module__)
            if kind.__module__ == "__main__" or getattr(found, kind.__qualname__, None) is not kind:
                raise Unknown(f"{kind.__qualname__}, which no other process can import")
            if kind not in self.laws:
                self.laws[kind] = None
                self.add(kind._fields, getattr(kind, "_field_defaults", None))  # own or of a base class
        elif not (issubclass(kind, BaseException) or _root(kind) in LIBRARIES):
            raise Unknown(f"the class {kind.__qualname__}")

    def by_name(self, value: Any) -> None:
        """A function of a library, of jit.py or simd.py; or a dispatcher of numba's own."""
        if hasattr(value, "targetoptions") and _root(value) not in LIBRARIES:
            self.follow(value.py_func, value.targetoptions)
        elif isinstance(value, FunctionType) and value.__module__ in OVERLOADED:
            self.put("overloaded", value.__module__, value.__qualname__)
            self.cells(value)
        elif isinstance(value, _FUNCTIONS) and _root(value) in LIBRARIES:
            self.put("library", getattr(value, "__module__", None), value.__name__)
        else:
            raise Unknown(f"{getattr(value, '__qualname__', repr(value))} of {type(value).__qualname__}")

    def close(self) -> None:
        """The bodies of all laws that the kernel can come to, until no more are found."""
        done = set[tuple[int, type]]()
        while open_ := [(k, law) for k in self.choices for law in self.laws if (k, law) not in done]:
            for at, law in open_:
                done.add((at, law))
                body = body_for(self.choices[at], law)
                if body is not None:
                    self.put("body", law.__qualname__)
                    self.add(body)


OVERLOADED = frozenset(f"{__package__}.{name}" for name in ("jit", "simd"))
"""Modules whose functions compiling.py and simd_code.py compile; all of these belong to ``surroundings``."""

_FUNCTIONS = (FunctionType, BuiltinFunctionType, np.ufunc, type(np.sum))


def _root(value: Any) -> str:
    """Package of a function or type."""
    return str(getattr(value, "__module__", None) or type(value).__module__).partition(".")[0]


def _hash(content: bytes) -> str:
    """SHA-256 hash of bytes, hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def _instructions(code: CodeType) -> Iterator[tuple[int, int]]:
    """Instructions of a function, each with its argument."""
    high = 0
    for operation, low in zip(code.co_code[::2], code.co_code[1::2], strict=True):
        argument = high | low
        if operation == _MORE:
            high = argument << 8
        else:
            high = 0
            yield operation, argument


@cache
def _read(code: CodeType) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """Hash of a function's code without its docstring and line numbers, the global names in it, and all names.

    Functions within the function count as parts of it.
    """
    named, constants = dict[str, None](), set[int]()
    for operation, argument in _instructions(code):
        if operation == _GLOBAL:
            named[code.co_names[argument >> 1]] = None
        elif operation in _HAS_CONSTANT:
            constants.add(argument)
    attributes = dict.fromkeys(code.co_names)
    parts: list[object] = [
        code.co_code.hex(), code.co_exceptiontable.hex(), code.co_flags, code.co_argcount, code.co_posonlyargcount,
        code.co_kwonlyargcount, code.co_name, code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars,
    ]  # fmt: skip
    for k, constant in enumerate(code.co_consts):
        if isinstance(constant, CodeType):
            inner, names, others = _read(constant)
            named.update(dict.fromkeys(names))
            attributes.update(dict.fromkeys(others))
            parts.append(inner)
        elif k in constants or not isinstance(constant, str):  # a text that no instruction takes is the docstring
            parts.append(sorted(map(repr, constant)) if isinstance(constant, frozenset) else repr(constant))
    return _hash("\0".join(map(str, parts)).encode()), tuple(named), tuple(attributes)


def warning(function: Callable[..., Any], unknown: Unknown) -> str:
    """Text that says why a kernel is not kept on disk."""
    return f"{function.__qualname__} is compiled anew by each process: {unknown} cannot be hashed by content"
