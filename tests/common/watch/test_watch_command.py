"""`watch` as a command: how it begins, how it ends, what it refuses."""

import re
import signal
import socket
import subprocess
import sys
import urllib.request

import pytest

from porescale.common.cli.application import application, main
from tests.reference.waiting import running, talked
from tests.reference.watched import PROGRAM, toy_run


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_it_with_one_line_and_code_0(tmp_path, how):
    toy_run(tmp_path / "run")
    words = [sys.executable, "-m", "tests.reference.watched", "watch", tmp_path / "run", "--no-open"]
    # Ignored where it was started, as in a shell's background; it ends all the same.
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with running(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            line = process.stdout.readline()
            link = re.fullmatch(r"watch .*run at (http://127\.0\.0\.1:\d+/[\w-]{22}/) \(Ctrl-C ends it\)\n", line)[1]
            with urllib.request.urlopen(f"{link}state", timeout=60) as answer:
                assert b'"finished"' in answer.read()
            with urllib.request.urlopen(link, timeout=60):  # an answer that is not read to its end
                process.send_signal(how)
                said, cried = talked(process)
    finally:
        signal.signal(signal.SIGINT, before)
    assert (process.returncode, said.count("\n"), cried) == (0, 1, "")
    with pytest.raises(OSError):  # noqa: PT011  (whatever the system calls a port at which nobody listens)
        urllib.request.urlopen(link, timeout=5)


def refused(capsys, *words):
    """What `watch` says of wrong use, in one line."""
    assert main(application(PROGRAM), ["watch", *map(str, words), "--no-open"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    return said.err


def test_a_port_in_use_is_said(tmp_path, capsys):
    toy_run(tmp_path)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        line = refused(capsys, tmp_path, "--port", port)
    assert line.startswith(f"--port = {port}: cannot be listened at (")
    assert line.endswith("; give another, or leave --port out: a free one is taken\n")


def test_wrong_folders_are_said(tmp_path, capsys):
    (tmp_path / "file").touch()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "file").touch()
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "card.json").write_text("{")
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "card.json").write_text('{"package": "continuum-sph", "scene": {}}')
    for name, problem in (("none", "is not there; begin the run first, or add --wait"), ("file", "holds no run"),
                          ("other", "holds no run and no sweep"), ("broken", "card.json is damaged"),
                          ("foreign", "holds a run of continuum-sph, not of toy")):  # fmt: skip
        assert problem in refused(capsys, tmp_path / name)
