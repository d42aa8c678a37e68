"""Sweeps through Slurm: what is killed, preempted, lost, called again or broken ends as if nothing had happened."""

import csv
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from porescale.common.core.atomic import owned
from porescale.common.studies.schedulers import slurm as scheduler
from porescale.common.studies.schedulers import slurm_job
from porescale.common.studies.schedulers.progress import of
from porescale.common.studies.schedulers.task import Task
from porescale.common.watch.sweep import Points
from tests.reference.faults.slurm import Slurm, ended, slurm
from tests.reference.same_run import differences
from tests.reference.toy_command import CLOCK, SCENE, begun, call, run_alone, stepping
from tests.reference.waiting import PATIENCE, done, kill, running, until

OUT = Path("out")


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Slurm]:
    """A Slurm, in a folder with a scene; looks at its queue follow each other at once."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    for name in ("FIRST_LOOK", "LAST_LOOK", "SECOND_LOOK", "ABSENT_SECONDS"):
        monkeypatch.setattr(scheduler, name, 0.05)
    (tmp_path / "scene.toml").write_text(SCENE)
    with slurm(tmp_path / "cluster") as made:
        yield made


def words(vary: str = "3,4", *more: str) -> list[str]:
    return ["sweep", "scene.toml", "--vary", f"toy.beads={vary}", "--out", str(OUT), "--scheduler", "slurm", *more]


@pytest.fixture
def sweep(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, list[str]]]:
    """Runs a sweep in this process; exit code, and lines on stderr."""

    def _sweep(vary: str = "3,4", *more: str) -> tuple[int, list[str]]:
        capsys.readouterr()
        code = call(words(vary, *more))
        return code, capsys.readouterr().err.splitlines()

    return _sweep


def go(folder: Path = OUT) -> None:
    """Runs are fast from now on."""
    folder.mkdir(exist_ok=True)
    (folder / "go").touch()


def under_way(name: str) -> Callable[[], bool]:
    """Whether a run has saved its state with rows after the first."""
    series, checkpoint = OUT / name / "series.csv", OUT / name / "checkpoint.h5"
    return lambda: checkpoint.exists() and series.exists() and series.read_text().count("\n") > 2


def outcomes() -> dict[str, str]:
    with open(OUT / "sweep.csv") as file:
        return {row["name"]: row["outcome"] for row in csv.DictReader(file)}


def untouched(beads: int, folder: Path) -> Path:
    """The run that nobody disturbed."""
    return run_alone(beads, folder)


def test_an_array_runs_the_points_and_no_more_than_jobs_at_a_time(cluster, sweep):
    go()
    code, said = sweep("3,4,5", "--jobs", "2", "--threads", "2")
    assert code == 0, said
    assert outcomes() == {f"beads={k}": "finished" for k in (3, 4, 5)}
    assert list(cluster.jobs) == ["100_0", "100_1", "100_2"]
    assert cluster.most <= 2
    script = cluster.jobs["100_0"].script.read_text()
    assert "--cpus-per-task=2" in script
    assert "--cpus-per-task 2" in script.splitlines()[-1]  # of the step, too
    assert "--requeue" in script
    assert "(3 of 3, about 0 s left)" in said[-1]
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []
    assert [row["state"]["outcome"] for row in Points(OUT, stepping()).rows()] == ["finished"] * 3  # as `watch` sees it
    code, said = sweep("3,4,5")
    assert code == 0
    assert said[0] == "3 of 3 points are there already"
    assert len(cluster.jobs) == 3


def test_a_killed_machine_gives_the_run_of_an_untouched_one(cluster, sweep):
    cluster.once(under_way("beads=3"), lambda: (cluster.kill("100_0"), go()))
    code, said = sweep()
    assert code == 0, said
    assert cluster.begun() == {"100_0": 2, "100_1": 1}
    assert [it[2] for it in begun(OUT) if it[0] == "beads=3"] == ["fresh", "resumed"]
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []
    assert differences(OUT / "beads=3", untouched(4, Path("other"))) != []  # the check that must fail


def test_a_warned_job_saves_its_state_and_is_queued_again(cluster, sweep):
    cluster.once(under_way("beads=3"), lambda: cluster.warn("100"))
    cluster.once(lambda: cluster.jobs["100"].starts == 2, go)
    code, said = sweep("3")
    assert code == 0, said
    assert cluster.begun() == {"100": 2}
    assert [it[2] for it in begun(OUT)] == ["fresh", "resumed"]
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []


def test_a_preempted_job_saves_its_state_and_is_queued_again(cluster, sweep):
    cluster.once(under_way("beads=3"), lambda: cluster.preempt("100"))
    cluster.once(lambda: cluster.jobs["100"].starts == 2, go)
    code, said = sweep("3")
    assert code == 0, said
    assert cluster.begun() == {"100": 2}
    assert outcomes() == {"beads=3": "finished"}
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []


def test_a_job_preempted_before_its_run_has_a_card_is_queued_again(cluster, sweep):
    cluster.once(lambda: begun(OUT), lambda: cluster.preempt("100", rest=0.5))
    cluster.once(lambda: cluster.jobs["100"].starts == 2, go)
    cluster.once(lambda: cluster.jobs["100"].starts == 2, go)
    code, said = sweep("3", "--set", "toy.packs=true")
    assert code == 0, said
    assert cluster.begun() == {"100": 2}
    assert [it[2] for it in begun(OUT)] == ["fresh", "fresh"]
    assert outcomes() == {"beads=3": "finished"}


@pytest.mark.parametrize(("code", "result"), [(130, False), (-signal.SIGTERM, False), (-signal.SIGKILL, True)])
def test_what_slurm_ends_leaves_no_result(tmp_path, monkeypatch, code, result):
    monkeypatch.setattr(slurm_job, "LAST_SECONDS", 0.0)
    monkeypatch.setattr(slurm_job.Process, "run", lambda self: (code, "said"))
    job, task = slurm_job.SlurmJob(600.0), Task("a", "toy", ("run",), tmp_path / "a")
    if result:
        assert job(task) == (code, "said")
    else:
        with pytest.raises(SystemExit):
            job(task)


def test_an_empty_queue_is_not_believed_while_the_accounts_say_that_jobs_run(cluster, sweep):
    empty = cluster.folder / "empty"
    cluster.once(under_way("beads=3"), empty.touch)
    cluster.once(lambda: empty.read_text().count("\n") > 20, go)  # looks, for longer than a job may be absent
    code, said = sweep("3")
    assert code == 0, said
    assert cluster.begun() == {"100": 1}
    assert len(begun(OUT)) == 1


@pytest.mark.parametrize(("again", "code"), [(False, 3), (True, None)])
def test_a_lost_job_of_an_unstable_run_is_queued_again_where_that_is_asked_for(tmp_path, again, code):
    class Job:
        """It has vanished."""

        def __init__(self) -> None:
            self.job_id, self.watcher = "100", dict[str, str]()

        def get_info(self, mode: str) -> dict[str, str]:
            return {}

    (tmp_path / "card.json").write_text('{"scene": {}, "outcome": "unstable"}')
    task = Task("a", "toy", ("run",), tmp_path, again)
    here = scheduler.Call(None, of({}, str), None, [], {})  # type: ignore[arg-type]
    done = here._without_result(task, Job())
    assert (done and done.code, here.todo) == (code, [task] if again else [])


def test_a_job_that_ran_and_vanishes_with_the_accounts_is_queued_again(cluster, sweep):
    asked = cluster.folder / "asked"  # the accounts said RUNNING; from now on they say nothing
    empty = cluster.folder / "empty"
    cluster.once(under_way("beads=3"), empty.touch)
    cluster.once(asked.exists, lambda: ((cluster.folder / "no accounts").touch(), cluster.lose("100"), empty.unlink()))
    cluster.once(lambda: "101" in cluster.jobs, go)
    code, said = sweep("3")
    assert code == 0, said
    assert "beads=3: job 100 is lost (no state known), queued again" in said
    assert cluster.begun() == {"100": 1, "101": 1}


def test_sbatch_that_fails_later_is_tried_again(cluster, sweep):
    refuse, refused = cluster.folder / "refuse", cluster.folder / "refused"
    (cluster.folder / "no accounts").touch()
    text = "sbatch: error: Batch job submission failed: Socket timed out"
    cluster.once(under_way("beads=3"), lambda: (refuse.write_text(text), cluster.lose("100")))
    cluster.once(refused.exists, lambda: (refuse.unlink(), go()))
    code, said = sweep("3")
    assert code == 0, said
    assert any("0 run, 1 are queued; sbatch refuses: " in it and "Socket timed out; tried again" in it for it in said)
    assert list(cluster.jobs) == ["100", "101"]


def test_what_the_user_has_set_for_sbatch_is_kept_where_the_option_does_not_say_otherwise(cluster, monkeypatch):
    for name, value in (("ACCOUNT", "abc"), ("PARTITION", "short"), ("JOB_NAME", "mine")):
        monkeypatch.setenv(f"SBATCH_{name}", value)
    go()
    assert call([*words("3")[:-1], "slurm:partition=long"]) == 0
    pairs = (cluster.jobs["100"].script.parent / "environment").read_text().split("\0")
    assert [it for it in pairs if it.startswith("SBATCH_")] == ["SBATCH_ACCOUNT=abc"]
    assert os.environ["SBATCH_PARTITION"] == "short"


@pytest.mark.slow
def test_a_lost_job_is_queued_again_and_given_up_after_three(cluster, sweep):
    cluster.once(under_way("beads=3"), lambda: cluster.lose("100"))
    cluster.once(lambda: "101" in cluster.jobs, go)
    code, said = sweep("3")
    assert code == 0, said
    assert any("beads=3: job 100 is lost (no state known), queued again" in line for line in said)
    assert [it[2] for it in begun(OUT)] == ["fresh", "resumed"]
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []


def test_a_job_that_is_always_lost_is_given_up(cluster, sweep):
    (cluster.folder / "no accounts").touch()
    for number in ("100", "101", "102"):
        cluster.once(lambda number=number: number in cluster.jobs, lambda number=number: cluster.lose(number))
    code, said = sweep("3")
    assert code == 1
    assert said[-1].startswith("beads=3: failed: lost 3 jobs (no state known); see ")
    assert len(cluster.jobs) == 3


def test_a_cancelled_job_is_not_queued_again(cluster, sweep):
    cluster.held = True
    cluster.once(lambda: "100_1" in cluster.jobs, lambda: cancel(cluster, "100_0"))
    code, said = sweep()
    assert code == 1
    assert "beads=3: interrupted: job 100_0 was cancelled" in said
    assert outcomes() == {"beads=3": "interrupted", "beads=4": "finished"}
    assert len(cluster.jobs) == 2


def cancel(cluster: Slurm, number: str) -> None:
    cluster.jobs[number].state = "CANCELLED by 0"
    cluster.held = False
    go()


def command(*more: str, **variables: str) -> list[str]:
    return [sys.executable, "-m", "tests.reference.toy_command", *words("3,4", *more)]


@pytest.mark.parametrize("wrong", [False, True])
def test_a_killed_command_called_again_finds_its_jobs_though_the_queue_is_wrong_once(cluster, sweep, wrong):
    with running(command(), stderr=subprocess.DEVNULL) as process:
        assert until(process, under_way("beads=4"), PATIENCE)
        kill(process)
    assert {job.state for job in cluster.jobs.values()} == {"RUNNING"}  # none of them went with it
    once = cluster.folder / "empty once"
    if wrong:
        once.touch()
    cluster.once(lambda: not once.exists(), go)
    code, said = sweep()
    assert code == 0, said
    assert "2 of 2 are queued already" in said
    assert cluster.begun() == {"100_0": 1, "100_1": 1}
    assert sorted(it[0] for it in begun(OUT)) == ["beads=3", "beads=4"]
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []


@pytest.mark.slow
def test_a_command_killed_before_it_knew_its_jobs_leaves_none_behind(cluster, sweep):
    cluster.held = True
    (cluster.folder / "dies").touch()
    done(command(), PATIENCE)
    assert [job.state for job in cluster.jobs.values()] == ["PENDING"] * 2
    (cluster.folder / "dies").unlink()
    go()
    cluster.once(lambda: len(cluster.cancelled) == 2, lambda: setattr(cluster, "held", False))
    code, said = sweep()
    assert code == 0, said
    assert cluster.begun() == {"100_0": 0, "100_1": 0, "101_0": 1, "101_1": 1}
    assert len(begun(OUT)) == 2


@pytest.mark.slow
def test_ctrl_c_leaves_the_jobs_and_says_how_to_go_on_or_end_them(cluster):
    with running(command(), stderr=subprocess.PIPE, text=True) as process:
        assert until(process, under_way("beads=4"), PATIENCE)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=PATIENCE)[1].splitlines()
        assert process.returncode == 130
    assert said[-2].startswith("2 jobs stay queued: call this again to wait for them, or end them by scancel --name=")
    assert said[-1] == "interrupted"
    assert {job.state for job in cluster.jobs.values()} == {"RUNNING"}
    go()
    ended(cluster)


@pytest.mark.slow
def test_queued_points_with_other_settings_are_refused(cluster, sweep):
    cluster.held = True
    with running(command(), stderr=subprocess.DEVNULL) as process:
        assert until(process, lambda: list((OUT / ".slurm").glob("100_1_submitted.pkl")), PATIENCE)
        kill(process)
    code, said = sweep("3,4", "--set", "toy.slow=0.3")
    assert code == 2
    assert said == [
        "run folder = 'out/beads=3': is queued with other settings; wait for it, cancel it (scancel 100_0), or name "
        "another --out"
    ]
    cluster.held = False
    go()
    ended(cluster)


def test_a_full_disk_of_one_point_is_its_verdict_and_the_others_go_on(cluster, sweep):
    go()
    Path("table.csv").write_text("name,toy.beads,toy.disk_fails_at\nfull,3,12\nfine,4,\n")
    code = call(["sweep", "scene.toml", "table.csv", "--out", "out", "--scheduler", "slurm"])
    assert code == 1
    assert outcomes() == {"full": "failed", "fine": "finished"}
    with open(OUT / "sweep.csv") as file:
        assert "No space left on device" in next(csv.DictReader(file))["problem"]


@pytest.mark.slow
def test_clocks_hours_apart_change_nothing(cluster, sweep, monkeypatch):
    monkeypatch.setenv(CLOCK, "-20000")
    cluster.once(under_way("beads=3"), lambda: (apart(), cluster.kill("100_0"), go()))
    code, said = sweep()
    assert code == 0, said
    assert cluster.begun() == {"100_0": 2, "100_1": 1}
    assert differences(OUT / "beads=3", untouched(3, Path("alone"))) == []


def apart() -> None:
    """Files of one point are of yesterday, those of the other of tomorrow."""
    for k, name in enumerate(("beads=3", "beads=4")):
        for path in (OUT / name).glob("*"):
            os.utime(path, (1.7e9 + 1e9 * k,) * 2)


def test_a_second_command_on_the_folder_is_refused(cluster, sweep):
    OUT.mkdir()
    with owned(OUT) as held:
        assert held
        code, said = sweep()
    assert code == 2
    assert said == ["folder = 'out': another command runs its points; wait for it, or name another --out"]
    assert not cluster.jobs


@pytest.mark.slow
def test_a_silent_controller_is_waited_for_but_not_at_the_start(cluster, sweep):
    deaf = cluster.folder / "deaf"
    deaf.touch()
    code, said = sweep()
    assert (code, len(said)) == (2, 1)
    assert "squeue does not answer (slurm_load_jobs error: Unable to contact slurm controller)" in said[0]
    deaf.unlink()
    cluster.once(under_way("beads=3"), deaf.touch)
    cluster.once(under_way("beads=4"), lambda: (go(), deaf.unlink()))
    code, said = sweep()
    assert code == 0, said


def test_a_folder_that_slurm_reads_as_a_pattern_is_refused(cluster, capsys):
    assert call(["sweep", "scene.toml", "--vary", "toy.beads=3", "--out", "50%j", "--scheduler", "slurm"]) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert "has a % in its path" in said[0]
    assert not cluster.jobs


def test_what_sbatch_refuses_is_one_line(cluster, sweep):
    refused = "sbatch: error: invalid partition specified: lang\nsbatch: error: Batch job submission failed: Invalid"
    (cluster.folder / "refuse").write_text(refused)
    code, said = sweep()
    assert (code, len(said)) == (2, 1)
    assert said[0].startswith("--scheduler = 'slurm': sbatch refuses: ")
    assert "Invalid" in said[0]
    assert not cluster.jobs
