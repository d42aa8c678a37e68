"""One process compiles a kernel, others wait for it; the second process is there when needed, and leaves nothing."""

import os
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
from filelock import FileLock

from porescale.common.compiled import ahead, turns
from porescale.common.compiled.turns import LONGEST, SUFFIX, Turns
from tests.reference.waiting import awaited

CHILD = "tests.reference.second_process"
ROOT = Path(__file__).resolve().parents[3]


def test_what_another_compiles_is_waited_for(tmp_path):
    other = FileLock(tmp_path / f"key{SUFFIX}")
    other.acquire()
    waits = []

    def sleep(seconds):
        waits.append(seconds)
        if len(waits) == 3:
            other.release()

    mine = Turns(sleep=sleep)
    assert mine.take("kernel", tmp_path / "key")
    assert len(waits) == 3
    mine.end()


def test_what_nobody_compiles_is_begun_at_once_and_leaves_no_file(tmp_path):  # the twin: nothing to wait for
    mine = Turns(sleep=lambda _: pytest.fail("waits for nobody"))
    assert not mine.take("kernel", tmp_path / "key")
    assert (mine.count, mine.name) == (1, "kernel")
    mine.end()
    assert not mine.name
    assert list(tmp_path.iterdir()) == []


def test_a_process_that_compiles_for_ever_is_waited_for_once(tmp_path):
    now = [0.0]

    def sleep(seconds):
        now[0] += LONGEST / 4

    mine = Turns(clock=lambda: now[0], sleep=sleep)
    with FileLock(tmp_path / f"key{SUFFIX}"):
        assert mine.take("kernel", tmp_path / "key")
        assert now[0] == LONGEST
        assert not mine.take("kernel", tmp_path / "key")
        assert now[0] == LONGEST


def test_seconds_of_compiling_are_counted_with_the_waits(tmp_path):
    now = [0.0]
    mine = Turns(clock=lambda: now[0])
    for took in (3.0, 4.0):
        mine.take("kernel", tmp_path / "key")
        now[0] += took
        mine.end()
        now[0] += 100.0  # no compiling
    assert mine.seconds == 7.0


def test_a_kernel_without_a_key_is_neither_noted_nor_waited_for(tmp_path):
    mine = Turns(sleep=lambda _: pytest.fail("waits for what is not kept"))
    with FileLock(tmp_path / f"kernel{SUFFIX}"):  # another process compiles one of that name
        assert not mine.take("kernel", tmp_path / "kernel")
        mine.end()
    mine.take("kernel", tmp_path / "module.kernel-key")  # the twin: it has one
    mine.end()
    assert (mine.count, mine.kept) == (2, ["module.kernel-key"])


def test_the_file_is_gone_before_the_lock_is_released(tmp_path, monkeypatch):
    mine, file, found = Turns(), tmp_path / f"key{SUFFIX}", []
    mine.take("kernel", tmp_path / "key")
    release = mine._lock.release
    monkeypatch.setattr(mine._lock, "release", lambda: (found.append(file.exists()), release()))
    assert file.exists()
    mine.end()
    assert found == [os.name == "nt"]  # Windows removes no open file
    assert not file.exists()


def test_a_folder_without_locks_is_done_without(tmp_path):
    (tmp_path / "file").write_text("no folder")
    mine = Turns()
    assert not mine.take("kernel", tmp_path / "file" / "key")
    mine.end()


def test_a_kernel_that_failed_holds_up_nobody(tmp_path):
    mine = Turns()
    mine.take("fails", tmp_path / "first")
    mine.take("next", tmp_path / "second")  # no end of the first
    with FileLock(tmp_path / f"first{SUFFIX}", blocking=False):
        mine.end()


def test_the_first_kernel_starts_what_waits_for_it_once(tmp_path):
    mine, begun = Turns(), []
    mine.first.append(lambda: begun.append(1))
    for name in ("one", "two"):
        mine.take(name, tmp_path / name)
        mine.end()
    assert begun == [1]


@pytest.fixture(autouse=True)
def path_of_the_tests(monkeypatch):
    """Modules of the tests are found by second processes from any folder."""
    monkeypatch.setenv("PYTHONPATH", str(ROOT))


@pytest.fixture
def process(tmp_path, monkeypatch):
    """Turns of this test alone, with two cores; and what the second process writes."""
    mine = Turns()
    for module in (turns, ahead):
        monkeypatch.setattr(module, "TURNS", mine)
    monkeypatch.setattr(ahead, "cores", lambda: 2)
    return mine, tmp_path / "number"


def test_the_second_process_lives_while_the_first_begins(process):
    mine, file = process
    with ahead.ahead(CHILD, lambda: str(file)):
        mine.take("kernel", file.parent / "key")
        mine.end()
        number = int(awaited(lambda: file.exists() and file.read_text()))
        assert alive(number)
    assert not alive(number)


