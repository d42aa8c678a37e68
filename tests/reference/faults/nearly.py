"""Scenes that are nearly right: shipped ones in which a few numbers, choices or sections are others.

    python -m tests.reference.faults.nearly --count 2000 --seed 5  every scene that `check` fails on without a refusal
    python -m tests.reference.faults.nearly --count 300 --build    builds those, too, that `check` accepts

A mutant passes the schema or is refused by it; what is left may be wrong as physics.  Whatever it is, it is refused in
lines, and never with a traceback.  What `check` accepts is built, a report has no number that is none, nothing warns of
arithmetic, and nothing takes long.
"""

import argparse
import copy
import math
import random
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.cli.package import Package
from porescale.common.core.errors import InputError
from porescale.common.schema.json_schema import scene_schema
from porescale.common.schema.scene import SceneBase
from porescale.common.schema.sections import load, scene_as_dict, validate
from tests.reference.faults import campaigns
from tests.reference.folders import CASES

FACTORS = (0.0, -1.0, 0.1, 0.5, 0.9, 0.999, 1.001, 1.1, 2.0, 10.0, 1e-3, 1e3)
"""What a number is multiplied by."""
SIDES = ("wall", "slip", "periodic")
ADDED: dict[str, Any] = {
    "disc": [{"x": 0.01, "y": 0.01, "diameter": 0.002}], "gravity": [0.3, -9.81], "lubrication": {},
    "gate": {"x": 0.01, "lift_speed": 0.5}, "sleep": {}, "probe": [{"x": 0.01, "y": 0.01}],
    "wall": [{"x": 0.0, "y": 0.001, "normal": [0.1, 1.0]}],
    "rectangle": [{"lower": [0.01, 0.002], "upper": [0.013, 0.005]}], "ring": {"x": 0.01, "y": 0.01, "diameter": 0.015},
    "polygon": [{"corners": [[0, 0], [0.003, 0], [0, 0.003]], "thickness": 1e-4, "at": [[0.005, 0.005]]}],
}  # fmt: skip
"""Sections that a scene may get."""
WORDLESS = "refused without a word"
"""How a mutant ends whose refusal says nothing."""
LATE, NO_NUMBER, SLOW = "checked, then refused", "a report without a number", "slow"
"""How one ends that `check` accepts and no run begins;  whose report has a nan;  that takes more than LONG."""
WRONG = (WORDLESS, LATE, NO_NUMBER, SLOW)
LONG = 20.0
"""Seconds of the processor that a check may take, a hundred times what the slowest shipped scene does."""
MOST_BYTES = 20e6
"""Of memory, of a scene that is built."""


