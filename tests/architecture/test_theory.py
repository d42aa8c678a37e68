"""Pages on theory name what there is: docstrings, files with their functions, rows, equations, works."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from porescale.common.evidence.register import discovered
from tests.architecture.sources import ROOT

PAGES = sorted((ROOT / "docs" / "theory").glob("*.md"))
COMPARISONS = sorted((ROOT / "docs" / "theory" / "comparisons").glob("*.md"))
LONGEST = 850  # characters: six lines of the manual, and a half for formulas
DOCSTRING = re.compile(r"^```\{docstring\} (\S+)$", re.MULTILINE)
FILE = re.compile(r"`((?:porescale|continuum_sph|tests|docs|cases)/[\w/.]+?)(?:::([\w.]+))?`")
ROWS = re.compile(r"^```\{rows\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ROW = re.compile(r"`((?:lbm|dem|coupling|piv|scene|continuum)\.\w+)`")
LABEL = re.compile(r"^\$\$ \(([\w-]+)\)$", re.MULTILINE)
QUOTED = re.compile(r"\{eq\}`([\w-]+)`")
CITED = re.compile(r"^Sources: \[([^\]]+)\]\(sources\.md\)\.$", re.MULTILINE)


@cache
def tree(path: Path) -> ast.Module:
    """The syntax of a source file."""
    return ast.parse(path.read_text(encoding="utf-8"))


def node_of(path: Path, names: list[str]) -> ast.AST | None:
    """What a dotted name within a file is bound to; None if there is no such name."""
    node: ast.AST = tree(path)
    for name in names:
        found = [it for it in getattr(node, "body", []) if name in bound(it)]
        if not found:
            return None
        node = found[-1]
    return node


def bound(node: ast.AST) -> list[str]:
    """Names that a statement binds."""
    if isinstance(node, ast.Assign | ast.AnnAssign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        return [it.id for target in targets for it in ast.walk(target) if isinstance(it, ast.Name)]
    return [getattr(node, "name", "")]


def without_docstring(name: str, root: Path = ROOT) -> bool:
    """Whether a dotted name of a module, class or function has no docstring to show."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        base = root.joinpath(*parts[:count])
        for path in (base.with_suffix(".py"), base / "__init__.py"):
            if path.is_file():
                node = node_of(path, parts[count:])
                kinds = ast.Module | ast.ClassDef | ast.FunctionDef
                return not (isinstance(node, kinds) and ast.get_docstring(node))
    return True


def missing_files(page: str, root: Path = ROOT) -> list[str]:
    """Files, and names within files, that a page names and that there are not."""
    wrong = []
    for name, inner in FILE.findall(page):
        path = root / name
        if not path.exists() or (inner and node_of(path, inner.split(".")) is None):
            wrong.append(f"{name}::{inner}" if inner else name)
    return wrong


def rows_named(page: str) -> list[str]:
    """Rows of validations that a page names, in lists and in text."""
    return [it for block in ROWS.findall(page) for it in block.split()] + ROW.findall(page)


@cache
def rows() -> set[str]:
    """Names of all rows that ``verify`` has."""
    found = [discovered(f"{package}.validation", "VALIDATIONS")() for package in ("porescale", "continuum_sph")]
    return {row.name for each in found for row in each}


def equations_astray(page: str) -> list[str]:
    """Equations that a page refers to and does not have, and labels that it has twice."""
    labels = LABEL.findall(page)
    return [it for it in QUOTED.findall(page) if it not in labels] + [it for it in labels if labels.count(it) > 1]


def without_source(page: str, sources: str) -> list[str]:
    """Works that the last line of a page cites and no line of the list of ``sources`` has, by first name and year."""
    wrong = []
    for work in [it.strip() for each in CITED.findall(page) for it in each.replace("\n", " ").split(";")]:
        name, years = re.split(r"[ ,']", work)[0], re.findall(r"\b\d{4}\b", work)
        lines = [line for line in sources.splitlines() if name in line]
        if not lines or any(all(year not in line for line in lines) for year in years):
            wrong.append(work)
    return wrong


