"""Pages on methods name tests that there are."""

import ast
import re

import pytest

from tests.architecture.sources import ROOT

STEPS = sorted(it for it in (ROOT / "docs" / "methods").glob("*.md") if it.name != "README.md")
TEST = re.compile(r"`(tests/[\w/]+\.py)::(\w+)`")


@pytest.mark.parametrize("page", STEPS, ids=lambda it: it.stem)
def test_a_page_names_tests_that_there_are(page):
    named = TEST.findall(page.read_text(encoding="utf-8"))
    assert named
    for path, name in named:
        tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
        assert name in [it.name for it in tree.body if isinstance(it, ast.FunctionDef)]
