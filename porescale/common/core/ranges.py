"""Ranges of numbers that a caller gives, and the errors that name those outside them."""

import math
import operator
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray, Floats


@dataclass(frozen=True)
class Range:
    """Finite numbers in ``unit``, greater than ``gt``, at least ``ge``, less than ``lt``, at most ``le``.

    A bound that is None does not limit them;  whole : whole numbers alone.
    """

    unit: str = ""
    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None
    whole: bool = field(default=False, kw_only=True)

    def allowed(self) -> str:
        """The range in words, without the unit: "> 0 and <= 1"; "" if every number is allowed."""
        bounds = (("> ", self.gt), (">= ", self.ge), ("< ", self.lt), ("<= ", self.le))
        words = " and ".join(f"{sign}{bound:g}" for sign, bound in bounds if bound is not None)
        return f"whole, {words}".removesuffix(", ") if self.whole else words

    def contains(self, value: Any) -> Any:
        """Whether ``value`` (in ``unit``) lies within the bounds; of an array, which values of it do."""
        bounds = (operator.gt, self.gt), (operator.ge, self.ge), (operator.lt, self.lt), (operator.le, self.le)
        within: Any = True
        for holds, bound in bounds:
            if bound is not None:
                within = within & holds(value, bound)
        return within

    def fault_of(self, key: str, value: Any) -> Fault | None:
        """What is wrong with one ``value`` called ``key``; None where nothing is."""
        if not is_number(value):
            return Fault(key, str(value), "is no number", self.unit, self.allowed(), "give one number")
        if self.whole and not isinstance(value, Integral):
            return Fault(key, value, "is no whole number", self.unit, self.allowed(), "give one without a point")
        if math.isfinite(value) and self.contains(float(value)):
            return None
        return self.out_of_range(key, value)

    def out_of_range(self, key: str, value: float, where: str = "") -> Fault:
        """The fault of a ``value`` outside the range;  where : which of several it is, as "of grain 3"."""
        problem = "is out of range" if math.isfinite(value) else "is not finite"
        repair = f"give a{' value' if math.isfinite(value) else ' finite value'} in this range"
        if not self.allowed():
            repair = "give a finite value"
        return Fault(key, value, f"{where}{' ' if where else ''}{problem}", self.unit, self.allowed(), repair)


FINITE = Range()
"""Every finite number, without unit."""


def is_number(value: object) -> bool:
    """Whether ``value`` is a real number, of Python or numpy; True and False are none."""
    if isinstance(value, bool | np.bool_):
        return False
    return isinstance(value, Real) or (getattr(value, "shape", None) == () and hasattr(value, "__float__"))


def require_in_range(
    place: str,
    given: Mapping[str, Any],
    ranges: Mapping[str, Range],
    choices: Mapping[str, Collection[str]] | None = None,
) -> None:
    """Raise InputError naming every value of ``given``, by its key after ``place``, that is not allowed.

    ranges : of the numbers, by key;  choices : words that may be given, by key.  Other keys of ``given`` pass.
    """
    faults = [within.fault_of(f"{place}.{key}", given[key]) for key, within in ranges.items()]
    for key, words in (choices or {}).items():
        if given[key] not in words:
            repair = "give one of these words"
            faults.append(Fault(f"{place}.{key}", str(given[key]), "is unknown", "", " or ".join(words), repair))
    found = [fault for fault in faults if fault is not None]
    if found:
        raise InputError(found)


def numbers(
    key: str, given: ArrayLike, shape: tuple[int, ...], within: Range = FINITE, of: str = "", *, spread: bool = False
) -> Floats:
    """``given`` as a new float64 array of ``shape``, every number of it ``within`` a range.

    shape : of a first length of -1 there may be any number of rows, and one row may be given as it is;  of : what has
    a row, for the message: "grain";  spread : one number or row may be given for all.  Raises InputError where it is
    no numbers, has another shape, or a number is outside the range: the first of these is named.
    """
    try:
        made = np.array(given, np.float64)
        if shape[:1] == (-1,) and (made.shape == shape[1:] or made.size == 0):
            made = made.reshape(shape)
        if spread:
            made = np.broadcast_to(made, shape).copy()
    except (TypeError, ValueError):
        raise misfit(key, given, shape, within, spread=spread) from None
    if made.ndim != len(shape) or any(one not in (other, -1) for other, one in zip(made.shape, shape, strict=True)):
        raise misfit(key, given, shape, within, spread=spread)
    bad = np.argwhere(~(np.isfinite(made) & within.contains(made)))
    if len(bad):
        where = f"of {of} {bad[0][0]}" if of else ""
        raise InputError(within.out_of_range(key, float(made[tuple(bad[0])]), where))
    return made


def require_arrays(place: str, given: Mapping[str, AnyArray], shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Raise InputError naming every array of ``given``, by its key after ``place``, that has not its shape, or whose
    elements are not float64 (those called "material": int64): kernels write into these arrays."""
    faults = []
    for key, shape in shapes.items():
        array, kind = given[key], np.int64 if key == "material" else np.float64
        allowed = f"shape {shape}, {np.dtype(kind).name}"
        if not isinstance(array, np.ndarray):
            faults.append(Fault(f"{place}.{key}", str(array), "is no array of numpy", "", allowed, "make it one"))
        elif array.shape != shape or array.dtype != kind:
            problem = f"is an array of shape {array.shape}, {array.dtype}"
            faults.append(Fault(f"{place}.{key}", None, problem, "", allowed, "give one for each particle"))
    if faults:
        raise InputError(faults)


def misfit(key: str, given: Any, shape: tuple[int, ...], within: Range, *, spread: bool) -> InputError:
    """The error for what is no array of numbers of this shape."""
    allowed = f"shape {str(shape).replace('-1', 'n')}{', or one for all' if spread else ''}"
    repair = f"give numbers{f' in {within.unit}' if within.unit else ''} of this shape"
    try:
        problem, shown = f"has the shape {np.asarray(given, np.float64).shape}", None
    except (TypeError, ValueError):
        problem, shown = "is no array of numbers", str(given)
    return InputError(Fault(key, shown, problem, "", allowed, repair))