def long_paragraphs(page: str, longest: int = LONGEST) -> list[str]:
    """First words of what a page says in one piece of more than ``longest`` characters: paragraphs and items of lists,
    but no tables, equations or code."""
    pieces = [it for part in re.split(r"\n\s*\n", page) for it in re.split(r"\n(?=[-*] |\d+\. )", part)]
    return [it[:60] for it in pieces if len(it) > longest and not it.startswith(("|", "```", "$$", "<"))]


@pytest.mark.parametrize("page", COMPARISONS, ids=lambda it: it.stem)
def test_a_page_of_comparisons_names_what_there_is(page):
    text = page.read_text(encoding="utf-8")
    labels = {it for each in (*PAGES, *COMPARISONS) for it in LABEL.findall(each.read_text(encoding="utf-8"))}
    assert missing_files(text) == []
    assert [name for name in rows_named(text) if name not in rows()] == []
    assert [name for name in QUOTED.findall(text) if name not in labels] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: it.stem)
def test_a_page_says_one_thing_at_a_time(page):  # what was tried besides, and its figures: docs/theory/comparisons
    assert long_paragraphs(page.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: it.stem)
def test_a_page_names_what_there_is(page):
    text = page.read_text(encoding="utf-8")
    assert [name for name in DOCSTRING.findall(text) if without_docstring(name)] == []
    assert missing_files(text) == []
    assert [name for name in rows_named(text) if name not in rows()] == []
    assert equations_astray(text) == []
    assert without_source(text, (ROOT / "docs" / "theory" / "sources.md").read_text(encoding="utf-8")) == []


def test_every_page_is_in_the_map():
    index = (ROOT / "docs" / "theory" / "index.md").read_text(encoding="utf-8")
    contents = re.findall(r"^\w+$", index.split("```{toctree}")[1], re.MULTILINE)
    assert sorted(contents) == [it.stem for it in PAGES if it.stem != "index"]


def test_every_page_of_comparisons_is_in_their_list():
    index = (ROOT / "docs" / "theory" / "comparisons" / "index.md").read_text(encoding="utf-8")
    contents = re.findall(r"^\w+$", index.split("```{toctree}")[1], re.MULTILINE)
    assert sorted(contents) == [it.stem for it in COMPARISONS if it.stem != "index"]


def test_labels_of_equations_are_of_one_page_each():
    labels = [it for page in (*PAGES, *COMPARISONS) for it in LABEL.findall(page.read_text(encoding="utf-8"))]
    assert len(labels) == len(set(labels)) > 20


def test_wrong_names_are_found(tmp_path):  # the checks that must fail
    (tmp_path / "porescale").mkdir()
    (tmp_path / "porescale" / "a.py").write_text("X = 1\n\n\ndef f():\n    pass\n\n\nclass C:\n    'c'\n")
    assert without_docstring("porescale.a.f", tmp_path)
    assert without_docstring("porescale.b", tmp_path)
    assert not without_docstring("porescale.a.C", tmp_path)
    page = "`porescale/a.py` `porescale/a.py::X` `porescale/a.py::C.m` `porescale/b.py`"
    assert missing_files(page, tmp_path) == ["porescale/a.py::C.m", "porescale/b.py"]
    assert rows_named("```{rows}\nlbm.one\ndem.two\n```\nand `lbm.three`") == ["lbm.one", "dem.two", "lbm.three"]
    assert equations_astray("$$\nx\n$$ (one)\n{eq}`one` {eq}`two`") == ["two"]
    assert long_paragraphs("a b\n\n- c\n- d e f\n\n| a long row |\n", 5) == ["- d e f"]
    assert without_source("Sources: [Who & Else 1999; Who 2000](sources.md).\n", "- Who, A. 1999: a") == ["Who 2000"]
