"""A run folder that a run may be writing to, read without writing, locking or joining anything in it.

Snapshots appear whole, by a rename, and rows in whole lines but for a torn last one: what can be read is right.  What
is read may be gone the next moment, when the run ends and joins its snapshots: then it is looked for anew.
"""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from porescale.common.core.errors import Fault, InputError
from porescale.common.record import snapshots, vtkhdf
from porescale.common.record.columns import TIME
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card, scene_end
from porescale.common.record.series import NAME as SERIES

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.api.program import Program

T = TypeVar("T")
TRIES = 3
"""How often a folder is read anew when something in it is gone while it is read."""
TAIL = 1 << 16
"""Bytes at the end of series.csv in which its last whole row is looked for."""


def inside(root: Path, path: Path) -> bool:
    """Whether ``path`` exists and lies in ``root`` (resolved), all links followed."""
    try:
        return path.resolve(strict=True).is_relative_to(root)
    except (OSError, RuntimeError):  # not there, or a link to itself
        return False


def elsewhere(path: Path) -> InputError:
    """The error for what a link in the watched folder leads out of it to."""
    return InputError(
        Fault("watch", str(path), "lies elsewhere, behind a link", repair="watch the folder where it lies")
    )


class Growing:
    """A run folder, looked at again and again by one thread at a time.  folder : resolved;  program : of its runs."""

    def __init__(self, folder: Path, program: Program) -> None:
        self.folder, self.program = folder.resolve(), program
        self._epoch = 0
        self._seen: tuple[Any, list[int], dict[str, int]] = (None, [], {})
        self._files: dict[Path, tuple[tuple[int, int, int], list[vtkhdf.Frame]]] = {}
        self._run: Run | None = None
        self._last: tuple[float, float] | None = None
        """When something was last written by the clock of who wrote it, and by our own."""

    def state(self) -> dict[str, Any]:
        """What changes while a run writes.

        epoch : how often something written before was taken back or replaced (a resumed or another run);  steps : of
        the snapshots;  tables : bytes of each, by name;  outcome, problem : of the card;  time, end : reached and to
        be reached, s, or None;  age : seconds since the last change.
        """
        run = self.run()
        steps, tables = [int(step) for step in run.steps], self._tables()
        identity, old_steps, old_tables = self._seen
        begun = run.card.get("started")
        shorter = any(tables.get(name, 0) < size for name, size in old_tables.items())
        if identity is not None and (identity != begun or steps[: len(old_steps)] != old_steps or shorter):
            self._epoch += 1
        self._seen = begun, steps, tables
        reached = last_value(self.folder / SERIES) if SERIES[:-4] in tables else None
        return {
            "epoch": self._epoch,
            "steps": steps,
            "tables": tables,
            "outcome": run.card.get("outcome") or "",
            "problem": run.card.get("problem") or "",
            "time": reached,
            "end": scene_end(run.card),
            "age": self._age(),
        }

    def run(self) -> Run:
        """The run as it is now, the same object while no snapshot and no card is new; InputError if there is none."""
        from porescale.common.api.open_run import Run

        if (self.folder / CARD).exists() and not inside(self.folder, self.folder / CARD):
            raise elsewhere(self.folder / CARD)
        card = self._again(lambda: read_card(self.folder))
        frames = self._again(lambda: snapshots.catalogue(self.folder, self._frames_of))
        before = self._run
        if before is None or before.card != card or dict(before._frames) != frames:
            self._run = before = Run(self.folder, card, frames, self.program)
        before.__dict__.pop("series", None)  # rows come between snapshots
        return before

    def ask(self, question: Callable[[Run], T]) -> T:
        """The answer of ``question`` to the run as it is now, asked again where a file was gone meanwhile."""
        return self._again(lambda: question(self.run()))

    def _again(self, question: Callable[[], T]) -> T:
        for _ in range(TRIES - 1):
            try:
                return question()
            except FileNotFoundError:
                continue
            except InputError as error:  # a snapshot that was joined while it was read is said to be damaged
                if not isinstance(error.__cause__, FileNotFoundError):
                    raise
        return question()

    def _frames_of(self, path: Path) -> list[vtkhdf.Frame]:
        """The frames of a file, read once unless it was replaced; InputError where it lies elsewhere."""
        found = path.stat()
        key = (found.st_ino, found.st_mtime_ns, found.st_size)
        known = self._files.get(path)
        if known is None or known[0] != key:
            if not inside(self.folder, path):
                raise elsewhere(path)
            self._files[path] = known = key, vtkhdf.frames_of(path)
        return known[1]

    def _tables(self) -> dict[str, int]:
        """Bytes of each table by name, series first."""
        found = {path.stem: path for path in self.folder.glob("[!.]*.csv") if inside(self.folder, path)}
        return {
            name: found[name].stat().st_size for name in sorted(found, key=lambda name: (name != SERIES[:-4], name))
        }

    def _age(self) -> float:
        """Seconds since something was last written.

        By our clock since a change was seen; only before that, what lies between our clock and that of the writer's
        machine counts, too.
        """
        changed, now = self._changed(), clock.monotonic()
        if self._last is None:
            self._last = changed, now - max(0.0, clock.time() - changed)
        elif changed != self._last[0]:
            self._last = changed, now
        return now - self._last[1]

    def _changed(self) -> float:
        """When something was last written, seconds of the clock."""
        places = [CARD, SERIES, snapshots.PARTS, "checkpoint.h5"]
        return max((path.stat().st_mtime for name in places if (path := self.folder / name).exists()), default=0.0)


def last_value(path: Path) -> float | None:
    """The last time in a table that may be growing; None where there is no whole row."""
    import csv

    try:
        with open(path, "rb") as file:
            head = file.readline()
            size = file.seek(0, 2)
            file.seek(max(len(head), size - TAIL))
            rows = file.read()
        last = rows.rpartition(b"\n")[0].rpartition(b"\n")[2]
        names, cells = (next(csv.reader([line.decode()]), []) for line in (head, last))
        return float(cells[names.index(TIME)]) if len(cells) == len(names) else None
    except (OSError, ValueError):
        return None
