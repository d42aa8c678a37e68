"""A part of a simulation: one thing of a scene, with all that it adds to a run.

A simulation is a list of parts.  What a scene does not request is no part of its list: it is not built, and costs
neither memory nor time.  In every step: ``before`` of all parts, the physics, the clock, ``after`` of all.  The order
of the list is the order of the columns of series.csv and of the order in which parts act; states are restored from the
last part to the first, so that a part may rely on what those after it have restored.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import inf
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.record.model import Snapshot

MISFITS = (KeyError, ValueError, TypeError, IndexError, AttributeError, OverflowError, AssertionError)
"""What a model may raise that is given another one's state."""


class Part:
    """What a part can do; what it does not override does nothing and costs nothing in the loop over steps.

    Reading methods (row, tables, show, state) leave the state of the simulation as it is.
    key : name of its entry in the state of the simulation; "" for entries that stand beside those of other parts.
    """

    key = ""

    def before(self) -> None:
        """Act just before a step; the clock stands at its begin."""

    def after(self) -> None:
        """Act just after a step; the clock stands at its end."""

    @property
    def acts_from(self) -> float:
        """A step, counted from the start, before which `before` and `after` have nothing to do; inf: they never have
        again."""
        return 0.0 if acts_between(self) else inf

    def check(self) -> None:
        """Raise Unstable, naming cell or grain, quantity and step, where the state is not finite or out of bounds."""

    def row(self) -> dict[str, float]:
        """Columns of series.csv, with units in their names; the same every time."""
        return {}

    def tables(self) -> dict[str, dict[str, float]]:
        """Rows of further tables by file name without suffix."""
        return {}

    def show(self, snapshot: Snapshot) -> None:
        """Add grids and clouds to a ``snapshot``."""

    def state(self) -> dict[str, Any]:
        """All it takes to go on bit for bit, as of `porescale.common.record.model.Model`."""
        return {}

    def restore(self, state: dict[str, Any]) -> None:
        """Take over what `state` of a part of the same scene gave."""


def overrides(part: Part, name: str) -> bool:
    """Whether a part has a method of its own instead of the empty one."""
    return getattr(type(part), name) is not getattr(Part, name)


def acts_between(part: Part) -> bool:
    """Whether a part has anything to do between steps."""
    return overrides(part, "before") or overrides(part, "after")


def state_of(parts: Iterable[Part]) -> dict[str, Any]:
    """The state of a simulation of ``parts``: each under its key, or beside the others."""
    whole: dict[str, Any] = {}
    for part in parts:
        own = part.state()
        whole |= {part.key: own} if part.key else own
    return whole


def restore(parts: list[Part], state: dict[str, Any]) -> None:
    """Give every one of ``parts`` its share of a ``state`` of `state_of`, the last part first."""
    for part in reversed(parts):
        part.restore(state[part.key] if part.key else state)


@contextmanager
def restoring() -> Iterator[None]:
    """InputError, caused by what it was, where a simulation within takes up a state and that is another one's."""
    try:
        yield
    except MISFITS as error:
        reason = f"holds no {error}" if isinstance(error, KeyError) else " ".join(str(error).split())
        raise InputError(
            Fault("state", None, f"is not that of a simulation of this scene ({reason})",
                  repair="give what state() of one returned, and build this one anew: it may be overwritten in part")
        ) from error  # fmt: skip


def row_of(parts: Iterable[Part]) -> dict[str, float]:
    """The columns of all ``parts``."""
    return {name: value for part in parts for name, value in part.row().items()}


def tables_of(parts: Iterable[Part]) -> dict[str, dict[str, float]]:
    """The tables of all ``parts``; columns of parts that share a table stand side by side."""
    found: dict[str, dict[str, float]] = {}
    for part in parts:
        for name, row in part.tables().items():
            found.setdefault(name, {}).update(row)
    return found
