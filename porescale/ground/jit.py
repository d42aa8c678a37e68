"""The one place that configures numba.

Kernels are compiled once and kept on disk.  numba stamps a cached kernel with its own file only, so an edited
contact law would survive inside a cached pair loop; the cache folder is therefore named after a hash of all
sources of both packages.  ``error_model="numpy"`` because the default division check stops vectorisation.
Fast-math is off: results must not depend on how a loop was cut into vectors.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from porescale.ground.cache import cache_root, hash_of, keep_only_used, writable
from porescale.ground.check import Fault, InputError

PACKAGES = ("porescale", "continuum_sph")


def source_hash() -> str:
    """Hash (12 hex digits) of every Python source of both packages."""
    root = Path(__file__).resolve().parents[2]
    return hash_of(root / package for package in PACKAGES)


def cache_folder() -> Path:
    """Folder for compiled kernels: ``$NUMBA_CACHE_DIR`` if set, else one named after the sources' hash."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    if given:
        return Path(given)
    return cache_root() / f"kernels-{source_hash()}-py{sys.version_info.major}{sys.version_info.minor}"


if not os.environ.get("NUMBA_CACHE_DIR"):
    KERNELS = cache_folder()
    os.environ["NUMBA_CACHE_DIR"] = str(KERNELS)
    keep_only_used(KERNELS, "kernels-*")
# Threads that wait at the end of a loop spin for milliseconds by default.  On a machine with other work that costs a
# factor of 20 (measured, two threads beside eight busy processes); this many turns, some 10 us, cost a quiet one
# nothing.
os.environ.setdefault("GOMP_SPINCOUNT", "3000")

import llvmlite.binding as llvm  # noqa: E402  (after the cache folder is set)
import numba  # noqa: E402
import numpy as np  # noqa: E402
from llvmlite import ir  # noqa: E402
from numba.extending import intrinsic, overload  # noqa: E402

# A row kernel reads and writes nine population rows: LLVM must compare 36 pairs of them before it vectorises,
# and gives up at 8 by default.
llvm.set_option("porescale", "-runtime-memory-check-threshold=256")

F = TypeVar("F", bound=Callable[..., Any])
# Where the folder cannot be written numba would cache beside the sources, or give up: compile anew then.
_FLAGS: dict[str, Any] = {"error_model": "numpy", "cache": writable(cache_folder()), "nogil": True}
_INLINED: Any = {"error_model": "numpy", "nogil": True, "forceinline": True}


def kernel(function: F) -> F:
    """Compile a serial kernel over arrays and numbers."""
    compiled: F = numba.njit(**_FLAGS)(function)
    return compiled


def parallel_kernel(function: F) -> F:
    """Compile a kernel whose ``prange`` loops run over threads; it must give the same bits at any count."""
    compiled: F = numba.njit(parallel=True, **_FLAGS)(function)
    return compiled


def inline(function: F) -> F:
    """Compile a small function that LLVM merges into the kernels that call it."""
    compiled: F = numba.njit(forceinline=True, **_FLAGS)(function)
    return compiled


def by_law(signature: F) -> Any:
    """Make an inline kernel whose body depends on the type of its last argument, the law: a NamedTuple of numbers.

    A sweep that takes a law and hands it on is compiled once for each law in use, and kept on disk, which it is not for
    functions as arguments.  ``signature`` lends name and docstring; ``@name.of(Law, ...)`` adds a body.  A law must be
    flat: loops over threads take no tuples within tuples.
    """
    bodies: dict[type, Any] = {}

    def chosen(*arguments: Any) -> Any:
        return bodies[type(arguments[-1])](*arguments)

    def plain(*arguments: Any) -> Any:
        return bodies[type(arguments[-1])].py_func(*arguments)

    def choose(*types: Any) -> Any:
        body = bodies.get(getattr(types[-1], "instance_class", type(None)))
        return None if body is None else body.py_func

    def of(*laws: type) -> Callable[[F], F]:
        def add(body: F) -> F:
            compiled = body if hasattr(body, "py_func") else inline(body)
            bodies.update(dict.fromkeys(laws, compiled))
            return compiled

        return add

    vars(chosen).update(__name__=signature.__name__, __doc__=signature.__doc__, of=of, py_func=plain)
    overload(chosen, strict=False, jit_options=_INLINED)(choose)
    return chosen


