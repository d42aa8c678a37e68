"""What takes long before the first step, its name and the time that it is expected to take, for what shows progress."""

import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from porescale.common.duration.quiet import load_now


@dataclass(frozen=True)
class Doing:
    """name : in words;  began : when, by `time.perf_counter`;  until : when it is expected to have ended."""

    name: str
    began: float
    until: float

    def left(self) -> float | None:
        """Seconds left; None once it lasts longer than was expected."""
        left = self.until - clock.perf_counter()
        return left if left > 0.0 else None


NOW: list[Doing] = []
"""What is done now, the innermost last; empty where nothing is named."""


@contextmanager
def doing(name: str, seconds: float) -> Iterator[None]:
    """Within this, progress names what is done and how much is left of so many ``seconds`` of a quiet machine."""
    began = clock.perf_counter()
    now = Doing(name, began, began + seconds * load_now())
    NOW.append(now)
    try:
        yield
    finally:
        NOW.remove(now)
