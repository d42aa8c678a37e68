"""What `run --budget` expects of a whole command and what the command takes, on a quiet and on a busy machine."""

import contextlib
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from porescale.common.evidence.files import markdown_table
from tests.architecture.sources import ROOT
from tests.evidence.fronts import SCENES

BUDGETS = "1min", "4min"
WITHIN = 0.3
"""Share of the expected seconds by which a command may be off."""
NO_RUN = ("piv_synthetic",)
"""Cases whose front is of pairs of pictures."""
HEADER = "case", "budget", "picked", "machine", "expected, s", "took, s", "off by", f"within {WITHIN:.0%}"
PICKED = re.compile(r"^picked (.*): error ", re.MULTILINE)
TOOK = re.compile(r"^expected (\S+) s, took (\S+) s", re.MULTILINE)
REFUSED = re.compile(r"is not enough: (.*), the cheapest point, takes (\S+) s")


class Kept(NamedTuple):
    """How a command with a budget ended: the point that was picked, seconds expected and taken; nan taken: refused."""

    case: str
    budget: str
    picked: str
    busy: bool
    expected: float
    took: float

    def row(self) -> tuple[str, ...]:
        """Cells of the table."""
        machine, off = "busy" if self.busy else "quiet", self.took / self.expected - 1.0
        start = f"[{self.case}](../cases/{self.case})", self.budget, self.picked, machine, f"{self.expected:.3g}"
        if off != off:
            return (*start, "refused: takes longer", "", "")
        return (*start, f"{self.took:.3g}", f"{off:+.0%}", "yes" if abs(off) <= WITHIN else "no")


@contextlib.contextmanager
def busy(on: bool) -> Iterator[None]:
    """A machine each of whose cores has another program's work to do, too."""
    load = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range((os.cpu_count() or 1) * on)]
    try:
        yield
    finally:
        for one in load:
            one.kill()
            one.wait()


def ended(case: str, package: str, budget: str, loaded: bool) -> Kept:
    """The end of one command;  raises RuntimeError for another than a finished run or a refused budget."""
    scene = ROOT / "cases" / case / SCENES.get(case, "scene.toml")
    with busy(loaded), tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", package.replace("-", "_"), "run", str(scene), "--budget", budget]
        run = subprocess.run([*words, "--out", str(Path(folder) / "run")], cwd=ROOT, capture_output=True, text=True)
    refused, picked, took = REFUSED.search(run.stderr), PICKED.search(run.stderr), TOOK.search(run.stdout)
    if refused:
        return Kept(case, budget, refused[1], loaded, float(refused[2]), float("nan"))
    if run.returncode or not picked or not took:
        raise RuntimeError(f"{' '.join(words)}: {run.returncode}\n{run.stdout}\n{run.stderr}")
    return Kept(case, budget, picked[1], loaded, float(took[1]), float(took[2]))


def measured(cases: Iterable[str], packages: dict[str, str]) -> list[Kept]:
    """Every command, one after the other: each of ``cases`` with each budget that picks another point."""
    rows: list[Kept] = []
    for case in cases:
        if case in NO_RUN:
            continue
        for loaded in (False, True):
            for budget in BUDGETS:
                one = ended(case, packages[case], budget, loaded)
                print(*one, file=sys.stderr, flush=True)
                if not any((it.case, it.picked, it.busy, it.took == it.took) ==
                           (one.case, one.picked, one.busy, one.took == one.took) for it in rows):  # fmt: skip
                    rows.append(one)
    return rows


def lines(rows: list[Kept], before: Iterable[str], today: str, processor: str) -> list[str]:
    """The table as lines of Markdown, with the rows of other cases of the table ``before``."""
    cells = [it.row() for it in rows]
    new, old = {row[0] for row in cells}, [tuple(line.strip("| \n").split(" | ")) for line in before]
    cells += [(*row, *[""] * (len(HEADER) - len(row))) for row in old if row[0].startswith("[") and row[0] not in new]
    cells.sort(key=lambda row: row[0])
    good, run = (sum(row[-1] in words for row in cells) for words in (("yes",), ("yes", "no")))
    said = f"{good} of {run} commands within {WITHIN:.0%}. On {processor}, {os.cpu_count()} cores, to {today}."
    return [*markdown_table(HEADER, cells), "", said]
