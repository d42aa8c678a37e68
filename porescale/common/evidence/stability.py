"""Stability maps: flows tried over ranges of two numbers, once for each law, and their verdicts.

Packages register their flows; `study stability` runs them and writes the map (stability_files.py).  A flow that stayed
within bounds is stable; it is also right if its error is known and at most the tolerance of the flow.
"""

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from porescale.common.evidence.files import finite
from porescale.common.evidence.register import Register

RIGHT, STABLE, UNSTABLE = "right", "stable", "unstable"
"""Verdicts on a run: accurate, only stable, or unstable."""


@dataclass(frozen=True)
class Axis:
    """A number that is varied.  name : with its unit, if any;  values : in the order of the picture, from mild to
    extreme;  quick : those of the short version.
    """

    name: str
    values: tuple[float, ...]
    quick: tuple[float, ...]

    def chosen(self, quick: bool) -> tuple[float, ...]:
        """The values of the long or the short version."""
        return self.quick if quick else self.values


@dataclass(frozen=True)
class Tried:
    """The result of one run of a flow.

    stable : never out of bounds;  error : distance from the reference, >= 0, as the flow defines it, None if it is not
    known;  numbers : further ones worth keeping, by name.
    """

    stable: bool
    error: float | None = None
    numbers: Mapping[str, float] | None = None


@dataclass(frozen=True)
class Row:
    """One try; the fields are the JSON keys.  ran : False where the verdict follows from a neighbour's."""

    flow: str
    law: str
    x: float
    y: float
    verdict: str
    error: float | None
    numbers: Mapping[str, float]
    ran: bool
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; numbers that are not finite become null."""
        made: dict[str, Any] = finite(asdict(self) | {"seconds": round(self.seconds, 3)})
        return made


Measure = Callable[[str, float, float], Tried]


@dataclass(frozen=True)
class Flow:
    """A registered flow.

    title : one line;  x, y : what is varied;  laws : names, given whether it is the short version;  right :
    largest error that counts as right;  because : what the error is and why that much;  judged : largest x at which an
    error is known;  monotone : once unstable at an x, so beyond it: the limit is found by halving;  limit : the one
    of the numbers that instability follows, "" if none.
    """

    name: str
    title: str
    x: Axis
    y: Axis
    laws: Callable[[bool], Sequence[str]]
    right: float
    because: str
    measure: Measure
    judged: float = math.inf
    monotone: bool = False
    limit: str = ""

    def count(self, quick: bool) -> int:
        """Laws times values of y: the number of calls of ``run``."""
        return len(self.laws(quick)) * len(self.y.chosen(quick))

    def run(self, law: str, y: float, quick: bool) -> list[Row]:
        """Run the flow at all values of x, in order; one row each."""
        values = self.x.chosen(quick)
        if not self.monotone:
            return [self._tried(law, x, y) for x in values]
        known = {x: self._tried(law, x, y) for x in values if x <= self.judged}
        low, high = -1, len(values)  # all up to low are stable, all from high on are not
        for at, x in enumerate(values):
            if x in known and known[x].verdict == UNSTABLE:
                high = at
                break
            low = at if x in known else low
        while high - low > 1:
            middle = (low + high) // 2
            row = known[values[middle]] = self._tried(law, values[middle], y)
            low, high = (low, middle) if row.verdict == UNSTABLE else (middle, high)
        verdicts = [STABLE if at <= low else UNSTABLE for at in range(len(values))]
        return [
            known.get(x) or Row(self.name, law, x, y, verdict, None, {}, False, 0.0)
            for x, verdict in zip(values, verdicts, strict=True)
        ]

    def _tried(self, law: str, x: float, y: float) -> Row:
        start = time.perf_counter()
        found = self.measure(law, x, y)
        error = None if found.error is None else float(found.error)
        right = error is not None and error <= self.right
        verdict = UNSTABLE if not found.stable else RIGHT if right else STABLE
        seconds = time.perf_counter() - start
        return Row(self.name, law, float(x), float(y), verdict, error, dict(found.numbers or {}), True, seconds)


class Stability(Register[Flow]):
    """A register of flows; names are ``topic.what``."""

    what = "flow"

    def flow(self, name: str, **parts: Any) -> Callable[[Measure], Measure]:
        """Register the decorated ``(law, x, y) -> Tried`` as a flow made of ``parts``, see :class:`Flow`."""

        def register(measure: Measure) -> Measure:
            """Keep it; returns it as it is."""
            made = Flow(name=name, measure=measure, **parts)
            assert made.right >= 0
            assert made.because, "a tolerance has a reason"
            self.add(made)
            return measure

        return register


def holds_up_to(rows: Iterable[Row], number: str) -> tuple[float, float]:
    """The largest value of a number below which every try was stable, 0 if none, and the least at which one was not.

    The second is infinite where all were stable.  Only of tries that ran.
    """
    pairs = [(row.numbers[number], row.verdict == UNSTABLE) for row in rows if number in row.numbers]
    worst = min((value for value, bad in pairs if bad), default=math.inf)
    return max((value for value, bad in pairs if not bad and value < worst), default=0.0), worst
