"""The one place that configures numba; imported when the first kernel is called, by jit.py.

``error_model="numpy"`` because the default division check stops vectorisation.  Fast-math is off: results must not
depend on how a loop was cut into vectors.
"""

import hashlib
import os
import sys
import warnings
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from types import FunctionType
from typing import Any

# Threads that wait at the end of a loop spin for milliseconds by default.  On a machine with other work that costs a
# factor of 20 (measured, two threads beside eight busy processes); this many turns, some 10 us, cost a quiet one
# nothing.
os.environ.setdefault("GOMP_SPINCOUNT", "3000")

import llvmlite
import llvmlite.binding as llvm
import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import config
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, _CacheLocator
from numba.core.codegen import get_host_cpu_features
from numba.core.cpu import CPUTargetOptions
from numba.core.errors import NumbaWarning
from numba.core.registry import cpu_target
from numba.extending import intrinsic, overload

from porescale.common.compiled import library
from porescale.common.compiled.cache import keep_only_used, mark_used, writable
from porescale.common.compiled.jit import GIVEN, body_for, cache_folder, prange, prefetch, thread, unchecked_view
from porescale.common.compiled.kernel_key import Unknown, key_of, warning
from porescale.common.compiled.turns import TURNS

# A row kernel reads and writes nine population rows: LLVM must compare 36 pairs of them before it vectorises,
# and gives up at 8 by default.
llvm.set_option("porescale", "-runtime-memory-check-threshold=256")

# LLVM uses half of the 512 bits of a vector on these processors, which once slowed their clock down.  All of it is
# 1.1 times as fast for fluid that lies in the cache (512² cells, either precision), 1.01 to 1.11 times with grains in
# it, 0.93 to 0.95 times for the contact steps of a thousand grains, and as fast for all else (Xeon of 2024, in turns,
# 2026-12-01).  Bits do not depend on it.
if vars(config)["CPU_FEATURES"] is None and "+avx512f" in get_host_cpu_features():
    vars(config)["CPU_FEATURES"] = f"{get_host_cpu_features()},-prefer-256-bit"
    cpu_target.target_context.codegen()  # made with these features, before variables of numba's might be read anew

# `disjoint` of jit.py: numba has this flag for what it compiles, and gives it no name among the options.
CPUTargetOptions.noalias = CPUTargetOptions.Mapping("noalias")

# Where the folder cannot be written numba would cache beside the sources, or give up: compile anew then.
_KEPT = writable(cache_folder())
_FLAGS: dict[str, Any] = {"error_model": "numpy", "nogil": True}
_INLINED: Any = {"error_model": "numpy", "nogil": True, "forceinline": True, **library.INNER}
library.use()
_MEANT = {"prange": (prange, numba.prange), "thread": (thread, vars(numba)["get_thread_id"])}
"""What kernels import from jit.py under names for which numba accepts its own objects only."""


def dispatcher(function: FunctionType, options: dict[str, Any], *, inner: bool = False) -> Any:
    """numba's dispatcher of a function; in the function's module, names of jit.py come to mean numba's own objects.

    inner : for calls from kernels, not from Python.
    """
    options = {**options, **(library.INNER if inner else library.OUTER)}
    names = function.__globals__
    for name, (ours, own) in _MEANT.items():
        if name in function.__code__.co_names and names.get(name) is ours:
            names[name] = own
    made: Any = numba.njit(**options, **_FLAGS)(function)
    if _KEPT:
        vars(made)["_cache"] = KernelCache(function, options, inner=inner)
    return made


_AT_RUN_TIME = ("NUMBA_CACHE_DIR", "NUMBA_DEBUG_CACHE", "NUMBA_NUM_THREADS", "NUMBA_THREADING_LAYER")
"""Variables that leave compiled code as it is."""


@lru_cache(maxsize=1)
def surroundings() -> str:
    """Hash of what every kernel depends on: these modules, the versions of what compiles, and numba's variables."""
    sources = [Path(__file__).with_name(f"{name}.py").read_text(encoding="utf-8") for name in _MACHINERY]
    versions = (sys.version, numba.__version__, llvmlite.__version__, np.__version__)
    flags = sorted(it for it in os.environ.items() if it[0].startswith("NUMBA_") and it[0] not in _AT_RUN_TIME)
    return hashlib.sha256(repr((sources, versions, flags)).encode()).hexdigest()


_MACHINERY = ("compiling", "jit", "kernel_key", "library", "simd", "simd_code", "simd_rows_code")


def _described(kind: Any) -> Any:
    """The type of an argument as values that `key_of` hashes.  Raises Unknown for functions and other objects."""
    if isinstance(kind, types.BaseTuple):
        parts: Any = kind
        return (str(kind), getattr(kind, "instance_class", None), tuple(_described(it) for it in parts))
    if isinstance(kind, types.Omitted):
        return ("omitted", kind.value)
    if isinstance(kind, types.Literal):
        return ("literal", kind.literal_value)
    if isinstance(kind, types.Array):
        return (str(kind), _described(kind.dtype))
    if isinstance(kind, types.Number | types.Boolean | types.NoneType | types.UnicodeType | types.Record):
        return repr(kind)
    if type(kind).__module__ == f"{__package__}.simd_code":  # its sources are in every key
        return str(kind)
    raise Unknown(f"an argument of type {kind}")