def places(table: Any, above: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The way to everything in a scene that is a number or a text with one."""
    items = table.items() if isinstance(table, dict) else enumerate(table) if isinstance(table, list) else ()
    for key, value in items:
        if isinstance(value, dict | list):
            yield from places(value, (*above, key))
        elif not isinstance(value, bool) and isinstance(value, int | float | str) and (*above, key) != ("title",):
            yield (*above, key)


def at(table: Any, way: tuple[Any, ...]) -> Any:
    """What a way leads to."""
    for key in way:
        table = table[key]
    return table


def scaled(value: Any, dice: random.Random) -> Any:
    """A number, with its unit where it has one, times one of FACTORS; a text without a number stays."""
    factor = dice.choice(FACTORS)
    if isinstance(value, int) and not isinstance(value, bool) and dice.random() < 0.5:
        return int(value * factor)
    if isinstance(value, int | float):
        return value * factor
    number, _, unit = value.partition(" ")
    try:
        return f"{float(number) * factor!r} {unit}"
    except ValueError:
        return value


def drawn(schema: Any, dice: random.Random) -> Any:
    """A value that a JSON ``schema`` allows, or all but allows: defaults, bounds, and numbers near them."""
    if "anyOf" in schema:
        return drawn(dice.choice([it for it in schema["anyOf"] if "$ref" not in it] or [{}]), dice)
    if "const" in schema or "enum" in schema:
        return schema["const"] if "const" in schema else dice.choice(schema["enum"])
    kind = schema.get("type")
    if kind in ("number", "integer"):
        near = [schema[key] for key in ("default", "minimum", "maximum", "exclusiveMinimum") if key in schema]
        value = dice.choice([*near, 0.01, 1.0, 3.0]) * dice.choice(FACTORS)
        return int(value) if kind == "integer" or dice.random() < 0.1 else value
    if kind == "array":
        inside = schema.get("prefixItems") or [schema.get("items", {})] * max(schema.get("minItems", 0), 1)
        return [drawn(it, dice) for it in inside]
    if kind == "object":
        keys = schema.get("properties", {})
        needed = [*schema.get("required", ()), *([dice.choice(list(keys))] if keys else [])]
        return {key: drawn(it, dice) for key, it in keys.items() if key in needed}
    return {"boolean": dice.random() < 0.5, "string": "a", "null": None}.get(str(kind), 1)


def key_set(table: Any, schema: Any, dice: random.Random) -> None:
    """One key of a ``table``, however deep, is drawn; it may have been absent."""
    for option in schema.get("anyOf", ()):
        if option.get("type") == ("array" if isinstance(table, list) else "object"):
            schema = option
            break
    if isinstance(table, list):
        return key_set(dice.choice(table), schema.get("items", {}), dice) if table else None
    if not isinstance(table, dict) or not schema.get("properties"):
        return None
    key = dice.choice(list(schema["properties"]))
    inside = table.get(key)
    if isinstance(inside, dict) or (isinstance(inside, list) and inside and isinstance(inside[0], dict)):
        return key_set(inside, schema["properties"][key], dice)
    table[key] = drawn(schema["properties"][key], dice)
    return None


def mutant(
    table: dict[str, Any], seed: int, schema: Any = None, others: Sequence[dict[str, Any]] = ()
) -> dict[str, Any]:
    """``table`` changed in one to three places; the same for the same seed.

    schema : of such scenes as JSON, from which keys are drawn;  others : scenes from which sections are taken
    """
    dice, made = random.Random(seed), copy.deepcopy(table)
    kinds = ["number", "number", "number", "side", "drop", "add"]
    kinds += ["key", "key", "key"] * (schema is not None) + ["section", "section"] * bool(others)
    for _ in range(dice.choice((1, 1, 2, 3))):
        kind = dice.choice(kinds)
        ways = list(places(made))
        if kind == "number" and ways:
            *above, last = dice.choice(ways)
            inside = at(made, tuple(above))
            inside[last] = scaled(inside[last], dice)
        elif kind == "side":
            made.setdefault("domain", {})[dice.choice(("left", "right", "bottom", "top"))] = dice.choice(SIDES)
        elif kind == "drop" and len(made) > 1:
            made.pop(dice.choice(list(made)))
        elif kind == "add":
            name = dice.choice(list(ADDED))
            made[name] = copy.deepcopy(ADDED[name])
        elif kind == "key":
            key_set(made, schema, dice)
        elif kind == "section":
            other = dice.choice(others)
            name = dice.choice(list(other))
            made[name] = copy.deepcopy(other[name])
    return made


def sources() -> list[tuple[Path, Package, dict[str, Any]]]:
    """Every shipped scene, with its package, as a table of all that it says; packings are left where they are placed,
    since settling takes seconds."""
    found = []
    for file in sorted(CASES.glob("*/scene.toml")):
        for package in (PORESCALE, CONTINUUM):
            try:
                table = given(scene_as_dict(load(file, package.scene())))
            except InputError:
                continue
            packing = (table.get("grains") or {}).get("packing")
            if packing and packing.get("settle", True) and not packing.get("compress"):
                packing["settle"] = False
                packing["packing_fraction"] = min(packing.get("packing_fraction", 0.5), 0.5)
            found.append((file, package, table))
            break
    return found


def given(value: Any) -> Any:
    """A table without what is None, deep inside too; lists for tuples."""
    if isinstance(value, dict):
        return {key: given(item) for key, item in value.items() if item is not None}
    return [given(item) for item in value] if isinstance(value, list | tuple) else value


def bytes_of(report: Any) -> float:
    """Memory (bytes) that a report of `check` expects; infinite where it says none."""
    rows = [row for rows in report.groups.values() for row in rows if row.name == "memory"]
    units = {"B": 1.0, "kB": 1e3, "MB": 1e6, "GB": 1e9, "MiB": 2.0**20, "GiB": 2.0**30, "kiB": 2.0**10}
    return float(rows[0].value) * units.get(rows[0].unit, math.inf) if rows else math.inf


def without_numbers(report: Any) -> bool:
    """Whether a value of a report of `check` is no number where it should be one."""
    return any(
        isinstance(row.value, float) and math.isnan(row.value) for rows in report.groups.values() for row in rows
    )


def judged(
    source: tuple[Path, Package, dict[str, Any]],
    seed: int,
    *,
    build: bool = False,
    others: Sequence[dict[str, Any]] | None = None,
) -> str:
    """What becomes of one mutant: "refused", "checked", "built" or one of WRONG; any other error is let out."""
    file, package, table = source
    begun, schema = time.process_time(), None if others is None else schema_of(package.scene())
    built, refused = False, ""
    try:
        scene = validate(package.scene(), mutant(table, seed, schema, others or ()), folder=file.parent)
        report = package.report(scene)
        if without_numbers(report):
            return NO_NUMBER
        refused = LATE
        if build and bytes_of(report) <= MOST_BYTES:
            package.build(scene)
            built = True
    except InputError as error:
        return (refused or "refused") if str(error).strip() else WORDLESS
    took = time.process_time() - begun
    return "built" if built else SLOW if took > LONG else "checked"


@cache
def schema_of(kind: type[SceneBase]) -> Any:
    """JSON schema of scenes of a kind."""
    return scene_schema(kind)


def main() -> int:
    """Exit code 1 if any mutant ended with another error than a refusal, or in one of the ways that are WRONG."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--count", type=int, default=1000, help="mutants in all")
    parser.add_argument("--seed", type=int, default=0, help="number of the first")
    parser.add_argument("--build", action="store_true", help="build what check accepts, up to 20 MB")
    parser.add_argument("--record", action="store_true", help="keep what it came to in docs/develop")
    words = parser.parse_args()
    warnings.simplefilter("error", RuntimeWarning)
    every, found, ends = sources(), 0, Counter[str]()
    for seed in range(words.seed, words.seed + words.count):
        source = every[seed % len(every)]
        others = [table for _, package, table in every if package is source[1]]
        try:
            ends[end := judged(source, seed, build=words.build, others=others)] += 1
            if end in WRONG:
                print(f"{source[0].parent.name}, seed {seed}: {end}", flush=True)
        except Exception:
            found += 1
            print(f"{source[0].parent.name}, seed {seed}:\n{traceback.format_exc(limit=-4)}", flush=True)
    if words.record:
        campaign = "nearly right scenes" + ", built" * words.build
        wrong = found + sum(ends[name] for name in WRONG)
        campaigns.record(campaign, words.seed, ends + Counter({"with a traceback": found}), wrong)
    print(", ".join(f"{count} {name}" for name, count in sorted(ends.items())), f"and {found} with a traceback")
    return int(found + sum(ends[name] for name in WRONG) > 0)


if __name__ == "__main__":
    sys.exit(main())
