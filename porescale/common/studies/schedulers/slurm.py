"""Runs as jobs of Slurm, through submitit: an optional extra, imported on request.

One array of jobs, which go on without the command that queued them.  All machines must see the folders of scene and
runs under the same paths, and this installation.
"""

import shutil
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from porescale.common.core.errors import INTERRUPTED, Fault, InputError, PorescaleError
from porescale.common.core.extras import installed
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.studies.schedulers.law import OPTION, Entry
from porescale.common.studies.schedulers.progress import Progress
from porescale.common.studies.schedulers.slurm_options import parameters
from porescale.common.studies.schedulers.slurm_queue import Queue, last_line
from porescale.common.studies.schedulers.task import Done, Task

FIRST_LOOK, LAST_LOOK, SLOWER = 1.0, 30.0, 1.1
"""Seconds between looks at the queue: at first, in the end, and how much longer each is than the one before."""
LINE_EVERY = 600.0
"""Seconds after which how far all is is said again, though no run has begun or ended."""
MOST = 1000
"""Jobs of one array; a cluster that does not say otherwise refuses more."""
LOSSES = 3
"""How often a job may vanish without a result before its run is given up."""
SECOND_LOOK = 5.0
"""Seconds after which a command that begins looks again, where the queue lacks jobs of an earlier one."""
ABSENT_SECONDS = 60.0
"""How long a job must be absent from the queue to count as ended: an answer may be wrong."""
ALIVE = ("RUNNING", "PENDING", "REQUEUED", "COMPLETING", "CONFIGURING", "SUSPENDED")
"""States in the accounts of jobs that have not ended, whatever the queue says."""
ENDS = {"finished": 0, "unstable": 3}
"""Exit codes of runs whose cards say that nothing is left to do."""


@dataclass
class Call:
    """What one call of a command waits for.

    waiting : task and job by name;  todo : tasks without a job;  absent : since when the queue lacks a job, by number;
    begun : whether Slurm has taken a job;  refused : why it did not take the last ones.
    """

    queue: Queue
    progress: Progress
    jobs: int | None
    todo: list[Task]
    waiting: dict[str, tuple[Task, Any]]
    lost: Counter[str] = field(default_factory=Counter)
    absent: dict[str, float] = field(default_factory=dict)
    begun: bool = False
    refused: str = ""
    said: tuple[str, float] = ("", 0.0)

    def submit(self) -> None:
        """Queue what has no job: all at once where none is queued, else as many as do not exceed ``jobs``.

        InputError where Slurm refuses the first ones; what it refuses later is tried again.
        """
        self.begun = self.begun or bool(self.waiting)
        room = MOST if not self.waiting or self.jobs is None else min(self.jobs - len(self.waiting), MOST)
        now, self.todo = self.todo[: max(room, 0)], self.todo[max(room, 0) :]
        if not now:
            return
        try:
            made = self.queue.submit(now, self.jobs)
        except InputError as error:
            if not self.begun:
                raise
            self.todo = [*now, *self.todo]
            self.refused = f"; {error.faults[0].problem}; tried again"
            return
        self.begun, self.refused = True, ""
        self.waiting |= {task.name: (task, job) for task, job in zip(now, made, strict=True)}

    def look(self) -> Iterator[Done]:
        """What has ended since the last look."""
        try:
            states = self.queue.states()
        except OSError as error:  # an overloaded controller; jobs go on without it
            self._say(f"squeue does not answer ({error.strerror})")
            return
        for task, job in list(self.waiting.values()):
            gone = self._gone(job, states)
            if job.paths.result_pickle.exists() or gone:
                done = self._result(task, job) if job.paths.result_pickle.exists() else self._without_result(task, job)
                self.waiting.pop(task.name)
                self.queue.forget(job)
                if done is not None:
                    yield done
        mine = [states.get(job.job_id, "") for _, job in self.waiting.values()]
        running = sum(state in ("RUNNING", "COMPLETING") for state in mine)
        self.progress.at_a_time = running or self.progress.at_a_time
        if mine or self.refused:
            queued = len(mine) - running + len(self.todo)
            self._say(f"{running} run, {queued} are queued{self.refused}", f", {self.progress.words()}")

    def _gone(self, job: Any, states: dict[str, str]) -> bool:
        """Whether the queue has lacked a job for long, and the accounts do not have it either."""
        now = time.monotonic()
        if job.job_id in states:
            self.absent.pop(job.job_id, None)
            return False
        if now - self.absent.setdefault(job.job_id, now) < ABSENT_SECONDS:
            return False
        if _state(job).startswith(ALIVE):
            self.absent[job.job_id] = now  # asked again after as long
            return False
        return True

    def _say(self, text: str, more: str = "") -> None:
        """A line, unless it is the last one again and that was not long ago."""
        last, at = self.said
        if text != last or time.monotonic() - at > LINE_EVERY:
            self.said = text, time.monotonic()
            self.progress.say(text + more)

    def _result(self, task: Task, job: Any) -> Done:
        """What a job has left."""
        try:
            return Done(task, *job.result())
        except RuntimeError as error:  # submitit's own: what the job raised, as text
            trace = (str(error).split("-" * 22 + "\n")[1:2] or [str(error)])[0]
            return Done(task, PorescaleError.code, f"{last_line(trace)}; see {job.paths.stderr}")

    def _without_result(self, task: Task, job: Any) -> Done | None:
        """What has become of a run whose job is not queued and has left no result; None if it is to be queued anew."""
        state = _state(job)
        folder = task.place / task.folder
        outcome = read_card(folder).get("outcome") if (folder / CARD).exists() else None
        if outcome == "finished" or (outcome in ENDS and not task.again):
            return Done(task, ENDS[str(outcome)], "")
        if state.startswith("CANCELLED"):
            return Done(task, INTERRUPTED, f"job {job.job_id} was cancelled")
        self.lost[task.name] += 1
        if self.lost[task.name] >= LOSSES:
            return Done(task, PorescaleError.code, f"lost {LOSSES} jobs ({state}); see {job.paths.stderr}")
        self.progress.say(f"{task.name}: job {job.job_id} is lost ({state}), queued again")
        self.todo.append(task)
        return None


