"""The pages keep up: every validation, command and case stands in them, none that is not there, and no dead link.

The README is short: what leaves it goes to docs.
"""

import ast
import importlib
import re
import runpy
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from cyclopts import App

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.cli.main import commands
from porescale.common.cli.application import application
from porescale.common.evidence.validation_files import number
from porescale.common.evidence.validations import Validation, Validations
from porescale.common.schema.sections import load
from tests.architecture.sources import ROOT


def page(name: str) -> str:
    """The text of a page."""
    return (ROOT / name).read_text(encoding="utf-8")


README, COMMANDS = page("README.md"), page("docs/commands.md")
TOPICS = sorted((ROOT / "docs" / "evidence").glob("*.md"))
EVIDENCE = "\n".join(path.read_text(encoding="utf-8") for path in TOPICS if path.stem != "trust")
PAGES = (
    "README.md", "CONTRIBUTING.md", *(f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))),
    *(f"docs/evidence/{path.name}" for path in TOPICS),
)  # fmt: skip
MOST_BYTES, MOST_LINES = 8192, 150
"""What a README may have at most: one that is read in a few minutes."""
WRITER = runpy.run_path(str(ROOT / ".ci" / "tables"))
PACKAGES = {"porescale": PORESCALE, "continuum_sph": CONTINUUM}
LINK = re.compile(r"!?\[[^\]]*\]\(([^()\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def behind(text: str, known: Iterable[Validation]) -> list[str]:
    """What the tables of validations lack, have too much or state otherwise: names, topics, sources, tolerances."""
    known = list(known)
    lines, stands, seen = {}, {}, list[str]()
    for topic in re.findall(r"<!-- (\w+) verify -->", text):
        block = WRITER["block"](text, f"{topic} verify")
        lines |= block
        seen += [line.split()[1] for line in WRITER["inside"](text, f"{topic} verify") if line.startswith("| ")]
        stands |= {name: topic for name in block if name != "validation"}
    found = [name for name, _ in sorted(stands.items() ^ {(one.name, one.topic) for one in known})]
    found += [f"{name}: twice" for name in sorted(stands) if seen.count(name) > 1]
    for one in known if not found else ():
        start, end = WRITER["markdown_row"](["", one.source])[3:-1], f"| {number(one.tolerance)} |"
        if start not in lines[one.name] or end not in lines[one.name][-60:]:
            found.append(f"{one.name}: source or tolerance")
    return found


def test_every_validation_stands_in_the_table_of_its_topic() -> None:
    known = [one for package in PACKAGES.values() for one in package.validations()]
    assert behind(EVIDENCE, known) == []  # else: .ci/tables verify new


def validation(name: str, tolerance: float = 0.5) -> Validation:
    return Validation(name, "a | b", "because", tolerance, False, lambda: None)


TABLE = """<!-- r verify -->
| validation | source | reference | measured | error | tolerance | run |
|---|---|---|---|---|---|---|
| r.a | a \\| b | 1 | 1 | 0 | 0.5 | 2026-01-01 0123abcd |
<!-- end of r verify -->"""


@pytest.mark.parametrize(
    "known",
    [[], [validation("r.b")], [validation("r.a"), validation("r.b")], [validation("r.a", 0.05)]],
)
def test_a_table_that_fell_behind_is_found(known: list[Validation]) -> None:  # the twin that must fail
    assert behind(TABLE, known)
    assert behind(TABLE.replace("\n<!-- end", "\n| r.a | again\n<!-- end"), [validation("r.a")])
    assert behind(TABLE.replace("r verify", "q verify"), [validation("r.a")])
    assert behind(TABLE, [validation("r.a")]) == []
    assert isinstance(PORESCALE.validations(), Validations)


def names(app: App, before: str) -> Iterator[str]:
    """Every command of an app, with those within commands: ``porescale study trade``."""
    for word in app:
        if not word.startswith("-"):
            yield f"{before} {word}"
            yield from names(app[word], f"{before} {word}")


APPS = {"porescale": commands(), "continuum-sph": application(CONTINUUM)}
KNOWN = {name for package, app in APPS.items() for name in names(app, package)}
QUOTED = re.compile(r"(?<![\w.-])(?<!from )(?<!import )(porescale|continuum-sph) ([a-z]+)(?: ([a-z]+))?")


def unknown_commands(text: str) -> list[str]:
    """Commands that a text quotes and no package has."""
    quotes = [*re.findall(r"`([^`\n]+)`", FENCE.sub("", text)), *FENCE.findall(text)]
    found = []
    for package, word, more in (match for quote in quotes for match in QUOTED.findall(quote)):
        inner = any(name.startswith(f"{package} {word} ") for name in KNOWN)
        if f"{package} {word}" not in KNOWN or (inner and more and f"{package} {word} {more}" not in KNOWN):
            found.append(f"{package} {word} {more}".strip())
    return found


def unnamed_commands(text: str) -> list[str]:
    """Commands of porescale that a text does not name."""
    ours = {name for name in KNOWN if name.startswith("porescale ")}
    outer = {name for name in ours if any(other.startswith(f"{name} ") for other in ours)}
    last = {name: f"`… {name.rpartition(' ')[2]}" for name in ours - outer}
    return [name for name in sorted(last) if f"`{name}" not in text and last[name] not in text]


@pytest.mark.parametrize("name", PAGES)
def test_every_command_that_is_named_is_there(name: str) -> None:
    assert unknown_commands(page(name)) == []


def test_every_command_is_named() -> None:
    assert unnamed_commands(COMMANDS) == []
    # The check that must fail: a page that lost a command.
    assert unnamed_commands(COMMANDS.replace("`porescale sweep ", "`porescale weep ")) == ["porescale sweep"]


def test_a_command_that_is_not_there_is_found() -> None:
    assert unknown_commands("`porescale check SCENE`, `porescale study trade X`, `continuum-sph verify`") == []
    assert unknown_commands("`porescale study trades X`") == ["porescale study trades"]
    assert unknown_commands("```sh\n.venv/bin/porescale rum x\n```") == ["porescale rum x"]


def anchors(text: str) -> set[str]:
    """What a link may name in a text: its headings in lower case, words joined, without marks."""
    heads = re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).strip().replace(" ", "-") for head in heads}


