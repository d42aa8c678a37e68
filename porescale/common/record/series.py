"""series.csv: one row per record, one column each, units in the column's name.

Numbers are written as ``repr`` does, so that reading gives the same bits.  Rows are appended; a kill leaves
at most one torn last line (no newline), which reading ignores and resuming cuts off.
"""

import csv
import io
import os
from pathlib import Path
from typing import IO

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray

NAME = "series.csv"
WORDS = frozenset({"body ()", "other body ()"})  # columns of names, of breaks.csv


class Series:
    """The growing series of a run.  ``length`` is the file's size in bytes so far."""

    def __init__(self, path: Path, keep: int = 0) -> None:
        """Go on in ``path`` after its first ``keep`` bytes; 0 starts anew.  InputError when it is shorter."""
        self.path = Path(path)
        require_length(self.path, keep)
        mode = "r+b" if keep else "wb"
        self._file: IO[bytes] = open(self.path, mode)  # noqa: SIM115  (stays open)
        self._file.truncate(keep)
        self._file.seek(keep)
        self.length = keep
        self.names: list[str] | None = _names(self.path) if keep else None

    def append(self, row: dict[str, float]) -> None:
        """Add one row; the first one of a file writes the names too.  InputError when the names differ."""
        if self.names is None:
            self.names = list(row)
            self._write(_line(self.names))
        if list(row) != self.names:
            differing = ", ".join(repr(name[:40]) for name in sorted(set(row) ^ set(self.names))[:3]) or "their order"
            problem = f"has other columns than the run ({differing})"
            raise InputError(Fault("series", str(self.path), problem, repair="start the run anew"))
        self._write(_line([repr(_plain(value)) for value in row.values()]))

    def sync(self) -> None:
        """Push what was appended to disk."""
        self._file.flush()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Sync to disk and close the file."""
        if not self._file.closed:
            self.sync()
            self._file.close()

    def _write(self, line: bytes) -> None:
        self.length += self._file.write(line)
        self._file.flush()


def require_length(path: Path, keep: int) -> None:
    """InputError unless the file has ``keep`` bytes or more."""
    size = path.stat().st_size if path.exists() else 0
    if size < keep:
        problem = f"has {size} bytes, the checkpoint needs {keep}"
        raise InputError(Fault("series", str(path), problem, repair="start the run anew"))


def _plain(value: float) -> float | int:
    """A Python number: ``repr`` of a numpy scalar would carry its type."""
    return int(value) if isinstance(value, int | np.bool_ | np.integer) else float(value)


def _line(cells: list[str]) -> bytes:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue().encode()


def _names(path: Path) -> list[str] | None:
    """The columns' names, None when the file is empty; InputError when it is no table."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            return next(csv.reader(file), None)
    except (UnicodeDecodeError, csv.Error):
        problem = "is damaged (its first line has no names of columns)"
        raise InputError(Fault("series", str(path), problem, repair="start the run anew")) from None


def run_table(folder: Path, name: str) -> dict[str, AnyArray]:
    """Columns of a table of the run in ``folder``, "series" for series.csv, as `read_series` has them."""
    return read_series(folder / f"{name}.csv")


def read_series(path: Path) -> dict[str, AnyArray]:
    """Columns by name, each (rows,) float64, or names of bodies (WORDS).

    A torn last line is ignored; no file or no rows give {}.

    InputError naming the line where a row is damaged.
    """
    path = Path(path)
    if not path.exists():
        return {}
    content = path.read_bytes()
    number = 0
    try:
        rows = list(csv.reader(io.StringIO(content[: content.rfind(b"\n") + 1].decode())))
        if not rows:
            return {}
        table = np.zeros((len(rows) - 1, len(rows[0])))
        words = [name in WORDS for name in rows[0]]
        for number, row in enumerate(rows[1:], 1):
            if len(row) != len(rows[0]):
                raise ValueError(f"{len(row)} cells for {len(rows[0])} columns")
            table[number - 1] = [0.0 if word else float(cell) for cell, word in zip(row, words, strict=True)]
    except (ValueError, csv.Error) as error:
        reason = " ".join(str(error).split())
        repair = "run it again, or take the file from a backup"
        fault = Fault(f"line {number + 1}", None, f"is damaged ({reason})", repair=repair, file=str(path))
        raise InputError(fault) from None
    return {
        name: np.array([row[k] for row in rows[1:]]) if words[k] else table[:, k].copy()
        for k, name in enumerate(rows[0])
    }
