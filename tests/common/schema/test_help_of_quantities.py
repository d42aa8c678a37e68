"""What messages say of a number: its help completes "give the ..."."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
NO_NOUN = re.compile(r'help="(of|from|at|in|to|under|by|for|with|how|whether|if|as) ')


def without_a_noun(text: str) -> list[str]:
    """Helps in a source that do not complete "give the ..."."""
    return [text[it.start() : it.start() + 60] for it in NO_NOUN.finditer(text)]


def test_every_help_begins_with_what_it_is():
    files = [*ROOT.glob("porescale/scene/**/*.py"), *ROOT.glob("continuum_sph/scene/*.py")]
    assert [line for file in files for line in without_a_noun(file.read_text(encoding="utf-8"))] == []


def test_a_help_that_begins_with_a_preposition_is_found():
    assert without_a_noun('density: float = quantity("kg/m^3", help="of grains per volume")') != []
