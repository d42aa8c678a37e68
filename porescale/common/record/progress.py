"""Progress of a run: a bar with time left on a terminal, a line in notebooks, a line every ten seconds elsewhere."""

import threading
import time as clock
from types import TracebackType

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    SpinnerColumn,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text

from porescale.common.compiled.turns import TURNS
from porescale.common.duration.doing import NOW
from porescale.common.duration.quiet import Moment, moment, share
from porescale.common.record.cost import UNCOUNTED

PATIENCE = 2.0
"""Seconds after which a person wonders what happens."""
LINE_EVERY = 10.0
LOOK_EVERY = 1.0
"""Seconds after which it is asked anew what share of a core the run gets."""
STARTING = "starting"
HALT, IDLE = 2.0, 0.01
"""Seconds by which a wait must last too long to count as time in which the process was stopped (SIGSTOP, Ctrl-Z), and
the share of them in which it must have had no more than the processor: a busy machine gives more."""


class Watch:
    """Context that shows the progress of a run from ``start`` to ``end`` (s of simulated time).

    quiet : nothing at all.  On a terminal a bar appears after two seconds, in a notebook one line that is written over;
    otherwise plain lines on stderr, the first after ten seconds.  A kernel that is being compiled is named.
    end : 0 where nothing runs, as of ``check``.
    finish : seconds that joining, pictures and film are expected to take after the last step on a quiet machine.
    """

    def __init__(self, title: str, start: float, end: float, *, quiet: bool = False, finish: float = 0.0) -> None:
        self.title, self.start, self.end, self.quiet, self.finish = title, start, end, quiet, finish
        self.console = Console(stderr=True)
        self.bar: Progress | None = None
        self.phase = STARTING
        self.time, self.step, self.updates = start, 0, 0
        self.began = clock.perf_counter()
        self.running: tuple[Moment, Moment] | None = None
        self.finishing_since: float | None = None
        self.stopped = 0.0
        self.last_line = self.began
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def __enter__(self) -> "Watch":
        self.began = self.last_line = clock.perf_counter()
        if not self.quiet:
            self._thread = threading.Thread(target=self._attend, daemon=True)
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        if self._thread is not None:
            self._thread.join()

    def update(self, step: int, time: float) -> None:
        """The run has come to ``step`` at ``time``, s."""
        self.step, self.time, self.updates = step, time, self.updates + 1
        if self.updates in (1, UNCOUNTED):  # until then kernels are compiled, or read from disk
            self.running = moment(), moment()
            self.start, self.stopped = time, 0.0
            self.phase = "running"
        elif self.running is not None and clock.perf_counter() > self.running[1].wall + LOOK_EVERY:
            self.running = self.running[0], moment()

    def enter(self, phase: str) -> None:
        """Name what happens after the steps, e.g. "writing pictures and film"."""
        self.phase = phase
        if self.finishing_since is None:
            self.finishing_since = clock.perf_counter()

    def doing(self) -> str:
        """What happens now, in words."""
        phase = NOW[-1].name if NOW else self.phase
        return f"{phase}, compiling kernel {TURNS.count}, {TURNS.name}" if TURNS.name else phase

    def say(self, text: str) -> None:
        """Print one line of text, unless quiet."""
        if not self.quiet:
            self.console.print(Text(text), highlight=False, soft_wrap=True)

    def left(self) -> float | None:
        """Seconds left, all that follows the steps included; None while unknown, and once that lasts too long.

        Before the first step, those left of what is done then (`doing`).

        Steps are expected to go on at their mean speed, rows, snapshots and checkpoints included, and what follows at
        the share of a core that they got.  The first blocks do not count, nor compiling, nor time in which the process
        was stopped.
        """
        if self.running is None:
            return NOW[-1].left() if NOW else None
        since, now = self.running
        finish = self.finish / share(since, now)
        if self.finishing_since is not None:
            left = finish - (clock.perf_counter() - self.finishing_since)
            return left if left > 0.0 else None
        if self.time <= self.start:
            return None
        spent = clock.perf_counter() - since.wall - self.stopped - (TURNS.seconds - since.compiling)
        return spent * (self.end - self.time) / (self.time - self.start) + finish

    def line(self) -> str:
        """Progress of the run as one line of text; before there is one, since when something is done."""
        if self.end == 0.0:
            left, since = self.left(), duration(clock.perf_counter() - self.began)
            return f"{self.title}: {self.doing()}, {since} so far" + (f", {duration(left)} left" if left else "")
        share = min(100.0, 100 * self.time / self.end) if self.end else 100.0  # the last step may go beyond the end
        text = f"{self.title}: {self.doing()}, t = {self.time:.4g} of {self.end:.4g} s ({share:.0f} %)"
        text += f", step {self.step}"
        left = self.left()
        return text if left is None else f"{text}, {duration(left)} left"

    def _wait(self, seconds: float) -> bool:
        """Wait so long, or until the end, and see whether the process was stopped meanwhile; whether it is the end."""
        until = clock.perf_counter() + seconds
        while True:
            began, busy = clock.perf_counter(), clock.process_time()
            wait = min(max(until - began, 0.0), 0.5)
            if self._stop.wait(wait):
                return True
            now = clock.perf_counter()
            over = now - began - wait
            if over > HALT and clock.process_time() - busy < IDLE * over:
                self.stopped += over
            if now >= until:
                return False

    def _attend(self) -> None:
        """Runs beside the model: wakes the bar after a while, then keeps it or the lines going."""
        if self._wait(PATIENCE):
            return
        if self.console.is_jupyter:
            self._write_over()
            return
        if self.console.is_terminal:
            self._show_bar()
            return
        while not self._wait(LINE_EVERY if self.last_line > self.began else LINE_EVERY - PATIENCE):
            self.last_line = clock.perf_counter()
            self.say(self.line())

    def _write_over(self) -> None:
        """One line of a notebook's output, written over until the end; then it says how far the run came."""
        longest, ended = 0, False
        while not ended:
            ended = self._wait(0.5)
            text = self.line()
            longest = max(longest, len(text))
            print(f"\r{text:<{longest}}", end="\n" if ended else "", flush=True)

    def _show_bar(self) -> None:
        columns = (
            SpinnerColumn(),
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[where]}"),
            TimeElapsedColumn(),
            TextColumn("{task.fields[left]}"),
        )
        with Progress(*columns, console=self.console, transient=True) as bar:
            task = bar.add_task(self.title, start=False, total=None, where="", left="")
            started = False
            while not self._wait(0.2):
                if self.running is not None and not started:
                    bar.start_task(task)
                    started = True
                left = self.left()
                bar.update(
                    task,
                    left="" if left is None else f"{duration(left)} left",
                    description=f"{self.title}: {self.doing()}",
                    total=self.end if started else None,
                    completed=self.time,
                    where=f"t = {self.time:.4g} s" if self.end else "",
                )


def duration(seconds: float) -> str:
    """Seconds in words: "8 s", "3 min 20 s", "2 h 05 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"
