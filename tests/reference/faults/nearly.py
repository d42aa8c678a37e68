"""Scenes that are nearly right: shipped ones in which a few numbers, choices or sections are others.

    python -m tests.reference.faults.nearly --count 2000 --seed 5  every scene that `check` fails on without a refusal
    python -m tests.reference.faults.nearly --count 300 --build    builds those, too, that `check` accepts

A mutant passes the schema or is refused by it; what is left may be wrong as physics.  Whatever it is, it is refused in
lines, and never with a traceback.
"""

import argparse
import copy
import math
import random
import sys
import traceback
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.cli.package import Package
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import open_scene, scene_as_dict, validate
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


def mutant(table: dict[str, Any], seed: int) -> dict[str, Any]:
    """``table`` changed in one to three places; the same for the same seed."""
    dice, made = random.Random(seed), copy.deepcopy(table)
    for _ in range(dice.choice((1, 1, 2, 3))):
        kind = dice.choice(("number", "number", "number", "side", "drop", "add"))
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
    return made


def sources() -> list[tuple[Path, Package, dict[str, Any]]]:
    """Every shipped scene, with its package, as a table of all that it says; packings are left where they are placed,
    since settling takes seconds."""
    found = []
    for file in sorted(CASES.glob("*/scene.toml")):
        for package in (PORESCALE, CONTINUUM):
            try:
                table = given(scene_as_dict(open_scene(file, package.scene()).scene))
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


def judged(source: tuple[Path, Package, dict[str, Any]], seed: int, *, build: bool = False) -> str:
    """What becomes of one mutant: "refused", WORDLESS, "checked", or "built"; any other error is let out."""
    file, package, table = source
    try:
        scene = validate(package.scene(), mutant(table, seed), folder=file.parent)
        report = package.report(scene)
        if not build or bytes_of(report) > MOST_BYTES:
            return "checked"
        package.build(scene)
    except InputError as error:
        return "refused" if str(error).strip() else WORDLESS
    return "built"


def main() -> int:
    """Exit code 1 if any mutant ended with another error than a refusal, or was refused without a word."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--count", type=int, default=1000, help="mutants in all")
    parser.add_argument("--seed", type=int, default=0, help="number of the first")
    parser.add_argument("--build", action="store_true", help="build what check accepts, up to 20 MB")
    words = parser.parse_args()
    every, found, ends = sources(), 0, Counter[str]()
    for seed in range(words.seed, words.seed + words.count):
        source = every[seed % len(every)]
        try:
            ends[end := judged(source, seed, build=words.build)] += 1
            if end == WORDLESS:
                print(f"{source[0].parent.name}, seed {seed}: {end}", flush=True)
        except Exception:
            found += 1
            print(f"{source[0].parent.name}, seed {seed}:\n{traceback.format_exc(limit=-4)}", flush=True)
    print(", ".join(f"{count} {name}" for name, count in sorted(ends.items())), f"and {found} with a traceback")
    return int(found + ends[WORDLESS] > 0)


if __name__ == "__main__":
    sys.exit(main())