class _Place(_CacheLocator):
    """Where kernels are kept: one folder, whatever file they stand in."""

    def __init__(self, file: str) -> None:
        self._py_file = file

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> Any:
        """Where a function of a file is kept."""
        return cls(py_file)

    def get_cache_path(self) -> str:
        """The folder of compiled kernels."""
        return str(cache_folder())

    def get_source_stamp(self) -> str:
        """Empty text, since the key already covers the source."""
        return ""

    def get_disambiguator(self) -> str:
        """Empty text, since the key already covers what differs."""
        return ""


class _Results(CompileResultCacheImpl):
    """How results are written and read: numba's way, in our place."""

    _locator_classes: Any = (_Place,)


class _Files(IndexDataCacheFile):
    """One file for each key, written whole or not at all; without an index, for the key says what is in it."""

    cleaned = False
    """Whether this process has removed what was not used for long."""

    def load(self, key: str | None) -> Any:
        """What was kept under the key, or None."""
        try:
            kept = self._load_data(f"{key}.nbc") if key else None
        except OSError:
            return None
        mark_used(Path(self._data_path(f"{key}.nbc")))
        return kept

    def save(self, key: str | None, data: Any) -> None:
        """Keep ``data`` under the key."""
        if key is None:
            return
        try:
            with TURNS.writing:
                self._save_data(f"{key}.nbc", data)
        except OSError:  # no room: other processes compile it, too
            return
        if not (GIVEN or _Files.cleaned):
            _Files.cleaned = True
            keep_only_used(Path(self._data_path(f"{key}.nbc")), "*.nbc*")


class KernelCache(FunctionCache):
    """Compiled kernels of one function on disk, kept under all that was compiled into them."""

    _impl_class = _Results

    def __init__(self, function: FunctionType, options: dict[str, Any], *, inner: bool) -> None:
        super().__init__(function)
        self._function, self._options, self._inner = function, options, inner
        self._cache_file = _Files(self._cache_path, "", "")

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What is kept, or None where this process is to compile it; another that does so now is waited for."""
        found = super().load_overload(sig, target_context)
        if found is None and not self._inner:
            name, key = self._function.__name__, self._index_key(sig, target_context.codegen())
            if TURNS.take(name, Path(self._cache_path) / f"{key or name}"):
                found = super().load_overload(sig, target_context)
            if found is not None:
                TURNS.end()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled, if there is room."""
        super().save_overload(sig, data)
        if not self._inner:
            TURNS.end()

    def _index_key(self, sig: Any, codegen: Any) -> str | None:
        """Name of the file for these types of arguments; None, with a warning, where there is no key."""
        try:
            given = (tuple(_described(kind) for kind in getattr(sig, "args", sig)), codegen.magic_tuple())
            key = key_of(self._function, self._options, given, surroundings(), _MEANT)
        except Unknown as unknown:
            warnings.warn(warning(self._function, unknown), NumbaWarning, stacklevel=2)
            return None
        name = f"{self._function.__module__}.{self._function.__qualname__}".replace("<", "").replace(">", "")
        return f"{name[-120:]}-{key}"


def choose_law_function(chosen: Callable[..., Any], bodies: dict[type, Any]) -> None:
    """Let ``chosen`` mean, in kernels, the body for the type of its last argument."""

    def choose(*types: Any) -> Any:
        """The body for the types of the arguments."""
        body = body_for(bodies, getattr(types[-1], "instance_class", type(None)))
        return None if body is None else body.compiled.py_func

    overload(chosen, strict=False, jit_options=_INLINED)(choose)


def choose_precision(chosen: Callable[..., Any], constants: dict[int, Any]) -> None:
    """Let ``chosen`` mean, in kernels, the constants for the bits of its argument."""

    def choose(number: Any) -> Any:
        """A function of the constants of the number's precision."""
        known = constants.get(getattr(number, "bitwidth", 0))
        return None if known is None else lambda number: known

    overload(chosen, strict=False, jit_options=_INLINED)(choose)


def _view(typing: Any, array: Any, first: Any, count: Any) -> Any:
    """Signature and code of ``unchecked_view`` in kernels."""
    if not isinstance(array, numba.types.Array) or array.ndim != 1 or array.layout != "C":
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        """An array of the same memory, from an entry on."""
        whole, made = (
            context.make_array(array)(context, builder, values[0]),
            context.make_array(array)(context, builder),
        )
        size = context.get_constant(numba.intp, context.get_abi_sizeof(context.get_data_type(array.dtype)))
        context.populate_array(
            made, data=builder.gep(whole.data, [values[1]], inbounds=True), shape=[values[2]], strides=[size],
            itemsize=size, meminfo=None,
        )  # fmt: skip
        return made._getvalue()

    return array(array, numba.intp, numba.intp), code


_part: Any = intrinsic(_view)


@overload(unchecked_view, strict=False, jit_options=_INLINED)
def _choose_part(array: Any, first: Any, count: Any) -> Any:
    return lambda array, first, count: _part(array, first, count)


def _prefetch(typing: Any, array: Any, at: Any) -> Any:
    """Signature and code of ``prefetch`` in kernels."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        """The machine's own word for it."""
        data = context.make_array(array)(context, builder, values[0]).data
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        ask = builder.module.declare_intrinsic("llvm.prefetch", (byte,), kind)
        place = builder.bitcast(builder.gep(data, [values[1]]), byte)
        builder.call(ask, [place, number(0), number(3), number(1)])  # to read, near, data
        return context.get_dummy_value()

    return numba.types.none(array, numba.intp), code


_fetch: Any = intrinsic(_prefetch)


@overload(prefetch, strict=False, jit_options=_INLINED)
def _choose_fetch(array: Any, at: Any) -> Any:
    return lambda array, at: _fetch(array, at)
