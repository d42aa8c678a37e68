"""Registers: rows of evidence by name, registered in the files that make them and found by looking into a folder."""

import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, ClassVar, Generic, Protocol, TypeVar

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.register import entries


class Named(Protocol):
    """What a register holds: anything with a name, ``topic.what`` where several rows belong to one topic."""

    @property
    def name(self) -> str:
        """The name that the row is chosen by."""


T = TypeVar("T", bound=Named)


class Register(Generic[T]):
    """Rows in the order of registration; each name occurs once.

    what : the word for one row in error messages.
    """

    what: ClassVar[str] = "row"

    def __init__(self, rows: Iterable[T] = ()) -> None:
        self._rows: dict[str, T] = {}
        self.include(rows)

    def add(self, row: T) -> None:
        """Register one row, whose name must be new."""
        assert row.name not in self._rows, f"two rows named {row.name}"
        self._rows[row.name] = row

    def include(self, rows: Iterable[T]) -> None:
        """Add all rows of another register, or of a list."""
        for row in rows:
            self.add(row)

    def __iter__(self) -> Iterator[T]:
        return iter(self._rows.values())

    def __getitem__(self, name: str) -> T:
        return self._rows[choose([name], self._rows, self.what)[0]]

    def chosen(self, names: Sequence[str] = ()) -> list[T]:
        """Rows by name, all of them without names; InputError on unknown names, suggesting the nearest."""
        return [self._rows[name] for name in choose(names, self._rows, self.what)]


def choose(requested: Sequence[str], known: Iterable[str], what: str) -> list[str]:
    """Names in ``known`` that ``requested`` selects, in the order of ``known``; all of them if ``requested`` is empty.

    A name stands for itself and for all below it: ``lbm`` for ``lbm.poiseuille``.  Raises InputError with one
    fault for each name that stands for nothing.
    """
    names = list(known)
    below = {name: [other for other in names if other == name or other.startswith(f"{name}.")] for name in requested}
    topics = {name.partition(".")[0] for name in names}
    unknown = [name for name, found in below.items() if not found]
    if unknown:
        from porescale.common.schema.messages import nearest  # brings pydantic, for which --help must not wait

        repair = {name: nearest(name, [*names, *topics], "names", topics) for name in unknown}
        raise InputError([Fault(name, None, f"no such {what}", repair=repair[name]) for name in unknown])
    wanted = {other for found in below.values() for other in found}
    return [name for name in names if not requested or name in wanted]


def what_raised(raised: Exception) -> str:
    """The class and text of an exception on one line, with the function and line that raised it."""
    place = traceback.extract_tb(raised.__traceback__)[-1]
    text = " ".join(str(raised).split())
    return f"{type(raised).__name__}: {text} ({place.name}, line {place.lineno})"


def discovered(package: str, name: str) -> Callable[[], Any]:
    """A function that joins the registers called ``name`` of all modules below ``package``, imported when it is called.

    A file that is added to the folder adds its rows.
    """

    def joined() -> Any:
        """One register of the same class with the rows of all."""
        found = list(entries(package, name))
        return type(found[0])(row for register in found for row in register)

    return joined
