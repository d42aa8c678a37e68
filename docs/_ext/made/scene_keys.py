"""Every key of a scene file: unit, range, default, meaning, and a value that a shipped case gives it."""

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from docs._ext.docstring import ROOT
from docs._ext.made.text import code, escaped, slug, table
from porescale.common.schema.json_schema import scene_schema

_ONE = r"[kMmuµn]?(m|g|s|N|Pa|J|W|K|rad|Hz)(\^-?\d|[²³])?"
UNIT = re.compile(rf"^(-|%|°|deg|px|{_ONE}([ /*]\(?{_ONE}\)?)*|1/{_ONE})$")
"""What stands last in the description of a key where it is a unit."""
WORDS = {"string": "text", "boolean": "true, false", "integer": "whole number", "number": "number"}


def scene_of(package: str) -> Any:
    """The scene type of a package, with what its builders put in."""
    if package == "porescale":
        from porescale.cli.main import PACKAGE
    else:
        from continuum_sph.cli import PACKAGE
    return PACKAGE.scene()


@cache
def used(package: str) -> dict[str, tuple[Any, str]]:
    """Keys that the scenes of shipped cases give, without indices: a value and the case."""
    found: dict[str, tuple[Any, str]] = {}

    def walk(value: Any, key: str, case: str) -> None:
        """Keep a value, and those below it."""
        if isinstance(value, dict):
            for name, below in value.items():
                walk(below, f"{key}.{name}" if key else name, case)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for below in value:
                walk(below, key, case)
        if key and (key not in found or len(str(value)) < len(str(found[key][0])) - 40):
            found[key] = (value, case)

    for path in sorted((ROOT / "cases").glob("*/*.toml")):
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        ours = "tank" in table if package == "continuum_sph" else "domain" in table
        if ours:
            levels = table.pop("quality", {})
            walk(table, "", path.parent.name)
            for level in levels.values():
                walk(level, "", path.parent.name)
    return found


def written(value: Any) -> str:
    """A value as a TOML file writes it, short."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        text = "{ " + ", ".join(f"{key} = {written(it)}" for key, it in value.items()) + " }"
    elif isinstance(value, list):
        text = "[" + ", ".join(map(written, value)) + "]"
    else:
        text = json.dumps(value, ensure_ascii=False) if isinstance(value, str) else f"{value:g}" if isinstance(
            value, float) else str(value)  # fmt: skip
    return text if len(text) <= 60 else text[:57] + "…"


def options(schema: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """The alternatives of a schema, itself where it has none; those of lists are their entries."""
    if "properties" in schema:  # what may stand beside it says only which keys go together
        yield schema
        return
    for one in schema.get("anyOf", [schema]):
        if one is not schema and "anyOf" in one:
            yield from options(one)
        else:
            yield one


def tables(schema: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Schemas of the tables that a key can hold, by itself or in a list."""
    found = [one for one in options(schema) if "properties" in one]
    for one in options(schema):
        if isinstance(one.get("items"), dict):
            found += [it for it in options(one["items"]) if "properties" in it]
    return found


def listed(schema: Mapping[str, Any]) -> bool:
    """Whether the tables of a key stand in a list: [[key]]."""
    return any(isinstance(it.get("items"), dict) and tables(it["items"]) for it in options(schema))


def bounds(one: Mapping[str, Any]) -> str:
    """The range of a number, in words."""
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    return ", ".join(f"{sign} {one[name]:g}" for name, sign in signs.items() if name in one)


def allowed(schema: Mapping[str, Any]) -> str:
    """What a key takes: choices, ranges, shapes."""
    found: list[str] = []
    for one in options(schema):
        kind = one.get("type", "")
        if "enum" in one or "const" in one:
            found += [code(json.dumps(it)) for it in one.get("enum", [one.get("const")])]
        elif kind in ("number", "integer"):
            found.append(bounds(one) or WORDS[kind])
        elif kind == "array":
            inner = one.get("prefixItems") or [one.get("items", {})]
            within = allowed(inner[0]) if isinstance(inner[0], dict) else ""
            size = len(one["prefixItems"]) if "prefixItems" in one else 0
            found.append(f"list of {size}: {within}" if size else f"list: {within or 'tables'}")
        elif "properties" in one or kind == "object":
            found.append("table")
        elif "$ref" not in one and kind in WORDS:
            found.append(WORDS[kind])
    return " or ".join(dict.fromkeys(it for it in found if it))


