"""Extreme but legal numbers end in a report or in refusals, never in another error."""

import contextlib
import itertools
import math
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from porescale import Scene
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate
from tests.reference.scenes import COLUMN, table

LOW, HIGH = 1e-12, 1e9
KEYS = [
    "domain__width", "domain__height", "time__end", "output__snapshot_interval", "output__series_interval",
    "fluid__viscosity", "fluid__spacing", "fluid__step", "fluid__density", "fluid__magic",
    "grains__density", "grains__hydraulic_radius_ratio", "grains__packing__diameter", "grains__packing__height",
    "grains__packing__width", "grains__packing__packing_fraction", "contact__stiffness", "contact__restitution",
    "contact__tangential_stiffness", "contact__friction", "contact__step", "gate__x", "gate__lift_speed",
]  # fmt: skip
VALUES = [1e-300, 1e-12, 1e-9, 1e-6, 1e3, 1e5, 1e9, 1e15, 1e300]


def numbers() -> st.SearchStrategy[float]:
    """Any order of magnitude."""
    return st.floats(math.log10(LOW) - 4, math.log10(HIGH) + 7).map(lambda exponent: 10**exponent)


def say(changes: dict[str, Any]) -> None:
    with contextlib.suppress(InputError):
        report(validate(Scene, table(**changes)))


@settings(max_examples=150)
@given(st.dictionaries(st.sampled_from(KEYS), numbers(), max_size=8), st.booleans(), st.booleans())
def test_any_numbers_end_in_a_report_or_in_refusals(changes, wet, settle):
    if not wet:
        changes = {key: value for key, value in changes.items() if not key.startswith("fluid")} | {"fluid": None}
    say({**changes, "grains__packing__settle": settle})


def test_each_number_alone_is_judged(subtests):
    for key, value in itertools.product(KEYS, VALUES):
        with subtests.test(key=key, value=value):
            say({key: value})
            say({key: value, "grains__packing__settle": False, "gate": None, "grains__packing__packing_fraction": 0.5})


def test_each_key_is_one_of_the_scene():
    assert {key.partition("__")[0] for key in KEYS} <= COLUMN.keys()
