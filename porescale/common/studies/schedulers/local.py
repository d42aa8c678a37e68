"""Runs side by side as processes of this machine, each on cores of its own where the system places them."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from queue import SimpleQueue
from typing import Any

from porescale.common.core.errors import INTERRUPTED
from porescale.common.studies.schedulers.cores import taken
from porescale.common.studies.schedulers.law import Entry
from porescale.common.studies.schedulers.progress import Progress
from porescale.common.studies.schedulers.task import Done, Process, Task


class Local:
    """The `Scheduler` of this machine.  process : makes what has ``run`` and ``stop`` of a task and its cores."""

    def __init__(self, process: Callable[[Task, Sequence[int]], Any] = Process) -> None:
        self.process = process

    def run(self, tasks: Sequence[Task], jobs: int | None, progress: Progress) -> Iterator[Done]:
        """See `Scheduler`; one at a time where ``jobs`` is None."""
        progress.at_a_time = jobs = min(jobs or 1, max(len(tasks), 1))
        alive: list[Any] = []
        stopped = False
        threads = tasks[0].threads if tasks else 1
        with taken(jobs, threads) as cores, ThreadPoolExecutor(jobs) as pool:
            free: SimpleQueue[list[int]] = SimpleQueue()
            for each in cores:
                free.put(each)

            def one(task: Task) -> Done:
                """A task, unless the others were stopped or one of them has raised."""
                nonlocal stopped
                place = free.get()
                process = self.process(task, place)
                alive.append(process)
                try:
                    if stopped:
                        return Done(task, INTERRUPTED, "")
                    began = progress.now()
                    code, said = process.run()
                    return Done(task, code, said, progress.now() - began)
                except BaseException:
                    stopped = True
                    raise
                finally:
                    alive.remove(process)
                    free.put(place)

            try:
                futures: list[Future[Done]] = [pool.submit(one, task) for task in tasks]
                for future in as_completed(futures):
                    yield future.result()
            except BaseException:
                stopped = True
                pool.shutdown(wait=False, cancel_futures=True)
                for process in list(alive):
                    process.stop()
                raise


SCHEDULER = Entry("local", "local", lambda text: text == "local", lambda text, threads: Local(), 0)