def about(schema: Mapping[str, Any]) -> tuple[str, str]:
    """Meaning and unit of a key, from its description."""
    text = str(schema.get("description", "")).split("\n\n")[0]
    text = re.sub(r"(, )?allowed: [^,]*$", "", " ".join(text.split()))
    text, over_time = re.sub(r", constant or over time$", "", text), text.endswith("constant or over time")
    head, _, tail = text.rpartition(", ")
    unit = ""
    if UNIT.match(tail):
        text, unit = head or "", tail
    return text + (" (constant or over time)" if over_time else ""), unit


def default(schema: Mapping[str, Any], required: bool) -> str:
    """The default of a key; "required" where it must be given."""
    if required:
        return "required"
    value = schema.get("default")
    return code(written(value)) if value not in (None, [], "", {}) else ""


class Writer:
    """Writes the tables of a scene; a table that was written before is named, not written again."""

    def __init__(self, package: str) -> None:
        self.package, self.examples = package, used(package)
        self.parts: list[str] = []
        self.known: dict[str, str] = {}

    def section(self, key: str, schema: Mapping[str, Any], in_list: bool) -> None:
        """A heading, what the table is, its keys, and then the tables in it."""
        inner = tables(schema)
        keys: dict[str, Any] = {}
        for one in inner:
            for name, it in one["properties"].items():
                keys.setdefault(name, it)
        must = set.intersection(*({*one.get("required", ())} for one in inner))
        depth = "##" if "." not in key else "###"
        self.parts.append(f"({self.anchor(key)})=\n{depth} {f'[[{key}]]' if in_list else f'[{key}]'}\n")
        text = next((it["description"] for it in (*inner, schema) if it.get("description")), "")
        for paragraph in str(text).split("\n\n"):
            self.parts.append(escaped(" ".join(paragraph.split())) + "\n")
        below = []
        rows = []
        for name, it in keys.items():
            place = f"{key}.{name}"
            meaning, unit = about(it)
            shown = "" if it.get("description") == text else escaped(meaning)
            if tables(it):
                mark = self.same(place, it)
                if mark == place:
                    below.append((place, it))
                shown = f"{shown}{'' if shown.endswith('.') else '.'} See [{mark}](#{self.anchor(mark)})."
            value, case = self.examples.get(place, (None, ""))
            example = f"{code(written(value))} ([{case}](../../cases/{case}/README.md))" if case else ""
            rows.append((code(name), escaped(unit), allowed(it), default(it, name in must), shown, example))
        self.parts.append(table(("key", "unit", "allowed", "default", "meaning", "example, from a case"), rows))
        for place, it in below:
            self.section(place, it, listed(it))

    def anchor(self, key: str) -> str:
        """Where a table stands."""
        return f"{slug(self.package)}-scene-{slug(key)}"

    def same(self, key: str, schema: Mapping[str, Any]) -> str:
        """The key under which such a table is written: this one unless one before had the same keys."""
        body = json.dumps([sorted(it["properties"]) for it in tables(schema)])
        return self.known.setdefault(body, key)


def page(package: str) -> str:
    """All tables of the scenes of a package, as Markdown."""
    schema = scene_schema(scene_of(package))
    writer = Writer(package)
    top, rows = schema["properties"], []
    must = set(schema.get("required", ()))
    for name, it in top.items():
        if tables(it):
            heading = f"[[{name}]]" if listed(it) else f"[{name}]"
            shown = f"[`{heading}`](#{writer.anchor(name)})"
        else:
            shown = code(name)
        meaning, unit = about(next((one for one in tables(it) if one.get("description")), it))
        first = re.split(r"(?<=[.;]) ", meaning)[0].rstrip(";")
        rows.append((shown, escaped(unit), "required" if name in must else default(it, False), escaped(first)))
    writer.parts.append(table(("section or key", "unit", "default", "what it is"), rows))
    for name, it in top.items():
        if name == "quality":
            continue
        if tables(it):
            writer.same(name, it)
            writer.section(name, it, listed(it))
    text = "\n".join(writer.parts)
    return text.replace("](#" + writer.anchor("quality") + ")", "](../scenes.md)")