def dead_links(file: Path, text: str) -> list[str]:
    """Links of a text in a ``file`` to what is not there, or leaves the project."""
    found = []
    for target in LINK.findall(FENCE.sub("", text)):
        path, _, anchor = target.partition("#")
        if re.match(r"[a-z]+:", path):
            continue
        there = (file.parent / path).resolve() if path else file
        page = there / "README.md" if there.is_dir() else there
        sound = there.exists() and there.is_relative_to(ROOT)
        if sound and anchor:
            sound = page.is_file() and anchor in anchors(text if page == file else page.read_text(encoding="utf-8"))
        if not sound:
            found.append(target)
    return found


def texts() -> list[Path]:
    """Every page of the project."""
    named = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True)
    return [ROOT / name for name in named.stdout.splitlines()] or [
        ROOT / "README.md", *(ROOT / "cases").rglob("*.md"), *(ROOT / "docs").rglob("*.md"),
    ]  # fmt: skip


def test_links_lead_somewhere() -> None:
    pages = texts()
    assert len(pages) > 50
    dead = {str(page.relative_to(ROOT)): dead_links(page, page.read_text(encoding="utf-8")) for page in pages}
    assert {page: links for page, links in dead.items() if links} == {}


PATH = re.compile(r"(?<![\w/.-])(?:porescale|continuum_sph|cases|docs|tests|\.ci)/[\w./-]*\w")
MODULE = re.compile(r"`((?:porescale|continuum_sph|tests)(?:\.[a-z_0-9]+)+)")
PLACEHOLDER = re.compile(r"[A-Z]{3,}")
WRITTEN = re.compile(r"^<!-- file: (\S+) -->", re.MULTILINE)
"""A file that the page itself shows, and that its code writes: tests/manual/snippets.py."""


