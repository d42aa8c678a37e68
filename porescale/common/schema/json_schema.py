"""JSON Schema (2020-12) of scenes, for editors: keys with units, ranges and choices, as a TOML file writes them."""

from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel

from porescale.common.core.version import VERSION
from porescale.common.schema.quantity import NUMBER, WITH_UNIT, Quantity
from porescale.common.schema.sections import LEVELS

TEXTS = {
    "text_with_unit": {"type": "string", "pattern": WITH_UNIT},
    "text_of_number": {"type": "string", "pattern": NUMBER},
}
"""What most keys take besides a number, stated once."""
DIALECT = "https://json-schema.org/draft/2020-12/schema"


def scene_schema(scene_type: type[BaseModel]) -> dict[str, Any]:
    """The schema of files of such a scene, with their quality levels."""
    made = _explained(_plain(scene_type.model_json_schema(by_alias=True)))
    level = {**_partial(made), "description": "What this level changes of the scene."}
    level["properties"] = {name: it for name, it in level["properties"].items() if name != "title"}
    levels = {name: {"$ref": "#/$defs/level"} for name in LEVELS}
    made["properties"] |= {
        "quality": _table(levels, "Levels of quality: tables that are laid over the scene."),
        "quality_default": {"enum": list(LEVELS), "description": "level that is used where none is chosen"},
    }
    program = scene_type.__module__.partition(".")[0]
    defs = {**{name: dict(it) for name, it in TEXTS.items()}, "level": level}
    return {"$schema": DIALECT, "title": f"Scene of {program} {VERSION}", **made, "$defs": defs}


def number() -> dict[str, Any]:
    """Schema of a number, or of a text that may have a unit."""
    return Quantity().text_or({"type": "number"})


def with_units(schema: dict[str, Any], units: Mapping[str, tuple[str, str]]) -> dict[str, Any]:
    """``schema`` of a table, with unit and meaning of some of its keys: key -> (unit, help)."""
    for key, (unit, help) in units.items():
        schema["properties"][key]["description"] = ", ".join(filter(None, (help, unit, "constant or over time")))
    return schema


def choice(names: Iterable[str], given: Mapping[str, Any]) -> dict[str, Any]:
    """Schema of one of ``names``, with what else ``given`` says of the key."""
    about = {name: given[name] for name in ("description", "default") if given.get(name) is not None}
    return {"enum": list(names), **about}


def word_or(words: Iterable[str], table: dict[str, Any]) -> dict[str, Any]:
    """Schema of a word, or of a table."""
    return {"description": table.get("description", ""), "anyOf": [{"enum": list(words)}, table]}


def _table(properties: dict[str, Any], description: str) -> dict[str, Any]:
    return {"type": "object", "additionalProperties": False, "description": description, "properties": properties}


def _plain(schema: Any) -> Any:
    """``schema`` without null, which TOML has not, without titles that repeat keys, and without unions of one."""
    if isinstance(schema, list):
        return [_plain(it) for it in schema if it != {"type": "null"}]
    if not isinstance(schema, dict):
        return schema
    for name, texts in TEXTS.items():
        if schema == texts:
            return {"$ref": f"#/$defs/{name}"}
    made = {}
    for name, below in schema.items():
        if name in ("properties", "$defs"):
            made[name] = {key: _plain(it) for key, it in below.items()}
        elif name in ("default", "enum", "const", "required"):
            made[name] = below
        elif name not in ("title", "$comment"):
            made[name] = _plain(below)
    if made.get("default", 0) is None or isinstance(made.get("default"), dict):
        del made["default"]
    if len(made.get("anyOf", ())) == 1:
        only = made.pop("anyOf")[0]
        made = {**only, **made}
    return made


def _explained(schema: dict[str, Any], above: str = "") -> dict[str, Any]:
    """``schema`` with a description of every key: its own, that of the sections in it, else that of its section."""
    made, about = dict(schema), schema.get("description", above)
    if isinstance(made.get("items"), dict):
        made["items"] = _explained(made["items"], about)
    for name in ("anyOf", "prefixItems"):
        if name in made:
            made[name] = [_explained(it, about) for it in made[name]]
    if "properties" in made:
        made["properties"] = {}
        for key, it in schema["properties"].items():
            items = it.get("items")
            inner = items.get("description") if isinstance(items, dict) else None
            made["properties"][key] = _explained({**it, "description": it.get("description") or inner or about}, about)
    return made


def _partial(schema: dict[str, Any]) -> dict[str, Any]:
    """``schema`` of a table with all of its keys optional, and those of tables within it; lists are replaced whole."""
    made = {name: it for name, it in schema.items() if name not in ("required", "default")}
    if "properties" in made:
        made["properties"] = {name: _partial(it) for name, it in made["properties"].items()}
    if "anyOf" in made:
        made["anyOf"] = [_partial(it) for it in made["anyOf"] if it.keys() != {"required"}]
        if not made["anyOf"]:
            del made["anyOf"]
    return made
