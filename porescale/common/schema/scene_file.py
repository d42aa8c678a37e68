"""Scene files: finding and reading them, laying one table over another, and `--set` entries."""

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import given_text
from porescale.common.schema.messages import Key, dotted, parse_key
from porescale.common.schema.written import plain

SCENE_FILE = "scene.toml"


def find(path: Path) -> Path:
    """The scene file that ``path`` (a file, or a folder with scene.toml) names; InputError if none."""
    try:
        folder = path.is_dir()
        file = path / SCENE_FILE if folder else path
        if file.is_file():
            return file
    except OSError as error:  # a name too long, a folder that may not be looked into
        raise InputError(Fault("SCENE", problem=f"cannot be read ({error.strerror})", repair="name another")) from None
    looked = f"looked for the file {file}" if folder else f"looked for a file or folder {path}"
    repair = f"{looked}; give a TOML file or a folder with {SCENE_FILE}"
    meant = [it for it in (path.parent / f"{name}.toml" for name in (path.name, path.stem)) if is_file(it)]
    if not folder and meant:
        repair = f"did you mean {meant[0]}?"
    raise InputError(Fault(str(path), problem="no scene here", repair=repair))


def is_file(path: Path) -> bool:
    """Whether there is a file, as far as one can see."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def name_of(file: Path) -> str:
    """Name of the scene in ``file``: its folder's if it is a scene.toml, else its own."""
    return file.resolve().parent.name if file.name == SCENE_FILE else file.stem


DEEPEST = 30
"""Tables and lists within each other: no scene needs more than six."""


def read(file: Path) -> dict[str, Any]:
    """The tables of a TOML file; InputError naming the line if it is none."""
    try:
        table = tomllib.loads(given_text(file))  # with a byte-order mark or not
        if _deeper(table, DEEPEST):
            raise RecursionError
        return table
    except RecursionError:
        problem = "has tables or lists within each other without end"
        raise InputError(Fault("TOML", None, problem, "", f"<= {DEEPEST} levels", file=str(file))) from None
    except tomllib.TOMLDecodeError as error:
        text, _, place = str(error).partition(" (at ")
        place = place.replace("end of document", f"line {len(given_text(file).splitlines())}, end of file")
        fault = Fault(place.rstrip(")"), problem=text, repair="correct the TOML there", file=str(file))
        raise InputError(fault) from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        fault = Fault(f"line {line}", problem="is not UTF-8 text", repair="save it as UTF-8", file=str(file))
        raise InputError(fault) from None
    except ValueError as error:  # a number of thousands of digits
        raise InputError(Fault("TOML", problem=str(error).partition(";")[0], file=str(file))) from None
    except OSError as error:
        raise InputError(Fault("TOML", problem=f"cannot be read ({error.strerror})", file=str(file))) from None


def _deeper(table: Any, levels: int) -> bool:
    """Whether something lies more than ``levels`` deep in ``table``; found without recursion."""
    layer = [table]
    for _ in range(levels):
        layer = [below for one in layer for below in (one.values() if isinstance(one, dict) else one)
                 if isinstance(below, dict | list)]  # fmt: skip
        if not layer:
            return False
    return True


