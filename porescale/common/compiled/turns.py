"""One process compiles a kernel; others that need it meanwhile wait, and take it from disk.

Each kernel that is not kept on disk is compiled under a lock on a file beside its place.  The system releases the lock
however the process ends, so that a killed one holds up nobody; a lock that cannot be had, or not soon, is done without,
and the kernel is compiled twice.  What is compiled, by whom and when changes no bit of it.
"""

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import Any

LONGEST = 30.0
"""Seconds that a kernel is waited for; once one took longer, none is waited for, and what two need is compiled twice.

A first Ctrl-C ends a run at the next whole block of steps, hence after the wait.  The wait does not look at it: without
the kernel the block cannot end, and to compile it from the start would rarely end it sooner.
"""
LOOK_EVERY = 0.05
SUFFIX = ".nbc.lock"
"""How the names of such files end: as kernels, they are removed when nothing has used them for long."""


@dataclass
class Turns:
    """The kernel that this process compiles.

    count : kernels compiled so far, this one included;  name : its name, "" for none;  seconds : that they took, waits
    included;  kept : where they are kept, those that are;  first : called before the first
    one, as `when_first` says;  writing : held while a file of a kernel is written.
    """

    count: int = 0
    name: str = ""
    seconds: float = 0.0
    kept: list[str] = field(default_factory=list)
    first: list[Callable[[], object]] = field(default_factory=list)
    patient: bool = True
    writing: Any = field(default_factory=Lock)
    clock: Callable[[], float] = time.monotonic
    sleep: Callable[[float], object] = time.sleep
    _lock: Any = None
    _began: float = 0.0

    def take(self, name: str, path: Path) -> bool:
        """Begin with a kernel that is kept at ``path`` without suffix; True where another process was waited for.

        A path that ends in no more than the name of the function is that of a kernel without a key: it is not kept, so
        that nothing is gained by waiting.
        """
        self.end()
        self.count, self.name, self._began = self.count + 1, name, self.clock()
        while self.first:
            self.first.pop()()
        if path.name == name:
            return False
        self.kept.append(path.name)
        from filelock import FileLock, Timeout

        lock = FileLock(path.with_name(path.name + SUFFIX))
        began, waited = self.clock(), False
        while self.patient:
            try:
                lock.acquire(blocking=False)
            except Timeout:
                waited = True
                self.sleep(LOOK_EVERY)
                self.patient = self.clock() - began < LONGEST
            except (OSError, RuntimeError):  # no room, no right to write, or a disk without locks
                return waited
            else:
                self._lock = lock
                return waited
        return waited

    def end(self) -> None:
        """The kernel is made, or was not to be made."""
        if self.name:
            self.name, self.seconds = "", self.seconds + self.clock() - self._began
        lock, self._lock = self._lock, None
        if lock is not None:  # the file first: once released it may be another's
            with suppress(OSError):  # Windows removes no open file; the release does it there
                Path(lock.lock_file).unlink(missing_ok=True)
            with suppress(OSError):
                lock.release()


TURNS = Turns()
"""Those of this process."""


def when_first(begin: Callable[[], object]) -> None:
    """Call ``begin`` when a kernel is found not to be on disk, once; never where all are."""
    TURNS.first.append(begin)
