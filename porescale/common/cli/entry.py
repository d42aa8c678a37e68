"""From the first line of a program to its end: Ctrl-C ends it with one line and exit code 130, wherever it comes.

The modules of a command take a second to import, and a scene some to be built.  In that time a KeyboardInterrupt was
seen to come before anything catches it; to be raised in a callback of the import system, which Python prints and
forgets; to be cleared by a library, so that the run went on to its end; and to leave an ``exec`` of source text, as of
`dataclasses`, after which Python 3.11 ends the process by the signal although it was caught.  What comes while Python
itself starts and imports the package is Python's to end.
"""

import _thread
import signal
import sys
import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import FrameType
from typing import Any

from porescale.common.core.errors import INTERRUPTED

AGAIN = 0.25
"""Seconds after which a Ctrl-C that was lost is raised once more; a command that has caught it ends sooner."""


class CtrlC(KeyboardInterrupt):
    """Ctrl-C.  Python ends a process by the signal where an exact KeyboardInterrupt has left an ``exec``."""


def command(module: str) -> int:
    """Run ``main()`` of a module, imported by its name, and give its exit code; 130 and one line after Ctrl-C.

    An exception that comes after Ctrl-C is taken for its consequence: libraries turn it into others while they are
    imported.
    """
    with ctrl_c() as came:
        try:
            code: int = import_module(module).main()
        except SystemExit:
            raise
        except BaseException:
            if not came:
                raise
            print("interrupted", file=sys.stderr)
            return INTERRUPTED
        return code


@contextmanager
def ctrl_c() -> Iterator[list[int]]:
    """Within this SIGINT raises `CtrlC`, again where it is lost; yields the list of those that came.

    Nothing is changed outside the main thread, or where SIGINT is ignored or handled by others.
    """
    came = list[int]()
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield came
        return

    ended = threading.Event()

    def interrupt(number: int, frame: FrameType | None) -> None:
        """Raise what ends the command, and see that it does."""
        came.append(number)
        stop = CtrlC()
        threading.Thread(target=again, args=(weakref.ref(stop),), daemon=True).start()
        try:
            raise stop
        finally:
            del stop  # else its traceback keeps it

    def again(raised: weakref.ref[CtrlC]) -> None:
        """Raise it once more where it is gone, lost in a callback or cleared by a library, and nothing has ended."""
        while not ended.wait(AGAIN):
            if raised() is None:
                _thread.interrupt_main()
                return

    def unraisable(lost: Any) -> None:
        """Print what a callback has lost, but for a Ctrl-C."""
        if not isinstance(lost.exc_value, CtrlC):
            printed(lost)

    signal.signal(signal.SIGINT, interrupt)
    printed, sys.unraisablehook = sys.unraisablehook, unraisable
    try:
        yield came
    finally:
        ended.set()
        sys.unraisablehook = printed
        signal.signal(signal.SIGINT, signal.default_int_handler)
