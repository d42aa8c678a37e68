"""Every row of `porescale verify` and of `continuum-sph verify` holds.

That each would fail with the error next door, the files beside this one test.
"""

from pathlib import Path

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE

ELSEWHERE = "scene."
"""Rows that tests of homogenisation run, which read their numbers too."""
DAILY = {
    "coupling.drag_balances_what_drives":
        "validation/coupling/test_coupling_driven.py test_without_the_push_a_disc_bears_less_than_what_drives",
    "coupling.square_arrays": "validation/coupling/test_coupling_arrays.py test_a_square_array_has_its_drag",
    "coupling.hexagonal_arrays": "validation/coupling/test_coupling_arrays.py test_a_hexagonal_array_has_its_drag",
    "coupling.fast_start": "coupling/test_coupling_rim.py test_a_cylinder_set_moving_at_once_has_its_drag",
    "coupling.taylor_couette_torque":
        "validation/coupling/test_coupling_rings.py test_a_disc_a_tenth_of_a_cell_too_wide_misses_the_torque",
}  # fmt: skip
"""Rows of 15 to 50 s, of many operators, places or directions: in turns with the slow tests here, while `verify` runs
them always; and for each the test, of a few seconds, that runs one of its cases every time, to the same tolerance."""
ROWS = [row for package in (PACKAGE, CONTINUUM) for row in package.validations() if not row.name.startswith(ELSEWHERE)]


def takes_turns(row):
    return row.slow or row.name in DAILY


@pytest.mark.parametrize(
    "row", [pytest.param(row, id=row.name, marks=[pytest.mark.slow] * takes_turns(row)) for row in ROWS]
)
def test_the_row_holds(row):
    found = row.run()
    assert found.passed, found


def test_one_case_of_each_row_that_takes_turns_runs_every_time():
    names = {row.name: row for row in ROWS}
    for name, place in DAILY.items():
        file, test = place.split()
        text = (Path(__file__).parents[1] / file).read_text(encoding="utf-8")
        before, _, body = text.partition(f"def {test}(")
        assert name in body.partition("\ndef ")[0], test
        assert "slow" not in before.rpartition("\n\n\n")[2], test
        assert not names[name].slow
