"""The code of the manual's pages, run from the top of a page to its end: ``python -m tests.manual.snippets PAGE``.

```python blocks run one after another in one Python: names carry on down the page.  Of ```console blocks, each line
that starts with ``$ `` is a command; it goes on where it ends with a backslash.  All run in one folder, empty at the
start.  Of ``porescale`` and ``continuum-sph`` the page's Python runs the program with these arguments: a process for
each would spend most of its time on imports and on reading kernels.  Other commands, and those of `PROCESSES`, run in a
shell that has both and ``python``.  A ```text block right after a block that runs says what that block prints, all of
it; ``...`` in it stands for anything.  A comment before a block says what is special:

    <!-- not run: reason -->        the block does not run, or is not what was printed
    <!-- file: NAME -->             the block, of any kind, is written to this file of the folder instead
    <!-- exit code: N -->           the last command of the block ends with N instead of 0
"""

import os
import re
import runpy
import shlex
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any

from porescale.common.compiled import ahead
from tests.reference.folders import DOCS, ROOT

FOLDERS = ("first_hour", "howto", "develop")
PAGES = sorted([*(path for folder in FOLDERS for path in (DOCS / folder).glob("*.md")), DOCS / "python.md"])
BLOCK = re.compile(
    r"(?:^<!-- (?P<note>[^\n]*?) -->\n\s*)?^(?P<fence>`{3,}|:{3,})(?P<kind>[^\n`]*)\n(?P<code>.*?)^(?P=fence)\s*$",
    re.M | re.S,
)
COMMAND = re.compile(r"^\$ ((?:[^\n]*\\\n)*[^\n]*)", re.M)
LIMIT = 300
"""Seconds that one command in a shell may take, compiling included."""
MODULES = {"porescale": "porescale", "continuum-sph": "continuum_sph"}
"""Programs, and what Python runs for them."""
PROCESSES = {"first_run", "install"}
"""Pages whose commands all run in a shell, as those of who begins do."""
SHELL = set("|&;<>()$`*?[]#~{}\n")
"""Signs that a shell gives a meaning to."""


@dataclass(frozen=True)
class Snippet:
    """A fenced block: its kind, its text, the comment before it, and the line of the page that its text starts at."""

    kind: str
    code: str
    note: str
    line: int

    @property
    def file(self) -> str:
        """The file that it is written to; empty: none."""
        return self.note.removeprefix("file:").strip() if self.note.startswith("file:") else ""

    @property
    def code_at_end(self) -> int:
        """Exit code of its last command."""
        return int(self.note.removeprefix("exit code:")) if self.note.startswith("exit code:") else 0

    @property
    def runs(self) -> bool:
        """Whether it is run or written."""
        return bool(self.file) or (self.kind in ("python", "console") and not self.note.startswith("not run"))

    @property
    def prints(self) -> bool:
        """Whether it is what the block before it prints, where that one runs."""
        return self.kind == "text" and not self.file and not self.note.startswith("not run")

    def commands(self) -> list[str]:
        """The lines of a console block that follow a prompt."""
        return [match[1] for match in COMMAND.finditer(self.code)]


def snippets(text: str) -> list[Snippet]:
    """The blocks of a page, from its top."""
    return [
        Snippet(match["kind"].strip(), match["code"], match["note"] or "", text.count("\n", 0, match.start("code")) + 1)
        for match in BLOCK.finditer(text)
    ]


def surroundings(folder: Path) -> dict[str, str]:
    """The environment of commands: ``porescale``, ``continuum-sph`` and ``python`` are those of this checkout."""
    folder.mkdir()
    for name in (*MODULES, "python"):
        call = f"-m {MODULES[name]}" if name in MODULES else ""
        path = folder / name
        path.write_text(f'#!/bin/sh\nexec "{sys.executable}" {call} "$@"\n', encoding="utf-8")
        path.chmod(0o755)
    sources = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    path_ = f"{folder}{os.pathsep}{os.environ['PATH']}"
    # One thread: of two workers on two cores neither has another.
    return {**os.environ, "PATH": path_, "PYTHONPATH": sources, "MPLBACKEND": "Agg", "NUMBA_NUM_THREADS": "1"}


