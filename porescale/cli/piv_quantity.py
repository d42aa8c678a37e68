"""Quantities given as options of ``porescale piv``."""

from porescale.common.core.errors import Fault, InputError


def quantity(key: str, text: str, unit: str) -> float:
    """A number with or without unit, in ``unit``, positive (or zero for a time)."""
    from porescale.common.core.units import to_si

    try:
        value = to_si(float(text), unit)
    except ValueError:
        try:
            value = to_si(text, unit)
        except ValueError as error:
            raise InputError(Fault(key, text, str(error), unit)) from error
    if value < 0 or (value == 0 and key not in ("--time", "--start", "--end")):
        raise InputError(Fault(key, text, "is out of range", unit, "> 0"))
    return value
