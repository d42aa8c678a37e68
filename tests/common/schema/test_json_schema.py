"""The JSON Schema of scenes: it takes every shipped scene, and refuses wrong keys, types, ranges, units."""

import copy
import io
import json
import tomllib
from collections.abc import Iterator
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

import continuum_sph
import porescale
from continuum_sph import cli as continuum_cli
from porescale.cli import main as porescale_cli
from porescale.common.cli import application
from porescale.common.schema.messages import every_key
from porescale.common.schema.scene_file import assign, parse_key

ROOT = Path(__file__).resolve().parents[3]
NO_SCENES = ("expected.toml", "trade.toml", "material.toml", "rates.toml")
FILES = [file for file in sorted((ROOT / "cases").glob("*/*.toml")) if file.name not in NO_SCENES]
SCHEMAS = {ps.__name__: ps.Scene.json_schema() for ps in (porescale, continuum_sph)}


def faults(table: dict[str, Any]) -> list[str]:
    """Where and why the schema of its program refuses a scene."""
    schema = SCHEMAS["continuum_sph" if "tank" in table else "porescale"]
    return [f"{it.json_path}: {it.message}" for it in Draft202012Validator(schema).iter_errors(table)]


@pytest.mark.parametrize("program", SCHEMAS)
def test_it_is_a_schema_of_2020_12(program: str) -> None:
    Draft202012Validator.check_schema(SCHEMAS[program])
    assert SCHEMAS[program]["$schema"].endswith("2020-12/schema")


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_it_takes_every_shipped_scene_and_refuses_it_with_a_slip(file: Path) -> None:
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    assert faults(table) == []
    for wrong in slips(table):
        assert faults(wrong) != []


def slips(table: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The scene with one thing wrong: an unknown key in each section, a text for a table, a required section less."""
    yield {**table, "dommain": {}}
    yield {**table, "time": "1 s"}
    yield {name: it for name, it in table.items() if name != "time"}
    for name, section in table.items():
        if isinstance(section, dict):
            own_law = ":" in str(section.get("law", ""))  # which may have numbers of any name, but no tables
            yield {**table, name: {**section, "spacign": {} if own_law else 1}}
            for key, value in section.items():
                if isinstance(value, int | float) and not isinstance(value, bool):
                    yield {**table, name: {**section, key: True}}
                    yield {**table, name: {**section, key: {"value": 1}}}


COLUMN = tomllib.loads((ROOT / "cases" / "column_collapse" / "scene.toml").read_text(encoding="utf-8"))
PAIRS = [
    ("fluid.spacing", ("0.375 mm", 1e-3, "1e-4m"), ("0.375", "mm", -1, 0, 1e5, True, [1], {})),
    ("fluid.operator", ("trt", "bgk"), ("trtt", 1)),
    ("fluid.solid_operator", ("exact-wall",), ("exactwall",)),
    ("fluid.precision", ("float32",), ("float16",)),
    ("contact.law", ("linear", "hertz", "laws.py:cubic"), ("Hertz", "", "laws.txt:cubic")),
    ("contact", ({"law": "a/laws.py:cubic", "hardness": "1 N/m^3"},), ({"law": "linear", "hardness": "1 N/m^3"},)),
    ("domain.top", ("slip", {"kind": "wall", "speed": "1 cm/s"}), ("slippery", {"kind": "walls"}, 3)),
    ("domain.left", ({"kind": "wall", "stress": [[0, 0], ["1 s", "2 kPa"]]},), ({"stress": [[0]]}, {"strss": 1})),
    ("gravity", ([0, -9.81], ["1 m/s^2", 0]), ([0], 9.81, ["1", 0])),
    ("quality.draft.fluid.spacing", ("1 mm", 1e-3), ("1",)),
    ("quality_default", ("draft",), ("rough",)),
    ("bonds", ({"at": "1 s"}, [{"at": 1}, {"at": 2}]), ({"att": 1}, 1)),
    ("cell", ({"rate_xy": {"amplitude": "1 1/s", "frequency": 1}},), ({"rate_xz": 1},)),
    ("fluid.body_force", (["1 1/m N/m^2", 0],), (["12", 0], ["1.5 ", 0], [".5", 0])),
    ("control", ([{"grain": 0, "x": "free", "y": {"velocity": "1 m/s"}}],), ([{"grain": 0, "x": "fre"}],)),
    ("grains.packing.diameter", ("1.5 mm",), (None,)),
]  # fmt: skip


@pytest.mark.parametrize(("key", "good", "bad"), PAIRS, ids=[it[0] for it in PAIRS])
def test_values_with_and_without_units_words_and_tables(key: str, good: tuple[Any, ...], bad: tuple[Any, ...]) -> None:
    for value in good:
        assert faults(assign(COLUMN, parse_key(key), value)) == []
    for value in bad:
        assert faults(assign(COLUMN, parse_key(key), value)) != []


def test_levels_need_not_be_whole_and_scenes_must() -> None:
    assert faults({**COLUMN, "quality": {"fine": {"grains": {"packing": {"seed": 2}}}}}) == []
    part = copy.deepcopy(COLUMN)
    del part["grains"]["packing"]["diameter"]
    assert faults(part) != []
    part["grains"]["packing"]["grading"] = [["1 mm", 0], ["2 mm", 100]]  # from which it follows
    assert faults(part) == []
    assert faults({**COLUMN, "quality": {"finest": {}}}) != []


@pytest.mark.parametrize("package", [porescale, continuum_sph])
def test_every_key_is_there_and_explained_with_its_unit(package: Any) -> None:
    schema = SCHEMAS[package.__name__]
    found = dict(keys({name: it for name, it in schema.items() if name != "$defs"}))
    assert set(every_key(package.Scene)) <= set(found)
    assert [place for place, it in found.items() if place[0] != "quality" and not it.get("description")] == []
    spacing = found["fluid", "spacing"] if package is porescale else found["numerics", "spacing"]
    assert "spacing" in spacing["description"]
    assert ", m, allowed: >= 1e-" in spacing["description"]
    assert not [it for it in found.values() if "default" in it and it["default"] is None]


def keys(schema: dict[str, Any], above: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    """Every key that a schema describes, without indices, and its schema."""
    for name, it in schema.get("properties", {}).items():
        yield (*above, name), it
        yield from keys(it, (*above, name))
    inner = schema.get("items")
    for it in (*schema.get("anyOf", ()), *([inner] if isinstance(inner, dict) else [])):
        yield from keys(it, above)


@pytest.mark.parametrize("app", [porescale_cli.commands(), application.application(continuum_cli.PACKAGE)])
def test_the_command_prints_it(app: Any) -> None:
    with redirect_stdout(io.StringIO()) as out:
        assert application.main(app, ["schema"]) == 0
    assert json.loads(out.getvalue()) in SCHEMAS.values()
