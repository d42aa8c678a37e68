"""A field of a section that measures something: its unit, its range, and the error message when it is wrong."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

import pydantic
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticUndefined, core_schema

from porescale.common.core.errors import Fault
from porescale.common.core.ranges import Range
from porescale.common.core.units import to_si

NUMBER = r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?.*$"
"""Texts that may stand for a number without unit: also 5 %."""
WITH_UNIT = NUMBER.replace(".*$", r"(\s*[^\s\d.+-]|\s+\S).*$")
"""Texts that may stand for a number with a unit; which units measure the same thing, a pattern cannot say."""


def in_this_range(repair: str) -> str:
    """``repair`` with these words after what is asked for, before what else is said of it (not within brackets)."""
    first, *rest = re.split(r"(?=[,;:] )(?![^(]*\))", repair, maxsplit=1)
    return f"{first} in this range{''.join(rest)}"


class Refused(ValueError):
    """Faults that a validator found.  Keys are relative to its section; "" is the section itself.

    Raise it from a pydantic validator, or an `InputError`, which is taken the same way: every fault then
    comes out in one list with all others of the file.
    """

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__("; ".join(fault.line() for fault in faults))


@dataclass(frozen=True)
class Quantity(Range):
    """Marks a number, or every number of a tuple or list, as a quantity in ``unit`` with a range.

    As an annotation, ``Annotated[float, Quantity("m", gt=0)]``, or through `quantity`.  Words of a Literal in
    the same field (``float | Literal["auto"]``) and None, where the field allows it, pass.
    """

    help: str = ""

    def repair(self) -> str:
        """How to correct a wrong value, as text."""
        form = f'give it in {self.unit}, as 1.5 or "1.5 {self.unit}"' if self.unit else "give it as a number"
        return f"{form} ({self.help})" if self.help else form

    def fault(self, key: str, value: Any, problem: str, repair: str = "") -> Fault:
        """A fault of this quantity at ``key``."""
        shown = value if isinstance(value, int | float | str) else None
        return Fault(key, shown, problem, self.unit, self.allowed(), repair or self.repair())

    def convert(self, value: Any, key: str = "", words: frozenset[str] = frozenset()) -> Any:
        """``value`` with every number and text in it as SI numbers; raises `Refused` with all faults."""
        if isinstance(value, list | tuple):
            parts: list[Any] = []
            faults: list[Fault] = []
            for index, part in enumerate(value):
                try:
                    parts.append(self.convert(part, f"{key}[{index}]", words))
                except Refused as refused:
                    faults += refused.faults
            if faults:
                raise Refused(*faults)
            return parts
        if isinstance(value, str) and value in words:
            return value
        try:
            number = to_si(value, self.unit)
        except ValueError as error:
            fault = self.fault(key, value, str(error))
            choices = [*(f'"{word}"' for word in sorted(words)), *filter(None, [fault.allowed])]
            raise Refused(replace(fault, allowed=", ".join(choices)) if words else fault) from None
        if not self.contains(number):
            repair = in_this_range(f"give {'the ' + self.help if self.help else 'a value'}")
            if self.unit == "rad" and isinstance(value, int | float) and self.contains(math.radians(value)):
                repair += f'; degrees are written as "{value:g} deg"'
            raise Refused(self.fault(key, value, "is out of range", repair))
        return number

    def text_or(self, schema: dict[str, Any]) -> dict[str, Any]:
        """A JSON schema with, for every number in it, one of a number in the range or a text with a unit."""
        if schema.get("type") in ("number", "integer"):
            bounds = {"exclusiveMinimum": self.gt, "minimum": self.ge, "exclusiveMaximum": self.lt, "maximum": self.le}
            given = {name: bound for name, bound in bounds.items() if bound is not None}
            texts = {"type": "string", "pattern": WITH_UNIT if self.unit else NUMBER}
            about = {name: it for name, it in schema.items() if name != "type"}
            return {**about, "anyOf": [{"type": schema["type"], **given}, texts]}
        made = dict(schema)
        if isinstance(made.get("items"), dict):
            made["items"] = self.text_or(made["items"])
        for name in ("anyOf", "prefixItems"):
            if name in made:
                made[name] = [self.text_or(it) for it in made[name]]
        return made

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: pydantic.GetJsonSchemaHandler) -> dict[str, Any]:
        """What a file may say: numbers, or texts with a unit."""
        return {**self.text_or(handler(core)), "description": self.about()}

    def about(self) -> str:
        """What it is, its unit and its range."""
        allowed = self.allowed()
        return ", ".join(filter(None, (self.help, self.unit, f"allowed: {allowed}" if allowed else "")))

    def __get_pydantic_core_schema__(self, source: Any, handler: pydantic.GetCoreSchemaHandler) -> CoreSchema:
        """Conversion first, then what pydantic checks for the annotated type (shape, integers, choices)."""
        words, optional = frozenset(_words(source)), _is_optional(source)

        def convert(value: Any) -> Any:
            """The value in SI; Refused where it is no number, has another unit or is out of range."""
            return None if value is None and optional else self.convert(value, "", words)

        return core_schema.no_info_before_validator_function(convert, handler(source))


def quantity(
    unit: str = "",
    default: Any = PydanticUndefined,
    *,
    gt: float | None = None,
    ge: float | None = None,
    lt: float | None = None,
    le: float | None = None,
    help: str = "",
) -> Any:
    """A section's field in ``unit``: ``spacing: float = quantity("m", gt=0, help="cell size")``.

    Bounds are in ``unit`` and hold for every number of a tuple or list.  Without ``default`` (a number, a
    text with a unit, or None where the type allows it) the key is required.  ``help`` completes "give the …".
    """
    mark = Quantity(unit, gt, ge, lt, le, help)
    info: FieldInfo = pydantic.Field(default, description=help or None, json_schema_extra={"description": mark.about()})
    info.metadata.append(mark)
    return info


def _members(annotation: Any) -> Iterator[Any]:
    """Members of a union, seen through tuples, lists and Annotated."""
    origin = get_origin(annotation)
    if origin in (Union, UnionType) or (isinstance(origin, type) and issubclass(origin, list | tuple)):
        for part in get_args(annotation):
            yield from _members(part)
    elif hasattr(annotation, "__metadata__"):
        yield from _members(get_args(annotation)[0])
    else:
        yield annotation


def _words(annotation: Any) -> Iterator[str]:
    """Words that a Literal in ``annotation`` allows."""
    for member in _members(annotation):
        if get_origin(member) is Literal:
            yield from (word for word in get_args(member) if isinstance(word, str))


def _is_optional(annotation: Any) -> bool:
    """Whether None is allowed as the whole value."""
    return get_origin(annotation) in (Union, UnionType) and type(None) in get_args(annotation)