@pytest.mark.parametrize("count", [1, 2])
def test_none_is_started_on_one_core_or_where_all_is_kept(process, monkeypatch, count):
    mine, file = process
    monkeypatch.setattr(ahead, "cores", lambda: count)
    with ahead.ahead(CHILD, lambda: pytest.fail("not to be started")):
        if count == 1:
            mine.take("kernel", file.parent / "key")
    mine.end()


def test_none_is_started_where_it_is_not_wanted(process):
    mine, file = process
    with ahead.ahead(CHILD, lambda: None):
        mine.take("kernel", file.parent / "key")
    mine.end()
    assert not file.exists()


@pytest.fixture
def module(tmp_path, monkeypatch):
    """Makes a module of code, which second processes find by its name; returns the name."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), str(tmp_path / "modules")]))
    (tmp_path / "modules").mkdir()

    def made(code):
        (tmp_path / "modules" / "made_here.py").write_text(code)
        return "made_here"

    return made


DEAF = """import os, time
from porescale.common.core.atomic import write_text
from pathlib import Path
write_text(Path({file!r}), str(os.getpid()))
time.sleep(600)
"""
LENGTH = """from porescale.common.compiled.ahead import serve
from porescale.common.core.atomic import write_text
from pathlib import Path
serve(lambda given: write_text(Path(given[0]), str(len(given[1]))))
"""
COMPILES = """import time
from pathlib import Path
from porescale.common.compiled.ahead import serve
from porescale.common.compiled.turns import TURNS
serve(lambda folder: (TURNS.take("kernel", Path(folder) / "key"), Path(folder, "begun").touch(), time.sleep(600)))
"""


def test_one_that_never_reads_holds_up_nobody(process, module, monkeypatch):
    mine, file = process
    monkeypatch.setattr(ahead, "PATIENCE", 600.0)  # it is not waited for
    with ahead.ahead(module(DEAF.format(file=str(file))), lambda: "x" * 2**20):  # a pipe holds 2^16 bytes
        mine.take("kernel", file.parent / "key")
        mine.end()
        number = int(awaited(lambda: file.exists() and file.read_text()))
        assert alive(number)
    assert not psutil.pid_exists(number)  # nor is a zombie left


def test_one_that_reads_gets_all_of_a_long_text(process, module):  # the twin
    _, file = process
    (second,) = ahead._start(module(LENGTH), [str(file), "x" * 2**20])
    assert int(awaited(lambda: file.exists() and file.read_text())) == 2**20
    ahead._end(*second)


def test_one_that_ends_before_it_reads_leaves_no_zombie():
    (second,) = ahead._start("no_such_module", "x" * 2**20)
    ahead._end(*second)
    assert second[0].returncode
    assert not psutil.pid_exists(second[0].pid)


def test_files_of_the_working_folder_are_no_modules_of_it(process, monkeypatch):
    mine, file = process
    folder = file.parent / "scenes"
    folder.mkdir()
    (folder / "json.py").write_text("open('executed', 'w').close()\n")
    monkeypatch.chdir(folder)
    with ahead.ahead(CHILD, lambda: str(file)):
        mine.take("kernel", file.parent / "key")
        mine.end()
        awaited(lambda: file.exists() and file.read_text())
    assert not (folder / "executed").exists()
    subprocess.run([sys.executable, "-m", "json"], check=False)  # the check that must fail
    assert (folder / "executed").exists()


@pytest.mark.parametrize(("folder", "own"), [("site-packages", False), ("source", True)])
def test_installed_packages_do_not_come_before_the_standard_library(tmp_path, monkeypatch, folder, own):
    root = tmp_path.resolve() / folder
    monkeypatch.setattr(ahead, "__file__", str(root / "porescale" / "common" / "compiled" / "ahead.py"))
    monkeypatch.setenv("PYTHONPATH", "given")
    assert ahead._paths().split(os.pathsep) == [str(root)] * own + ["given"]


def test_one_that_is_ended_while_it_compiles_leaves_no_lock(process, module):
    mine, file = process
    with ahead.ahead(module(COMPILES), lambda: str(file.parent)):
        mine.take("kernel", file.parent / "kernel")
        mine.end()
        awaited((file.parent / "begun").exists)  # the file of a lock is there a moment before the lock is held
        assert (file.parent / f"key{SUFFIX}").exists()
    assert list(file.parent.glob(f"*{SUFFIX}")) == []


def test_it_ends_when_the_first_is_killed(tmp_path):
    file, quiet = tmp_path / "number", subprocess.DEVNULL
    code = (
        f"import json, time\nfrom porescale.common.compiled import ahead\n"
        f"started = ahead._start({CHILD!r}, {str(file)!r})\ntime.sleep(600)"
    )
    first = subprocess.Popen([sys.executable, "-c", code], stdout=quiet, stderr=quiet)
    try:
        number = int(awaited(lambda: file.exists() and file.read_text()))
        assert alive(number)
    finally:
        first.kill()
        first.wait(60)
    awaited(lambda: not alive(number))


def alive(number: int) -> bool:
    """Whether a process runs, zombies left out."""
    return psutil.pid_exists(number) and psutil.Process(number).status() != psutil.STATUS_ZOMBIE
