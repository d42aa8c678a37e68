"""From pydantic's errors to readable faults: dotted keys, units, ranges, and the nearest known name."""

import difflib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from porescale.common.core.errors import Fault
from porescale.common.schema.quantity import Quantity, in_this_range

Key = tuple[str | int, ...]


def dotted(key: Key) -> str:
    """``("grains", 1, "radius")`` as ``grains[1].radius``."""
    text = ""
    for part in key:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def nearest(name: str, known: Iterable[str], what: str = "keys", listed: Iterable[str] | None = None) -> str:
    """A repair for an unknown name: the nearest known one, else all that are ``listed``, or all of them."""
    names = sorted(set(known))
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    if close:
        return f"did you mean {close[0]!r}?"
    names = names if listed is None else sorted(listed)
    return f"known {what}: {', '.join(names)}" if names else f"there are no {what} here"


def translate(error: ValidationError, scene_type: type[BaseModel], data: Mapping[str, Any]) -> list[tuple[Key, Fault]]:
    """Every error of validating ``data`` as ``scene_type``: faults with their keys, in the fields' order."""
    found: list[tuple[Key, Fault]] = []
    short: set[Key] = set()
    branches: dict[Key, int] = {}  # where the first branch of a union was reported
    for item in error.errors(include_url=False):
        key, owners, field, in_branch = _locate(item, scene_type, data)
        raised = getattr(item.get("ctx", {}).get("error"), "faults", None)
        if raised is not None:
            found += [_placed(key, fault) for fault in raised]
            continue
        fault = _fault(item, key, owners, field, scene_type)
        if in_branch and key in branches:
            at = branches[key]
            first = found[at][1]
            if fault.problem not in first.problem:
                found[at] = (key, replace(first, problem=f"{first.problem}, or {fault.problem}"))
            continue
        if in_branch:
            branches[key] = len(found)
        found.append((key, fault))
        if item["type"] == "too_short":
            short.add(key)
    # a list whose only entry is wrong is not short: its entry is told
    return [it for it in found if it[0] not in short or not any(_below(key, it[0]) for key, _ in found)]


def _below(key: Key, above: Key) -> bool:
    """Whether a ``key`` lies within the section or list at ``above``."""
    return len(key) > len(above) and key[: len(above)] == above


PLAIN = {"int_type": "is not a whole number", "int_parsing": "is not a whole number",
         "int_from_float": "is not a whole number", "string_too_short": "is empty"}  # fmt: skip
"""Problems in other words than pydantic's, which speak of validation and parsing."""
LONGEST_INDEX = 9
"""Digits: what is longer counts nothing, and is a name."""


def parse_key(text: str) -> Key:
    """``grains[1].radius`` or ``grains.1.radius`` as ``("grains", 1, "radius")``."""
    parts = text.replace("[", ".").replace("]", "").split(".")
    return tuple(int(part) if part.isdecimal() and len(part) <= LONGEST_INDEX else part for part in parts)


def _placed(key: Key, fault: Fault) -> tuple[Key, Fault]:
    """A fault raised by the section at ``key``, with the whole key."""
    inner = parse_key(fault.key.lstrip(".")) if fault.key else ()
    whole = (*key, *(part for part in inner if part != ""))
    return whole, replace(fault, key=dotted(whole) or "scene")


