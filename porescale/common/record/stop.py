"""Ctrl-C and a polite kill end a run at the next whole block, with its state saved."""

import signal
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import FrameType
from typing import Any

from porescale.common.core.errors import PorescaleError

POLITE = ("SIGINT", "SIGTERM", "SIGBREAK")
"""Names of the signals that request a stop, of which a system has two; SIGBREAK is Windows' for processes."""


class Interrupted(PorescaleError):
    """A stop of the run was requested; its state is saved.  Exit code 130."""

    code = 130


class StopRequest:
    """Truthy once a stop of the run was requested."""

    def __init__(self) -> None:
        self.requested = False

    def __bool__(self) -> bool:
        return self.requested


def polite_signals() -> list[signal.Signals]:
    """The signals of this system that request a stop."""
    return [number for number in signal.Signals if number.name in POLITE]


@contextmanager
def polite_stop() -> Iterator[StopRequest]:
    """Turn the first SIGINT, SIGTERM or (Windows) SIGBREAK into a request; a second one acts as it did before.

    Outside the main thread, where signals cannot be caught, the request never comes.
    """
    request = StopRequest()
    if threading.current_thread() is not threading.main_thread():
        yield request
        return
    before = {number: signal.getsignal(number) for number in polite_signals()}

    def ask(number: int, frame: FrameType | None) -> None:
        """Note the first signal; a second one ends the process as it would have without this."""
        request.requested = True
        _restore(before)

    for number in before:
        signal.signal(number, ask)
    try:
        yield request
    finally:
        _restore(before)


@contextmanager
def interrupted_by(*numbers: signal.Signals) -> Iterator[None]:
    """Within this the signals raise KeyboardInterrupt, also in the background, where shells have SIGINT ignored.

    Nothing is changed outside the main thread.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, signal.default_int_handler) for number in numbers}
    try:
        yield
    finally:
        _restore(before)


def _restore(before: Mapping[signal.Signals, Any]) -> None:
    """Let signals mean again what they did before."""
    for number, handler in before.items():
        signal.signal(number, handler if handler is not None else signal.SIG_DFL)
