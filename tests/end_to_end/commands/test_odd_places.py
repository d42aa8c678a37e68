"""Commands where something is missing that most people have: open streams, a home; and where the process is stopped."""

import os
import signal
import subprocess
import sys
import time

import pytest

from tests.reference.folders import ROOT
from tests.reference.scenes import COLUMN, write
from tests.reference.waiting import awaited, done, running

CHECK = [sys.executable, "-m", "porescale", "check"]


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A scene file."""
    return write(tmp_path_factory.mktemp("scenes") / "column.toml", COLUMN)


@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_a_command_does_without_the_streams_that_are_closed(file, closed):
    shell = ["sh", "-c", f'exec "$@" {closed}', "sh"]
    ended = done([*shell, *CHECK, file], cwd=ROOT)
    assert ended.returncode == 0
    assert "Traceback" not in ended.stderr
    assert ("spacing" in ended.stdout) == (">&-" not in closed.split())
    wrong = done([*shell, *CHECK, file, "--set", "time.end=-1"], cwd=ROOT)  # the twin that must fail
    assert wrong.returncode == 2
    assert "Traceback" not in wrong.stderr


HOMELESS = """
import os, pwd, runpy, sys
def unknown(number):
    raise KeyError(number)
pwd.getpwuid = unknown
sys.argv = ["porescale", *sys.argv[1:]]
runpy.run_module("porescale", run_name="__main__")
"""
"""porescale for a user of whom the system knows no home, as in a container."""


def test_a_user_without_a_home_checks_a_scene(file):
    known = {key: value for key, value in os.environ.items() if key not in ("HOME", "XDG_CACHE_HOME")}
    ended = done([sys.executable, "-c", HOMELESS, "check", file], cwd=ROOT, env=known)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "spacing" in ended.stdout


WATCHED = """
import io, sys, time
from rich.console import Console
from porescale.common.record import progress
progress.PATIENCE, progress.HALT = 0.01, 0.3
watch = progress.Watch("dam", 0.0, 10.0)
watch.console = Console(file=io.StringIO())
with watch:
    watch.update(0, 0.0)
    watch.update(1, 5.0)
    print("runs", flush=True)
    sys.stdin.readline()
    time.sleep(1.0)  # the wait that was going on is over
    print(watch.stopped, watch.left(), flush=True)
"""
"""What a run thinks that it has left, half-way."""


def left_after(seconds: float) -> tuple[float, float]:
    """Seconds in which a run was stopped as it sees it, and seconds that it has left, if it is stopped for so long."""
    words = [sys.executable, "-c", WATCHED]
    with running(words, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "runs\n"
        began = time.monotonic()
        os.kill(process.pid, signal.SIGSTOP)
        awaited(lambda: time.monotonic() > began + seconds)
        os.kill(process.pid, signal.SIGCONT)
        process.stdin.write("\n")
        process.stdin.flush()
        stopped, left = map(float, process.stdout.readline().split())
        spent = time.monotonic() - began
    assert left <= spent - stopped + 1.0  # half of the run is left: as long as it took to here, starting apart
    return stopped, left


def test_time_in_which_a_run_is_stopped_is_no_time_that_it_takes():
    stopped, _ = left_after(3.0)
    assert (
        stopped >= 2.0
    )  # up to half a second it would have waited anyway; the check that must fail has clocks of its own
