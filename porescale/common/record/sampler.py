"""Interface of a function of the user's that measures a model while it runs, with a table of its own."""

from typing import Protocol

from porescale.common.record.model import Model
from porescale.common.record.schedule import Schedule


class Sampler(Protocol):
    """Measures a model at times of its own; what it gives goes to <name>.csv, cut back like the series."""

    name: str
    schedule: Schedule

    def restart(self) -> None:
        """Forget all rows: the run begins, or goes on from a checkpoint."""

    def sample(self, *, scheduled: bool) -> dict[str, float] | None:
        """A row, with "time (s)" first, or None where there is none; may raise anything.

        scheduled : whether an event of the schedule falls on this step, or the run only ends here.
        """


def samplers_of(model: Model) -> list[Sampler]:
    """The samplers of a model; none if it has no ``samplers``."""
    return list(getattr(model, "samplers", ()))
