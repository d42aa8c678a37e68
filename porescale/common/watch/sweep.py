"""A folder of runs, as a sweep writes it, looked at while its points run: one row a point, a small picture, and what
their ensembles are worth."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any

import cv2

from porescale.common.core.errors import InputError
from porescale.common.page.tables import over_time
from porescale.common.record.card import FINISHED
from porescale.common.record.columns import TIME
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.studies.ensemble_picture import band
from porescale.common.studies.parameter_table import ENSEMBLE, SWEEP
from porescale.common.studies.sweep_files import COSTS
from porescale.common.watch.growing import Growing, inside

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.api.program import Program

WIDE = 220
"""Pixels of a small picture, across or up, whichever is more."""


class Points:
    """The runs in a folder.  folder : resolved;  program : of its runs."""

    def __init__(self, folder: Path, program: Program) -> None:
        self.folder, self.program = folder.resolve(), program
        self._runs: dict[str, Growing] = {}
        self._pictures: dict[str, tuple[int, bytes]] = {}

    def names(self) -> list[str]:
        """Folders of runs, in the order of sweep.csv, those that are not in it yet after it."""
        found = {path.parent.name for path in self.folder.glob(f"[!.]*/{CARD}") if inside(self.folder, path)}
        first = [row["name"] for row in self._table() if row.get("name") in found]
        return list(dict.fromkeys([*first, *sorted(found)]))

    def run(self, name: str) -> Growing | None:
        """The run of that name; None where there is none."""
        return self._growing(name) if name in self.names() else None

    def _growing(self, name: str) -> Growing:
        """The run in a folder, the same object each time."""
        return self._runs.setdefault(name, Growing(self.folder / name, self.program))

    def rows(self) -> list[dict[str, Any]]:
        """A row for each point: what it sets, how far it is, what it cost, and its numbers in sweep.csv."""
        table = {row.get("name"): row for row in self._table()}
        return [self._row(name, table.get(name, {})) for name in self.names()]

    def _row(self, name: str, line: dict[str, str]) -> dict[str, Any]:
        """state : of the run, None with problem where it cannot be read;  values, numbers : by key and title."""
        row: dict[str, Any] = {
            "name": name,
            "state": None,
            "problem": "",
            "values": {},
            "cost": {},
            "numbers": {},
            "picture": False,
        }
        growing = self._growing(name)
        try:
            card, row["state"] = growing.run().card, growing.state()
        except (InputError, OSError) as error:
            return row | {"problem": " ".join(str(error).split())}
        pairs = (str(text).partition("=") for text in card.get("settings") or ())
        row["values"] = {key: _number(value) for key, _, value in pairs}
        if card.get("quality"):
            row["values"]["quality"] = card["quality"]
        row["picture"] = bool(row["state"]["steps"]) and growing.run().own
        row["cost"] = {title: card.get(key) for title, key in COSTS.items()}
        known = {"name", "quality", "outcome", "problem", *COSTS, *row["values"]}
        row["numbers"] = {title: _number(cell) for title, cell in line.items() if title not in known}
        return row | {"problem": row["state"]["problem"]}

    def ensembles(self) -> list[dict[str, Any]]:
        """The ensembles of ensemble.csv: {"name", "members" (names of their points), "finished" (of these), "said" (how
        many of how many), "lines" (its quantities, numbers as such)}."""
        made: dict[str, dict[str, Any]] = {}
        there = set(self.names())
        for line in self._table(ENSEMBLE):
            name, members = line.get("name", ""), line.get("members", "").split()
            if name not in made:
                outcomes = {it: self._outcome(it) for it in members if it in there}
                done = [it for it, outcome in outcomes.items() if outcome == FINISHED]
                others = [it for it in outcomes.values() if it != FINISHED]
                counts = ", ".join(f"{others.count(it)} {it}" for it in dict.fromkeys(others))
                said = f"{len(done)} of {len(members)} finished" + (f" ({counts})" if counts else "")
                made[name] = {"name": name, "members": members, "finished": done, "said": said, "lines": []}
            made[name]["lines"].append({key: _number(cell) for key, cell in line.items() if key != "members"})
        return list(made.values())

    def _outcome(self, name: str) -> str:
        """How a point stands by its card."""
        try:
            return str(read_card(self.folder / name).get("outcome"))
        except (InputError, OSError):
            return "unreadable"

    def band(self, name: str) -> dict[str, Any] | None:
        """Means of the finished members of an ensemble over time, as a table of a page, with "half" of Student's
        interval for each column; None where there is no such ensemble, or none has finished."""
        found = next((it for it in self.ensembles() if it["name"] == name), None)
        if found is None or not found["finished"]:
            return None
        series = [dict(self._growing(it).run().series) for it in found["finished"]]
        shared = [column for column in series[0] if column != TIME and all(column in it for it in series)]
        curves = {column: band([(it[TIME], it[column]) for it in series]) for column in shared}
        known = {column: it for column, it in curves.items() if it is not None}
        if not known:
            return None
        times = {TIME: next(iter(known.values())).time}
        means = over_time("series", times | {column: it.mean for column, it in known.items()})
        halves = over_time("series", times | {column: it.half for column, it in known.items()})
        return means | {"half": halves["data"]}

    def _table(self, name: str = SWEEP) -> list[dict[str, str]]:
        """The lines of sweep.csv, or another table, as they are; none where there is none."""
        path = self.folder / f"{name}.csv"
        if not inside(self.folder, path):
            return []
        with open(path, newline="", encoding="utf-8", errors="replace") as file:
            return [{str(key): str(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def picture(self, name: str) -> bytes | None:
        """The last snapshot of a point as a small PNG; None where there is none, or another package paints it."""
        growing = self.run(name)
        if growing is None:
            return None
        run = growing.run()
        step = int(run.steps[-1]) if len(run) else -1
        if self._pictures.get(name, (None,))[0] != step:
            self._pictures[name] = step, growing.ask(_small) if len(run) and run.own else b""
        return self._pictures[name][1] or None


def _small(run: Run) -> bytes:
    """The last snapshot of a run, painted as `show` does and made small."""
    from porescale.common.pictures.look import survey
    from porescale.common.pictures.picture import Painter, png

    look = run.program.look(run)
    last = run.snapshot(-1, look.cells)
    canvas = Painter(survey([run.snapshot(0, look.cells), last], look)).canvas
    image = canvas.draw(last)
    scale = WIDE / max(image.shape[:2])
    size = [max(1, round(scale * side)) for side in image.shape[1::-1]]
    return png(cv2.resize(image, size, interpolation=cv2.INTER_AREA))


def _number(text: str) -> float | str | None:
    """A cell as a number where it is one; None where it is empty."""
    try:
        return float(text)
    except ValueError:
        return text or None
