"""What a watched folder offers by name: the page, what is new, frames and tables of a run; of a sweep its points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.page.frames import frame
from porescale.common.page.meta import frames_of, meta, shown
from porescale.common.page.page import compact
from porescale.common.page.quantise import Precision
from porescale.common.page.tables import names, table
from porescale.common.page.texts import verdicts
from porescale.common.record.card import plain
from porescale.common.record.read_card import NAME as CARD
from porescale.common.watch.growing import Growing, inside
from porescale.common.watch.server import Answer
from porescale.common.watch.shell import shell
from porescale.common.watch.sweep import Points

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.api.program import Program

MOST_CELLS = 1_000_000
"""Cells of a frame that is sent; of larger grids every so many-th in either direction."""
GROWN = 1.2
"""Factor by which snapshots become more before ranges of colours are looked for anew."""
RUN, SWEEP, NOTHING = "run", "sweep", "nothing"


def kind_of(folder: Path) -> str:
    """What a folder holds: a run, a sweep, or nothing yet; InputError where it holds something else."""
    if (folder / CARD).is_file():
        return RUN
    found = list(folder.glob("[!.]*")) if folder.is_dir() else []
    if any((path / CARD).is_file() for path in found):
        return SWEEP
    if folder.exists() and (found or not folder.is_dir()):
        repair = "name a run folder, or the folder of a sweep"
        raise InputError(Fault("folder", str(folder), f"holds no run and no sweep ({CARD} is missing)", repair=repair))
    return NOTHING


class Data:
    """The data of a run that may be growing, by the names that its page asks for."""

    def __init__(self, growing: Growing) -> None:
        self.growing = growing
        self._ranged, self._outcome = 0, ""

    def __call__(self, parts: Sequence[str]) -> Answer | None:
        """``state``, ``meta``, ``news``, ``frame/3``, ``table/series``; None for anything else."""
        growing = self.growing
        match list(parts):
            case ["state"]:
                return _json(growing.state())
            case ["meta"]:
                return _json(growing.ask(lambda run: meta(run, precision(run))))
            case ["news"]:
                return _json(growing.ask(self._news))
            case ["frame", number] if number.isdecimal() and number.isascii() and len(number) < 12:
                return self._frame(int(number))
            case ["table", name]:
                return self._table(name)
        return None

    def _news(self, run: Run) -> dict[str, Any]:
        """The part of `meta` that changes while a run writes; ranges of colours are looked for now and then only."""
        found = {"tables": names(run), "outcome": run.outcome, "problem": str(run.card.get("problem") or ""),
                 "card": run.card, **frames_of(run, precision(run)), "verdicts": verdicts(run)}  # fmt: skip
        if len(run) >= GROWN * self._ranged or run.outcome != self._outcome:
            self._ranged, self._outcome = len(run), run.outcome
            found |= shown(run)
        return found

    def _frame(self, number: int) -> Answer | None:
        def packed(run: Run) -> bytes | None:
            """The bytes of the frame, if it is there."""
            return frame(run, number, precision(run)) if number < len(run) else None

        content = self.growing.ask(packed)
        return None if content is None else Answer(content, "application/octet-stream")

    def _table(self, name: str) -> Answer | None:
        def read(run: Run) -> dict[str, Any] | None:
            """The table, if it is there and in the folder."""
            there = name in names(run) and inside(self.growing.folder, run.folder / f"{name}.csv")
            return table(run, name) if there else None

        found = self.growing.ask(read)
        return None if found is None else _json(found)


def precision(run: Run) -> Precision:
    """How finely frames are sent: every cell, unless they are more than a screen has points."""
    first = run.snapshot(0, ()) if len(run) else None
    most = max((math.prod(grid.shape) for grid in first.grids.values()), default=0) if first else 0
    return Precision(every=max(1, math.ceil(math.sqrt(most / MOST_CELLS))))


class Site:
    """The pages of a watched folder, a run's or a sweep's, whichever it becomes; made for a `Server`."""

    def __init__(self, folder: Path, program: Program) -> None:
        self.folder, self.program = folder, program
        self._run = Data(Growing(folder, program))
        self._points: Points | None = None
        self._of_points: dict[str, Data] = {}

    def __call__(self, parts: Sequence[str]) -> Answer | None:
        """The answer for the parts of a path after the token."""
        kind = kind_of(self.folder)
        if list(parts) == [""]:
            return page(kind, self.folder.resolve().name)
        if list(parts) == ["kind"]:
            return _json(kind)
        if kind == RUN:
            return self._run(parts)
        return self._sweep(parts) if kind == SWEEP else None

    def _sweep(self, parts: Sequence[str]) -> Answer | None:
        """``points``, ``picture/NAME``, ``ensembles``, ``band/NAME`` (null where there is none); pages and data of each
        run, ``run/NAME/…``."""
        if self._points is None:
            self._points = Points(self.folder, self.program)
        match list(parts):
            case ["points"]:
                return _json(self._points.rows())
            case ["ensembles"]:
                return _json(self._points.ensembles())
            case ["band", name]:
                return _json(self._points.band(name))
            case ["picture", name]:
                content = self._points.picture(name)
                return None if content is None else Answer(content, "image/png")
            case ["run", name, *rest] if rest:
                growing = self._points.run(name)
                if growing is None:
                    return None
                data = self._of_points.setdefault(name, Data(growing))
                return page("point", name) if rest == [""] else data(rest)
        return None


def page(kind: str, name: str) -> Answer:
    """The page of a kind of `shell`."""
    return Answer(shell(kind, name).encode(), "text/html; charset=utf-8")


def _json(value: Any) -> Answer:
    """``value`` as JSON that browsers read."""
    return Answer(compact(plain(value)).encode(), "application/json")
