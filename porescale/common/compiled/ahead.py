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

PATIENCE = 10.0
"""Seconds in which the second process must have ended."""


@contextmanager
def ahead(module: str, given: Callable[[], Any]) -> Iterator[None]:
    """Within this, ``python -m module`` compiles what is not on disk, if anything is not.

    given : what the process reads from its input, as JSON, or None where it is not wanted; called only then.
    """
    started = list[subprocess.Popen[bytes]]()
    if sys.executable and cores() > 1:
        when_first(lambda: started.extend(_start(module, given())))
    try:
        yield
    finally:
        TURNS.first.clear()
        for process in started:
            _end(process)


def cores() -> int:
    """Cores that this process may use."""
    allowed = getattr(os, "sched_getaffinity", None)
    return len(allowed(0)) if allowed else os.cpu_count() or 1


def _start(module: str, given: Any) -> list[subprocess.Popen[bytes]]:
    """The process; none where it is not wanted, or the system lets none be started."""
    if given is None:
        return []
    root = str(Path(__file__).resolve().parents[3])
    paths = os.pathsep.join(filter(None, [root, os.environ.get("PYTHONPATH")]))
    quiet: Any = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    try:
        process = subprocess.Popen(
            [sys.executable, "-m", module], stdin=subprocess.PIPE, env={**os.environ, "PYTHONPATH": paths},
            start_new_session=True, **quiet,
        )  # fmt: skip
        assert process.stdin
        process.stdin.write(json.dumps(given).encode() + b"\n")
        process.stdin.flush()
    except OSError:
        return []
    return [process]


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ask the process to end, and see that it does."""
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
            os._exit(0)

    threading.Thread(target=leave, daemon=True).start()
    try:
        work(given)
    finally:
        os._exit(0)  # the thread still reads
