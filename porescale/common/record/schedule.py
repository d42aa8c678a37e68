"""When to record: events at multiples of an interval, without touching the model's steps."""

import math
from collections.abc import Iterable

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import is_number
from porescale.common.record.model import Model, variable_step

NEVER = 1 << 62
SLACK = 1e-9
"""A step that ends this fraction of an interval before an event still counts as on time: summing a million
steps leaves a relative round-off near 1e-10."""

CHECK_EVERY = 100
"""Steps after which a model is checked at the latest for a state that is not finite or out of bounds."""
BLOCK_SECONDS = 0.2
"""Wall-clock length of a block: how long Ctrl-C and the progress bar may have to wait."""


class Schedule:
    """Events at 0, interval, 2 interval, ...

    With a fixed step an event k falls on step round(k interval / step), so that rounding does not
    accumulate; an interval below one step means every step.  With a varying step (``step_seconds`` None) an
    event falls on the first step at or after its time; ``done`` then counts the events passed and belongs
    into the checkpoint.
    """

    def __init__(self, interval: float, step_seconds: float | None) -> None:
        self.interval = interval
        self.ratio = None if step_seconds is None else max(1.0, interval / step_seconds)
        self.done = -1

    def due(self, step: int, time: float) -> bool:
        """Whether an event falls on this step.  With a varying step: call it once for each step."""
        if math.isinf(self.interval):
            return step == 0
        if self.ratio is None:
            passed = math.floor(time / self.interval + SLACK)
            due = passed > self.done
            self.done = max(passed, self.done)
            return due
        near = round(step / self.ratio)
        return any(round(k * self.ratio) == step for k in (near - 1, near, near + 1))

    def following(self, step: int) -> int:
        """The first step after ``step`` on which an event falls; fixed step only."""
        assert self.ratio is not None
        if math.isinf(self.ratio):
            return NEVER
        event = int(step / self.ratio)
        while round(event * self.ratio) <= step:
            event += 1
        return round(event * self.ratio)

    def state(self) -> dict[str, float]:
        """Interval and number of events done, for a checkpoint."""
        return {"interval": self.interval, "done": self.done}

    def restore(self, state: dict[str, float], time: float) -> None:
        """Go on after ``time``, s; a new interval counts from the run's start as the old one did."""
        if state["interval"] == self.interval:
            self.done = int(state["done"])
        elif math.isfinite(self.interval):
            self.done = math.floor(time / self.interval + SLACK)


def block(model: Model, last: int | None, schedules: Iterable[Schedule], rate: float) -> int:
    """Steps until something is due or checked, at most a block's worth at ``rate`` steps per wall-clock second.

    last : step at which the run ends, None where only its time decides.
    """
    if variable_step(model):
        return 1
    step = model.step
    events = [schedule.following(step) for schedule in schedules]
    due = min(*events, (step // CHECK_EVERY + 1) * CHECK_EVERY, NEVER if last is None else last)
    return max(1, min(due - step, int(rate * BLOCK_SECONDS)))


MOST, MOST_BYTES = 10_000_000, 2**44
"""Snapshots or rows of a run, and bytes of them, beyond which nothing could hold or read them."""
MANY, MANY_BYTES = 100_000, 2**35
"""Beyond these a slip is likely."""


def recorded(end: float, interval: float, steps: int) -> int:
    """Events until ``end`` (s), the first at 0: one for each ``interval`` (s), at most one for each step."""
    return min(math.floor(end / interval + SLACK), steps) + 1


def too_many(what: str, interval: float, count: int, size: float) -> str:
    """A warning of so many events of ``output.{what}_interval`` (s) and so many bytes, "" where they are few.

    InputError where they are beyond what can be written.
    """
    events = {"snapshot": "snapshots", "series": "rows of series.csv"}[what]
    problem = f"makes {count:.3g} {events}, about {size / 2**30:.3g} GiB"
    if count > MOST or size > MOST_BYTES:
        raise InputError(Fault(f"output.{what}_interval", interval, problem, "s", repair="lengthen it"))
    if count > MANY or size > MANY_BYTES:
        return f"output.{what}_interval = {interval:g} s {problem}; a longer one saves time and disk"
    return ""


def positive(key: str, value: float, *, endless: bool = False) -> float:
    """``value`` (s) if it is a positive number, finite unless ``endless``; else InputError."""
    if not is_number(value):
        raise InputError(Fault(key, str(value), "is no number of seconds", repair="give it in s, as 0.001"))
    number = float(value)
    if not number > 0 or (math.isinf(number) and not endless):
        raise InputError(Fault(key, value, "must be positive" + ("" if endless else " and finite"), unit="s"))
    return number
