"""One run as what runs it takes it, and as a process of the machine that it comes to."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from porescale.common.core.atomic import owned
from porescale.common.core.errors import INTERRUPTED, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.studies.schedulers.cores import pin

OWN_GROUP = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)
STOP: int = getattr(signal, "CTRL_BREAK_EVENT", signal.SIGTERM)
"""What asks a process to save its state and end; Windows sends such things to groups of processes alone.  Not SIGINT,
which shells have ignored in the background: a run that has not begun its steps would go on to its end."""
LOOK = 0.5
"""Seconds between looks at a run folder that another run holds."""


@dataclass(frozen=True)
class Task:
    """A run to be made.

    name : of its point;  module : of the package, for ``python -m``;  words : of its command line, without what goes on
    with a run;  folder : its run folder;  again : begin anew with a run that went unstable or failed;  threads : of its
    kernels;  place : where its command line is given, since paths in it may be relative.
    """

    name: str
    module: str
    words: tuple[str, ...]
    folder: Path
    again: bool = False
    threads: int = 1
    place: Path = field(default_factory=Path.cwd)

    def command(self) -> list[str]:
        """The words with what goes on with the run, if it was begun; InputError where its card cannot be read."""
        if not (self.place / self.folder / CARD).exists():
            return list(self.words)
        return [*self.words, "--overwrite" if self.anew() else "--resume"]

    def anew(self) -> bool:
        """Whether a run that was begun is begun anew; InputError where its card cannot be read."""
        folder = self.place / self.folder
        begun = self.again and (folder / CARD).exists()
        return begun and read_card(folder).get("outcome") in ("unstable", "failed")


class Done(NamedTuple):
    """A task that has ended: exit code of its process, what it said on stderr, and its wall-clock seconds from the
    start of the process, 0 where they are not known."""

    task: Task
    code: int
    said: str
    seconds: float = 0.0


class Process:
    """A task as a process of this machine.  cores : which it may use, all if there are none.

    A run that another process still makes, since its command was killed or lost, is waited for and then gone on with:
    no run is made twice at a time.
    """

    def __init__(self, task: Task, cores: Sequence[int] = ()) -> None:
        self.task, self.cores = task, cores
        self._stopped = threading.Event()
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None

    def run(self) -> tuple[int, str]:
        """Exit code, and what was said on stderr; 130 where it was stopped before it began.

        A run that another process began, unseen since it had no card yet, refuses this one: it is waited for, too.
        """
        while True:
            try:
                self._wait_for_others()
                words = self.task.command()
            except InputError as error:
                return error.code, str(error)
            code, said = self._once(words)
            if code != InputError.code or not self._held():
                return code, said

    def _once(self, words: Sequence[str]) -> tuple[int, str]:
        """`run` with this command line."""
        with self._lock:
            if self._stopped.is_set():
                return INTERRUPTED, "interrupted"
            # What one core is given to needs no pool of threads for all of them.
            few = {"NUMBA_NUM_THREADS": str(self.task.threads)} if self.cores else {}
            self._process = subprocess.Popen(
                [sys.executable, "-m", self.task.module, *words], cwd=self.task.place, env={**os.environ, **few},
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
                errors="replace", creationflags=OWN_GROUP,
            )  # fmt: skip
            pin(self._process.pid, self.cores)
        said, code = self._process.communicate()[1], self._process.returncode
        before_steps = self._stopped.is_set() and code == -signal.SIGTERM  # when nothing was to be saved
        return INTERRUPTED if before_steps else code, said

    def stop(self) -> None:
        """Let it save its state and end, or not begin; returns at once."""
        self._stopped.set()
        self._signal(lambda process: process.send_signal(STOP))

    def kill(self) -> None:
        """End it at once, its state as last saved."""
        self._stopped.set()
        self._signal(lambda process: process.kill())

    def _signal(self, send: Callable[[subprocess.Popen[str]], object]) -> None:
        with self._lock:
            if self._process is not None:
                send(self._process)

    def _wait_for_others(self) -> None:
        """Until no other process holds the run folder, or this one is stopped."""
        while self._held() and not self._stopped.wait(LOOK):
            pass

    def _held(self) -> bool:
        """Whether another process makes the run; not where its lock cannot be opened, as the run itself then says."""
        folder = self.task.place / self.task.folder
        try:
            if (folder / CARD).exists():
                with owned(folder) as mine:
                    return not mine
        except OSError:
            pass
        return False
