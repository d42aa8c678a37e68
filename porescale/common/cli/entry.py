"""From the first line of a program to its end: Ctrl-C ends it with one line and exit code 130, wherever it comes.

The modules of a command take a second to import, and a scene some to be built.  Three things were seen to happen to a
KeyboardInterrupt in that time: nothing caught it yet; it was raised in a callback of the import system, which Python
prints and forgets; it left an ``exec`` of source text, as of `dataclasses`, after which Python 3.11 ends the process by
the signal although it was caught.  What comes while Python itself starts and imports the package is Python's to end.
"""

import _thread
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import FrameType
from typing import Any

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it: 128 + SIGINT."""
AGAIN = 0.01
"""Seconds after which a Ctrl-C that a callback has lost is raised once more."""


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
    """Within this SIGINT raises `CtrlC`, again where a callback loses it; yields the list of those that came.

    Nothing is changed outside the main thread, or where SIGINT is ignored or handled by others.
    """
    came = list[int]()
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield came
        return

    def interrupt(number: int, frame: FrameType | None) -> None:
        """Raise what ends the command."""
        came.append(number)
        raise CtrlC

    def unraisable(lost: Any) -> None:
        """Raise a lost Ctrl-C again, not within this function; print all else as before."""
        if isinstance(lost.exc_value, CtrlC):
            later = threading.Timer(AGAIN, _thread.interrupt_main)
            later.daemon = True
            later.start()
        else:
            printed(lost)

    signal.signal(signal.SIGINT, interrupt)
    printed, sys.unraisablehook = sys.unraisablehook, unraisable
    try:
        yield came
    finally:
        sys.unraisablehook = printed
        signal.signal(signal.SIGINT, signal.default_int_handler)