def _fault(
    item: Mapping[str, Any], key: Key, owners: Sequence[type[BaseModel]], field: FieldInfo | None, root: type[BaseModel]
) -> Fault:
    """Fault made from one pydantic error."""
    kind, context, value = item["type"], item.get("ctx", {}), item["input"]
    shown = value if isinstance(value, str | int | float) else None
    marked = next((mark for mark in field.metadata if isinstance(mark, Quantity)), None) if field else None
    unit, allowed = (marked.unit, marked.allowed()) if marked else ("", "")
    help = (field.description or "") if field else ""
    name = dotted(key) or "scene"
    if kind == "missing" and isinstance(key[-1], int):
        return Fault(dotted(key[:-1]), None, f"entry [{key[-1]}] is missing", unit, allowed)
    if kind == "missing":
        a_section = field is not None and any(True for _ in sections_in(field.annotation))
        several = field is not None and get_origin(field.annotation) in (tuple, list)
        header = f"[[{name}]]" if several else f"[{name}]"
        repair = f"add {header}" if a_section else f"add {key[-1]} = …"
        return Fault(name, None, "is missing", unit, allowed, f"{repair} ({help})" if help else repair)
    if kind == "too_short" and field is not None and any(True for _ in sections_in(field.annotation)):
        count, least = context["actual_length"], context["min_length"]
        return Fault(name, None, f"holds {count} of the {least} that it needs", repair=f"add [[{name}]] ({help})")
    if kind == "extra_forbidden":
        tables = value if isinstance(value, list) and value else [value]
        what = "section" if all(isinstance(it, dict) for it in tables) else "key"
        return Fault(name, shown, f"unknown {what}", repair=_suggestion(str(key[-1]), owners, root))
    if kind in ("literal_error", "enum"):
        allowed = str(context["expected"])
        choices = [word.strip("'\" ") for part in allowed.split(" or ") for word in part.split(",")]
        return Fault(name, shown, "unknown choice", "", allowed, nearest(str(value), choices, "choices"))
    if kind == "union_tag_invalid":
        tags = [tag.strip("' ") for tag in str(context["expected_tags"]).split(",")]
        discriminator = str(context["discriminator"]).strip("'")
        repair = nearest(str(context["tag"]), tags, "choices")
        return Fault(f"{name}.{discriminator}", context["tag"], "unknown choice", "", ", ".join(tags), repair)
    if kind == "union_tag_not_found":
        discriminator = str(context["discriminator"]).strip("'")
        tags = sorted({tag for inner in sections_in(field.annotation) for tag in _tags(inner)}) if field else []
        repair = f"add {discriminator} = …"
        return Fault(f"{name}.{discriminator}", None, "is missing", "", ", ".join(tags), repair)
    if kind in ("model_type", "model_attributes_type", "dict_type") and isinstance(value, list):
        return Fault(name, None, "is a list, where there is one only", repair=f"write [{name}] once, its keys below")
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return Fault(name, shown, "is not a section", repair=f"write [{name}] and its keys below")
    if kind in ("bool_type", "bool_parsing"):
        return Fault(name, shown, "is neither true nor false", repair=f"give true or false ({help})" if help else "")
    if kind in ("tuple_type", "list_type") and isinstance(value, Mapping):
        return Fault(name, None, "is not a list", repair=f"write [[{name}]] and its keys below")
    if kind in ("tuple_type", "list_type"):
        return Fault(name, shown, "is not a list", unit, allowed, "write it as [ … ]")
    if kind in ("too_short", "too_long"):
        few = kind == "too_short"
        bound = context["min_length" if few else "max_length"]
        belong = f"at {'least' if few else 'most'} {bound} {'belongs' if bound == 1 else 'belong'}"
        problem = f"has {context['actual_length']} entries where {belong}"
        return Fault(name, value if isinstance(value, list) else shown, problem, unit, allowed, _give(help))
    for sign, bound in ((">", "gt"), (">=", "ge"), ("<", "lt"), ("<=", "le")):
        if bound in context:
            repair = in_this_range(_give(help)) if help else ""
            return Fault(name, shown, "is out of range", unit, f"{sign} {context[bound]}", repair)
    problem = str(item["msg"]).removeprefix("Value error, ").removeprefix("Assertion failed, ")
    problem = problem[:1].lower() + problem[1:]
    given = value if isinstance(value, list | dict) else shown
    problem = PLAIN.get(kind, problem.replace("input should be", "should be"))
    return Fault(name, given, problem, unit, allowed, _give(help))


def _give(help: str) -> str:
    """What to do about a wrong value, by what the field's help says that it is."""
    asks = help.partition(" ")[0] in ("which", "how", "what", "whether")
    return f"give {'' if asks else 'the '}{help}" if help else ""


def _suggestion(name: str, owners: Sequence[type[BaseModel]], root: type[BaseModel]) -> str:
    """What ``name`` follows from where that is known; else the nearest known key beside it; else the section that has a
    key of that name; else all known keys."""
    for owner in owners:
        if name in (instead := getattr(owner, "follows", {})):
            return f"it follows from {instead[name]}"
    known = {alias for owner in owners for alias in _fields(owner)}
    if not difflib.get_close_matches(name, known, n=1, cutoff=0.6):
        elsewhere = [place for place in every_key(root) if place[-1] == name]
        if elsewhere:
            return f"did you mean {' or '.join(dotted(place) for place in elsewhere[:3])}?"
    return nearest(name, known)


def _locate(
    item: Mapping[str, Any], root: type[BaseModel], data: Any
) -> tuple[Key, list[type[BaseModel]], FieldInfo | None, bool]:
    """Key of a pydantic error, the section types its last part belongs to, its field, and whether pydantic
    was trying one branch of a union (whose name, which is no part of the key, is then in the location).
    """
    location, real_end = item["loc"], item["type"] in ("missing", "extra_forbidden")
    key: Key = ()
    owners, inner, field, in_branch = [root], [root], None, False
    for index, part in enumerate(location):
        last = index == len(location) - 1
        here = (isinstance(data, Mapping) and part in data) or (
            isinstance(data, list | tuple) and isinstance(part, int) and part < len(data)
        )
        if not here and not (last and real_end):
            tagged = [owner for owner in inner if part == owner.__name__ or part in _tags(owner)]
            inner, in_branch = tagged or inner, in_branch or not tagged
            continue
        key = (*key, part)
        data = data[part] if here else None
        if isinstance(part, str):
            owners = inner
            field = next((_fields(owner)[part] for owner in owners if part in _fields(owner)), None)
            inner = list(sections_in(field.annotation)) if field else []
    return key, owners, field, in_branch


def _fields(owner: type[BaseModel]) -> dict[str, FieldInfo]:
    """Fields of a section by the name they have in a file."""
    return {field.alias or name: field for name, field in owner.model_fields.items()}


def _tags(owner: type[BaseModel]) -> set[Any]:
    """Words that choose this section among others of a union."""
    return {tag for field in owner.model_fields.values() for tag in get_args(field.annotation) if isinstance(tag, str)}


def sections_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """Section types that a field of this annotation may hold, through unions, lists, tuples and tables."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from sections_in(part)


def every_key(scene_type: type[BaseModel], above: tuple[type[BaseModel], ...] = ()) -> Iterator[Key]:
    """All keys of a scene type, without list indices; a section within itself is entered once."""
    for name, field in _fields(scene_type).items():
        yield (name,)
        for inner in dict.fromkeys(sections_in(field.annotation)):
            if inner not in (*above, scene_type):
                for key in every_key(inner, (*above, scene_type)):
                    yield (name, *key)
