"""Convergence: experiments with a known answer, run at several resolutions, and the order at which their error falls.

Packages register their ladders beside their validations; `study convergence` runs them and writes the files
(convergence_files.py).
"""

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from porescale.common.evidence.files import finite
from porescale.common.evidence.register import Register, what_raised


@dataclass(frozen=True)
class Row:
    """The outcome of a ladder; the fields are the JSON keys.

    errors : one for each of ``levels``;  measured : order, see `order_of`, None where it cannot be computed;  expected,
    within, because : as of the `Ladder`;  holds : whether the measured order is at least the expected one less
    ``within``, None where no order is expected; False of a ladder that ended with an exception, whose text is
    ``because``.
    """

    name: str
    title: str
    along: str
    levels: Sequence[float]
    errors: Sequence[float]
    measured: float | None
    expected: float | None
    within: float
    because: str
    holds: bool | None
    seconds: float

    @property
    def topic(self) -> str:
        """First part of the name."""
        return self.name.partition(".")[0]

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; numbers that are not finite become null."""
        made: dict[str, Any] = finite(asdict(self) | {"seconds": round(self.seconds, 2)})
        return made

    @classmethod
    def of(cls, known: Mapping[str, Any]) -> "Row":
        """The row of a JSON object, keys beyond its own left out; an error that was not finite is nan."""
        own = {key: known[key] for key in cls.__dataclass_fields__}
        errors = [math.nan if error is None else error for error in own["errors"]]
        return cls(**own | {"errors": errors})


def order_of(levels: Sequence[float], errors: Sequence[float]) -> float | None:
    """Least-squares slope of log(error) against log(level), sign changed; None if an error is not positive and finite.

    levels : resolutions, > 0: the larger, the finer.
    """
    if not all(math.isfinite(error) and error > 0 for error in errors):
        return None
    return -float(np.polyfit(np.log(levels), np.log(errors), 1)[0])


@dataclass(frozen=True)
class Ladder:
    """A registered experiment over several resolutions.

    name : ``topic.what``;  title : one line, with what the error is;  along : what is refined, with its unit;
    levels : from coarse to fine, larger is finer;  expected : order of the theory, None if none is expected;
    within : by how much the measured order may be below it;  because : of the order, and of ``within`` or of the error
    that stays;  measure : error >= 0 at a level.
    """

    name: str
    title: str
    along: str
    levels: tuple[float, ...]
    expected: float | None
    within: float
    because: str
    measure: Callable[[float], float]

    def run(self) -> Row:
        """Measure at every level, from coarse to fine.

        After an exception the errors of its level and of finer ones are nan, ``because`` is its text, and the order
        does not hold, even where none is expected.
        """
        start, because, raises = time.perf_counter(), self.because, False
        errors = [math.nan] * len(self.levels)
        try:
            for k, level in enumerate(self.levels):
                errors[k] = float(self.measure(level))
        except Exception as raised:  # whatever a ladder does must not end the others
            because, raises = what_raised(raised), True
        measured = order_of(self.levels, errors)
        holds = False if raises else None
        if self.expected is not None:
            holds = measured is not None and measured >= self.expected - self.within
        seconds = time.perf_counter() - start
        return Row(
            self.name, self.title, self.along, self.levels, errors, measured, self.expected, self.within, because,
            holds, seconds,
        )  # fmt: skip


Measure = Callable[[float], float]


class Ladders(Register[Ladder]):
    """A register of ladders."""

    what = "ladder"

    def ladder(
        self, name: str, *, title: str, along: str, levels: Iterable[float], because: str,
        expected: float | None = None, within: float = 0.0,
    ) -> Callable[[Measure], Measure]:  # fmt: skip
        """Register the decorated function, which gives the error at a level."""
        chosen = tuple(map(float, levels))
        assert len(chosen) > 2, "an order needs three levels"
        assert list(chosen) == sorted(chosen), "levels go from coarse to fine"
        assert because, "an order has a reason"

        def register(measure: Measure) -> Measure:
            """Keep ``measure`` as the ladder; returns it."""
            self.add(Ladder(name, title, along, chosen, expected, within, because, measure))
            return measure

        return register
