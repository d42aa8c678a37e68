"""Points run one after another or side by side, each a process of its own with a run folder of its own.

A campaign that was stopped goes on where it was: finished points are left alone, begun ones resume from their
checkpoint.  A point that went unstable keeps that verdict until it is requested again.
"""

import signal
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from porescale.common.core.atomic import owned
from porescale.common.core.errors import INTERRUPTED, Fault, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.record.stop import interrupted_by
from porescale.common.studies.parameter_table import Point
from porescale.common.studies.schedulers import progress
from porescale.common.studies.schedulers.law import Scheduler
from porescale.common.studies.schedulers.local import Local
from porescale.common.studies.schedulers.task import Done, Task

FINISHED, UNSTABLE, REFUSED = "finished", "unstable", "refused"
CODES = {0: FINISHED, 2: REFUSED, 3: UNSTABLE, INTERRUPTED: "interrupted"}
"""How a point's process ended, by exit code; anything else failed."""


@dataclass(frozen=True)
class Ended:
    """How a point ended.  card : its run card, {} where there is none;  problem : what it said, in one line."""

    point: Point
    folder: Path
    outcome: str
    card: dict[str, Any]
    problem: str = ""

    @property
    def seconds(self) -> float:
        """Wall-clock seconds of the run."""
        return float(self.card.get("seconds") or 0.0)


@dataclass
class Campaign:
    """What all points share.

    module : of the package, for ``python -m``;  scene : file;  folder : where run folders go;  settings, quality :
    what lies below those of the points;  threads : of each run;  again : retry what went unstable, and begin anew with
    what failed;  scheduler : what runs them.
    """

    module: str
    scene: Path
    folder: Path
    settings: tuple[str, ...] = ()
    quality: str | None = None
    threads: int = 1
    again: bool = False
    scheduler: Scheduler = field(default_factory=Local)

    def words(self, point: Point) -> list[str]:
        """The command line of a point, without `--resume`."""
        made = ["run", str(self.scene), "--out", str(self.place(point)), "--quiet", "--threads", str(self.threads)]
        level = point.quality or self.quality
        made += ["--quality", level] if level else []
        for setting in (*self.settings, *point.settings):
            made += ["--set", setting]
        return made

    def place(self, point: Point) -> Path:
        """The run folder of a point."""
        return self.folder / point.name

    def before(self, point: Point) -> Ended | None:
        """How a point ended earlier, None where it must still run; InputError where another run lies in its folder."""
        folder = self.place(point)
        if not (folder / CARD).exists():
            return None
        card = read_card(folder)
        if list(card.get("settings") or ()) != [*self.settings, *point.settings]:
            repair = "name another --out, or remove that folder"
            raise InputError(Fault("run folder", str(folder), "holds a run with other settings", repair=repair))
        outcome = str(card.get("outcome"))
        if outcome == FINISHED or (outcome == UNSTABLE and not self.again):
            return Ended(point, folder, outcome, card, str(card.get("problem") or ""))
        return None

    def task(self, point: Point) -> Task:
        """What runs a point, or goes on with it."""
        words = tuple(self.words(point))
        return Task(point.name, self.module, words, self.place(point), self.again, self.threads)

    def ended(self, point: Point, done: Done) -> Ended:
        """How a point ended whose process did."""
        folder = self.place(point)
        card = read_card(folder) if (folder / CARD).exists() else {}
        lines = [line for line in done.said.splitlines() if line.strip() and not line.startswith("warning:")]
        silent = (
            f"its process was ended by signal {-done.code}" if done.code < 0 else f"exit code {done.code}, no message"
        )
        problem = "" if done.code == 0 else (lines or [silent])[-1]
        return Ended(point, folder, CODES.get(done.code, "failed"), card, problem)

    def all(self, points: Sequence[Point], jobs: int | None, say: Callable[[str], object]) -> Iterator[Ended]:
        """Every point, as it ends, ``jobs`` at a time (None: as the scheduler sees fit); what was done earlier comes
        first.

        ``say`` gets how many are done and how long the rest will take.  Ctrl-C and SIGTERM are passed on to what
        runs here, which then saves its state, and raise KeyboardInterrupt.  InputError where another command runs
        points in this folder.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        with owned(self.folder) as held:
            if not held:
                problem, repair = "another command runs its points", "wait for it, or name another --out"
                raise InputError(Fault("folder", str(self.folder), problem, repair=repair))
            yield from self._all(points, jobs, say)

    def _all(self, points: Sequence[Point], jobs: int | None, say: Callable[[str], object]) -> Iterator[Ended]:
        earlier = [self.before(point) for point in points]
        yield from (ended for ended in earlier if ended is not None)
        left = {point.name: point for point, ended in zip(points, earlier, strict=True) if ended is None}
        if len(left) < len(points):
            say(f"{len(points) - len(left)} of {len(points)} points are there already")
        if not left:
            return
        rest = progress.of({name: self.place(point) for name, point in left.items()}, say)
        with interrupted_by(signal.SIGTERM):  # so that what runs is not left behind
            done = self.scheduler.run([self.task(point) for point in left.values()], jobs, rest)
            for number, each in enumerate(done, 1):
                ended = self.ended(left[each.task.name], each)
                rest.ended(ended.point.name, each.seconds or ended.seconds)
                say(f"{ended.point.name}: {ended.outcome}, {ended.seconds:.3g} s "
                    f"({number} of {len(left)}, {rest.words()})")  # fmt: skip
                yield ended
