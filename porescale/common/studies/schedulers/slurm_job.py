"""A run as a job of Slurm: what submitit calls on the machine that the job comes to."""

import signal
import threading
import time
from pathlib import Path
from typing import Any

from porescale.common.core.errors import INTERRUPTED, InputError, PorescaleError
from porescale.common.record.check_state import CHECKPOINT
from porescale.common.record.resume import how_far
from porescale.common.studies.schedulers.task import Process, Task

WARNING_SECONDS = 120
"""How long before the end of its time a job is told, so that its run saves its state."""
SAVING_SECONDS = 90.0
"""How long a run has for that before it is ended as last saved."""
LAST_SECONDS = 60.0
"""How long a job whose run was ended by Slurm's own signal waits for what Slurm does with it."""


class SlurmJob:
    """Runs a task; ended early by Slurm, it is queued again and the run goes on from its checkpoint.

    seconds : that the job may take.
    """

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds

    def __call__(self, task: Task) -> tuple[int, str]:
        """Exit code of the run, and what it said on stderr."""
        self._began, self._step = time.monotonic(), reached(task)
        self._process, self._ended = Process(task), threading.Event()
        found: list[tuple[int, str] | OSError] = []

        def run() -> None:
            """In a thread, so that signals are answered while the run goes on.

            Slurm sends them to all processes of a job; those meant for submitit, which would end the run unsaved, are
            masked here and so in the run.
            """
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGUSR1, signal.SIGUSR2})
            try:
                found.append(self._process.run())
            except OSError as error:
                found.append(error)
            finally:
                self._ended.set()

        threading.Thread(target=run, daemon=True).start()
        while not self._ended.wait(1.0):
            pass
        if isinstance(found[0], OSError):
            return PorescaleError.code, f"{found[0].filename}: {found[0].strerror}"
        if found[0][0] in (INTERRUPTED, -signal.SIGTERM):  # with its state saved, or before it had one
            # Slurm asked the run itself: it now queues the job again or ends it; no result may say that it is done.
            time.sleep(LAST_SECONDS)
            raise SystemExit(INTERRUPTED)
        return found[0]

    def checkpoint(self, task: Task) -> Any:
        """submitit's question, when Slurm warns of the end of the job, of what is to be queued again.

        PorescaleError where the job's time is over and the run has saved nothing new: it would never end.
        """
        from submitit.helpers import DelayedSubmission

        self._process.stop()
        if not self._ended.wait(SAVING_SECONDS):
            self._process.kill()
            self._ended.wait(SAVING_SECONDS)
        late = time.monotonic() - self._began > self.seconds / 2
        if late and reached(task) <= self._step:
            minutes = self.seconds / 60
            raise PorescaleError(f"no checkpoint within the {minutes:g} min of a job; give it more: slurm:time=…")
        return DelayedSubmission(SlurmJob(self.seconds), task)

    __submitit_checkpoint__ = checkpoint
    """The name that later versions of submitit ask for."""


def reached(task: Task) -> int:
    """The step of the checkpoint that the run goes on from, -1 where there is none or it is begun anew."""
    folder: Path = task.place / task.folder
    try:
        return how_far(folder).step if (folder / CHECKPOINT).exists() and not task.anew() else -1
    except (InputError, OSError):
        return -1
