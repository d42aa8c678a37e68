"""What may be lost at any time and made again: the folder for it, and hashes that say what it was made from."""

import errno
import hashlib
import os
import shutil
import time
import warnings
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from porescale.common.core.errors import PorescaleWarning

DAY = 86400.0
"""Seconds of a day."""
ROOM = 2**25
"""Free bytes without which no kernels are kept: the run would end half-way, without room for them."""


def cache_root() -> Path:
    """``$XDG_CACHE_HOME/porescale``, or ``~/.cache/porescale`` where the variable is unset or empty.  Not made here.

    A place that cannot be made where the user has no home: no other folder is safe from other users.
    """
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "porescale"
    except RuntimeError:
        return Path(os.devnull) / "porescale"


def hash_of(folders: Iterable[Path]) -> str:
    """Hash (12 hex digits) of every Python source in ``folders``: names, from each folder's own on, and contents.

    The order of the folders counts; where they lie does not.
    """
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            content = path.read_bytes()
            digest.update(f"{path.relative_to(folder.parent).as_posix()}\0{len(content)}\0".encode())
            digest.update(content)
    return digest.hexdigest()[:12]


def writable(folder: Path) -> bool:
    """Whether kernels may be kept in ``folder``, which is made if it does not exist; warns where they may not."""
    reason = ""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or str(error)
    else:
        if not os.access(folder, os.W_OK | os.X_OK):
            reason = os.strerror(errno.EACCES)
        elif shutil.disk_usage(folder).free < ROOM:
            reason = f"less than {ROOM // 2**20} MiB are free"
    if Path(os.devnull) in folder.parents:
        reason = "the user has no home folder"
    if reason:
        text = f"{folder}: compiled kernels cannot be kept there ({reason}), so that every run compiles its own, which "
        text += "takes minutes; name another folder in NUMBA_CACHE_DIR"
        warnings.warn(text, PorescaleWarning, stacklevel=2)
    return not reason


def keep_only_used(current: Path, pattern: str, days: float = 30.0) -> None:
    """Mark the folder or file ``current`` as used now; remove its neighbours matching ``pattern`` unused for ``days``.

    Best effort: what cannot be marked or removed stays as it is.  ``current`` need not exist and is never removed.
    """
    with suppress(OSError):
        mark_used(current)
        for other in current.parent.glob(pattern):
            if other != current and other.stat().st_mtime < time.time() - days * DAY:
                if other.is_dir():
                    shutil.rmtree(other, ignore_errors=True)
                else:
                    other.unlink(missing_ok=True)


USED: list[str] = []
"""Names of what this process marked as used, kernels that were kept among them."""


def mark_used(path: Path) -> None:
    """Mark a file or folder as used now; best effort, it need not exist."""
    USED.append(path.name)
    with suppress(OSError):
        os.utime(path)
