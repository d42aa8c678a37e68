"""What messages say of a number: its help completes "give the ...", and begins with a noun."""

import math
import re
from pathlib import Path

import pytest

from porescale.common.schema.quantity import Quantity, Refused

ROOT = Path(__file__).resolve().parents[3]
NO_NOUN = re.compile(r"""help=["'](of|from|at|in|to|under|by|for|with|how|whether|if|as|a|an|the|only|left out:|m:) """)


def without_a_noun(text: str) -> list[str]:
    """Helps in a source that do not complete "give the ..."."""
    return [text[it.start() : it.start() + 60] for it in NO_NOUN.finditer(text)]


def test_every_help_begins_with_what_it_is():
    files = [*ROOT.glob("porescale/scene/**/*.py"), *ROOT.glob("continuum_sph/scene/*.py")]
    assert [line for file in files for line in without_a_noun(file.read_text(encoding="utf-8"))] == []


def test_a_help_that_begins_with_something_else_is_found():
    for help in ("of grains per volume", "a point", "the same by sound", "left out: that of the normal"):
        assert without_a_noun(f'density: float = quantity("kg/m^3", help="{help}")') != []


def test_a_repair_of_a_wrong_unit_says_the_unit_before_what_the_number_is():
    help = "k of full pores; with soil.suction under gravity"
    assert Quantity("m/s", help=help).repair() == f'give it in m/s, as 1.5 or "1.5 m/s" ({help})'
    assert Quantity("", help="exponent m").repair() == "give it as a number (exponent m)"


@pytest.mark.parametrize(
    ("help", "said"),
    [
        ("speed at which it rises; left out, it vanishes at once",
         "give the speed at which it rises in this range; left out, it vanishes at once"),
        ("radius over another, 0.7 to 0.9 in beds", "give the radius over another in this range, 0.7 to 0.9 in beds"),
        ("corners (x, y) of the outline", "give the corners (x, y) of the outline in this range"),
        ("", "give a value in this range"),
    ],
)  # fmt: skip
def test_the_range_is_that_of_what_is_asked_for_not_of_the_last_word(help, said):
    with pytest.raises(Refused) as caught:
        Quantity("m", gt=0, help=help).convert(-1.0)
    assert caught.value.faults[0].repair == said


def test_an_angle_beyond_its_range_that_would_be_in_it_as_degrees_is_told_how_to_write_them():
    angle = Quantity("rad", ge=0, le=1.4, help="angle of friction")
    for given, ends in ((30, '; degrees are written as "30 deg"'), (200, "in this range"), ("2 rad", "in this range")):
        with pytest.raises(Refused) as caught:
            angle.convert(given)
        assert caught.value.faults[0].repair.endswith(ends)
    assert angle.convert("30 deg") == pytest.approx(math.pi / 6, rel=1e-15)
