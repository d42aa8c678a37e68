"""What a scheduler is: it takes runs and gives each as it ends.  One file each, found in this folder by its name.

Whoever runs a task begins it with ``Task.command``, asked where and when it begins: a run that was begun is gone on
with from its checkpoint, so that what was interrupted, requeued or lost can be given to any scheduler again.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from porescale.common.core.errors import Fault, InputError
from porescale.common.studies.schedulers.progress import Progress
from porescale.common.studies.schedulers.task import Done, Task

OPTION = "--scheduler"


class Scheduler(Protocol):
    """What runs tasks: processes here, or the queue of a cluster."""

    def run(self, tasks: Sequence[Task], jobs: int | None, progress: Progress) -> Iterator[Done]:
        """Each task as it ends, in any order, each once.

        jobs : at a time, None for as many as the scheduler sees fit;  progress : told how many run at a time
        (``at_a_time``), and what else is worth a line.  When it is left early, by an exception or by Ctrl-C, what runs
        here is asked to save its state, and what is in a queue stays there: called again, it is waited for, not sent
        again.
        """
        ...


@dataclass(frozen=True)
class Entry:
    """A scheduler by name.

    name : a word;  written : as `--scheduler` takes it;  takes : whether a value of the option is its own;  open : the
    scheduler from that value and the threads of each run, InputError where it cannot be had;  order : in lists.
    """

    name: str
    written: str
    takes: Callable[[str], bool]
    open: Callable[[str, int], Scheduler]
    order: int = 100


def scheduler_of(text: str, threads: int) -> Scheduler:
    """The scheduler that `--scheduler` names, for runs of so many threads; InputError where there is none."""
    from porescale.common.core.register import discover

    known: dict[str, Entry] = discover(__package__ or "", "SCHEDULER")
    for entry in known.values():
        if entry.takes(text):
            return entry.open(text, threads)
    raise InputError(Fault(OPTION, text, "is not known", "", ", ".join(entry.written for entry in known.values())))
