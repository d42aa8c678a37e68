"""What differs between two scenes."""

from collections.abc import Iterator, Mapping
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.html import html_table
from porescale.common.record.read_card import scene_folder
from porescale.common.schema.describe import clipped, differences
from porescale.common.schema.messages import dotted
from porescale.common.schema.sections import Section, validate

SHOWN = 3
"""Lines of repr."""


class Diff(Mapping[str, tuple[Any, Any]]):
    """What differs between two scenes a and b: key -> (value in a, value in b), None where there is none; SI.

    Empty where they are equal.  ``print`` shows all of it, repr the first lines, a notebook a table.
    """

    def __init__(self, rows: Mapping[str, tuple[Any, Any]], units: Mapping[str, str]) -> None:
        self._rows, self._units = dict(rows), dict(units)

    def __getitem__(self, key: str) -> tuple[Any, Any]:
        """Both values of a key that differs."""
        return self._rows[key]

    def __iter__(self) -> Iterator[str]:
        """Keys that differ, in the order of the scene."""
        return iter(self._rows)

    def __len__(self) -> int:
        """How many keys differ."""
        return len(self._rows)

    def __str__(self) -> str:
        """A line for each key."""
        return "\n".join(self._lines()) or "no difference"

    def __repr__(self) -> str:
        """At most three lines."""
        lines = list(self._lines())
        if len(lines) > SHOWN:
            lines = [*lines[: SHOWN - 1], f"… {len(lines) - SHOWN + 1} more: print it"]
        return "\n".join(lines) or "no difference"

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        rows = [(key, _text(a), _text(b), self._units[key]) for key, (a, b) in self.items()]
        return html_table("", ("key", "a", "b", "unit"), rows) if rows else "<p>no difference</p>"

    def _lines(self) -> Iterator[str]:
        wide = max(map(len, self), default=0)
        for key, (a, b) in self.items():
            yield clipped(f"{key:{wide}}  {_text(a)} -> {_text(b)} {self._units[key]}".rstrip())


def diff(a: Any, b: Any, scene_type: type[Section]) -> Diff:
    """What differs between two scenes, or runs with a card; InputError where one is neither."""
    rows = list(differences(_scene(a, scene_type), _scene(b, scene_type)))
    return Diff({dotted(key): (one, other) for key, one, other, _ in rows}, {dotted(it[0]): it[3] for it in rows})


def _scene(given: Any, scene_type: type[Section]) -> Section:
    """The scene itself, or that on the card of a run."""
    if isinstance(given, scene_type):
        return given
    card = getattr(given, "card", None)
    if isinstance(card, Mapping) and isinstance(card.get("scene"), Mapping):
        return validate(scene_type, card["scene"], folder=scene_folder(card))
    problem = "is neither a scene nor a run of this package"
    raise InputError(Fault("diff", type(given).__name__, problem, repair="load or open it first"))


def _text(value: Any) -> str:
    """A value to the last bit; a dash for none."""
    return "–" if value is None else repr(value)
