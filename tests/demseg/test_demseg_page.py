"""The table of docs/demseg.md says what cases, validations and a moment's computing say."""

import re

import pytest

from porescale.cli.main import PACKAGE as PORESCALE
from tests.reference.demseg_page import NUMBERS, PAGE, WHAT, parts, rows, with_numbers
from tests.reference.folders import CASES, ROOT

TEXT = PAGE.read_text(encoding="utf-8")


def test_the_page_has_the_numbers_of_today():
    assert with_numbers(TEXT) == TEXT, "python -m tests.reference.demseg_page writes it"


def test_every_number_has_a_row_of_the_page():
    assert NUMBERS.keys() <= {row[WHAT] for row in rows(TEXT)}


def test_a_number_that_changed_is_found():  # the twin that must fail
    changed = TEXT.replace("| 582 | 582 |", "| 582 | 583 |")
    assert changed != TEXT
    assert with_numbers(changed) == TEXT


VERIFY = re.compile(r"porescale verify ([\w.]+)")
DECK = re.compile(r"porescale demseg run ([\w/]+)")
SCRIPT = re.compile(r"python (cases/[\w/.]+)")


def unknown(command):
    """Validations, decks and scripts that a command of the page names, and that are not there."""
    names = {one.name for one in PORESCALE.validations()}
    missing = [name for name in VERIFY.findall(command) if name not in names]
    missing += [name for name in DECK.findall(command) if not (CASES / name / "in_gm.dat").exists()]
    return missing + [name for name in SCRIPT.findall(command) if not (ROOT / name).exists()]


def test_every_command_of_the_page_names_what_there_is():
    commands = [row[-1] for row in rows(TEXT)]
    assert [command for command in commands if unknown(command)] == []
    found = [pattern.search(command) for command in commands for pattern in (VERIFY, DECK, SCRIPT)]
    assert sum(match is not None for match in found) > 20


@pytest.mark.parametrize("command", [
    "`porescale verify dem.rock`", "`porescale verify dem.rock_of_triangles`", "`porescale demseg run demseg_square`",
    "`python cases/rock/stone.py`",
])  # fmt: skip
def test_a_command_of_what_is_not_there_is_found(command):  # the twin that must fail
    assert unknown(command)


@pytest.mark.parametrize("section", ["I-2", "I-3", "I-4", "I-5", "I-6", "I-7", "I-8", "II-2", "II-3", "II-4"])
def test_every_section_with_something_to_compute_has_a_row(section):
    assert any(row[0].startswith(section) for row in rows(TEXT))


def test_304_discs_make_as_many_triangles_as_in_the_tutorial():
    # Euler: 2 n - 2 - h of n seeds, h of them on the sides, 69 in the tutorial.  h is about 4 sqrt(n) = 70, and
    # scatters by some of its root: 8.
    triangles, sides = parts("triangles")
    assert triangles == pytest.approx(537, abs=8)
    assert sides == 3 * triangles
    assert parts("cells")[0] == 304
