"""Runs on workers of dask.distributed: an optional extra, imported on request.

Every worker must see the folders of scene and runs under the same paths, and have this package installed.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.studies.schedulers.law import OPTION, Entry
from porescale.common.studies.schedulers.progress import Progress
from porescale.common.studies.schedulers.task import Done, Process, Task

CONNECT_SECONDS = 20.0


def elsewhere(task: Task) -> tuple[int, str]:
    """On a worker: run the task; exit code and what it said on stderr."""
    try:
        return Process(task).run()
    except OSError as error:  # the folder is not there on this worker
        return 1, f"{error.filename}: {error.strerror}"


class Dask:
    """The `Scheduler` at an address, as many tasks at a time as it has workers; InputError if it has none."""

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client
        except ImportError:
            problem = "needs dask.distributed"
            raise InputError(Fault(OPTION, address, problem, repair="pip install 'porescale[cluster]'")) from None
        try:
            self.client: Any = Client(address, timeout=CONNECT_SECONDS)
            self.slots = len(self.client.ncores())
        except (OSError, ValueError, TypeError) as error:
            said = " ".join(str(error).split())[:120]
            repair = "name it as tcp://host:8786, as `dask scheduler` prints it"
            raise InputError(Fault(OPTION, address, f"does not answer ({said})", repair=repair)) from None
        if not self.slots:
            raise InputError(Fault(OPTION, address, "has no workers", repair="start some with `dask worker`"))

    def run(self, tasks: Sequence[Task], jobs: int | None, progress: Progress) -> Iterator[Done]:
        """See `Scheduler`; a task whose worker is lost is run by another one, from its checkpoint.

        Left early, what has not begun is cancelled; what runs on a worker goes on to its end.
        """
        from distributed import as_completed

        progress.at_a_time = min(jobs or self.slots, self.slots)
        left = iter(tasks)
        # Never shared, since a run folder is no pure function's value.
        sent = {self._send(task): task for task in islice(left, progress.at_a_time)}
        ended = as_completed(list(sent))
        try:
            for future in ended:
                task = sent.pop(future)
                error = future.exception()
                said = None if error is None else f"{type(error).__name__}: {error}"
                yield Done(task, *future.result()) if said is None else Done(task, 1, said)
                for more in islice(left, 1):
                    future = self._send(more)
                    sent[future] = more
                    ended.add(future)
        except BaseException:
            self.client.cancel(list(sent))
            raise

    def _send(self, task: Task) -> Any:
        return self.client.submit(elsewhere, task, pure=False)


def takes(text: str) -> bool:
    """Whether this is an address."""
    return "://" in text or re.fullmatch(r"[\w.-]+:\d+", text) is not None


SCHEDULER = Entry("dask", "tcp://host:8786 (dask)", takes, lambda text, threads: Dask(text))
