"""What every scheduler does with runs, and what names one."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from porescale.common.core.atomic import owned
from porescale.common.core.errors import INTERRUPTED, InputError
from porescale.common.studies.schedulers import slurm as slurm_scheduler
from porescale.common.studies.schedulers import task as task_module
from porescale.common.studies.schedulers.dask import Dask, takes
from porescale.common.studies.schedulers.law import Scheduler, scheduler_of
from porescale.common.studies.schedulers.local import Local
from porescale.common.studies.schedulers.progress import of
from porescale.common.studies.schedulers.slurm_options import parameters
from porescale.common.studies.schedulers.task import Process, Task
from tests.reference.faults.slurm import slurm
from tests.reference.same_run import differences
from tests.reference.toy_command import SCENE, begun, call, run_alone
from tests.reference.waiting import PATIENCE, awaited, running, until


@contextmanager
def local(folder: Path) -> Iterator[Scheduler]:
    yield Local()


@contextmanager
def slurms(folder: Path) -> Iterator[Scheduler]:
    with slurm(folder / "cluster"):
        yield scheduler_of("slurm:time=1h", 1)


@contextmanager
def dasks(folder: Path) -> Iterator[Scheduler]:
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
        made = Dask(cluster.scheduler_address)
        yield made
        made.client.close()


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder with a scene whose runs are fast, to which commands go."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    for name in ("FIRST_LOOK", "LAST_LOOK", "SECOND_LOOK", "ABSENT_SECONDS"):
        monkeypatch.setattr(slurm_scheduler, name, 0.05)
    (tmp_path / "scene.toml").write_text(SCENE)
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "go").touch()
    return tmp_path


def task(name: str, *settings: str) -> Task:
    """A run of the toy."""
    folder = Path("runs") / name
    words = ("run", "scene.toml", "--out", str(folder), "--threads", "1")
    return Task(
        name, "tests.reference.toy_command", (*words, *(it for text in settings for it in ("--set", text))), folder
    )


@pytest.mark.parametrize("opened", [local, dasks, slurms])
def test_every_scheduler_gives_each_run_once_with_its_verdict_and_goes_on_with_begun_ones(place, opened):
    tasks = [task("sound", "toy.beads=3"), task("wild", "toy.breaks_at=50"), task("long", "time.end=0.2")]
    begun_before = subprocess.run([sys.executable, "-m", tasks[2].module, *task("long").words], check=False)
    assert begun_before.returncode == 0  # half of the long one
    said: list[str] = []
    with opened(place) as scheduler:
        done = list(scheduler.run(tasks, 2, of({it.name: it.folder for it in tasks}, said.append)))
    assert sorted((it.task.name, it.code) for it in done) == [("long", 0), ("sound", 0), ("wild", 3)]
    assert "unstable at step" in next(it.said for it in done if it.task.name == "wild")
    assert sorted((name, how) for name, _, how in begun(Path("runs"))) == [
        ("long", "fresh"), ("long", "resumed"), ("sound", "fresh"), ("wild", "fresh"),
    ]  # fmt: skip
    assert differences(Path("runs/sound"), run_alone(3, Path("alone"))) == []
    assert differences(Path("runs/sound"), Path("runs/long")) != []  # the check that must fail


def test_a_killed_command_called_again_waits_for_what_still_runs_and_runs_nothing_twice(place, capsys, monkeypatch):
    go = Path("runs/go")
    go.unlink()
    words = ["sweep", "scene.toml", "--vary", "toy.beads=3,4", "--out", "runs", "--jobs", "2"]
    command = [sys.executable, "-m", "tests.reference.toy_command", *words]
    series = [Path(f"runs/beads={k}/series.csv") for k in (3, 4)]
    with running(command, stderr=subprocess.DEVNULL) as process:
        assert until(process, lambda: all(it.exists() and it.read_text().count("\n") > 2 for it in series), PATIENCE)
        process.send_signal(signal.SIGKILL)
        process.wait(PATIENCE)
        waits = Process._wait_for_others

        def seen(self: Process) -> None:
            """The runs end only now that they are waited for."""
            go.touch()
            waits(self)

        monkeypatch.setattr(Process, "_wait_for_others", seen)
        assert call(words) == 0
    assert [how for _, _, how in begun(Path("runs"))] == ["fresh", "fresh", "resumed", "resumed"]
    assert differences(Path("runs/beads=3"), run_alone(3, Path("alone"))) == []
    assert "beads=4: finished" in capsys.readouterr().err


def test_a_held_run_folder_is_waited_for_until_the_campaign_is_stopped(place, monkeypatch):
    folder = Path("runs/held")
    folder.mkdir()
    (folder / "card.json").write_text('{"scene": {}}')
    process = Process(task("held"))
    looks = []
    held_by_another = Process._held
    monkeypatch.setattr(task_module, "LOOK", 0.01)
    monkeypatch.setattr(Process, "_held", lambda self: looks.append(held_by_another(self)) or looks[-1])
    with owned(folder) as held, ThreadPoolExecutor(1) as pool:
        assert held
        ended = pool.submit(process.run)
        try:
            awaited(lambda: len(looks) > 3 or ended.done(), PATIENCE)
            assert all(looks)
            assert not ended.done()
        finally:
            process.stop()
        assert ended.result(PATIENCE) == (INTERRUPTED, "interrupted")
    assert begun(Path("runs")) == []


def test_a_run_that_has_not_begun_its_steps_is_stopped_where_a_shell_has_ctrl_c_ignored(place):
    # As in `nohup porescale study trade SCENE &`: what it starts would go on to its end.
    go = Path("runs/go")
    go.unlink()
    process = Process(task("a", "toy.packs=true"))
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with ThreadPoolExecutor(1) as pool:
            ended = pool.submit(process.run)
            try:
                awaited(lambda: begun(Path("runs")) or ended.done(), PATIENCE)
                process.stop()
                assert ended.result(PATIENCE)[0] == INTERRUPTED
            finally:
                go.touch()  # what still waits ends
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_run_that_another_process_began_unseen_is_waited_for_and_gone_on_with(place, monkeypatch):
    folder, go = Path("runs/a"), Path("runs/go")
    go.unlink()
    folder.mkdir()
    looks = []
    held_by_another = Process._held
    monkeypatch.setattr(Process, "_held", lambda self: looks.append(held_by_another(self)) or looks[-1])
    with ThreadPoolExecutor(1) as pool:
        with owned(folder) as held:
            assert held
            ended = pool.submit(Process(task("a", "toy.packs=true")).run)
            awaited(lambda: begun(Path("runs")) or ended.done(), PATIENCE)  # it packs: there was no card
            (folder / "card.json").write_text('{"scene": {}}')
            go.touch()
            awaited(lambda: True in looks or ended.done(), PATIENCE)
            assert not ended.done()
        assert ended.result(PATIENCE)[0] == 0
    assert len(begun(Path("runs"))) == 2


def test_a_run_folder_whose_lock_cannot_be_opened_is_the_verdict_of_its_point(place):
    folder = Path("runs/a")
    (folder / ".lock").mkdir(parents=True)
    (folder / "card.json").write_text('{"scene": {}}')
    code, said = Process(task("a")).run()
    assert code == 1
    assert ".lock" in said


def test_dask_left_early_cancels_what_it_has_sent(place, monkeypatch):
    with dasks(place) as scheduler:
        cancelled, cancel = [], scheduler.client.cancel
        monkeypatch.setattr(scheduler.client, "cancel", lambda them: (cancelled.extend(them), cancel(them)))
        done = scheduler.run([task(name) for name in "abc"], 2, of({}, str))
        next(done)
        done.close()
        assert [it.cancelled() for it in cancelled] == [True]  # of three one has ended, one was not sent


def test_a_run_that_failed_is_gone_on_with_and_begun_anew_only_where_that_is_asked_for(place):
    folder = Path("runs/a")
    folder.mkdir()
    again = Task("a", "toy", ("run",), folder, again=True)
    for outcome, expected in (("failed", "--overwrite"), ("unstable", "--overwrite"), ("interrupted", "--resume")):
        (folder / "card.json").write_text(f'{{"scene": {{}}, "outcome": "{outcome}"}}')
        assert Task("a", "toy", ("run",), folder).command() == ["run", "--resume"]
        assert again.command() == ["run", expected]


def test_a_damaged_card_is_the_verdict_of_its_point(place):
    folder = Path("runs/a")
    folder.mkdir()
    (folder / "card.json").write_text("{")
    code, said = Process(replace(task("a"), again=True)).run()
    assert code == 2
    assert "card.json is damaged" in said


REFUSED = [
    ("slrum", "is not known (allowed: local, slurm"),
    ("slurm:partition", "partition= names nothing"),
    ("slurm:time=2", "time=2 is no time; write it as 90min, 2h or 3d"),
    ("slurm:time=1min", "is less than 5min"),
    ("slurm:memory=4", "is no memory; write it as 500M or 4G"),
    ("slurm:gpus=0", "is no number of them"),
    ("slurm:cores=4", "'cores' is not known"),
    ("slurm:time=1h,time=2h", "is given twice"),
    ("slurm:partition=a b", "names nothing"),
    ("slurm:partition=long", "finds no sbatch here"),
    ("tcp://localhost:1", "needs dask.distributed"),
]


@pytest.mark.parametrize(("text", "said"), REFUSED)
def test_a_scheduler_that_cannot_be_had_is_one_line(place, monkeypatch, text, said):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError) as caught:
        scheduler_of(text, 1)
    (fault,) = caught.value.faults
    assert said in fault.line()
    assert fault.line().startswith(f"--scheduler = {text!r}: ")


def test_without_submitit_the_line_says_what_to_install(place, monkeypatch, capsys):
    monkeypatch.setattr(slurm_scheduler, "installed", lambda name: False)
    assert call(["sweep", "scene.toml", "--vary", "toy.beads=3", "--scheduler", "slurm"]) == 2
    said = capsys.readouterr().err.splitlines()
    assert said == ["--scheduler = 'slurm': needs submitit; pip install 'porescale[cluster]'"]
    assert not Path("runs/scene_sweep").exists()


def test_options_are_those_of_sbatch():
    text = "slurm:partition=long,time=90min,account=abc,memory=1.5G,gpus=2,qos=low"
    assert parameters(text, 4) == {
        "partition": "long", "time": 90, "account": "abc", "mem": "1536M", "gpus_per_node": 2, "qos": "low",
        "cpus_per_task": 4,
    }  # fmt: skip
    assert parameters("slurm", 1) == {"time": 60, "cpus_per_task": 1}


def test_addresses_are_those_of_dask():
    assert all(map(takes, ("tcp://host:8786", "tls://host:1", "inproc://1/2", "host:8786")))
    assert not any(map(takes, ("slurm", "slurm:time=2h", "local", "nowhere")))