def run_page(page: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run all of a page in a process of its own, in an empty ``folder``."""
    environment = surroundings(folder.parent / f"{folder.name}_bin")
    command = [sys.executable, "-m", "tests.manual.snippets", str(page)]
    limits: Any = {"stdin": subprocess.DEVNULL, "timeout": 2 * LIMIT}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, **limits)


def run_here(words: list[str]) -> int:
    """Exit code of ``porescale`` or ``continuum-sph`` with these arguments, run here as ``python -m`` runs it."""
    before, sys.argv = sys.argv, words
    try:
        runpy.run_module(MODULES[words[0]], run_name="__main__", alter_sys=False)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    finally:
        sys.argv = before
    return 0


@contextmanager
def printed() -> Iterator[list[str]]:
    """What this process and those that it starts print meanwhile, as the list's one text afterwards; printed then."""
    found: list[str] = []
    sys.stdout.flush()
    before = os.dup(1)
    with TemporaryFile() as file:
        os.dup2(file.fileno(), 1)
        try:
            yield found
        finally:
            sys.stdout.flush()
            os.dup2(before, 1)
            os.close(before)
            file.seek(0)
            found.append(file.read().decode())
            print(found[0], end="", flush=True)


def is_printed(stated: str, found: str) -> bool:
    """Whether a text states what was found, where ``...`` stands for anything; spaces at the ends of lines are none."""
    wanted, given = ("\n".join(line.rstrip() for line in it.strip().splitlines()) for it in (stated, found))
    return re.fullmatch(".*".join(map(re.escape, wanted.split("..."))), given, re.S) is not None


def run_command(command: str, alone: bool) -> int:
    """Exit code of a command.  alone : in a process of its own, whatever it is."""
    words = shlex.split(command.replace("\\\n", ""))
    if not alone and words[0] in MODULES and not SHELL & set(command.replace("\\\n", "")):
        return run_here(words)
    return subprocess.run(["bash", "-c", command], timeout=LIMIT).returncode


def main(page: Path) -> None:
    """Run a page here; an exception, or a SystemExit that names the line, where a block fails."""
    ahead.cores = lambda: 1  # no second process that compiles: the other core has the other worker
    names: dict[str, object] = {"__name__": "__main__"}
    found: str | None = None
    for snippet in snippets(page.read_text(encoding="utf-8")):
        if snippet.prints and found is not None and not is_printed(snippet.code, found):
            raise SystemExit(f"{page.name}, line {snippet.line}: is not what was printed:\n{found}")
        found = None
        if snippet.file:
            Path(snippet.file).parent.mkdir(parents=True, exist_ok=True)
            Path(snippet.file).write_text(snippet.code, encoding="utf-8")
        elif snippet.runs:
            found = run_block(snippet, page, names)


def run_block(snippet: Snippet, page: Path, names: dict[str, object]) -> str:
    """Run a block with the ``names`` of the page's Python; returns what it printed."""
    if snippet.kind == "python":
        with printed() as texts:
            exec(compile("\n" * (snippet.line - 1) + snippet.code, str(page), "exec"), names)
        return texts[0]
    commands, given = snippet.commands(), []
    if not commands:
        raise SystemExit(f"{page.name}, line {snippet.line}: no command; lines with one start with '$ '")
    for command in commands:
        due = snippet.code_at_end if command == commands[-1] else 0
        print(f"$ {command}", flush=True)
        with printed() as texts:
            code = run_command(command, alone=page.stem in PROCESSES)
        given += texts
        if code != due:
            raise SystemExit(f"{page.name}, line {snippet.line}: exit code {code}, not {due}")
    return "".join(given)


if __name__ == "__main__":
    # By hand, anywhere but in an empty folder: in one that is made for it and removed.
    target = Path(sys.argv[1]).resolve()
    if os.listdir():
        with TemporaryDirectory() as empty:
            (Path(empty) / "page").mkdir()
            done = run_page(target, Path(empty) / "page")
        print(done.stdout + done.stderr)
        sys.exit(done.returncode)
    sys.path.insert(0, os.getcwd())  # as for a script that lies there
    main(target)
