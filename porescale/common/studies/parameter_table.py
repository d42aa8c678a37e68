"""Points of a sweep: settings that are laid over a scene, read from a table.

Three ways to say them, one file or option each:

CSV      a column for each key of the scene ("contact.friction"), a row for each run; ``name`` and ``quality`` are
         optional, an empty cell leaves the scene's value.
TOML     ``[[point]]`` tables with keys as in CSV, dotted or nested; ``[vary]`` with a list for each key: every
         combination.
options  ``--vary contact.friction=0.2,0.5``, repeatable: every combination.
"""

from __future__ import annotations

import csv
import itertools
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import given_text
from porescale.common.schema import scene_file

if TYPE_CHECKING:
    from porescale.common.api.program import Program

AS_IT_IS = "as-it-is"
"""Name of the point that sets nothing."""
LONGEST = 80
MOST = 100_000
SWEEP, ENSEMBLE = "sweep", "ensemble"
"""Names of the files of a sweep, and of its repeats."""
FILES = f"{SWEEP}.csv", f"{SWEEP}.md", f"{SWEEP}.png", f"{ENSEMBLE}.csv", "report.html"
"""What lies beside the folders of points, so that none may have its name."""


@dataclass(frozen=True)
class Point:
    """One run.  name : that of its folder, unique;  settings : ``section.key=value``;  quality : level or None;
    of : the point that it repeats, None for one that stands alone."""

    name: str
    settings: tuple[str, ...]
    quality: str | None = None
    of: Point | None = None

    @property
    def over(self) -> tuple[str, ...]:
        """Settings that tell it from other repeats of the same point."""
        return self.settings[len(self.of.settings) :] if self.of else ()

    def value(self, key: str) -> str:
        """What it sets ``key`` to, a text without the quotes of TOML; "" where it leaves the scene's value."""
        found = [text.partition("=")[2] for text in self.settings if text.partition("=")[0] == key]
        return _unquoted(found[-1]) if found else ""


def read_points(path: Path) -> list[Point]:
    """The points in a CSV or TOML file, in its order; InputError naming file and line or key."""
    try:
        rows = list(_of_csv(path)) if path.suffix.lower() == ".csv" else list(_of_toml(path))
    except InputError as error:
        raise error.in_file(str(path)) from None
    if not rows:
        raise InputError(Fault("points", None, "there are none", file=str(path), repair="give a row for each run"))
    return named(rows)


def varied(options: Sequence[str]) -> list[Point]:
    """Every combination of ``key=a,b,c`` options; InputError where one is not of that form, or a key, or a value
    of it, is given twice.

    Commas inside brackets or quotes belong to the value: ``domain.left=[0,1],[0,2]``.
    """
    return named(combinations(_lists(options), "--vary"))


def ladders(options: Sequence[str]) -> list[list[Point]]:
    """The points of each ``key=a,b,c`` option by itself, no two of any of them of one name; InputError as `varied`."""
    points = [combinations([settings], "--vary") for settings in _lists(options)]
    names = iter(named(itertools.chain(*points)))
    return [list(itertools.islice(names, len(ladder))) for ladder in points]


def _lists(options: Sequence[str]) -> list[list[str]]:
    """The settings of each ``key=a,b,c`` option."""
    lists = []
    for option in options:
        key, equals, values = option.partition("=")
        parts = split(values)
        if not equals or not key.strip() or not all(parts):
            repair = "write it as --vary contact.friction=0.2,0.5"
            raise InputError(Fault(repr(option), None, "is not key=a,b,c", file="--vary", repair=repair))
        lists.append([f"{key.strip()}={part}" for part in parts])
    _once([settings[0] for settings in lists], "--vary")
    return lists


def crossed(points: Sequence[Point], others: Sequence[Point]) -> list[Point]:
    """Every point of one list with every one of the other laid over it; InputError where both set a key."""
    for point in points:
        _once((*point.settings, *others[0].settings), "--vary")
    pairs = itertools.product(points, others)
    return named([Point("", a.settings + b.settings, b.quality or a.quality) for a, b in pairs])


def _once(settings: Iterable[str], source: str) -> None:
    """InputError where a key is set twice."""
    seen = set[str]()
    for key in (text.partition("=")[0] for text in settings):
        if key in seen:
            repair = "give all of its values in one place"
            raise InputError(Fault(key, None, "is given twice", repair=repair, file=source))
        seen.add(key)


def repeats(point: Point, choices: Iterable[tuple[str, ...]]) -> list[Point]:
    """Repeats of a point, one for each choice of settings over its own; names end with what the first of them sets."""
    made = []
    for over in choices:
        key, _, value = over[0].partition("=")
        own = f"{point.name}," if point.settings or point.quality or point.name != AS_IT_IS else ""
        name = f"{own}{key.rpartition('.')[2]}={value}"
        made.append(Point(name, (*point.settings, *over), point.quality, point))
    return made


def named(points: Iterable[Point]) -> list[Point]:
    """Points with a name each, made of what they set; those that share one, or that of a file, are numbered."""
    made, last = [], dict.fromkeys(FILES, 1)  # the number of the last one of a name
    for point in points:
        name = own = _slug(point.name or _made_name(point))
        while name.casefold() in last:
            last[own.casefold()] += 1
            name = f"{own}-{last[own.casefold()]}"
        last[name.casefold()] = 1
        made.append(replace(point, name=name))
    return made


def literal(value: Any, key: str) -> str:
    """A value as TOML writes it; InputError for what a setting cannot hold."""
    if isinstance(value, bool | int | float | str | list):
        return scene_file.value_text(value)
    raise InputError(Fault(key, str(value), "is not a number, text, truth or list"))


