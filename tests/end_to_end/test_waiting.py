"""A child that hangs says where, and is gone; one that ends is waited for."""

from __future__ import annotations

import faulthandler
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.reference.waiting import Hung, done, ended, running, until

HANGS = "import threading\ndef stuck():\n    lock = threading.Lock()\n    lock.acquire()\n    lock.acquire()\nstuck()"
FORKS = "import subprocess, sys\nchild = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'])\n"
PATIENCE = 5.0
"""Seconds for a child to have come to where it hangs: what it says then is asserted, not when it says it."""


def test_a_child_that_ends_is_told_with_what_it_said():
    words = "import sys; print('out'); print('err', file=sys.stderr); sys.exit(3)"
    it = done([sys.executable, "-c", words])
    assert (it.returncode, it.stdout, it.stderr) == (3, "out\n", "err\n")


def test_a_child_that_hangs_says_where_and_is_gone():
    with pytest.raises(Hung, match=r"(?s)hung for 5 s: .*line 5 in stuck"):
        done([sys.executable, "-c", HANGS], PATIENCE)


def test_what_a_child_that_hangs_has_started_is_gone_with_it(tmp_path):
    note = tmp_path / "number"
    words = FORKS + f"open({str(note)!r}, 'w').write(str(child.pid))\n" + HANGS
    with pytest.raises(Hung):
        done([sys.executable, "-c", words], PATIENCE)
    status = Path(f"/proc/{int(note.read_text())}/stat")  # gone, or a zombie that nobody has waited for yet
    assert not status.exists() or status.read_text().rpartition(")")[2].split()[0] in "ZX"


def test_what_never_happens_ends_the_wait_when_the_process_does():
    with running([sys.executable, "-c", ""], stderr=subprocess.PIPE) as process:
        assert not until(process, lambda: False)
    with running([sys.executable, "-c", HANGS], stderr=subprocess.PIPE) as process, pytest.raises(Hung):
        until(process, lambda: False, PATIENCE)


@pytest.mark.parametrize("hangs", [False, True])
def test_a_forked_child_that_hangs_is_told_from_one_that_ends(tmp_path, hangs):
    said = tmp_path / "said"
    number = os.fork()
    if number == 0:
        try:
            faulthandler.enable(said.open("w"))
            time.sleep(600 if hangs else 0)
        finally:
            os._exit(5)
    if hangs:
        with pytest.raises(Hung, match="test_a_forked_child"):
            ended(number, PATIENCE, said)
        with pytest.raises(ChildProcessError):
            os.waitpid(number, os.WNOHANG)
    else:
        assert ended(number) == 5