def by_precision(build: Callable[[type], Any]) -> Any:
    """Make an inline kernel of one number that returns ``build(np.float32)`` or ``build(np.float64)`` as constants.

    A float64 literal promotes a float32 kernel; what this returns for a number of the kernel's own precision does not.
    """
    constants = {32: build(np.float32), 64: build(np.float64)}

    def chosen(number: Any) -> Any:
        return constants[8 * np.dtype(type(number)).itemsize]

    def choose(number: Any) -> Any:
        known = constants.get(getattr(number, "bitwidth", 0))
        return None if known is None else lambda number: known

    vars(chosen).update(__name__=build.__name__, __doc__=build.__doc__)
    overload(chosen, strict=False, jit_options=_INLINED)(choose)
    return chosen


def part(array: Any, first: Any, count: Any) -> Any:
    """``count`` entries of a one-dimensional array from ``first`` on; for loops that take many short parts.

    In kernels a view that owns nothing: a slice made the usual way counts references and is cut to the array, which
    costs more than a part of a dozen entries.  Not checked: that the part lies in the array.
    """
    return array[first : first + count]


def _view(typing: Any, array: Any, first: Any, count: Any) -> Any:
    """``part`` in kernels."""
    if not isinstance(array, numba.types.Array) or array.ndim != 1 or array.layout != "C":
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
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


@overload(part, strict=False, jit_options=_INLINED)
def _choose_part(array: Any, first: Any, count: Any) -> Any:
    return lambda array, first, count: _part(array, first, count)


def fetch(array: Any, at: Any) -> None:
    """Ask for the entry ``at`` of a contiguous array, counted as if it were flat, to be brought to the nearest cache.

    For entries that a loop comes to in an order that no machine foresees.  Does nothing else, nor in plain Python.
    """


def _prefetch(typing: Any, array: Any, at: Any) -> Any:
    """``fetch`` in kernels."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        data = context.make_array(array)(context, builder, values[0]).data
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        ask = builder.module.declare_intrinsic("llvm.prefetch", (byte,), kind)
        place = builder.bitcast(builder.gep(data, [values[1]]), byte)
        builder.call(ask, [place, number(0), number(3), number(1)])  # to read, near, data
        return context.get_dummy_value()

    return numba.types.none(array, numba.intp), code


_fetch: Any = intrinsic(_prefetch)


@overload(fetch, strict=False, jit_options=_INLINED)
def _choose_fetch(array: Any, at: Any) -> Any:
    return lambda array, at: _fetch(array, at)


def sum_by_halves(count: int) -> Any:
    """Make an inline kernel (array, first) that sums ``count`` entries, a power of two, from ``first`` on.

    The second half is added to the first until one is left: vector additions, in an order that no machine changes.
    """

    def total(array: Any, first: Any) -> Any:
        left = array[first : first + count]
        while left.shape[0] > 1:
            half = left.shape[0] // 2
            left = left[:half] + left[half:]
        return left[0]

    def vector(typing: Any, array: Any, first: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            start = builder.gep(context.make_array(array)(context, builder, values[0]).data, [values[1]], inbounds=True)
            kind = ir.VectorType(context.get_data_type(array.dtype), count)
            left = builder.load(builder.bitcast(start, kind.as_pointer()), align=4)
            size = count
            while size > 1:
                size //= 2
                none = ir.Constant(left.type, ir.Undefined)
                halves = [
                    builder.shuffle_vector(left, none, ir.Constant(ir.VectorType(ir.IntType(32), size), lanes))
                    for lanes in (list(range(size)), list(range(size, 2 * size)))
                ]
                left = builder.fadd(*halves)
            return builder.extract_element(left, ir.Constant(ir.IntType(32), 0))

        return array.dtype(array, numba.intp), code

    vector_total: Any = intrinsic(vector)

    def choose(array: Any, first: Any) -> Any:
        return lambda array, first: vector_total(array, first)

    vars(total)["py_func"] = total
    overload(total, strict=False, jit_options=_INLINED)(choose)
    return total


prange = numba.prange
thread: Any = vars(numba)["get_thread_id"]
"""Number, below ``most_threads()``, of the thread that runs an iteration of a prange loop: for scratch, not results."""


def set_threads(count: int | None) -> int:
    """Use ``count`` threads (None: all cores) in parallel kernels; returns it.  InputError unless there are as many."""
    limit = most_threads()
    chosen = limit if count is None else count
    if not 1 <= chosen <= limit:
        raise InputError(Fault("--threads", count, "is out of range", allowed=f"1 to {limit}"))
    numba.set_num_threads(chosen)
    return chosen


def most_threads() -> int:
    """Most threads that parallel kernels can be given."""
    return int(vars(numba.config)["NUMBA_NUM_THREADS"])


def threads() -> int:
    """Number of threads that parallel kernels use now."""
    return int(numba.get_num_threads())