def flat(table: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys and values of nested tables."""
    for name, value in table.items():
        key = f"{above}{name}"
        if isinstance(value, Mapping):
            yield from flat(value, f"{key}.")
        else:
            yield key, value


def values_of(program: Program, scene: Path, settings: Sequence[str], quality: str | None = None) -> dict[str, Any]:
    """The value of every dotted key of the scene in a file, at a level, with ``settings`` over it."""
    from porescale.common.schema.sections import load, scene_as_dict

    return dict(flat(scene_as_dict(load(scene, program.scene(), quality=quality, overrides=settings))))


def changed(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    """Keys whose values differ between two scenes, in order; of one that is only in one of them the other is None."""
    return sorted(key for key in one.keys() | other.keys() if one.get(key) != other.get(key))


def settings_of(table: Mapping[str, Any]) -> tuple[str, ...]:
    """A table of keys, dotted or nested, as settings."""
    return tuple(f"{key}={literal(value, key)}" for key, value in flat(table))


def _unquoted(value: str) -> str:
    """A value of ``literal`` that is a text, as that text; every other as it is."""
    return str(json.loads(value)) if re.fullmatch(r'"([^"\\]|\\.)*"', value) else value


def _of_csv(path: Path) -> Iterator[Point]:
    try:
        lines = list(csv.reader(given_text(path).splitlines()))
    except OSError as error:
        raise InputError(Fault("table", None, f"cannot be read ({error.strerror})")) from None
    except UnicodeDecodeError as error:
        at = error.object[: error.start].count(b"\n") + 1
        raise InputError(Fault(f"line {at}", None, "is not UTF-8 text", repair="save it as UTF-8")) from None
    except csv.Error as error:
        raise InputError(Fault("table", None, f"is not valid CSV ({error})")) from None
    head = [name.strip() for name in lines[0]] if lines else []
    if other := next((sign for sign in ";\t" if any(sign in name for name in head)), ""):
        shown = {";": "semicolons", "\t": "tabs"}[other]
        raise InputError(Fault("line 1", None, f"has {shown} between its columns", repair="take commas"))
    if len(set(head)) < len(head) or not all(head):
        raise InputError(Fault("line 1", ", ".join(head), "is not a name for every column, each once"))
    for number, line in enumerate(lines[1:], 2):
        if not any(cell.strip() for cell in line):
            continue
        if len(line) != len(head):
            raise InputError(Fault(f"line {number}", None, f"has {len(line)} cells, the first line {len(head)}"))
        row = dict(zip(head, (cell.strip() for cell in line), strict=True))
        name, quality = row.pop("name", ""), row.pop("quality", "") or None
        yield Point(name, tuple(f"{key}={value}" for key, value in row.items() if value), quality)


def _of_toml(path: Path) -> Iterator[Point]:
    table = scene_file.read(path)
    unknown = table.keys() - {"point", "vary"}
    if unknown:
        raise InputError(Fault(min(unknown), None, "is unknown", repair="write [[point]] tables, or [vary]"))
    rows, lists = table.get("point", []), table.get("vary", {})
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise InputError(Fault("point", None, "is not a list of tables", repair="write [[point]]"))
    if not isinstance(lists, dict):
        raise InputError(Fault("vary", None, "is not a table", repair="write [vary] and a list for each key"))
    for row in rows:
        name, quality = str(row.pop("name", "")), row.pop("quality", None)
        yield Point(name, settings_of(row), None if quality is None else str(quality))
    if lists:
        choices = []
        for key, values in flat(lists):
            if not isinstance(values, list) or not values:
                raise InputError(Fault(f"vary.{key}", str(values), "is not a list of values"))
            choices.append([f"{key}={literal(value, key)}" for value in values])
        yield from combinations(choices)


def combinations(lists: Sequence[Sequence[str]], source: str = "") -> list[Point]:
    """A point for every choice of one setting out of each list; InputError where one is there twice, or they are too
    many.  source : what messages call the place of the lists."""
    for settings in lists:
        if len(set(settings)) < len(settings):
            key, _, value = next(it for it in settings if settings.count(it) > 1).partition("=")
            raise InputError(Fault(key, _unquoted(value), "is given twice", repair="leave one out", file=source))
    count = math.prod(map(len, lists))
    if count > MOST:
        raise InputError(Fault("points", count, "are too many combinations", "", f"<= {MOST}"))
    return [Point("", settings) for settings in itertools.product(*lists)]


def split(text: str) -> list[str]:
    """``text`` at commas outside brackets and quotes."""
    parts, depth, quote, start = [], 0, "", 0
    for at, sign in enumerate(text):
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "\"'":
            quote = sign
        elif sign in "[({":
            depth += 1
        elif sign in "])}":
            depth -= 1
        elif sign == "," and depth == 0:
            parts.append(text[start:at].strip())
            start = at + 1
    return [*parts, text[start:].strip()]


def _made_name(point: Point) -> str:
    """The last parts of keys, and values."""
    parts = [point.quality or ""]
    for setting in point.settings:
        key, _, value = setting.partition("=")
        parts.append(f"{key.rpartition('.')[2]}={value}")
    return ",".join(part for part in parts if part) or AS_IT_IS


def _slug(name: str) -> str:
    """``name`` as a folder may be called on any system: no separators, no quotes, no leading dot."""
    cleaned = re.sub(r"[^\w.,=+-]+", "_", name.replace('"', "").replace("'", "")).strip("._")
    return cleaned[:LONGEST] or "point"
