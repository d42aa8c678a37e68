"""What may be lost at any time and made again: the folder for it, and hashes that say what it was made from."""

import hashlib
import os
import shutil
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

DAY = 86400.0
"""Seconds of a day."""


def cache_root() -> Path:
    """``$XDG_CACHE_HOME/porescale``, or ``~/.cache/porescale`` where the variable is unset or empty.  Not made here."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "porescale"


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
    """Whether files may be put into ``folder``, which is made if it does not exist."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK | os.X_OK)


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


def mark_used(path: Path) -> None:
    """Mark a file or folder as used now; best effort, it need not exist."""
    with suppress(OSError):
        os.utime(path)
