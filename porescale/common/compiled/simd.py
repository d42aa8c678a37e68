"""Several numbers at once: what a loop over a row of partners adds up, a few of them side by side.

A compiler that keeps the order of sums, as is required here, adds the terms of a row one after the other and leaves
most of the machine idle.  Here the order is part of the program: a row is taken LANES entries at a time, every lane has
its own sum, and `reduce_add` adds the lanes by halves.  The same bits on any machine, however wide its vectors are.

In kernels what these functions return is a vector of LANES float64 that takes + - * / with its like and with numbers;
in plain Python it is an array.  Numbers may stand for vectors everywhere.
"""

import ctypes
import os
from collections.abc import Callable
from ctypes.util import find_library
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from porescale.common.compiled.jit import when_compiling

LANES = 4  # twice as many are 2 % faster where vectors are that wide (measured), and half as many registers elsewhere
EIGHT = 8  # numbers of either precision in the vectors of `load_eight`: a vector of float32 where they are 256 bits
WORDS = 32  # that `store_sorted` compares at once: a row of partners
COLUMNS = 8  # that `gather_rows` reads of a record
CODE, ROWS_CODE = f"{__package__}.simd_code", f"{__package__}.simd_rows_code"
"""Modules with the compiled form of these functions: of those on vectors, and of those on lines and rows."""


def sqrt(a: Any) -> Any:
    """Square root of every lane."""
    return np.sqrt(a)


def rint(a: Any) -> Any:
    """The whole number nearest to a, the even one of two."""
    return np.rint(a)


def maximum(a: Any, b: Any) -> Any:
    """The greater of two, b where they cannot be compared."""
    return np.where(np.greater(a, b), a, b)[()]


def minimum(a: Any, b: Any) -> Any:
    """The lesser of two, b where they cannot be compared."""
    return np.where(np.less(a, b), a, b)[()]


def fma(a: Any, b: Any, c: Any) -> Any:
    """a b + c of three vectors, or numbers of one precision, rounded once: one instruction where a processor has it.

    Written out where it saves time, since a compiler that chose by itself would not choose alike in every kernel.  The
    same bits on every machine; slow on those before 2013, which have no such instruction.
    """
    one, two, three = np.broadcast_arrays(a, b, c)
    fused = _fused(one.dtype == np.float32)
    return np.array([fused(*each) for each in zip(one.flat, two.flat, three.flat, strict=True)], one.dtype).reshape(
        one.shape
    )[()]


@cache
def _fused(single: bool) -> Callable[..., float]:
    """C's own function of that, for float or double."""
    library = ctypes.CDLL(find_library("m") or ("ucrtbase" if os.name == "nt" else None))
    found, kind = (library.fmaf, ctypes.c_float) if single else (library.fma, ctypes.c_double)
    found.restype, found.argtypes = kind, [kind] * 3
    return found


def choose(a: Any, b: Any, larger: Any, other: Any) -> Any:
    """``larger`` where a > b, else ``other``, also where they cannot be compared."""
    return np.where(np.greater(a, b), larger, other)[()]


def zeros() -> Any:
    """Zero in every lane."""
    return np.zeros(LANES)


def ramp() -> Any:
    """0, 1, 2, … in the lanes."""
    return np.arange(float(LANES))


def reduce_add(a: Any) -> Any:
    """Sum of the lanes of ``a``: the second half is added to the first until one is left."""
    while len(a) > 1:
        a = a[: len(a) // 2] + a[len(a) // 2 :]
    return a[0]


def load(line: Any, first: Any, end: Any) -> Any:
    """Entries ``line[first]``, ``line[first + 1]`` … of a float64 array, 0 from ``line[end]`` on.

    Not checked: that ``line`` has LANES entries from ``first`` on, also where the last ones are not taken.
    """
    inside = np.arange(first, first + LANES) < end
    return np.where(inside, line[first : first + LANES], 0.0)


def mask_tail(a: Any, first: Any, end: Any) -> Any:
    """Lanes of ``a`` that stand for entries ``first``, ``first + 1`` … of a row, 0 from ``end`` on."""
    return np.where(np.arange(first, first + LANES) < end, a, 0.0)


def store(line: Any, first: Any, end: Any, values: Any) -> None:
    """Write LANES values to ``line[first]``, ``line[first + 1]`` … of an array of float64, or of float32 to which they
    are rounded, none from ``line[end]`` on."""
    count = min(LANES, end - first)
    line[first : first + count] = values[:count]


def load_eight(line: Any, first: Any) -> Any:
    """Entries ``line[first]`` to ``line[first + 7]`` of an array of float32 or float64, as a vector of that.

    Not checked: that they are there.
    """
    return line[first : first + EIGHT]


def ramp_eight(line: Any) -> Any:
    """0 to 7 as a vector of the precision of an array."""
    return np.arange(EIGHT).astype(line.dtype)


def store_eight(line: Any, first: Any, values: Any) -> None:
    """Write a vector of eight to ``line[first]`` and on.  Not checked: that they are there."""
    line[first : first + EIGHT] = values


def store_sorted(line: Any, count: Any, target: Any, first: Any) -> None:
    """Write the first ``count`` entries of ``line`` to ``target[first]`` and on, the least first; both int32.

    Every entry counts those less than it, which says where it goes: quick for tens of entries, and nothing is guessed.
    Not checked: that no two are equal, that ``line`` has WORDS entries more, and that ``target`` has room.
    """
    target[first : first + count] = np.sort(line[:count])


def row_gatherer(columns: int) -> Any:
    """Make the function that takes that many columns, an even number, of rows."""

    def take(record: Any, row: Any, first: Any, end: Any, other: Any, column: Any = 0, before: Any = 0) -> Any:
        """Columns of LANES rows of ``record`` (n, m), each as a vector, from ``column`` on: rows ``row[first]``,
        ``row[first + 1]`` … less ``before`` and, from ``row[end]`` on, row ``other``.

        ``row`` int32.  Not checked: that the rows and columns are there.
        """
        chosen = [row[k] - before if k < end else other for k in range(first, first + LANES)]
        return tuple(record[chosen, column : column + columns].T)

    when_compiling(lambda _: import_module(ROWS_CODE).teach_rows(take, columns))
    return take


gather_rows = row_gatherer(COLUMNS)
gather_four = row_gatherer(4)
gather_two = row_gatherer(2)
when_compiling(lambda _: import_module(ROWS_CODE))
