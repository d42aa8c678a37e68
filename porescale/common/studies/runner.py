"""Points run one after another or side by side, each a process of its own with a run folder of its own.

A campaign that was stopped goes on where it was: finished points are left alone, begun ones resume from their
checkpoint.  A point that went unstable keeps that verdict until it is requested again.
"""

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.studies.parameter_table import Point

FINISHED, UNSTABLE, REFUSED = "finished", "unstable", "refused"
CODES = {0: FINISHED, 2: REFUSED, 3: UNSTABLE, 130: "interrupted"}
"""How a point's process ended, by exit code; anything else failed."""

OWN_GROUP = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)
STOP: int = getattr(signal, "CTRL_BREAK_EVENT", signal.SIGINT)
"""What asks a process to save its state and end; Windows sends such things to groups of processes alone."""
Run = Callable[[list[str]], tuple[int, str]]
"""Runs the words of a command line; gives exit code and what it said on stderr."""


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
    what lies below those of the points;  threads : of each run;  again : retry what went unstable or failed;  run :
    None for processes on this machine.
    """

    module: str
    scene: Path
    folder: Path
    settings: tuple[str, ...] = ()
    quality: str | None = None
    threads: int = 1
    again: bool = False
    run: Run | None = None
    _alive: set[subprocess.Popen[str]] = field(default_factory=set)
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _stopped: bool = False

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

    def one(self, point: Point) -> Ended:
        """Run a point, or go on with it."""
        folder, words = self.place(point), self.words(point)
        begun = (folder / CARD).exists()
        again = begun and read_card(folder).get("outcome") in (UNSTABLE, "failed")
        words += ["--overwrite"] if again else ["--resume"] if begun else []
        code, said = (self.run or self._process)(words)
        card = read_card(folder) if (folder / CARD).exists() else {}
        lines = [line for line in said.splitlines() if line.strip() and not line.startswith("warning:")]
        return Ended(point, folder, CODES.get(code, "failed"), card, "" if code == 0 or not lines else lines[-1])

    def all(self, points: Sequence[Point], jobs: int, say: Callable[[str], object]) -> Iterator[Ended]:
        """Every point, as it ends, ``jobs`` at a time; what was done earlier comes first.

        ``say`` gets how many are done and how long the rest will take.  Ctrl-C and SIGTERM are passed on to what
        runs, which then saves its state, and raise KeyboardInterrupt.
        """
        earlier = [self.before(point) for point in points]
        yield from (ended for ended in earlier if ended is not None)
        left = [point for point, ended in zip(points, earlier, strict=True) if ended is None]
        if len(left) < len(points):
            say(f"{len(points) - len(left)} of {len(points)} points are there already")
        start = time.perf_counter()
        with _terminable(), ThreadPoolExecutor(jobs) as pool:
            try:
                futures: list[Future[Ended]] = [pool.submit(self._unless_stopped, point) for point in left]
                for number, future in enumerate(as_completed(futures), 1):
                    ended = future.result()
                    rest = (time.perf_counter() - start) / number * (len(left) - number)
                    say(f"{ended.point.name}: {ended.outcome}, {ended.seconds:.3g} s "
                        f"({number} of {len(left)}, about {rest:.0f} s left)")  # fmt: skip
                    yield ended
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                self._stop()
                raise

    def _unless_stopped(self, point: Point) -> Ended:
        """Run the point with `one`, unless another point has raised."""
        if self._stopped:
            return Ended(point, self.place(point), CODES[130], {})
        try:
            return self.one(point)
        except BaseException:
            self._stopped = True
            raise

    def _process(self, words: list[str]) -> tuple[int, str]:
        with self._lock:
            if self._stopped:
                return 130, "interrupted"
            process = subprocess.Popen(
                [sys.executable, "-m", self.module, *words],
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
                errors="replace", creationflags=OWN_GROUP,
            )  # fmt: skip
            self._alive.add(process)
        try:
            said = process.communicate()[1]
        finally:
            with self._lock:
                self._alive.discard(process)
        return process.returncode, said

    def _stop(self) -> None:
        """Pass Ctrl-C on to the running processes."""
        with self._lock:
            self._stopped = True
            for process in self._alive:
                process.send_signal(STOP)


@contextmanager
def _terminable() -> Iterator[None]:
    """SIGTERM as KeyboardInterrupt, so that what runs is not left behind; in the main thread only."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
