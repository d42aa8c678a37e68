"""A Slurm of one machine: `sbatch`, `squeue`, `sacct`, `scancel`, `scontrol` and `srun` as scripts, and what they ask.

The tasks of arrays are processes of this machine.  A test can hold them back, kill, preempt, warn or lose them, and
make its commands fail; it says so beforehand, as what is to be done once something has happened.  Signals go to all
processes of a job but its batch shell, as Slurm sends them.
"""

import os
import re
import signal
import subprocess
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil

from tests.reference.waiting import PATIENCE, awaited

LOOK = 0.01
TOOLS = {
    "sbatch": """
        [ -e "$FAKE/refuse" ] && { cat "$FAKE/refuse" >&2; touch "$FAKE/refused"; exit 1; }
        n=100; until mkdir "$FAKE/jobs/$n" 2>/dev/null; do n=$((n + 1)); done
        cp "$1" "$FAKE/jobs/$n/script"; env -0 > "$FAKE/jobs/$n/environment"; pwd > "$FAKE/jobs/$n/place"
        touch "$FAKE/jobs/$n/sent"; until [ -e "$FAKE/jobs/$n/known" ]; do sleep 0.01; done
        [ -e "$FAKE/dies" ] && kill -9 $PPID
        echo "Submitted batch job $n" """,
    "squeue": """
        [ -e "$FAKE/deaf" ] && { echo "slurm_load_jobs error: Unable to contact slurm controller" >&2; exit 1; }
        [ -e "$FAKE/empty once" ] && { rm "$FAKE/empty once"; exit 0; }
        [ -e "$FAKE/empty" ] && { echo >> "$FAKE/empty"; exit 0; }
        for word; do case $word in --name=*) want=${word#--name=};; esac; done
        while IFS='|' read -r id state name; do [ "$name" = "$want" ] && echo "$id|$state"; done < "$FAKE/queue"
        exit 0""",
    "sacct": """
        [ -e "$FAKE/no accounts" ] && { echo "Slurm accounting storage is disabled" >&2; exit 1; }
        cat "$FAKE/accounts"; touch "$FAKE/asked" """,
    "scancel": """ask="$FAKE/requests/$$"; echo cancel "$@" > "$ask.new"; mv "$ask.new" "$ask"
        while [ -e "$ask" ]; do sleep 0.01; done""",
    "scontrol": """ask="$FAKE/requests/$$"; echo "$@" > "$ask.new"; mv "$ask.new" "$ask"
        while [ -e "$ask" ]; do sleep 0.01; done""",
    "srun": """
        while :; do case $1 in
            --unbuffered) shift;; --cpus-per-task) shift 2;;
            --output) out=$2; shift 2;; --error) err=$2; shift 2;; *) break;;
        esac; done
        A=$SLURM_ARRAY_JOB_ID a=$SLURM_ARRAY_TASK_ID j=$SLURM_JOB_ID
        name() { echo "$1" | sed "s/%A/$A/; s/%a/$a/; s/%j/$j/; s/%t/0/"; }
        exec "$@" >> "$(name "$out")" 2>> "$(name "$err")" """,
}


@dataclass
class Job:
    """A task.  number : as Slurm writes it;  starts : how often it was begun;  again : queue it when it ends;  gone :
    nothing knows it."""

    number: str
    script: Path
    name: str
    limit: int
    state: str = "PENDING"
    process: subprocess.Popen[bytes] | None = None
    starts: int = 0
    again: bool = False
    end: str = ""
    gone: bool = False

    @property
    def array(self) -> str:
        """Number of its array, or its own."""
        return self.number.partition("_")[0]

    def processes(self) -> list[psutil.Process]:
        """What runs in it, without its batch shell."""
        with suppress(psutil.NoSuchProcess):
            if self.process is not None:
                return psutil.Process(self.process.pid).children(recursive=True)
        return []

    def signal(self, number: int) -> None:
        """To all its processes."""
        for process in self.processes():
            with suppress(psutil.NoSuchProcess):
                process.send_signal(number)

    def kill(self) -> None:
        """SIGKILL to all of it."""
        if self.process is not None:
            with suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)


