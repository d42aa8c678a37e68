"""Files that people name, read whole: what reading would not end of, or not fit into memory, cannot be read.

Also paths that people give in Python."""

import errno
import os
import stat
from pathlib import Path

from porescale.common.core.errors import Fault, InputError

STILLS = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm", ".webp")
"""Endings of files that are pictures."""
LARGEST = 256 * 2**20
"""Bytes of a file that is read whole: a list of a million circles has a tenth of it."""


def path_of(key: str, given: str | Path, repair: str) -> Path:
    """``given`` as a path; InputError, naming ``key``, where it is neither a text nor a path."""
    if isinstance(given, str | os.PathLike):
        return Path(given)
    raise InputError(Fault(key, str(given), f"is no path ({type(given).__name__})", repair=repair))


def require_finite(path: Path, most: int | None = None) -> None:
    """OSError, with a reason as the system's own, where ``path`` is a device or a pipe, or has over ``most`` bytes."""
    found = os.stat(path)
    if not (stat.S_ISREG(found.st_mode) or stat.S_ISDIR(found.st_mode)):
        raise OSError(errno.EINVAL, "is no regular file", str(path))
    if most is not None and found.st_size > most:
        problem = f"is too large: {found.st_size / 2**20:.0f} MiB, {most / 2**20:.0f} are allowed"
        raise OSError(errno.EFBIG, problem, str(path))


def given_bytes(path: Path) -> bytes:
    """What is in a file of at most ``LARGEST`` bytes; OSError, with its reason, where it cannot be read."""
    require_finite(path, LARGEST)
    return path.read_bytes()


def reason(error: Exception) -> str:
    """Why a file cannot be read: what the system says, or else the error itself (a null in a name, a broken table)."""
    return getattr(error, "strerror", None) or str(error)


def given_text(path: Path) -> str:
    """The text of such a file, with a byte-order mark or without; UnicodeDecodeError where it is not UTF-8."""
    return given_bytes(path).decode("utf-8-sig")
