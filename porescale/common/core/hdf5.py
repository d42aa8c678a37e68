"""HDF5 files that are written whole or not at all, also where the disk is full.

HDF5 cannot close a file whose last writes failed: the library crashes the process (2.0.0, and others before).  Its
writes therefore go through a file of ours, which stores the first error, reports success to
the library, and raises when the file is closed.
"""

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py

from porescale.common.core.atomic import whole
from porescale.common.core.seal import seal_of


class Forgiving(io.RawIOBase):
    """A new file whose writes never fail; ``trouble`` holds the first that should have."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._file = open(path, "w+b", buffering=0)  # noqa: SIM115  (stays open)
        self.trouble: OSError | None = None

    def write(self, content: Any) -> int:
        """All of ``content``, or a note that it could not be."""
        left = memoryview(content).cast("B")
        size = len(left)
        try:
            while left and self.trouble is None:
                left = left[self._file.write(left) :]
        except OSError as error:
            self.trouble = error
        if self.trouble is not None:
            self._file.seek(len(left), os.SEEK_CUR)
        return size

    def readinto(self, buffer: Any) -> int:
        """Fills ``buffer``; with zeros where nothing could be written."""
        view = memoryview(buffer).cast("B")
        found = self._file.readinto(view)
        view[found:] = bytes(len(view) - found)
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        """The file, cut or made longer."""
        try:
            return self._file.truncate(size)
        except OSError as error:
            self.trouble = self.trouble or error
            return size or 0

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Move the position in the file, as of any binary file; returns the new one."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Position in the file, bytes from its beginning."""
        return self._file.tell()

    def seekable(self) -> bool:
        """True: a file can always seek."""
        return True

    def close(self) -> None:
        """Close the file beneath."""
        self._file.close()
        super().close()


@contextmanager
def writing(path: Path, *, seal: bool = False, **options: Any) -> Iterator[h5py.File]:
    """A new HDF5 file that appears at ``path`` on leaving without error; ``options`` as for `h5py.File`.

    seal : whether it ends with a seal (seal.py).

    Raises OSError, with the file's name, when any write failed; then ``path`` is as it was.
    """
    with whole(path) as beside:
        made = Forgiving(beside)
        try:
            with h5py.File(made, "w", **options) as file:
                yield file
            if seal and made.trouble is None:
                made.write(seal_of(made, made.seek(0, os.SEEK_END)))
        finally:
            made.close()
        if made.trouble is not None:
            error = made.trouble
            raise OSError(error.errno, error.strerror, str(path)) from error
