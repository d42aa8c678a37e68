"""Pages on methods show the source as it is, and name tests that there are."""

import ast
import re

import pytest

from tests.architecture.quotes import PAGES, QUOTE, renewed
from tests.architecture.sources import ROOT

STEPS = sorted(it for it in PAGES.glob("*.md") if it.name != "README.md")
TEST = re.compile(r"`(tests/[\w/]+\.py)::(\w+)`")


@pytest.mark.parametrize("page", STEPS, ids=lambda it: it.stem)
def test_a_page_shows_the_source_as_it_is(page):
    text = page.read_text(encoding="utf-8")
    assert QUOTE.search(text)
    assert renewed(text) == text, "python -m tests.architecture.quotes puts it right"


@pytest.mark.parametrize("page", STEPS, ids=lambda it: it.stem)
def test_a_page_names_tests_that_there_are(page):
    named = TEST.findall(page.read_text(encoding="utf-8"))
    assert named
    for path, name in named:
        tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
        assert name in [it.name for it in tree.body if isinstance(it, ast.FunctionDef)]


def test_a_page_that_differs_by_a_sign_is_found(tmp_path):  # the check that must fail
    (tmp_path / "a.py").write_text("def f(x):\n    return x + 1\n")
    page = "<!-- a.py: f -->\n```python\ndef f(x):\n    return x - 1\n```\n<!-- end -->\n"
    assert renewed(page, tmp_path) == page.replace("x - 1", "x + 1")
