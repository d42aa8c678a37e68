"""A second process that compiles kernels while the run begins.

The first process compiles kernels in the order in which it comes to them.  Where one is not on disk, and there are two
cores, a second process is started with the same scene; it comes to later kernels sooner, since it leaves out what takes
time but no kernels of its own.  Both keep what they compile on disk, and neither begins with what the other has begun
(turns.py).  Which of them compiled a kernel changes no bit.

The second process is asked to end by the end of its input, which also comes when the first one is killed.  It then ends
at once, but not in the middle of a file.
"""

import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from porescale.common.compiled.turns import TURNS, when_first
from porescale.common.core.machine import cores

PATIENCE = 10.0
"""Seconds in which the second process must have ended."""
INSTALLED = ("site-packages", "dist-packages")
"""Names of folders of installed packages."""


_Second = tuple[subprocess.Popen[bytes], threading.Thread]
"""The process, and the thread that writes its input."""


@contextmanager
def ahead(module: str, given: Callable[[], Any]) -> Iterator[None]:
    """Within this, ``python -m module`` compiles what is not on disk, if anything is not.

    given : what the process reads from its input, as JSON, or None where it is not wanted; called only then.
    """
    started = list[_Second]()
    if sys.executable and cores() > 1:
        when_first(lambda: started.extend(_start(module, given())))
    try:
        yield
    finally:
        TURNS.first.clear()
        for second in started:
            _end(*second)


def _paths() -> str:
    """PYTHONPATH of the process: this package's place first, unless it is installed and found anyway."""
    root = Path(__file__).resolve().parents[3]
    own = "" if root.name in INSTALLED else str(root)  # before the standard library it would hide modules of that
    return os.pathsep.join(filter(None, [own, os.environ.get("PYTHONPATH")]))


def _start(module: str, given: Any) -> list[_Second]:
    """The process; none where it is not wanted, or the system lets none be started.

    ``-P`` keeps files of the working folder from being taken for modules.  A pipe holds 64 KiB, and the process may
    never read: its input is written by a thread.
    """
    if given is None:
        return []
    text = json.dumps(given).encode() + b"\n"
    quiet: Any = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", module], stdin=subprocess.PIPE, env={**os.environ, "PYTHONPATH": _paths()},
            start_new_session=True, **quiet,
        )  # fmt: skip
    except OSError:
        return []
    pipe: Any = process.stdin

    def write() -> None:
        """Give the process its input."""
        with suppress(OSError, ValueError):  # it has ended
            pipe.write(text)
            pipe.flush()

    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    return [(process, writer)]


def _end(process: subprocess.Popen[bytes], writer: threading.Thread) -> None:
    """Ask the process to end, and see that it does; one that has not read its input has begun nothing."""
    if writer.is_alive():
        process.kill()
    with suppress(OSError):
        process.stdin.close()  # type: ignore[union-attr]
    try:
        process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def serve(work: Callable[[Any], object]) -> None:
    """What the second process does: ``work`` on what it is given, until that is done or its input ends."""
    given = json.loads(sys.stdin.buffer.readline())

    def leave() -> None:
        """Wait for the end of the input."""
        sys.stdin.buffer.read()
        with TURNS.writing:
            try:
                TURNS.end()
            finally:
                os._exit(0)

    threading.Thread(target=leave, daemon=True).start()
    try:
        with suppress(Exception):  # the run comes to it, too, and says it
            work(given)
        TURNS.end()
    finally:
        os._exit(0)  # the thread still reads
