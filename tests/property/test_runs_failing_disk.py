"""Whatever call to the disk fails, and in whatever way, the run says so, and goes on later as if nothing had been."""

import errno
import resource
import signal
from contextlib import suppress
from pathlib import Path

import pytest

from porescale.common.core.errors import PorescaleError
from tests.reference.faults.failing_disk import Disk, calls, failing, whole
from tests.reference.same_run import differences
from tests.reference.toy_model import run_toy

SHORT = {"duration": 0.04, "checkpoint_seconds": 0.0}
TROUBLES = (errno.ENOSPC, errno.EIO, errno.EACCES)


@pytest.fixture(scope="module")
def untouched(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("disk") / "untouched"
    run_toy(folder, **SHORT)
    return folder


def survives(folder: Path, disk: Disk, untouched: Path) -> None:
    """A run on ``disk`` ends well or with an error that is no bug; resumed on a good one it is the untouched run."""
    with failing(disk), suppress(OSError, PorescaleError):
        run_toy(folder, **SHORT)
    whole(folder)
    run_toy(folder, **SHORT, resume=(folder / "card.json").exists())
    assert differences(folder, untouched) == []


@pytest.mark.parametrize("trouble", TROUBLES)
@pytest.mark.parametrize("sticky", [False, True])
def test_a_call_that_fails_loses_nothing(tmp_path, untouched, trouble, sticky):
    total = calls(tmp_path / "count", lambda folder: run_toy(folder, **SHORT))
    assert total > 200  # there is something to fail
    for nth in range(7 * TROUBLES.index(trouble) + 3 * sticky, total, 71):
        survives(tmp_path / f"run{nth}", Disk(tmp_path / f"run{nth}", nth, trouble, sticky), untouched)


@pytest.mark.slow
@pytest.mark.parametrize("trouble", TROUBLES)
def test_no_call_that_fails_loses_anything(tmp_path, untouched, trouble):
    for nth in range(calls(tmp_path / "count", lambda folder: run_toy(folder, **SHORT))):
        survives(tmp_path / f"run{nth}", Disk(tmp_path / f"run{nth}", nth, trouble, nth % 2 == 0), untouched)


@pytest.mark.parametrize("size", [0, 100, 1000, 3000, 10_000, 30_000])
def test_files_that_may_not_grow_lose_nothing(tmp_path, untouched, size):
    """The system itself refuses writes, those of HDF5's library too, as it does when the disk is full."""
    before, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.getsignal(signal.SIGXFSZ)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        with pytest.raises(OSError, match="File too large"):
            run_toy(tmp_path / "run", **SHORT)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    whole(tmp_path / "run")
    run_toy(tmp_path / "run", **SHORT, resume=(tmp_path / "run" / "card.json").exists())
    assert differences(tmp_path / "run", untouched) == []


def test_writing_in_place_would_lose_the_old_file(tmp_path):  # the twin that must fail
    file = tmp_path / "card.json"
    file.write_text("old")
    with failing(Disk(tmp_path, 1)) as disk:
        stream = open(file, "wb")  # noqa: SIM115
        stream.close()
        with pytest.raises(OSError, match="No space"):
            open(file, "ab")  # noqa: SIM115
    assert disk.called == ["file", "file"]
    assert file.read_text() == ""
