"""A seal at the end of a file: what was written, byte for byte, or the file is refused.

The last bytes of a sealed file are ``MARK`` and the SHA-256 digest, 32 bytes, of all before them.  HDF5 knows where its
part ends and does not read what follows, so that programs that know nothing of seals read a sealed file as before.
Checksums of single datasets would leave out attributes, names, types, and the tables that lead to them.  A seal is
compared by who asks `sealed`: a resume does, `checkpoint.read_header`, which reads how far a run came, does not.
"""

import hashlib
from pathlib import Path
from typing import Protocol

MARK = b"\nsha256:"
PIECE = 1 << 20
"""Bytes read at once."""
LENGTH = len(MARK) + 32


class Readable(Protocol):
    """A binary file, as far as a seal needs it."""

    def seek(self, offset: int, whence: int = 0, /) -> int:
        """Go to a place; returns it."""

    def read(self, size: int = -1, /) -> bytes | None:
        """The next ``size`` bytes."""


def seal_of(file: Readable, size: int) -> bytes:
    """The seal of the first ``size`` bytes of a file, from its beginning on."""
    digest = hashlib.sha256()
    file.seek(0)
    while size > 0:
        piece = file.read(min(PIECE, size))
        if not piece:
            break
        digest.update(piece)
        size -= len(piece)
    return MARK + digest.digest()


def sealed(path: Path) -> bool | None:
    """Whether the file at ``path`` is as it was sealed; None: it has no seal.  OSError where it cannot be read."""
    with open(path, "rb") as file:
        size = file.seek(0, 2) - LENGTH
        if size < 0:
            return None
        file.seek(size)
        found = file.read(LENGTH)
        return found == seal_of(file, size) if found.startswith(MARK) else None
