"""Sections as people read them: in a few lines, as a table, and what differs between two of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from porescale.common.core.html import html_table
from porescale.common.schema.messages import Key, dotted
from porescale.common.schema.quantity import Quantity

WIDEST = 118
"""Characters of a line."""
MOST = 3
"""Entries of a list of sections that are shown."""


@dataclass(frozen=True)
class Entry:
    """A value of a section with its whole key;  unit : SI, "" if none;  help : what it is;  given : not the default."""

    key: Key
    value: Any
    unit: str
    help: str
    given: bool


def entries(section: BaseModel, above: Key = ()) -> Iterator[Entry]:
    """Every value of a section and of those within it, in their order."""
    for name, field in type(section).model_fields.items():
        value, key = getattr(section, name), (*above, field.alias or name)
        if isinstance(value, BaseModel):
            yield from entries(value, key)
        elif _sections(value):
            for index, below in enumerate(value):
                yield from entries(below, (*key, index))
        else:
            given = field.is_required() or value != field.get_default(call_default_factory=True)
            yield Entry(key, value, unit_of(field), field.description or "", given)


def unit_of(field: FieldInfo) -> str:
    """SI unit of a field, "" if it has none."""
    return next((mark.unit for mark in field.metadata if isinstance(mark, Quantity)), "")


def in_a_line(section: BaseModel) -> str:
    """A section in one line: what of it is not as by default."""
    parts = []
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        if field.is_required() or value != field.get_default(call_default_factory=True):
            parts.append(f"{field.alias or name}={_short(value)}{f' {unit}' if (unit := unit_of(field)) else ''}")
    return clipped(f"{type(section).__name__}({', '.join(parts)})")


def in_lines(scene: BaseModel, name: str, quality: str | None) -> str:
    """A scene in at most three lines: name, level and title; its sections; the keys that every such scene gives."""
    title = getattr(scene, "title", "")
    first = (
        (f"Scene {name!r}" if name else "Scene")
        + (f" ({quality})" if quality else "")
        + (f": {title}" if title else "")
    )
    sections = []
    for field in type(scene).model_fields:
        value = getattr(scene, field)
        if isinstance(value, BaseModel):
            sections.append(field)
        elif _sections(value):
            sections.append(f"{field} ({len(value)})" if len(value) > 1 else field)
    numbers = [f"{dotted(it.key)} = {_short(it.value)} {it.unit}".rstrip() for it in entries(scene)
               if it.given and it.unit and len(it.key) == 2]  # fmt: skip
    return "\n".join(clipped(line) for line in (first, f"sections: {', '.join(sections)}", ", ".join(numbers)))


def as_html(section: BaseModel, caption: str) -> str:
    """A section as a table of keys, values, units and what they are; what is as by default is counted only."""
    rows, left = [], 0
    for it in entries(section):
        hidden = any(isinstance(part, int) and part >= MOST for part in it.key)
        if it.given and not hidden:
            rows.append((dotted(it.key), _short(it.value), it.unit, it.help))
        left += not it.given or hidden
    foot = f"<p>{left} more keys, of long lists or as by default: to_dict()</p>" if left else ""
    return html_table(caption, ("key", "value", "unit", ""), rows) + foot


def differences(a: Any, b: Any, key: Key = (), unit: str = "") -> Iterator[tuple[Key, Any, Any, str]]:
    """Every key whose values differ, with both and the unit; of a section that one has not, all that the other's has.

    What is not there is None.
    """
    if a == b:
        return
    one = a if isinstance(a, BaseModel) else b
    if isinstance(one, BaseModel) and (a is None or b is None or type(a) is type(b)):
        for name, field in type(one).model_fields.items():
            left, right = getattr(a, name, None), getattr(b, name, None)
            yield from differences(left, right, (*key, field.alias or name), unit_of(field))
    elif _sections(a or b) and (_sections(a) or not a) and (_sections(b) or not b):
        for index in range(max(len(a or ()), len(b or ()))):
            left, right = ((it or ())[index] if index < len(it or ()) else None for it in (a, b))
            yield from differences(left, right, (*key, index))
    else:
        yield key, a, b, unit


def clipped(text: str, widest: int = WIDEST) -> str:
    """``text``, cut where it is longer than a line."""
    return text if len(text) <= widest else f"{text[: widest - 1]}…"


def _sections(value: Any) -> bool:
    """Whether a value is a list of sections with an entry."""
    return isinstance(value, list | tuple) and bool(value) and isinstance(value[0], BaseModel)


def _short(value: Any) -> str:
    """A value in a few characters: six digits of a number, the first entries of a list."""
    if isinstance(value, BaseModel):
        return in_a_line(value)
    if isinstance(value, bool) or value is None:
        return str(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        few = [_short(part) for part in value[: MOST + 1]]
        return f"[{', '.join([*few, '…'] if len(value) > len(few) else few)}]"
    return clipped(repr(value) if isinstance(value, str) else str(value), 60)