def missing_files(text: str) -> list[str]:
    """Files and modules that a text names and the project does not have, but for links; NAME stands for any."""
    paths = [path for path in PATH.findall(LINK.sub("", text)) if not PLACEHOLDER.search(path)]
    own = [place for path in map(Path, WRITTEN.findall(text)) for place in (path, *path.parents)]
    found = [path for path in paths if not (ROOT / path).exists() and Path(path) not in own]
    for name in MODULE.findall(text):
        module = ROOT / name.replace(".", "/")
        places = (module, module.with_suffix(".py"), module.parent.with_suffix(".py"))  # the last: a name in a module
        if not any(place.exists() for place in places):
            found.append(name)
    return found


def test_files_that_are_named_are_there() -> None:
    pages = [path for path in texts() if path.name != "CHANGELOG.md"]  # which names what was
    lost = {str(path.relative_to(ROOT)): missing_files(path.read_text(encoding="utf-8")) for path in pages}
    assert {path: names for path, names in lost.items() if names} == {}


def test_a_file_that_is_gone_is_found() -> None:
    assert missing_files("`porescale/lbm/fluid.py`, cases/rock, cases/NAME/NAME.py, `tests.reference.dem.dem`") == []
    assert missing_files("see porescale/gone.py and `porescale.lbm.gone`") == [
        "porescale/gone.py",
        "porescale.lbm.gone",
    ]
    assert missing_files("`porescale.lbm.fluid.Fluid`") == []
    shown = "<!-- file: cases/gone/scene.toml -->\nsee cases/gone and cases/gone/expected.toml"
    assert missing_files(shown) == ["cases/gone/expected.toml"]


@pytest.mark.parametrize("link", ["cases/none", "cases#none", "#none", "../elsewhere"])
def test_a_dead_link_is_found(link: str) -> None:
    assert dead_links(ROOT / "README.md", f"# Some words, `x`\n[a]({link}) [b](#some-words-x) [c](cases)") == [link]


def too_long(text: str) -> bool:
    """Whether a README has more bytes or lines than are read."""
    return len(text.encode()) > MOST_BYTES or len(text.splitlines()) > MOST_LINES


def test_the_readme_is_short() -> None:
    assert not too_long(README)
    # The checks that must fail: a byte and a line too many.
    assert too_long("ü" * (MOST_BYTES // 2) + "x")
    assert too_long("x\n" * (MOST_LINES + 1))
    assert not too_long("x\n" * MOST_LINES)


def targets(name: str) -> set[str]:
    """What a page links to, as paths from the root."""
    found = (target.partition("#")[0] for target in LINK.findall(FENCE.sub("", page(name))))
    inside = [((ROOT / name).parent / path).resolve() for path in found if path and ":" not in path]
    return {path.relative_to(ROOT).as_posix() for path in inside if path.is_relative_to(ROOT)}


def test_every_page_case_and_study_is_linked() -> None:
    cases = {path.parent.relative_to(ROOT).as_posix() for path in (ROOT / "cases").glob("*/README.md")}
    assert cases - targets("docs/cases.md") == set()
    pages = {path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").glob("*.md")} - {"docs/index.md"}
    assert "docs/index.md" in targets("README.md")
    assert pages - targets("docs/index.md") == set()
    linked = set().union(*map(targets, PAGES))
    assert {"docs/stability/stability.png", "docs/extremes/extremes.png"} <= linked
    folders = [path for path in (ROOT / "docs").iterdir() if path.is_dir() and not path.name.startswith("_")]
    studies = {path.relative_to(ROOT).as_posix() for path in folders}
    assert {study for study in studies if not any(link.startswith(f"{study}/") for link in linked)} == set()


FENCED = re.compile(r"^```(python|toml)\n(.*?)^```", re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("name", PAGES)
def test_what_pages_quote_is_right(name: str, tmp_path: Path) -> None:
    for kind, text in FENCED.findall(page(name)):
        if kind == "python":
            tree = ast.parse(text)
            for node in (node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)):
                public = importlib.import_module(node.module or "")
                assert [alias.name for alias in node.names if not hasattr(public, alias.name)] == []
        else:
            (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
            assert load(tmp_path, PORESCALE.scene())
