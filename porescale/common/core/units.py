"""Quantities at the door: a number is SI already, a string such as "1.5 mm" carries its unit.

Conversion is exact in decimal and rounded once, so "1.5 mm" gives the very bits of 0.0015.
"""

import math
import re
from decimal import Decimal, localcontext
from functools import lru_cache
from tokenize import TokenError
from typing import Any

_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_POWER = re.compile(r"([^\W\d_])([+-]?\d)")
LONGEST = 64
"""Characters of a unit: the parser recurs into what is longer."""
CYCLES = ("hertz",)
"""How names of units end that count cycles a second."""
TYPE_SIZES = ("point", "pica", "didot", "cicero")
"""How names of units end that printers measure letters in."""
# No unit has a power of a power or a three-digit number; both would make the parser compute for ever.
_ABSURD = re.compile(r"\d\s*(\*\*|\^)|\d{3}")


_USUAL = {
    "m": {"cm": "0.01", "mm": "0.001", "um": "0.000001", "µm": "0.000001", "km": "1000"},
    "m^2": {"cm^2": "0.0001", "mm^2": "0.000001"},
    "s": {"ms": "0.001", "us": "0.000001", "µs": "0.000001", "min": "60", "h": "3600"},
    "m/s": {"cm/s": "0.01", "mm/s": "0.001"},
    "m^2/s": {"cm^2/s": "0.0001", "mm^2/s": "0.000001"},
    "rad": {"degree": "0.01745329251994329576923690768", "deg": "0.01745329251994329576923690768"},
    "kg/m^3": {"g/cm^3": "1000"},
    "Pa": {"kPa": "1000", "MPa": "1000000", "GPa": "1000000000"},
    "Pa s": {"mPa s": "0.001"},
    "N/m": {"kN/m": "1000", "MN/m": "1000000"},
}
"""Units that most scenes are written in, by the unit wanted, as Pint has them: Pint takes longer to learn its units
than a scene takes to be checked.  The wanted unit itself needs no entry."""


@lru_cache(maxsize=1)
def _registry() -> Any:
    """Pint's registry, computing in decimals; importing pint takes longer than all the rest, hence here."""
    import pint

    return pint.UnitRegistry(non_int_type=Decimal)


def _parse(unit: str) -> Any:
    """The pint unit that ``unit`` names; ``kg/m3`` is read as ``kg/m^3``.  ValueError if there is none."""
    import pint

    if len(unit) <= LONGEST and not _ABSURD.search(unit):
        for text in (unit, _POWER.sub(r"\1^\2", unit)):
            try:
                return _registry().parse_units(text)
            # What pint raises on text that is no unit: its own errors, and Python's from its parser.
            except (pint.PintError, ValueError, AssertionError, TypeError, AttributeError, TokenError):
                continue
    raise ValueError(f"unknown unit {unit!r}")


@lru_cache(maxsize=512)
def _factor_and_offset(source: str, unit: str) -> tuple[Decimal, Decimal]:
    """Decimals a and b with value in ``unit`` = a * (value in ``source``) + b.  ValueError if none."""
    usual = {unit: "1"} | _USUAL.get(unit, {})
    if source in usual:
        return Decimal(usual[source]), Decimal(0)
    import pint

    registry = _registry()
    given, wanted = _parse(source), _parse(unit)
    _require_one_meaning(source, given)
    try:
        zero = registry.Quantity(Decimal(0), given).to(wanted).magnitude
        one = registry.Quantity(Decimal(1), given).to(wanted).magnitude
    except pint.DimensionalityError:
        raise ValueError(f"{source!r} does not measure the same thing as {unit or 'a plain number'}") from None
    _require_same_count(source, given, unit, wanted)
    return one - zero, zero


def _require_one_meaning(source: str, given: Any) -> None:
    """ValueError for units that Pint reads as something else than a laboratory means: to it a pixel is 1/96 inch, a
    point 1/72 inch, a ton 2000 pounds; and for those of logarithms, which it does not convert in decimals."""
    for name in _names(given):
        if name.endswith(("pixel", "dot")):
            raise ValueError(f"{source!r} names a pixel, which has no length of its own; write that of one, in mm")
        if name.endswith(TYPE_SIZES):
            raise ValueError(f"{source!r} is a size of letters; write mm")
        if name in ("ton", "force_ton"):
            metric = "t" if name == "ton" else "tf"
            raise ValueError(f"{source!r} could be 1000 kg or 2000 pounds; write {metric} for the first, kg or lb")
        if _is_logarithm(name):
            raise ValueError(f"{source!r} is of a logarithm; write the number itself")


