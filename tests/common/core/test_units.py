"""Quantities: numbers pass, texts with units become SI by exact decimal conversion."""

import math
import sys
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porescale.common.core import units
from porescale.common.core.units import to_si
from tests.reference.waiting import done

PREFIXES = {"km": 3, "m": 0, "dm": -1, "cm": -2, "mm": -3, "um": -6, "nm": -9}


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_passes_unchanged(value: float) -> None:
    assert to_si(value, "m") == value


@given(st.decimals(-1000, 1000, places=4, allow_nan=False), st.sampled_from(sorted(PREFIXES)))
def test_a_prefix_only_shifts_the_decimal_point(number: object, unit: str) -> None:
    # Exact: decimal shift, then the one rounding that Python's own literal has too.
    assert to_si(f"{number} {unit}", "m") == float(f"{number}e{PREFIXES[unit]}")


def test_scaling_in_binary_would_miss_the_last_bit() -> None:  # the twin: what exact conversion avoids
    assert any(k / 10 * 0.001 != to_si(f"{k / 10} mm", "m") for k in range(1, 100))


@given(st.floats(min_value=-1e6, max_value=1e6, allow_nan=False))
def test_degrees_and_back(degrees: float) -> None:
    # pi to 28 digits, one rounding here and one in math.degrees: 2 eps.
    assert math.degrees(to_si(f"{degrees!r} deg", "rad")) == pytest.approx(degrees, rel=2 * sys.float_info.epsilon)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("1.5 mm", "m", 0.0015),
        ("0.3mm", "m", 0.0003),
        ("1 mm^2/s", "m²/s", 1e-6),
        ("2.65 g/cm³", "kg/m**3", 2650.0),
        ("2650 kg/m3", "kg/m³", 2650.0),
        ("1 cP", "Pa s", 1e-3),
        ("50 %", "", 0.5),
        ("3", "", 3.0),
        ("20 kN/m", "N/m", 2e4),
        ("-9.81 m/s2", "m/s²", -9.81),
        ("1 min", "s", 60.0),
        ("20 degC", "K", 293.15),
        ("2 Hz", "1/s", 2.0),
        ("0.5 rad/s", "rad/s", 0.5),
        ("0.5 1/s", "rad/s", 0.5),
        ("50 N m/rad", "N m", 50.0),
        ("1.6 t/m^3", "kg/m^3", 1600.0),
        ("2 tf/m^2", "Pa", 19613.3),
    ],
)
def test_texts_with_units_become_si(text: str, unit: str, value: float) -> None:
    assert to_si(text, unit) == value  # exact: decimals, rounded once


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        ("1 s", "m", "does not measure the same thing as m"),
        ("60 rpm", "1/s", "is of an angle, 1/s is not; 60 rpm are 1 Hz"),
        ("1 Hz", "rad/s", "is not of an angle, rad/s is; 1 Hz are 60 rpm"),
        ("30 degree", "", "of an angle of friction take the tangent"),
        ("50 %", "rad", "a slope of 50 % is atan(0.5)"),
        ("1 px", "m", "'px' names a pixel, which has no length of its own"),
        ("0.05 mm/px", "m", "'mm/px' names a pixel, which has no length of its own"),
        ("3 point", "m", "is a size of letters"),
        ("1.6 ton/m^3", "kg/m^3", "could be 1000 kg or 2000 pounds; write t for the first"),
        ("2 ton_force/m^2", "Pa", "write tf for the first"),
        ("3 dB", "", "is of a logarithm"),
        ("3 dBm/Hz", "J", "is of a logarithm"),
        ("1 parsnip", "m", "unknown unit 'parsnip'"),
        ("1", "m", "has no unit"),
        ("wide", "m", "is not a number with a unit"),
        ("1,5 mm", "m", "has a comma; write a number with a point"),
        ("0.3,-9.81", "m/s^2", "and a list as [0.1, 0.2]"),
        ("1 m**9**9**9", "m", "unknown unit"),
        ("1 m)", "m", "unknown unit"),
        ("1e99999999999 m", "m", "fits"),
        (10**400, "m", "fits"),
        (True, "m", "true or false"),
        ([1.0], "m", "a list"),
        ({}, "m", "a table"),
        (None, "m", "nothing"),
        (math.nan, "m", "not finite"),
        (-math.inf, "m", "not finite"),
        ("1e999 m", "m", "not finite"),
    ],
)
def test_what_is_no_quantity_is_refused_in_words(value: object, unit: str, words: str) -> None:
    with pytest.raises(ValueError, match=r"^[^\n]*$") as error:
        to_si(value, unit)
    assert words in str(error.value)


def test_numbers_and_usual_units_never_load_pint() -> None:
    code = "import sys; from porescale.common.core.units import to_si; to_si(1.0, 'm'); to_si('30 degree', 'rad'); "
    code += "to_si('5 N s/m', 'N s/m'); print('pint' in sys.modules)"
    assert done([sys.executable, "-c", code]).stdout.strip() == "False"


def test_usual_units_are_pints() -> None:
    for unit, known in units._USUAL.items():
        for source, factor in known.items():
            one, zero = pints(source, unit)
            assert (one - zero, zero) == (Decimal(factor), 0), (source, unit)


def test_a_wrong_factor_is_seen() -> None:  # the twin that must fail
    one, zero = pints("cm", "m")
    assert one - zero != Decimal(units._USUAL["m"]["mm"])
    assert zero == 0


def pints(source: str, unit: str) -> tuple[Decimal, Decimal]:
    """One and zero of a unit in another, by Pint alone."""
    registry = units._registry()
    given, wanted = units._parse(source), units._parse(unit)
    one, zero = (registry.Quantity(Decimal(number), given).to(wanted).magnitude for number in (1, 0))
    return one, zero
