"""A disk whose n-th call fails: no space, an I/O error, no permission; or kills the process that calls."""

import builtins
import io
import os
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest.mock import patch

import h5py

from porescale import open_run
from porescale.common.record import schedule
from porescale.common.record.checkpoint import read_checkpoint

CALLS = ("replace", "open", "fsync", "mkdir", "unlink", "rmdir", "write", "ftruncate")
"""Functions of os that touch the disk; besides these, opening a file by Python and by HDF5."""


@dataclass
class Disk:
    """Counts the calls that concern ``folder``; the ``nth`` (from 0, -1: none) raises OSError ``errno``.

    sticky : all later ones fail, too, as on a disk that is full or gone;  kill : SIGKILL instead, "before" the call or
    "after" it;  called : what each call was.
    """

    folder: Path
    nth: int = -1
    errno: int = 28
    sticky: bool = False
    kill: str = ""
    called: list[str] = field(default_factory=list)

    def wrap(self, name: str, real: Callable[..., Any]) -> Callable[..., Any]:
        """``real``, counted."""

        def call(*args: Any, **named: Any) -> Any:
            if self._concerns(args):
                self.called.append(name)
                number = len(self.called) - 1
                if 0 <= self.nth <= number if self.sticky else number == self.nth:
                    if self.kill == "after":
                        with suppress(OSError):
                            real(*args, **named)
                    if self.kill:
                        os.kill(os.getpid(), signal.SIGKILL)
                    where = str(args[0]) if isinstance(args[0], str | Path) else None
                    raise OSError(self.errno, os.strerror(self.errno), where)
            return real(*args, **named)

        return call

    def _concerns(self, args: tuple[Any, ...]) -> bool:
        """Whether a call names a file in the folder, or a descriptor, which may be of one."""
        first = args[0] if args else None
        return isinstance(first, int) or (isinstance(first, str | Path) and str(first).startswith(str(self.folder)))


@contextmanager
def failing(disk: Disk) -> Iterator[Disk]:
    """Within it every call goes through ``disk``.

    No clock cuts the blocks of steps, after each of which a run may save: its calls are the same in every run.
    """
    made = h5py.File.__init__

    def h5_file(self: Any, name: Any, *args: Any, **named: Any) -> None:
        disk.wrap("h5py.File", lambda *_: None)(name)
        made(self, name, *args, **named)

    patches = [patch.object(os, name, disk.wrap(name, getattr(os, name))) for name in CALLS]
    opened = disk.wrap("file", io.open)
    patches += [patch.object(io, "open", opened), patch.object(builtins, "open", opened)]
    patches.append(patch.object(h5py.File, "__init__", h5_file))
    patches.append(patch.object(schedule, "BLOCK_SECONDS", 1e9))
    for each in patches:
        each.start()
    try:
        yield disk
    finally:
        for each in reversed(patches):
            each.stop()


def calls(folder: Path, run: Callable[[Path], object]) -> int:
    """How many calls to the disk ``run`` makes in ``folder``, which is gone afterwards."""
    with failing(Disk(folder)) as disk:
        run(folder)
    shutil.rmtree(folder)
    return len(disk.called)


def whole(folder: Path) -> None:
    """Every file that is there can be read."""
    if (folder / "card.json").exists():
        run = open_run(folder)
        for k in range(len(run)):
            run.snapshot(k)
        assert len(set(map(len, run.series.values()))) <= 1
    if (folder / "checkpoint.h5").exists():
        read_checkpoint(folder / "checkpoint.h5")
