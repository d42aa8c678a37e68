"""The README keeps up: it has every validation, command and case that there is, none that is not, and no dead link."""

from __future__ import annotations

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
from porescale.common.evidence.validations import Validation, Validations
from tests.architecture.sources import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
WRITER = runpy.run_path(str(ROOT / ".ci" / "readme"))
PACKAGES = {"porescale": PORESCALE, "continuum_sph": CONTINUUM}
LINK = re.compile(r"!?\[[^\]]*\]\(([^()\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def behind(text: str, package: str, known: Iterable[Validation]) -> list[str]:
    """What a README's table of validations lacks, has too much or states otherwise: names, sources, tolerances."""
    lines = WRITER["block"](text, f"{package} verify")
    stands = {name for name in lines if name != "validation"}
    known = list(known)
    found = sorted(stands ^ {one.name for one in known})
    found += [f"{name}: twice" for name in sorted(stands) if text.count(f"\n| {name} ") > 1]
    for one in known if not found else ():
        start, end = WRITER["written"](["", one.source])[3:-1], f"| {WRITER['number'](one.tolerance)} |"
        if start not in lines[one.name] or not lines[one.name].endswith(end):
            found.append(f"{one.name}: source or tolerance")
    return found


@pytest.mark.parametrize("package", PACKAGES)
def test_every_validation_stands_in_the_table(package: str) -> None:
    assert behind(README, package, PACKAGES[package].validations()) == []  # else: .ci/readme verify new


def validation(name: str, tolerance: float = 0.5) -> Validation:
    return Validation(name, "a | b", "because", tolerance, False, lambda: None)


TABLE = """<!-- p verify -->
| validation | source | reference | measured | error | tolerance |
|---|---|---|---|---|---|
| r.a | a \\| b | 1 | 1 | 0 | 0.5 |
<!-- end of p verify -->"""


@pytest.mark.parametrize(
    "known",
    [[], [validation("r.b")], [validation("r.a"), validation("r.b")], [validation("r.a", 0.05)]],
)
def test_a_table_that_fell_behind_is_found(known: list[Validation]) -> None:  # the twin that must fail
    assert behind(TABLE, "p", known)
    assert behind(TABLE.replace("\n<!-- end", "\n| r.a | again\n<!-- end"), "p", [validation("r.a")])
    assert behind(TABLE, "p", [validation("r.a")]) == []
    assert isinstance(PORESCALE.validations(), Validations)


def names(app: App, before: str) -> Iterator[str]:
    """Every command of an app, with those within commands: ``porescale study trade``."""
    for word in app:
        if not word.startswith("-"):
            yield f"{before} {word}"
            yield from names(app[word], f"{before} {word}")


APPS = {"porescale": commands(), "continuum-sph": application(CONTINUUM)}
KNOWN = {name for package, app in APPS.items() for name in names(app, package)}
QUOTED = re.compile(r"(?<![\w.-])(?<!from )(porescale|continuum-sph) ([a-z]+)(?: ([a-z]+))?")


def unknown_commands(text: str) -> list[str]:
    """Commands that a text quotes and no package has."""
    quotes = [*re.findall(r"`([^`\n]+)`", FENCE.sub("", text)), *FENCE.findall(text)]
    found = []
    for package, word, more in (match for quote in quotes for match in QUOTED.findall(quote)):
        inner = any(name.startswith(f"{package} {word} ") for name in KNOWN)
        if f"{package} {word}" not in KNOWN or (inner and more and f"{package} {word} {more}" not in KNOWN):
            found.append(f"{package} {word} {more}".strip())
    return found


def test_every_command_is_named_and_every_one_named_is_there() -> None:
    assert unknown_commands(README) == []
    ours = {name for name in KNOWN if name.startswith("porescale ")}
    outer = {name for name in ours if any(other.startswith(f"{name} ") for other in ours)}
    last = {name: f"`… {name.rpartition(' ')[2]}" for name in ours - outer}
    assert [name for name in sorted(last) if f"`{name}" not in README and last[name] not in README] == []


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


@pytest.mark.parametrize("link", ["cases/none", "cases#none", "#none", "../elsewhere"])
def test_a_dead_link_is_found(link: str) -> None:
    assert dead_links(ROOT / "README.md", f"# Some words, `x`\n[a]({link}) [b](#some-words-x) [c](cases)") == [link]


def test_every_case_is_linked_and_maps_are_shown() -> None:
    linked = LINK.findall(README)
    cases = {path.parent.relative_to(ROOT).as_posix() for path in (ROOT / "cases").glob("*/README.md")}
    assert cases - set(linked) == set()
    shown = set(re.findall(r"!\[[^\]]+\]\(([^()\s]+)\)", README))
    assert {"docs/stability/stability.png", "docs/extremes/extremes.png"} <= shown
    studies = {path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").iterdir()}
    assert {study for study in studies if not any(link.startswith(study) for link in linked)} == set()
