"""What is given to a measurement, checked before anything is done with it: one fault for each that is of no use.

Each check returns the faults of one argument, none where it is good; ``refuse`` raises those of all of them.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeGuard

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range
from porescale.common.core.units import to_si

BRIGHTEST = 1e7
"""Size of a grey level, at most: sums of its fourth powers over a block of pixels, and over a thousand pairs, are
within single precision, and so is a level of 24 bits.
"""


def refuse(*faults: Iterable[Fault]) -> None:
    """Raise InputError with all ``faults``, if there are any."""
    found = [fault for several in faults for fault in several]
    if found:
        raise InputError(found)


def is_whole(value: Any) -> TypeGuard[int]:
    """Whether it is a whole number, of Python or numpy; True, 3.0 and "3" are none."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def within(key: str, value: Any, allowed: Range) -> list[Fault]:
    """Faults of a number that must be in the range ``allowed``."""
    fault = allowed.fault_of(key, value)
    return [] if fault is None else [fault]


def region(key: str, value: Any) -> list[Fault]:
    """Faults of left, top, right, bottom, px: four whole numbers, right and bottom beyond left and top."""
    allowed = "left, top, right, bottom: four whole px"
    if value is None:
        return []
    if isinstance(value, str) or not _listed(value) or len(value) != 4 or not all(map(is_whole, value)):
        return [Fault(key, _shown(value), "is no region", allowed=allowed)]
    left, top, right, bottom = value
    if left >= right or top >= bottom:
        return [Fault(key, _shown(value), "is empty", allowed="left below right, and top below bottom")]
    return []


def polygons(key: str, value: Any) -> list[Fault]:
    """Faults of a list of polygons, each a text "x,y x,y x,y …"."""
    if not isinstance(value, str) and _listed(value) and all(isinstance(it, str) for it in value):
        return []
    allowed = '["x,y x,y x,y …", …], a text for each polygon'
    return [Fault(key, _shown(value), f"is no list of texts but {_kind(value)}", allowed=allowed)]


def bitmap(key: str, value: Any) -> list[Fault]:
    """Faults of a bitmap: a path, or an array (rows, columns) of flags or finite numbers; None is good."""
    if value is None or isinstance(value, str | Path):
        return []
    allowed = "a path, or an array (rows, columns) of flags"
    if not isinstance(value, np.ndarray):
        return [Fault(key, None, f"is neither a path nor an array but {_kind(value)}", allowed=allowed)]
    if value.ndim != 2 or value.dtype.kind not in "buif" or not np.isfinite(value).all():
        return [Fault(key, sized(value), "is no bitmap", allowed=allowed)]
    return []


def flags(key: str, value: Any) -> list[Fault]:
    """Faults of an array (rows, columns), True in solids; None is good."""
    if value is None or (isinstance(value, np.ndarray) and value.ndim == 2 and value.dtype == bool):
        return []
    given = sized(value) if isinstance(value, np.ndarray) else _kind(value)
    return [Fault(key, given, "is no array of flags", allowed="(rows, columns), True in solids", repair="give a > 0")]


def grey(key: str, value: Any, name: str = "") -> list[Fault]:
    """Faults of a grey picture: (rows, columns) of finite numbers within BRIGHTEST;  name : said before its shape."""
    if not isinstance(value, np.ndarray):
        return [Fault(key, f"{name}{_kind(value)}", "is no array", allowed="arrays (rows, columns)")]
    given = name + sized(value)
    if value.ndim != 2 or value.dtype.kind not in "uif":
        return [Fault(key, given, "is no grey picture", allowed="(rows, columns) of numbers")]
    if value.dtype.kind == "f" and not np.isfinite(value).all():
        return [Fault(key, given, "is no grey picture", allowed="(rows, columns) of finite numbers")]
    wide = value.dtype.kind == "f" or value.dtype.itemsize > 2
    if wide and value.size and max(-float(value.min()), float(value.max())) > BRIGHTEST:
        problem = f"has grey levels of {float(value.min()):.3g} to {float(value.max()):.3g}"
        return [Fault(key, given, problem, allowed=f"-{BRIGHTEST:g} to {BRIGHTEST:g}", repair="divide them all by one")]
    return []


def folder(key: str, value: Any) -> list[Fault]:
    """Faults of a path to a folder that may not be there yet; None is good."""
    if value is not None and not isinstance(value, str | Path):
        return [Fault(key, _shown(value), f"is no path but {_kind(value)}", repair="name a folder")]
    taken = value is not None and Path(value).is_file()
    return [Fault(key, str(value), "is a file", repair="name a folder")] if taken else []


def amount(key: str, value: float | str | None, unit: str, *, bare: bool = False) -> float | None:
    """A length or time in SI units, positive (times of frames: zero too), named as an option; None stays.

    bare : a text without a unit is a number in SI units.  Raises InputError.
    """
    number = value
    if bare and value is not None:
        with suppress(ValueError):
            number = float(value)
    if number is None:
        return None
    try:
        found = to_si(number, unit)
    except ValueError as error:
        raise InputError(Fault(key, value, str(error), unit)) from None
    least = ">= 0" if key in ("--time", "--start", "--end") else "> 0"
    if found < 0 or (found == 0 and least == "> 0"):
        raise InputError(Fault(key, value, "is out of range", unit, least))
    return found


def scales(
    scale: float | str | None, interval: float | str | None, rate: float | None, *, bare: bool = False
) -> tuple[float | None, float | None]:
    """Metres a pixel and seconds a frame of a film with a ``rate`` of its own; InputError for a scale without an
    interval.  bare : as of `amount`."""
    pixel, seconds = amount("--scale", scale, "m", bare=bare), amount("--interval", interval, "s", bare=bare)
    if seconds is None and rate:
        seconds = 1 / rate
    if pixel is not None and seconds is None:
        repair = 'give the time between frames: "5 ms"'
        raise InputError(Fault("--interval", None, "is needed with --scale", repair=repair))
    return pixel, seconds


def solids(*, no_slip: bool, there: bool) -> list[Fault]:
    """Faults of no flow at solids: whether any are ``there``, by a mask or polygons."""
    if there or not no_slip:
        return []
    return [Fault("--no-slip", None, "there are no solids", repair="give --mask or --polygon")]


def sized(value: np.ndarray) -> str:
    """Shape and type of an array in words."""
    return f"{' x '.join(map(str, value.shape))} of {value.dtype}"


def _listed(value: Any) -> bool:
    """Whether it is a row of things."""
    return isinstance(value, Sequence) or (isinstance(value, np.ndarray) and value.ndim == 1)


def _shown(value: Any) -> str:
    """What was given, without the spaces of a tuple."""
    return ",".join(map(str, value)) if _listed(value) and not isinstance(value, str) else str(value)


def _kind(value: Any) -> str:
    """The type of what was given, in a word."""
    return type(value).__name__
