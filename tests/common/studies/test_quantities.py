"""Numbers that a row of expected.toml or of a study reads from a table."""

import math

import numpy as np
import pytest

from porescale.common.studies.quantities import measured


def test_a_number_is_read_as_the_row_says():
    columns = {"time (s)": np.array([0.0, 1.0, 2.0, 3.0]), "y (m)": np.array([8.0, 6.0, 3.0, 4.0])}
    row = {"column": "y (m)", "at": 0.5}
    assert measured(columns, row) == 7.0
    passed = {**row, "integral": True}
    assert measured(columns, {**passed, "at": "end"}) == 15.0  # 7 + 4.5 + 3.5
    assert measured(columns, {**passed, "at": {"first_above": 11.5}}) == 2.0
    for at in ("begin", {"share_of": "rise", "first_below": 1}, {}):
        with pytest.raises(ValueError, match=r"at|share_of"):
            measured(columns, {**row, "at": at})


def test_the_last_row_stands_for_half_a_row_more() -> None:
    columns = {"time (s)": np.array([0.0, 0.2, 0.399]), "front (m)": np.array([0.0, 2.0, 3.0])}
    assert measured(columns, {"column": "front (m)", "at": 0.4}) == 3.0  # a step that does not divide the end
    assert math.isnan(measured(columns, {"column": "front (m)", "at": 0.5}))  # over 0.0995 s, half a row
