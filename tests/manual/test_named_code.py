"""Files and functions that the pages for developers name are there."""

import re

import pytest

from tests.reference.folders import DOCS, ROOT

PAGES = sorted((DOCS / "develop").glob("*.md"))
NAMED = re.compile(r"`((?:\w+/)+(?:\w+\.py)?)(?::\s+([\w.]+))?`")
"""``folder/file.py``, ``folder/``, or ``folder/file.py: name``, ``…: Class.method``."""


def missing(text: str) -> list[str]:
    """What a page names as code and the tree does not have: below the root, porescale or its common folder."""
    found = []
    for path, name in NAMED.findall(re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
        places = [place for place in (ROOT / path, ROOT / "porescale" / path) if place.exists()]
        if not places:
            found.append(path)
        for part in filter(None, name.split(".")):
            if not any(re.search(rf"\b(?:def|class) {part}\b|^{part}\b", it.read_text("utf-8"), re.M) for it in places):
                found.append(f"{path}: {name}")
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_names_is_there(page):
    assert missing(page.read_text(encoding="utf-8")) == []


def test_pages_name_code():
    assert sum(len(NAMED.findall(page.read_text(encoding="utf-8"))) for page in PAGES) > 50


@pytest.mark.parametrize("wrong", ["`dem/steps.py`", "`dem/step.py: contact_stepz`", "`dem/grains.py: Grains.leap`"])
def test_a_name_that_is_gone_is_found(wrong):  # the check that must fail
    assert len(missing(f"See {wrong}.")) == 1
