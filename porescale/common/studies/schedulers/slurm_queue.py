"""The jobs of a folder of runs: which of them Slurm has in its queue, and which run each of them makes.

submitit keeps what a job runs in a file that is called after the job's number.  That file and the queue are all that
is known: a command that is called again finds its jobs there, whatever ended it before.
"""

import hashlib
import io
import logging
import os
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stderr
from pathlib import Path
from pickle import UnpicklingError
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.studies.schedulers.law import OPTION
from porescale.common.studies.schedulers.slurm_job import WARNING_SECONDS, SlurmJob
from porescale.common.studies.schedulers.task import Task

PLACE = ".slurm"
"""Folder beside the run folders for what submitit writes."""
SUBMITTED, RESULT = "_submitted.pkl", "_0_result.pkl"
TIMEOUTS = 100_000
"""How often a job may come to the end of its time: the run ends some time, or stops saving anything new."""
PATIENCE = 60.0
"""Seconds after which a command of Slurm is given up."""
DEFAULTS = ("account", "partition", "qos", "constraint", "reservation")
"""What sbatch reads from variables (SBATCH_ACCOUNT) that the user has set, where the option does not say otherwise.

Others stay out, since they come before what a job's script asks for: its name, time or array.
"""


class Queue:
    """Jobs of the runs in ``folder``.  asked : parameters of submitit's executor."""

    def __init__(self, folder: Path, asked: dict[str, Any]) -> None:
        import submitit

        logging.getLogger("submitit").setLevel(logging.ERROR)
        self.submitit: Any = submitit
        self.folder, self.asked = folder.resolve() / PLACE, asked
        self.name = f"porescale-{hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:10]}"

    def states(self) -> dict[str, str]:
        """State of each job that is queued or runs, by number; OSError where Slurm does not say."""
        words = ["squeue", "--noheader", "--array", "--format=%i|%T", f"--name={self.name}"]
        try:
            done = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE, check=True)
        except subprocess.SubprocessError as error:
            raise OSError(0, last_line(str(getattr(error, "stderr", "") or error)), "squeue") from None
        rows = (line.strip().partition("|") for line in done.stdout.splitlines() if "|" in line)
        return {number: state for number, _, state in rows}

    def missing(self, states: dict[str, str]) -> bool:
        """Whether a job that an earlier command has queued has left no result and is not among these."""
        numbers = {path.name.removesuffix(SUBMITTED) for path in self.folder.glob(f"[0-9]*{SUBMITTED}")}
        return any(not (self.folder / f"{number}{RESULT}").exists() for number in numbers - set(states))

    def found(self, states: dict[str, str]) -> dict[str, tuple[Task, Any]]:
        """Task and job, by the task's name, of what an earlier command has queued.

        A job without a file does nothing: its command was ended between queuing and naming it; it is cancelled.  Files
        of jobs that are not queued any more are removed.
        """
        made = {}
        for number in states:
            try:
                submission = self.submitit.helpers.DelayedSubmission.load(self.folder / f"{number}{SUBMITTED}")
                (task,) = submission.args
                made[task.name] = task, self._job(number)
            except (OSError, EOFError, UnpicklingError, AttributeError, ImportError, ValueError, TypeError):
                self.cancel([number])
        for path in self.folder.glob("*.pkl"):
            if path.name.partition("_")[0] not in {number.partition("_")[0] for number in states}:
                path.unlink(missing_ok=True)
        return made

    def submit(self, tasks: Sequence[Task], jobs: int | None) -> list[Any]:
        """A job for each task, as one array of which at most ``jobs`` run at a time; InputError where Slurm refuses."""
        executor = self.submitit.SlurmExecutor(self.folder, max_num_timeout=TIMEOUTS)
        executor.update_parameters(
            job_name=self.name, signal_delay_s=WARNING_SECONDS, array_parallelism=jobs or len(tasks),
            # A job's one step does not take the job's cores over in all versions of Slurm.
            srun_args=["--cpus-per-task", str(self.asked["cpus_per_task"])],
            additional_parameters={"requeue": True}, **self.asked,
        )  # fmt: skip
        try:
            kept = self._defaults()
            # A command within a job of its own does not hand that on; submitit prints what it raises, too.
            with self.submitit.helpers.clean_env(), _set(kept), redirect_stderr(io.StringIO()):
                made: list[Any] = executor.map_array(SlurmJob(60.0 * self.asked["time"]), tasks)
        except (self.submitit.core.utils.FailedJobError, self.submitit.core.utils.FailedSubmissionError) as error:
            raise InputError(Fault(OPTION, "slurm", f"sbatch refuses: {last_line(str(error))}")) from None
        return made

    def forget(self, job: Any) -> None:
        """Remove the files of a job that has ended, but for what it said."""
        job.paths.submitted_pickle.unlink(missing_ok=True)
        job.paths.result_pickle.unlink(missing_ok=True)

    def cancel(self, numbers: Sequence[str]) -> None:
        """End the jobs of these ``numbers``; what scancel says of ones that ended is not read."""
        subprocess.run(["scancel", *numbers], capture_output=True, timeout=PATIENCE, check=False)

    def _defaults(self) -> dict[str, str]:
        """The user's variables that sbatch shall read."""
        names = {f"SBATCH_{key.upper()}" for key in DEFAULTS if key not in self.asked}
        return {name: os.environ[name] for name in names if name in os.environ}

    def _job(self, number: str) -> Any:
        return self.submitit.SlurmJob(self.folder, number)


@contextmanager
def _set(variables: dict[str, str]) -> Iterator[None]:
    """Environment variables that are not set, while this lasts."""
    os.environ.update(variables)
    try:
        yield
    finally:
        for name in variables:
            os.environ.pop(name, None)


def last_line(text: str) -> str:
    """The last line of a text that says something."""
    lines = [line.strip() for line in text.splitlines() if line.strip(" -\t")]
    return lines[-1] if lines else "no reason given"
