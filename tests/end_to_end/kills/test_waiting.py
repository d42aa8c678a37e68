"""A child that hangs says where, and is gone; one that ends is waited for."""

import faulthandler
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.reference.waiting import Hung, awaited, done, ended, living, running, talked, until

HANGS = """
import sys, threading
from pathlib import Path

def stuck():
    lock = threading.Lock()
    lock.acquire()
    Path(sys.argv[1]).touch(), lock.acquire()

stuck()
"""
"""Says by a file that it has come to line 8, where it hangs."""
FORKS = "import subprocess, sys\nchild = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'])\n"


def test_a_child_that_ends_is_told_with_what_it_said():
    words = "import sys; print('out'); print('err', file=sys.stderr); sys.exit(3)"
    it = done([sys.executable, "-c", words])
    assert (it.returncode, it.stdout, it.stderr) == (3, "out\n", "err\n")


def test_a_child_that_hangs_says_where_and_is_gone(tmp_path):
    here = tmp_path / "here"
    with running([sys.executable, "-c", HANGS, here], stderr=subprocess.PIPE) as process:
        assert until(process, here.exists)
        assert living(process.pid) == [process.pid]
        with pytest.raises(Hung, match=r"(?s)hung for 0 s: .*line 8 in stuck"):
            talked(process, 0.0)
    assert not living(process.pid)


def test_a_child_has_the_time_that_it_is_given(tmp_path):
    with pytest.raises(Hung, match=r"hung for 0\.2 s"):
        done([sys.executable, "-c", HANGS, tmp_path / "here"], 0.2)


@pytest.mark.parametrize("hangs", [False, True])
def test_what_a_child_has_started_is_gone_with_it(tmp_path, hangs):
    here = tmp_path / "here"
    words = FORKS + "print(child.pid, flush=True)\n" + (HANGS if hangs else "")
    command = [sys.executable, "-c", words, here]
    with running(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        number = int(process.stdout.readline())
        if hangs:
            assert until(process, here.exists)
            assert {process.pid, number} <= set(living(process.pid))
            with pytest.raises(Hung):
                talked(process, 0.0)
        else:
            awaited(lambda: process.poll() == 0)
            assert living(process.pid) == [number]  # the twin: it would go on
    status = Path(f"/proc/{number}/stat")  # gone, or a zombie that nobody has waited for yet
    assert not status.exists() or status.read_text().rpartition(")")[2].split()[0] in "ZX"


def test_what_never_happens_ends_the_wait_when_the_process_does(tmp_path):
    with running([sys.executable, "-c", ""], stderr=subprocess.PIPE) as process:
        assert not until(process, lambda: False)
    command = [sys.executable, "-c", HANGS, tmp_path / "here"]
    with running(command, stderr=subprocess.PIPE) as process, pytest.raises(Hung):
        until(process, lambda: False, 0.2)
    with pytest.raises(Hung, match="in vain"):
        awaited(lambda: False, 0.0)


@pytest.mark.parametrize("hangs", [False, True])
def test_a_forked_child_that_hangs_is_told_from_one_that_ends(tmp_path, hangs):
    said = tmp_path / "said"
    number = os.fork()
    if number == 0:
        try:
            file = said.open("w")
            faulthandler.enable(file)
            print("here", file=file, flush=True)
            time.sleep(600 if hangs else 0)
        finally:
            os._exit(5)
    if hangs:
        awaited(lambda: said.exists() and "here" in said.read_text())
        with pytest.raises(Hung, match="test_a_forked_child"):
            ended(number, 0.0, said)
        with pytest.raises(ChildProcessError):
            os.waitpid(number, os.WNOHANG)
    else:
        assert ended(number) == 5
