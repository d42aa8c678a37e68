"""The columns of a table over time: a mapping of arrays that shows itself and becomes a pandas DataFrame."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from textwrap import shorten
from typing import TYPE_CHECKING

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.extras import extra
from porescale.common.core.html import html_table
from porescale.common.core.types import AnyArray

if TYPE_CHECKING:
    import pandas

TIME = "time (s)"
"""Name of the column of times, the first of every table of a run."""
WIDE = 110
"""Characters of a line in what tables and runs say of themselves."""
SHOWN = 4
"""Rows at either end of a table that notebooks show."""


class MissingColumn(InputError, KeyError):
    """There is no column or array of that name: the message names the nearest."""

    def __str__(self) -> str:
        """The message as it is; KeyError would quote it."""
        return "\n".join(fault.line() for fault in self.faults)


def missing(what: str, name: object, known: Iterable[str], where: str) -> MissingColumn:
    """The error for a name that is not among ``known`` names of columns or arrays."""
    from porescale.common.schema.messages import nearest

    return MissingColumn(Fault(what, str(name), f"is not in {where}", repair=nearest(str(name), known, f"{what}s")))


def split(column: str) -> tuple[str, str]:
    """Name and unit of a column: "front (m)" is ("front", "m")."""
    name, _, unit = column.rpartition(" (")
    return (name, unit.removesuffix(")")) if name else (column, "")


class Columns(Mapping[str, AnyArray]):
    """Columns of a table by name with unit ("time (s)", "front (m)"), each (rows,), in the file's order.

    name : of the table, "series" for series.csv.  A column that is not there raises MissingColumn, a KeyError, with the
    nearest name.
    """

    def __init__(self, columns: Mapping[str, AnyArray], name: str) -> None:
        self._columns, self.name = dict(columns), name

    def __getitem__(self, column: str) -> AnyArray:
        try:
            return self._columns[column]
        except KeyError:
            raise missing("column", column, self._columns, self.name) from None

    def __contains__(self, column: object) -> bool:
        return column in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows: the length of the first column, 0 without columns."""
        return len(next(iter(self._columns.values()), ()))

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a pandas DataFrame whose index is the time, in s; needs pandas (extra "notebook")."""
        frame: pandas.DataFrame = extra("pandas").DataFrame(self._columns)
        return frame.set_index(TIME) if TIME in self._columns else frame

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._columns)

    def __repr__(self) -> str:
        return f"{self._title()}\n{shorten(', '.join(self._columns), WIDE, placeholder=' …')}".rstrip()

    def _repr_html_(self) -> str:
        picked = range(self.rows) if self.rows <= 2 * SHOWN else [*range(SHOWN), *range(self.rows - SHOWN, self.rows)]
        rows: list[list[object]] = [[_shown(column[k]) for column in self._columns.values()] for k in picked]
        if self.rows > 2 * SHOWN:
            rows.insert(SHOWN, ["…"] * len(self))
        return html_table(self._title(), list(self._columns), rows)

    def _title(self) -> str:
        """Name, rows, columns and times in one line."""
        text = f"{self.name}: {self.rows} rows of {len(self)} columns"
        if self.rows and TIME in self._columns:
            text += f", {self[TIME][0]:.6g} to {self[TIME][-1]:.6g} s"
        return text


def _shown(value: object) -> str:
    """A number to six digits, or a word as it is."""
    return value if isinstance(value, str) else f"{value:.6g}"
