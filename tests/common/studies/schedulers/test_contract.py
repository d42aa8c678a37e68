"""What every scheduler does with runs, and what names one."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from porescale.common.core.atomic import owned
from porescale.common.core.errors import InputError
from porescale.common.studies.schedulers import slurm as slurm_scheduler
from porescale.common.studies.schedulers.dask import Dask, takes
from porescale.common.studies.schedulers.law import Scheduler, scheduler_of
from porescale.common.studies.schedulers.local import Local
from porescale.common.studies.schedulers.progress import of
from porescale.common.studies.schedulers.slurm_options import parameters
from porescale.common.studies.schedulers.task import INTERRUPTED, Process, Task
from tests.reference.faults.slurm import slurm
from tests.reference.same_run import differences
from tests.reference.toy_command import SCENE, begun, call, run_alone
from tests.reference.waiting import PATIENCE, running, until


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
    monkeypatch.setattr(slurm_scheduler, "FIRST_LOOK", 0.05)
    monkeypatch.setattr(slurm_scheduler, "LAST_LOOK", 0.05)
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


def test_a_held_run_folder_is_waited_for_until_the_campaign_is_stopped(place):
    folder = Path("runs/held")
    folder.mkdir()
    (folder / "card.json").write_text('{"scene": {}}')
    process = Process(task("held"))
    with owned(folder) as held:
        assert held
        process.stop()
        assert process.run() == (INTERRUPTED, "interrupted")
    assert begun(Path("runs")) == []


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
