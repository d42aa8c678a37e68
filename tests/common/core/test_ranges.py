"""Ranges of numbers that a caller gives, and the errors for what lies outside."""

import math

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.core.ranges import Range, numbers, require_in_range

SHARE = Range("m", gt=0.0, le=1.0)


@pytest.mark.parametrize("value", [0.0, -1.0, 1.5, math.nan, math.inf, "1", None, [0.5]])
def test_a_value_outside_its_range_is_refused_with_key_value_unit_range_and_repair(value):
    with pytest.raises(InputError) as caught:
        require_in_range("place", {"key": value}, {"key": SHARE})
    (fault,) = caught.value.faults
    assert fault.key == "place.key"
    assert str(value) == str(fault.value)
    assert fault.unit == "m"
    assert fault.allowed == "> 0 and <= 1"
    assert fault.repair


@pytest.mark.parametrize("value", [1, 1.0, 0.5, np.float32(0.5), np.array(0.5)])
def test_a_value_in_its_range_passes(value):
    require_in_range("place", {"key": value}, {"key": SHARE})


def test_every_wrong_value_is_a_fault_of_its_own():
    given = {"one": 2.0, "two": 0.5, "kind": "soft"}
    with pytest.raises(InputError) as caught:
        require_in_range("place", given, {"one": SHARE, "two": SHARE}, {"kind": ("stiff", "hard")})
    assert [fault.key for fault in caught.value.faults] == ["place.one", "place.kind"]
    assert caught.value.faults[1].allowed == "stiff or hard"


def test_an_array_has_its_shape_and_its_range():
    assert numbers("key", [[1, 2], [3, 4]], (-1, 2)).tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert numbers("key", [1, 2], (-1, 2)).shape == (1, 2)
    assert numbers("key", [], (-1, 2)).shape == (0, 2)
    assert numbers("key", 3.0, (2,), spread=True).tolist() == [3.0, 3.0]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ([1.0, 2.0, 3.0], r"shape \(3,\).*allowed: shape \(2,\)"),
        (3.0, r"shape \(\)"),
        (["a", "b"], "no array of numbers"),
        ([[1.0, 2.0], [3.0]], "no array of numbers"),
        ([0.5, math.nan], "nan m: of grain 1 is not finite"),
        ([0.5, 2.0], "2.0 m: of grain 1 is out of range"),
    ],
)
def test_an_array_that_is_none_of_these_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        numbers("key", given, (2,), SHARE, "grain")


def test_what_was_given_is_copied():
    given = np.ones(2)
    numbers("key", given, (2,))[0] = 5.0
    assert given.tolist() == [1.0, 1.0]