@dataclass
class Slurm:
    """The controller, in a thread.  jobs : by number;  held : nothing starts;  most : jobs that ran at a time."""

    folder: Path
    jobs: dict[str, Job] = field(default_factory=dict)
    held: bool = False
    most: int = 0
    cancelled: list[str] = field(default_factory=list)
    _plans: list[tuple[Callable[[], Any], Callable[[], object]]] = field(default_factory=list)
    _ends: threading.Event = field(default_factory=threading.Event)
    errors: list[BaseException] = field(default_factory=list)

    def once(self, happens: Callable[[], Any], act: Callable[[], object]) -> None:
        """Do something as soon as something has happened; in order, each after the one before."""
        self._plans.append((happens, act))

    def begun(self) -> Counter[str]:
        """How often each job was begun."""
        return Counter({number: job.starts for number, job in self.jobs.items()})

    def kill(self, number: str, *, again: bool = True) -> None:
        """The machine of a job fails; it is queued again unless Slurm is told not to."""
        job = self.jobs[number]
        job.again, job.end = again, "NODE_FAIL"
        job.kill()

    def preempt(self, number: str, *, grace: float = PATIENCE, rest: float = 0.0) -> None:
        """Another job needs the machine: SIGTERM, SIGKILL where the run has not ended after a while; queued again.

        rest : seconds that what else runs in the job has after the run.
        """
        job = self.jobs[number]
        job.again, job.end = True, "PREEMPTED"
        runs = [it for it in job.processes() if "submitit.core._submit" not in it.cmdline()]
        job.signal(signal.SIGTERM)
        psutil.wait_procs(runs, timeout=grace)
        time.sleep(rest)
        job.kill()

    def warn(self, number: str) -> None:
        """The time of a job is nearly over."""
        self.jobs[number].signal(signal.SIGUSR2)

    def lose(self, number: str) -> None:
        """A job ends, and nothing knows of it any more."""
        self.jobs[number].gone = True
        self.kill(number, again=False)

    def _work(self) -> None:
        try:
            while not self._ends.wait(LOOK):
                self._accept()
                self._answer()
                self._end_and_start()
                self._write()
                if self._plans and self._plans[0][0]():
                    self._plans.pop(0)[1]()
        except BaseException as error:
            self.errors.append(error)
            raise

    def _accept(self) -> None:
        for place in self.folder.glob("jobs/*"):
            if (place / "sent").exists() and not (place / "known").exists():
                text = (place / "script").read_text()
                options = dict(re.findall(r"#SBATCH --([\w-]+)=(\S+)", text))
                array = re.fullmatch(r"0-(\d+)%(\d+)", options.get("array", ""))
                numbers = [f"{place.name}_{k}" for k in range(int(array[1]) + 1)] if array else [place.name]
                limit = int(array[2]) if array else 1
                for number in numbers:
                    self.jobs[number] = Job(number, place / "script", options["job-name"], limit)
                self._write()
                (place / "known").touch()

    def _answer(self) -> None:
        for ask in self.folder.glob("requests/*[0-9]"):
            word, *numbers = ask.read_text().split()
            for number in numbers:
                job = self.jobs[number]
                if word == "requeue":
                    job.again = True
                else:
                    self.cancelled.append(number)
                    job.end, job.again = "CANCELLED by 0", False
                    if job.state == "PENDING":
                        job.state = job.end
                    job.kill()
            ask.unlink()

    def _end_and_start(self) -> None:
        running = [job for job in self.jobs.values() if job.state == "RUNNING"]
        for job in list(running):
            assert job.process is not None
            code = job.process.poll()
            if code is None:
                continue
            running.remove(job)
            job.state = "PENDING" if job.again else job.end or ("COMPLETED" if code == 0 else "FAILED")
            job.again, job.end = False, ""
        for job in self.jobs.values():
            side = sum(other.array == job.array for other in running)
            if job.state == "PENDING" and not self.held and side < job.limit:
                self._start(job)
                running.append(job)
        self.most = max(self.most, len(running))

    def _start(self, job: Job) -> None:
        place = job.script.parent
        pairs = (pair.partition("=") for pair in (place / "environment").read_text().split("\0") if pair)
        task = job.number.partition("_")[2]
        extra = {"SLURM_JOB_ID": job.number.replace("_", "0"), "SLURM_NTASKS": "1", "SLURM_PROCID": "0"}
        extra |= {"SLURM_ARRAY_JOB_ID": job.array, "SLURM_ARRAY_TASK_ID": task} if task else {}
        job.process = subprocess.Popen(
            ["bash", str(job.script)], cwd=(place / "place").read_text().strip(), start_new_session=True,
            env={name: value for name, _, value in pairs} | extra, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        job.state, job.starts = "RUNNING", job.starts + 1

    def _write(self) -> None:
        known = [job for job in self.jobs.values() if not job.gone]
        queued = [f"{it.number}|{it.state}|{it.name}\n" for it in known if it.state in ("PENDING", "RUNNING")]
        self._replace("queue", "".join(queued))
        self._replace("accounts", "JobID|State|NodeList\n" + "".join(f"{it.number}|{it.state}|here\n" for it in known))

    def _replace(self, name: str, text: str) -> None:
        beside = self.folder / f"{name}.new"
        beside.write_text(text)
        beside.replace(self.folder / name)


@contextmanager
def slurm(folder: Path) -> Iterator[Slurm]:
    """A controller, its commands on the PATH while this lasts; then all that it runs is killed."""
    for name in ("bin", "jobs", "requests"):
        (folder / name).mkdir(parents=True)
    for name, text in TOOLS.items():
        tool = folder / "bin" / name
        tool.write_text(f"#!/bin/sh\nFAKE='{folder}'\n{text}\n")
        tool.chmod(0o755)
    made = Slurm(folder)
    made._write()
    thread = threading.Thread(target=made._work, daemon=True)
    thread.start()
    before = os.environ["PATH"]
    os.environ["PATH"] = f"{folder / 'bin'}{os.pathsep}{before}"
    try:
        yield made
    finally:
        os.environ["PATH"] = before
        made._ends.set()
        thread.join(PATIENCE)
        for job in made.jobs.values():
            job.kill()
            if job.process is not None:
                job.process.wait(PATIENCE)
    assert not made.errors


def ended(made: Slurm) -> None:
    """Wait until nothing is queued or runs."""
    awaited(lambda: all(job.state not in ("PENDING", "RUNNING") for job in made.jobs.values()), PATIENCE)
    time.sleep(2 * LOOK)
