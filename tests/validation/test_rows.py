"""Every row of `porescale verify` and of `continuum-sph verify` holds.

That each would fail with the error next door, the files beside this one test.
"""

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE

ELSEWHERE = "scene."
"""Rows that tests of homogenisation run, which read their numbers too."""
ROWS = [row for package in (PACKAGE, CONTINUUM) for row in package.validations() if not row.name.startswith(ELSEWHERE)]


@pytest.mark.parametrize("row", [pytest.param(row, id=row.name, marks=[pytest.mark.slow] * row.slow) for row in ROWS])
def test_the_row_holds(row):
    found = row.run()
    assert found.passed, found