def _state(job: Any) -> str:
    """What the accounts say of a job now; what they said before does not stand in where they are silent."""
    job.watcher.clear()
    return str(job.get_info(mode="force").get("State") or "no state known")


class Slurm:
    """The `Scheduler` of a cluster; InputError where something for it is missing."""

    def __init__(self, text: str, threads: int) -> None:
        self.asked = parameters(text, threads)
        if not installed("submitit"):
            raise InputError(Fault(OPTION, text, "needs submitit", repair="pip install 'porescale[cluster]'"))
        for tool in ("sbatch", "squeue", "srun", "scancel"):
            if shutil.which(tool) is None:
                repair = "call this on a machine that can submit jobs"
                raise InputError(Fault(OPTION, text, f"finds no {tool} here", repair=repair))

    def run(self, tasks: Sequence[Task], jobs: int | None, progress: Progress) -> Iterator[Done]:
        """See `Scheduler`; as many at a time as Slurm gives where ``jobs`` is None."""
        folder = tasks[0].folder.parent
        if "%" in str(folder.resolve()):
            problem, repair = "has a % in its path, which Slurm reads as a number of a job", "name another --out"
            raise InputError(Fault("folder", str(folder), problem, repair=repair))
        queue = Queue(folder, self.asked)
        try:
            states = queue.states()
            if queue.missing(states):
                time.sleep(SECOND_LOOK)
                states |= queue.states()
            found = queue.found(states)
        except OSError as error:
            raise InputError(Fault(OPTION, "slurm", f"squeue does not answer ({error.strerror})")) from None
        waiting = {task.name: found[task.name] for task in tasks if task.name in found}
        for task in tasks:
            if task.name in waiting and waiting[task.name][0].words != task.words:
                job = waiting[task.name][1].job_id
                repair = f"wait for it, cancel it (scancel {job}), or name another --out"
                raise InputError(Fault("run folder", str(task.folder), "is queued with other settings", repair=repair))
        if waiting:
            progress.say(f"{len(waiting)} of {len(tasks)} are queued already")
        here = Call(queue, progress, jobs, [task for task in tasks if task.name not in waiting], waiting)
        pause = FIRST_LOOK
        try:
            while here.todo or here.waiting:
                here.submit()
                ended = list(here.look())
                yield from ended
                if (here.todo or here.waiting) and not ended:
                    time.sleep(pause)
                    pause = min(SLOWER * pause, LAST_LOOK)
        except BaseException:
            if here.waiting:
                progress.say(
                    f"{len(here.waiting)} jobs stay queued: call this again to wait for them, or end them by "
                    f"scancel --name={queue.name}"
                )
            raise


def takes(text: str) -> bool:
    """Whether this is slurm, with options or without."""
    return text.partition(":")[0] == "slurm" and "://" not in text


SCHEDULER = Entry("slurm", "slurm[:partition=…,time=2h,account=…]", takes, Slurm, 10)
