"""Waiting for what the operating system does in its own time, but not for ever: the one place where tests wait.

A process that hangs says where, is killed, and the test fails.  A Python process that has faulthandler enabled prints
the stacks of its threads on SIGABRT, also from within compiled code and while it waits for a lock.
"""

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

PATIENCE = 600.0
"""Seconds after which a child counts as hanging.  None takes more than a minute or two, compiling included."""
LOOK = 2e-3
"""Seconds between looks."""
LAST_WORDS = 30.0
"""Seconds that a child has for printing its stacks, on a busy machine too."""
WORDS = 8000
"""Characters of what a child said that are shown."""


class Hung(AssertionError):
    """A child neither ended nor did what was waited for."""


def done(command: Sequence[object], patience: float = PATIENCE, **named: Any) -> subprocess.CompletedProcess[str]:
    """``subprocess.run`` of a Python program, what it says kept as text; Hung, with its stacks, after ``patience`` s.

    Whatever it has started itself is killed with it.
    """
    with running(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **named) as process:
        said, cried = talked(process, patience)
        return subprocess.CompletedProcess(process.args, process.returncode, said, cried)


@contextmanager
def running(command: Sequence[object], **named: Any) -> Iterator[subprocess.Popen[Any]]:
    """A process of its own group with faulthandler enabled; killed with all that it started when left.

    Nothing of it runs afterwards, of what started no group of its own.
    """
    env = {**named.pop("env", os.environ), "PYTHONFAULTHANDLER": "1"}
    process = subprocess.Popen([*map(str, command)], env=env, start_new_session=True, **named)
    try:
        yield process
    finally:
        if process.poll() is None or living(process.pid):
            kill(process)
        process.wait()
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()


def talked(process: subprocess.Popen[Any], patience: float = PATIENCE) -> tuple[Any, Any]:
    """``process.communicate()``; Hung after ``patience`` s, with the stacks of the process and of what it started."""
    try:
        return process.communicate(timeout=patience)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGABRT)  # it is not waited for yet, so that its group is there
    try:
        said = process.communicate(timeout=LAST_WORDS)
    except subprocess.TimeoutExpired:
        kill(process)
        said = process.communicate()
    kill(process)
    raise Hung(f"{process.args} hung for {patience:g} s: {_last(''.join(map(_text, said)))}")


def _last(said: str) -> str:
    """The last words of a child, without the list of compiled modules that faulthandler puts below the stacks."""
    return said.partition("\nExtension modules:")[0][-WORDS:]


def until(process: subprocess.Popen[Any], happens: Callable[[], object], patience: float = PATIENCE) -> bool:
    """Wait until something happens or ``process`` has ended; whether it happened.  Hung after ``patience`` s."""
    began = time.monotonic()
    while not happens():
        if process.poll() is not None:
            return bool(happens())
        if time.monotonic() - began > patience:
            talked(process, 0.0)
        time.sleep(LOOK)
    return True


def awaited(happens: Callable[[], Any], patience: float = PATIENCE) -> Any:
    """What ``happens()`` gives as soon as that is true; Hung after ``patience`` s."""
    began = time.monotonic()
    while not (found := happens()):
        if time.monotonic() - began > patience:
            raise Hung(f"waited for {patience:g} s in vain")
        time.sleep(LOOK)
    return found


def living(group: int) -> list[int]:
    """Processes of a group that still run: a zombie, which waits to be waited for, does not."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        with suppress(FileNotFoundError, ProcessLookupError):  # it ends while it is looked at
            state, _, its_group = status.read_text(errors="replace").rpartition(")")[2].split()[:3]
            if state not in "ZX" and int(its_group) == group:
                found.append(int(status.parent.name))
    return found


def kill(process: subprocess.Popen[Any]) -> None:
    """SIGKILL to a process of `running` and to what it started; returns when none of them runs any more.

    SIGKILL is on its way when the call that sends it returns: what it ends may still write, or be seen to run.
    """
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    awaited(lambda: not living(process.pid))


def ended(number: int, patience: float = PATIENCE, said: Path | None = None, look: float = LOOK) -> int:
    """Exit code of child ``number``, -n if signal n ended it; Hung after ``patience`` s.

    said : the file in which it has faulthandler enabled, and says what else it says
    """
    began = time.monotonic()
    while time.monotonic() - began < patience:
        found, status = os.waitpid(number, os.WNOHANG)
        if found:
            return os.waitstatus_to_exitcode(status)
        time.sleep(look)
    raise Hung(f"process {number} hung for {patience:g} s: {given_up(number, said)}")


def given_up(number: int, said: Path | None = None) -> str:
    """Last words of child ``number``, which is made to print its stacks to file ``said`` and is killed."""
    os.kill(number, signal.SIGABRT)
    began = time.monotonic()
    while time.monotonic() - began < LAST_WORDS and not os.waitpid(number, os.WNOHANG)[0]:
        time.sleep(LOOK)
    with suppress(ProcessLookupError, ChildProcessError):
        os.kill(number, signal.SIGKILL)
        os.waitpid(number, 0)
    return _last(said.read_text(errors="replace")) if said is not None and said.exists() else ""


def _text(said: Any) -> str:
    return said.decode("utf-8", "replace") if isinstance(said, bytes) else said or ""