def merge(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """A new table, ``base`` with ``over`` laid on it: tables merge, all else (lists too) is replaced."""
    merged = dict(base)
    for name, value in over.items():
        below = merged.get(name)
        merged[name] = (
            merge(below if isinstance(below, Mapping) else {}, value) if isinstance(value, Mapping) else value
        )
    return merged


def holds(table: Any, key: Key) -> bool:
    """Whether ``table`` has an entry at ``key``."""
    for part in key:
        inside = isinstance(table, list) and isinstance(part, int) and part < len(table)
        if not inside and not (isinstance(table, Mapping) and part in table):
            return False
        table = table[part]
    return True


NAME = r"[\w-]+(\[\d+\])*(\.[\w-]+(\[\d+\])*)*"
"""Of a key: ``fluid.spacing``, ``grains[0].radius`` or ``grains.0.radius``."""


def parse_name(name: str) -> Key:
    """``section.key`` as a key; InputError if it is none."""
    if not isinstance(name, str) or not re.fullmatch(NAME, name):
        raise InputError(Fault(repr(name), None, "is not section.key", repair='write it as "time.end"'))
    key = parse_key(name)
    if len(key) > DEEPEST:
        problem = "has tables or lists within each other without end"
        raise InputError(Fault(f"{name[:20]}…", None, problem, "", f"<= {DEEPEST} levels"))
    return key


def setting_text(name: str, value: Any) -> str:
    """``section.key=value``, which `parse_setting` reads back to the bit; InputError where ``name`` is no key."""
    parse_name(name)
    return f"{name}={value_text(plain(value))}"


def value_text(value: Any) -> str:
    """A plain value as TOML in one line; "none" for None, which TOML has not."""
    if isinstance(value, Mapping):
        entries = [f"{value_text(name)} = {value_text(below)}" for name, below in value.items()]
        return f"{{ {', '.join(entries)} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):  # TOML's texts are those of JSON but for the sign of deletion
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return "none" if value is None else repr(value)


def parse_setting(text: str) -> tuple[Key, Any]:
    """``section.key=value`` as key and value (a TOML value, else the text itself); else InputError."""
    name, equals, value = text.partition("=")
    if not equals or not re.fullmatch(NAME, name.strip()):
        repair = "write it as --set time.end=0.1"
        raise InputError(Fault(repr(text), None, "is not section.key=value", file="--set", repair=repair))
    key = parse_key(name.strip())
    try:
        parsed = tomllib.loads(f"value = {value}")
        if len(key) > DEEPEST or _deeper(parsed, DEEPEST):
            raise RecursionError
    except RecursionError:
        problem = "has tables or lists within each other without end"
        raise InputError(Fault(f"{name[:20]}…", None, problem, "", f"<= {DEEPEST} levels", file="--set")) from None
    except ValueError:  # no TOML
        parsed = {}
    return key, parsed["value"] if parsed.keys() == {"value"} else value.strip()


def assign(table: Mapping[str, Any], key: Key, value: Any) -> dict[str, Any]:
    """A copy of ``table`` with ``value`` at ``key``; missing tables are made.  InputError on bad indices."""
    return dict(_assigned(table, key, value, ()))


def without(table: Mapping[str, Any], key: Key) -> dict[str, Any]:
    """A copy of ``table`` without what is at ``key``, if there is something; InputError for an entry of a list."""
    if not holds(table, key):
        return dict(table)
    if isinstance(key[-1], int):
        problem, repair = "is an entry of a list, which cannot be taken out", "give the list without it"
        raise InputError(Fault(dotted(key), None, problem, repair=repair))
    if len(key) == 1:
        return {name: value for name, value in table.items() if name != key[0]}
    above: Any = table
    for part in key[:-1]:
        above = above[part]
    return assign(table, key[:-1], {name: value for name, value in above.items() if name != key[-1]})


def _assigned(below: Any, key: Key, value: Any, above: Key) -> Any:
    """``below`` (what is at ``above``) with ``value`` at ``key`` inside it."""
    if not key:
        return value
    part, rest = key[0], key[1:]
    if isinstance(below, list):
        if not isinstance(part, int) or part >= len(below):
            allowed = f"0 to {len(below) - 1}" if below else "none: the list is empty"
            inner = rest if isinstance(part, int) else key
            example = dotted((*above, 0, *inner))
            repair = f"name one, as in {example}=…" if below else "give the whole list"
            place = dotted((*above, part))
            raise InputError(Fault(place, None, "no such entry of a list", "", allowed, repair, "--set"))
        return [*below[:part], _assigned(below[part], rest, value, (*above, part)), *below[part + 1 :]]
    if isinstance(part, int):
        problem = "is not in the scene" if below == {} else "is no list"
        raise InputError(Fault(dotted(above), None, problem, repair="give the whole list", file="--set"))
    tables = below if isinstance(below, Mapping) else {}
    name = str(part)
    return {**tables, name: _assigned(tables.get(name, {}), rest, value, (*above, name))}
