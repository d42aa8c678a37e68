"""Numbers as Fortran's list-directed input takes them: 5.0d-5, 1.0+8, 3*0.0, commas, records that run over lines.

A record begins on a new line, goes on over as many lines as it needs, and ends with its line.  After the first value of
a line a comment may follow: words that do not begin as a number does, or what comes after ! or #.  Lines without a
value are passed over, as are a byte-order mark and the control character that ends files of DOS.
"""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import given_bytes

REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[edEDqQ]([+-]?\d+)|([+-]\d+))?")
"""Mantissa, exponent after a letter, exponent without one."""
WHOLE = re.compile(r"[+-]?\d+")
BEGUN = re.compile(r"[-+]?[-+.]?\d|[-+]?(nan|inf)(inity)?$", re.IGNORECASE)
"""How a word begins that is meant as a number: a digit after signs or a point, or all of nan or inf."""
MARKS = ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig"))
REPEATED = re.compile(r"(\d+)\*(.+)")
LONGEST_WHOLE = 18
"""Digits of a whole number: all fit into 64 bits."""
MOST_REPEATS = 100_000
Field = tuple[str, type]


class Reader:
    """The records of one file, from its first on.

    Raises InputError, naming file, line, field and what was expected, at the first value that is missing, is no number,
    or is one too many; values that are not valid are collected by ``must``, see ``done``.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.line = 0  # of the last record, counted from 1
        self.faults: list[Fault] = []
        self._over: tuple[str, str] | None = None  # the first record that took more lines than usual: where, and what
        self._lines_of: dict[str, int] = {}  # of the values of the last record
        try:
            given = given_bytes(path)
        except OSError as error:
            raise InputError(Fault(str(path), problem=f"cannot be read ({error.strerror})")) from None
        encoding = next((name for mark, name in MARKS if given.startswith(mark)), "utf-8")
        self._lines = given.decode(encoding, errors="replace").rstrip("\x1a").splitlines()

    def record(self, *fields: Field, rows: int | None = 1) -> list[float]:
        """The values of the next record, one a field; whole ones where the field's type is int.

        rows : lines that it is commonly written on, None: one, or one for each value.  Every later fault begins with
        the first record that took more, as a line with too few values lets all later ones be read as what they are not.
        """
        values: list[float] = []
        self._lines_of = {}
        words: list[str] = []
        shared: list[tuple[int, int]] = []  # line, and how many of the record's values it has
        while len(values) < len(fields):
            self._note_over(fields, shared, rows)
            words, before = self._next_words(fields[len(values)][0], fields, shared), len(values)
            while words and len(values) < len(fields):
                if len(values) > before and not BEGUN.match(words[0]):
                    words = []  # a comment
                    break
                name, kind = fields[len(values)]
                values += self._values(words.pop(0), name, kind)
                self._lines_of.setdefault(name, self.line)
            shared.append((self.line, len(values) - before))
        if len(values) > len(fields) or (words and _number(words[0])):
            more = words[0] if len(values) == len(fields) else f"{values[-1]:g}"
            raise self._broken(
                f"after {fields[-1][0]}", more, "one value too many", "the end of the line, or a comment"
            )
        return values

    def _note_over(self, fields: Sequence[Field], shared: Sequence[tuple[int, int]], rows: int | None) -> None:
        """Keep what is said of a record that is not whole after its usual lines, if it is the first; see record."""
        if rows is None:
            rows = len(fields) if all(count == 1 for _, count in shared) else 1
        if self._over is not None or len(shared) < rows:
            return
        lines = " and ".join(str(line) for line, _ in shared[:rows])
        where, has = (f"line {lines}", "has") if rows == 1 else (f"lines {lines}", "have")
        count, names = sum(count for _, count in shared[:rows]), ", ".join(name for name, _ in fields)
        self._over = where, f"{has} {count} of the {len(fields)} values {names}"

    def must(self, fine: bool, name: str, value: float, expected: str) -> None:
        """Note a fault of the field ``name`` of the last record unless it is ``fine``."""
        if not fine:
            shown = int(value) if float(value).is_integer() and abs(value) < 1e15 else value
            self.faults.append(self._fault(name, shown, "makes no sense", expected))

    @property
    def begun(self) -> int:
        """Line that the last record begins on, from 1."""
        return min(self._lines_of.values(), default=self.line)

    def more(self) -> bool:
        """Whether another record follows."""
        return any(_words(self._lines[k]) for k in range(self.line, len(self._lines)))

    def done(self) -> None:
        """Raise InputError if ``must`` noted faults, or if records are left over."""
        if self.faults:
            raise InputError(self.faults)
        for k in range(self.line, len(self._lines)):
            words = _words(self._lines[k])
            if words and _number(words[0]):
                self.line = k + 1
                raise self._broken("after the last record", words[0], "one value too many", "the end of the file")

    def _next_words(self, name: str, fields: Sequence[Field], shared: Sequence[tuple[int, int]]) -> list[str]:
        while self.line < len(self._lines):
            self.line += 1
            if words := _words(self._lines[self.line - 1]):
                return words
        began = (
            f"a number, for the record that line {shared[0][0]} begins with {fields[0][0]}" if shared else "a number"
        )
        raise self._broken(name, None, "the file ends here", began)

    def _values(self, word: str, name: str, kind: type) -> list[float]:
        again = REPEATED.fullmatch(word)
        times, text = (int(again[1]), again[2]) if again else (1, word)
        if times > MOST_REPEATS:
            raise self._broken(name, word, "too many repeats", f"at most {MOST_REPEATS}")
        if kind is int:
            if not WHOLE.fullmatch(text):
                raise self._broken(name, word, "is no whole number", "a whole number")
            if len(text) > LONGEST_WHOLE:
                raise self._broken(name, word, "is too large", f"at most {LONGEST_WHOLE} digits")
            return [int(text)] * times
        found = REAL.fullmatch(text)
        if not found:
            raise self._broken(name, word, "is no number", "a number such as 5.0d-5")
        value = float(f"{found[1]}e{found[2] or found[3] or 0}")
        if not math.isfinite(value):
            raise self._broken(name, word, "is too large", "a number below 1.8d308")
        return [value] * times

    def _broken(self, name: str, value: str | None, problem: str, expected: str) -> InputError:
        return InputError([*self.faults, self._fault(name, value, problem, expected)])

    def _fault(self, name: str, value: object, problem: str, expected: str) -> Fault:
        line = self._lines_of.get(name, max(self.line, 1))
        found = Fault(f"line {line}, {name}", value, f"{problem}, expected {expected}")
        if self._over is not None:
            where, what = self._over
            found = Fault(where, None, f"{what}; then {found.line()}")
        return replace(found, file=str(self.path))


def _words(line: str) -> list[str]:
    return re.split(r"[!#]", line, maxsplit=1)[0].replace(",", " ").split()


def _number(word: str) -> bool:
    again = REPEATED.fullmatch(word)
    return REAL.fullmatch(again[2] if again else word) is not None


def real(value: float) -> str:
    """A number that reads back to the same bits, here and in Fortran."""
    return repr(float(value)).replace("e", "d")


def table(rows: Sequence[Sequence[float | int]]) -> str:
    """Lines of numbers: whole ones as such, others as ``real``."""
    return "".join(" ".join(str(v) if isinstance(v, int) else real(v) for v in row) + "\n" for row in rows)


def plain(rows: Iterable[Sequence[float | int]]) -> str:
    """Lines of numbers with an e for the exponent, as plotting programs read them."""
    return table(list(rows)).replace("d", "e")
