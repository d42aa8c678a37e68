"""Validations: numbers the code computes beside numbers known from elsewhere, with reasoned tolerances.

Packages register theirs; `verify` and the tests run the same rows.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.api.report import shown
from porescale.common.evidence.files import finite
from porescale.common.evidence.register import Register, what_raised

if TYPE_CHECKING:
    from rich.table import Table

Numbers = float | Sequence[float]


@dataclass(frozen=True)
class Measured:
    """What a validation found.

    reference, measured : one number or several, same unit;  error : distance between them, >= 0, as the
    validation defines it (it is compared with the tolerance).
    """

    reference: Numbers
    measured: Numbers
    error: float

    @classmethod
    def absolute(cls, reference: ArrayLike, measured: ArrayLike) -> Measured:
        """The error is the largest |measured - reference|."""
        known, found = np.asarray(reference), np.asarray(measured)
        return cls(known.tolist(), found.tolist(), float(np.abs(found - known).max()))

    @classmethod
    def relative(cls, reference: ArrayLike, measured: ArrayLike) -> Measured:
        """The error is the largest |measured/reference - 1|."""
        known, found = np.asarray(reference), np.asarray(measured)
        return cls(known.tolist(), found.tolist(), float(np.abs(found / known - 1.0).max()))


@dataclass(frozen=True)
class Row:
    """The outcome of a validation, as `verify` prints it; the fields are the JSON keys."""

    name: str
    source: str
    reference: Numbers | None
    measured: Numbers | None
    error: float | None
    tolerance: float
    because: str
    seconds: float
    passed: bool

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; numbers that are not finite become null."""
        return {key: finite(value) for key, value in asdict(self).items()}


@dataclass(frozen=True)
class Validation:
    """A registered validation.

    source : paper, figure or exact solution;  because : how the tolerance follows;  slow : only on demand.
    """

    name: str
    source: str
    because: str
    tolerance: float
    slow: bool
    measure: Callable[[], Measured]

    @property
    def topic(self) -> str:
        """The folder of ``validation`` that it stands in, else the first part of its name."""
        _, inside, path = str(self.measure.__module__).partition(".validation.")
        folder, deeper, _ = path.partition(".")
        return folder if inside and deeper else self.name.partition(".")[0]

    def run(self) -> Row:
        """Measure once.  An exception counts as failed, with its text in ``because``; nan never passes."""
        start = time.perf_counter()
        reference: Numbers | None = None
        measured: Numbers | None = None
        error, because = math.nan, self.because
        try:
            found = self.measure()
            reference, measured, error = found.reference, found.measured, float(found.error)
            if error < 0:
                raise ValueError(f"an error is a distance and cannot be {error}")
        except Exception as raised:  # whatever a validation does must not end the others
            because = what_raised(raised)
            error = math.nan
        seconds = time.perf_counter() - start
        passed = error <= self.tolerance
        row_error = None if math.isnan(error) else error
        return Row(self.name, self.source, reference, measured, row_error, self.tolerance, because, seconds, passed)


class Validations(Register[Validation]):
    """A register of validations; names are ``topic.what``."""

    what = "validation"

    def row(
        self, name: str, *, source: str, because: str, tolerance: float, slow: bool = False
    ) -> Callable[[Callable[[], Measured]], Callable[[], Measured]]:
        """Register the decorated function, which measures and returns a `Measured`."""
        assert tolerance >= 0
        assert source, "a validation names its source"
        assert because, "a tolerance has a reason"

        def register(measure: Callable[[], Measured]) -> Callable[[], Measured]:
            """Keep ``measure`` as the validation; returns it."""
            self.add(Validation(name, source, because, tolerance, slow, measure))
            return measure

        return register

    def chosen(self, names: Sequence[str] = (), *, slow: bool = False) -> list[Validation]:
        """Validations by name (a topic stands for all its own), without names all; slow ones by name or ``slow``.

        Raises InputError on unknown names, suggesting the nearest.
        """
        return [item for item in super().chosen(names) if slow or not item.slow or item.name in names]

    def run(self, names: Sequence[str] = (), *, slow: bool = False) -> list[Row]:
        """Run the rows that `chosen` gives."""
        return [item.run() for item in self.chosen(names, slow=slow)]


def table(rows: Sequence[Row]) -> Table:
    """Rows as a table for the terminal: numbers in one line, below it where they come from and why the tolerance."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, show_header=False)
    made.add_column()
    made.add_column(overflow="fold")
    for row in rows:
        verdict = Text("pass", style="green") if row.passed else Text("FAIL", style="bold red")
        text = Text(row.name, style="bold")
        text.append(
            f"\nreference {shown(row.reference)}, measured {shown(row.measured)}, "
            f"error {shown(row.error)}, tolerance {shown(row.tolerance)}",
            style="not bold",
        )
        text.append(f"\n{row.source}; {row.because}", style="not bold dim")
        made.add_row(verdict, text)
    return made
