"""One process compiles a kernel, others wait for it; the second process is there when needed, and leaves nothing."""

import subprocess
import sys

import pytest
from filelock import FileLock

from porescale.common.compiled import ahead, turns
from porescale.common.compiled.turns import LONGEST, SUFFIX, Turns
from tests.reference.waiting import awaited

CHILD = "tests.reference.second_process"


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
    import psutil

    return psutil.pid_exists(number) and psutil.Process(number).status() != psutil.STATUS_ZOMBIE