def _require_same_count(source: str, given: Any, unit: str, wanted: Any) -> None:
    """ValueError where a number or a rate is wanted and the text gives an angle, or the other way round: to Pint an
    angle is a plain number, 1 Hz is 1 rad/s, and 60 rpm are 6.28 Hz.  1/s stays another way to write rad/s."""
    without = {name: power for name, power in _roots(wanted).items() if name != "radian"}
    rate = without == {"second": -1}
    if without and not rate:
        return
    shown, angle, wants_angle = unit or "a plain number", _has_angle(given), _has_angle(wanted)
    if angle and not wants_angle:
        why = "60 rpm are 1 Hz" if rate else "of an angle of friction take the tangent"
        raise ValueError(f"{source!r} is of an angle, {shown} is not; {why}")
    if wants_angle and not angle and not (rate and not any(name.endswith(CYCLES) for name in _names(given))):
        why = "1 Hz are 60 rpm, or 6.2832 rad/s" if rate else "a slope of 50 % is atan(0.5) = 26.57 degree"
        raise ValueError(f"{source!r} is not of an angle, {shown} is; {why}")


def _has_angle(unit: Any) -> bool:
    """Whether a unit is of an angle, or of one over a time."""
    return "radian" in _roots(unit)


def _names(unit: Any) -> list[str]:
    """The units that a unit is written in."""
    return [name for name, _ in _registry().Quantity(Decimal(1), unit).unit_items()]


def _is_logarithm(name: str) -> bool:
    """Whether Pint takes a logarithm to convert a unit, which it can of floats alone, or a difference of such."""
    try:
        _registry().Quantity(Decimal(1), name.removeprefix("delta_")).to_root_units()
    except TypeError:
        return True
    return False


def _roots(unit: Any) -> dict[str, Decimal]:
    """The base units that a unit is made of, radian among them, with their powers."""
    return dict(_registry().Quantity(Decimal(1), unit).to_root_units().unit_items())


def require_unit(unit: str) -> None:
    """ValueError where ``unit`` is none; "" is that of a plain number."""
    if unit and unit not in _USUAL:
        _parse(unit)


def to_si(value: Any, unit: str) -> float:
    """``value`` in ``unit`` (an SI unit, "" for a plain number), as a float.

    Numbers pass unchanged; a string must be a number followed by a unit of the same dimension (a string
    without a unit passes only where ``unit`` is "").  Raises ValueError, with a readable message, on anything
    else: booleans, nan, infinities, unknown units, other dimensions.
    """
    if isinstance(value, str):
        result = _from_text(value, unit)
    elif isinstance(value, bool) or not hasattr(value, "__float__"):
        raise ValueError(f"is not a number but {_kind(value)}")
    else:
        try:
            result = float(value)
        except (OverflowError, TypeError):
            raise ValueError("is not a number that fits") from None
    if not math.isfinite(result):
        raise ValueError("is not finite")
    return result


def _from_text(text: str, unit: str) -> float:
    """The number that ``text`` states, in ``unit``."""
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise ValueError("is not a number" + (" with a unit" if unit else ""))
    number, given = match.groups()
    if given.startswith(","):
        raise ValueError("has a comma; write a number with a point, and a list as [0.1, 0.2]")
    if not given and unit:
        raise ValueError(f"has no unit; write {number} without quotes for {unit}, or add the unit")
    factor, offset = _factor_and_offset(given, unit)
    try:
        with localcontext() as context:
            context.prec = 60  # digits; far more than a double has, so that the only rounding is the last
            return float(Decimal(number) * factor + offset)
    except ArithmeticError:  # exponents beyond what decimals hold
        raise ValueError("is not a number that fits") from None


def _kind(value: Any) -> str:
    """What ``value`` is, in the words of a scene file."""
    names = {bool: "true or false", dict: "a table", list: "a list", tuple: "a list", type(None): "nothing"}
    return names.get(type(value), f"a {type(value).__name__}")
