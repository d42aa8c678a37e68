"""Whatever a model calls its state comes back bit for bit."""

import struct
import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint

DTYPES = st.one_of(
    hnp.boolean_dtypes(),
    hnp.integer_dtypes(),
    hnp.unsigned_integer_dtypes(),
    hnp.floating_dtypes(),
    hnp.complex_number_dtypes(),
    hnp.datetime64_dtypes(),
    hnp.unicode_string_dtypes(),
)
ARRAYS = hnp.arrays(DTYPES, hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4))
NUMBERS = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8))
SCALARS = st.one_of(st.floats().map(np.float64), st.integers(-9, 9).map(np.int32), st.booleans().map(np.bool_))
VALUES = st.recursive(
    st.one_of(NUMBERS, SCALARS, ARRAYS),
    lambda inner: st.one_of(
        st.dictionaries(st.text(max_size=6), inner, max_size=4),
        st.lists(inner, max_size=3),
        st.lists(inner, max_size=3).map(tuple),
    ),
    max_leaves=8,
)


def identical(one, other):
    """The same type and bits, all the way down."""
    if type(one) is not type(other):
        return False
    if isinstance(one, dict):
        return list(one) == list(other) and all(identical(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(identical, one, other))
    if isinstance(one, np.ndarray | np.generic):
        return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
    if isinstance(one, float):
        return struct.pack("d", one) == struct.pack("d", other)
    return one == other


@settings(max_examples=120)
@given(st.dictionaries(st.text(max_size=6), VALUES, max_size=5))
def test_a_state_comes_back_bit_for_bit(state):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "checkpoint.h5"
        write_checkpoint(path, state)
        assert identical(read_checkpoint(path), state)


def test_the_comparison_sees_a_bit():
    assert not identical({"a": 0.0}, {"a": -0.0})
    assert not identical({"a": np.zeros(2)}, {"a": np.zeros(2, np.float32)})
    assert not identical({"a": 1}, {"a": True})
