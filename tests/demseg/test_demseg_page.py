"""The table of docs/demseg.md says what cases, validations and a moment's computing say."""

import pytest

from tests.reference.demseg_page import PAGE, ROWS, parts, table, with_table


def test_the_page_has_the_numbers_of_today():
    text = PAGE.read_text(encoding="utf-8")
    assert with_table(text, table()) == text, "python -m tests.reference.demseg_page writes it"


def test_a_number_that_changed_is_found():  # the twin that must fail
    text = PAGE.read_text(encoding="utf-8")
    assert with_table(text, table().replace("| 582 | 582 |", "| 582 | 583 |")) != text


@pytest.mark.parametrize("section", ["I-2", "I-3", "I-4", "I-5", "I-6", "I-7", "I-8", "II-2", "II-3", "II-4"])
def test_every_section_with_something_to_compute_has_a_row(section):
    assert any(row.section.startswith(section) for row in ROWS)


def test_304_discs_make_as_many_triangles_as_in_the_tutorial():
    # Euler: 2 n - 2 - h of n seeds, h of them on the sides, 69 in the tutorial.  h is about 4 sqrt(n) = 70, and
    # scatters by some of its root: 8.
    triangles, sides = parts("triangles")
    assert triangles == pytest.approx(537, abs=8)
    assert sides == 3 * triangles
    assert parts("cells")[0] == 304
