"""Scenes: quantities, every fault at once, nearest names, quality levels, overrides, round trips."""

import json
from pathlib import Path
from typing import Annotated, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, model_validator

from porescale.common.core.errors import Fault, InputError
from porescale.common.schema.messages import dotted, every_key, parse_key
from porescale.common.schema.scene import SceneBase
from porescale.common.schema.scene_file import assign, holds, merge, parse_setting
from porescale.common.schema.sections import (
    Quantity,
    Refused,
    Section,
    load,
    quantity,
    scene_as_dict,
    validate,
)


class Fluid(Section):
    spacing: float = quantity("m", gt=0, le=1, help="cell size")
    viscosity: float | Literal["auto"] = quantity("m²/s", "1 mm²/s", gt=0)
    collision: Literal["bgk", "trt"] = "trt"
    gravity: tuple[float, float] = quantity("m/s²", (0.0, -9.81))
    wall: float | None = quantity("m", None, ge=0)
    stirred: bool = Field(False, description="moves at the start")


class Disc(Section):
    kind: Literal["disc"] = "disc"
    radius: float = quantity("m", gt=0)


class Clump(Section):
    kind: Literal["clump"]
    members: list[tuple[float, float]] = quantity("m")
    repeats: int = quantity("", 3, ge=1)


class Clock(Section):
    duration: float = quantity("s", gt=0)
    step: float = quantity("s", 0.1, gt=0)
    frames: int = Field(10, ge=1, lt=1000)

    @model_validator(mode="after")
    def _a_step_fits(self) -> "Clock":
        if self.step > self.duration:  # an InputError is collected like a Refused
            raise InputError(Fault("step", self.step, "is longer than the run", "s"))
        return self


class Scene(SceneBase):
    fluid: Fluid | None = None
    grains: tuple[Annotated[Disc | Clump, Field(discriminator="kind")], ...] = ()
    size: Annotated[float, Quantity("m", gt=0)] = 1.0
    clock: Clock

    @model_validator(mode="after")
    def _cells_fit(self) -> "Scene":
        if self.fluid and self.fluid.spacing > self.size:
            raise Refused(Fault("fluid.spacing", self.fluid.spacing, "is larger than the domain", "m"))
        return self


GOOD = """
[fluid]
spacing = "0.3 mm"
[[grains]]
kind = "disc"
radius = "2 mm"
[[grains]]
kind = "clump"
members = [[0.001, "1 mm"], [0, 0]]
[clock]
duration = 2
"""


@pytest.fixture
def write(tmp_path: Path):
    def _write(text: str) -> Path:
        file = tmp_path / "column" / "scene.toml"
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    return _write


def lines(path: Path, **options) -> list[str]:
    """The faults of loading ``path``, one line each."""
    with pytest.raises(InputError) as caught:
        load(path, Scene, **options)
    found = str(caught.value).splitlines()
    assert len(found) == len(caught.value.faults)
    return found


def test_quantities_arrive_in_si_at_any_depth(write) -> None:
    scene = load(write(GOOD), Scene)
    assert scene.fluid.spacing == 0.0003
    assert scene.fluid.viscosity == 1e-6  # a default may have a unit too
    assert scene.fluid.gravity == (0.0, -9.81)
    assert scene.grains[0].radius == 0.002
    assert scene.grains[1].members == [(0.001, 0.001), (0.0, 0.0)]


def test_a_folder_is_its_scene_toml_and_names_the_scene(write) -> None:
    file = write(GOOD)
    assert load(file.parent, Scene) == load(str(file), Scene)
    assert load(file.parent, Scene).name == "column"
    single = file.with_name("dam.toml")
    single.write_text(GOOD)
    assert load(single, Scene).name == "dam"


def test_every_fault_of_a_file_comes_at_once_in_one_line_each(write) -> None:
    found = lines(
        write(
            """
viscosity = 3
tempo = 3
[flud]
spacing = 1
[fluid]
spacing = "0.3 s"
viscocity = 1
collision = "trtt"
gravity = [0, "x"]
wall = nan
[[grains]]
kind = "disc"
radius = -1
[[grains]]
kind = "clump"
members = [[1, 2], [3, "4 s"], [1]]
repeats = 2.5
[[grains]]
kind = "clamp"
[[grains]]
radius = 1
[clock]
step = true
frames = false
"""
        )
    )
    expected = [
        ("fluid.spacing = '0.3 s'", "does not measure the same thing as m", "> 0 and <= 1 m", "cell size"),
        ("fluid.collision = 'trtt'", "unknown choice", "'bgk' or 'trt'", "did you mean 'trt'?"),
        ("fluid.gravity[1] = 'x'", "is not a number", "m/s²"),
        ("fluid.wall = nan m", "is not finite", ">= 0 m"),
        ("fluid.viscocity = 1", "unknown key", "did you mean 'viscosity'?"),
        ("grains[0].radius = -1 m", "out of range", "> 0 m"),
        ("grains[1].members[1][1] = '4 s'", "does not measure the same thing as m"),
        ("grains[1].repeats = 2.5", "whole number", ">= 1"),
        ("grains[2].kind = 'clamp'", "disc, clump", "did you mean 'clump'?"),
        ("grains[3].kind: is missing", "clump, disc"),
        ("clock.duration: is missing", "> 0 s"),
        ("clock.step = True s", "is not a number"),
        ("clock.frames = 'false'", "whole number"),
        ("viscosity = 3: unknown key", "did you mean fluid.viscosity?"),
        ("tempo = 3: unknown key", "known keys: clock, fluid, grains, size"),
        ("flud: unknown section", "did you mean 'fluid'?"),
    ]
    assert len(found) == len(expected)
    for line, parts in zip(found, expected, strict=True):
        assert "scene.toml: " in line
        assert all(part in line for part in parts), (line, parts)


def test_checks_across_keys_join_the_list(write) -> None:
    found = lines(write(GOOD + "step = 3\n[[grains]]\nkind = 'disc'\nradius = 0"))
    assert any("clock.step = 3.0 s: is longer than the run" in line for line in found)
    assert any("grains[2].radius = 0 m: is out of range" in line for line in found)
    assert len(found) == 2
    (line,) = lines(write("size = 0.2\n" + GOOD.replace('"0.3 mm"', "0.5")))
    assert "fluid.spacing = 0.5 m: is larger than the domain" in line


def test_a_list_of_values_is_an_unknown_key_and_tables_are_an_unknown_section(write) -> None:
    (line,) = lines(write(f"lower = [0, 1]\n{GOOD}"))
    assert "lower: unknown key" in line
    (line,) = lines(write(f"{GOOD}\n[[lowest]]\nx = 1"))
    assert "lowest: unknown section" in line


def test_a_wrong_shape_is_named(write) -> None:
    found = lines(write("fluid = 3\nsize = [1]\n[clock]\nduration = 1\n[grains]\n[quality]\ndraft = 3"))
    assert [line.split("scene.toml: ")[1].split(";")[0] for line in found] == [
        "quality.draft = 3: is not a table",
        "fluid = 3: is not a section",
        "grains: is not a list",
        "size = [1.0] m: should be a valid number (allowed: > 0 m)",
    ]
    assert found[2].endswith("write [[grains]] and its keys below")
    twice = GOOD.replace("[fluid]", "[[fluid]]")
    assert lines(write(twice))[0].endswith(
        "fluid: is a list, where there is one only; write [fluid] once, its keys below"
    )
    assert lines(write(GOOD + "[[grains]]\nkind = 'clump'\nmembers = 3\n"))[0].endswith("write it as [ … ]")
    short = lines(write(GOOD.replace("spacing", "gravity = [1]\nspacing"))).pop()
    assert "fluid.gravity: entry [1] is missing" in short


@pytest.mark.parametrize(
    ("text", "words"), [("a = 1\nb =\nc = 2", "line 2"), ("[x", "line 1, end of file"), ("a = 1\na = 2", "line 2")]
)
def test_broken_toml_names_file_and_line(write, text: str, words: str) -> None:
    line = lines(write(text)).pop()
    assert "scene.toml: " in line
    assert words in line


def test_text_that_is_not_utf8_names_its_line(write) -> None:
    file = write("")
    file.write_bytes(b"a = 1\nb = '\xff'")
    assert "line 2: is not UTF-8" in lines(file).pop()


def test_a_missing_file_says_what_was_looked_for(tmp_path: Path) -> None:
    assert "looked for a file or folder" in lines(tmp_path / "nowhere").pop()
    assert f"looked for the file {tmp_path}/scene.toml" in lines(tmp_path).pop()


def test_later_wins_scene_then_quality_then_settings(write) -> None:
    file = write(
        'quality_default = "draft"\n' + GOOD + "[quality.draft.clock]\nstep = 0.2\nframes = 5\n"
        "[quality.fine.fluid]\nspacing = '0.1 mm'"
    )
    assert load(file, Scene).clock.step == 0.2
    fine = load(file, Scene, quality="fine")
    assert (fine.fluid.spacing, fine.clock.step) == (0.0001, 0.1)
    both = load(file, Scene, overrides=["clock.step=0.3", "clock.duration=4 s"])
    assert (both.clock.step, both.clock.frames, both.clock.duration) == (0.3, 5, 4.0)
    assert load(file, Scene).source.quality == "draft"
    assert load(file, Scene).source.levels == ("draft", "fine")


def test_an_absent_level_lists_those_it_has(write) -> None:
    file = write(GOOD + "[quality.draft]\n[quality.fine]")
    line = lines(file, quality="standard").pop()
    assert "allowed: draft, fine" in line
    assert "[quality.standard]" in line
    assert "allowed: none" in lines(write(GOOD), quality="fine").pop()
    assert "quality_default" in lines(write("quality_default = 'finest'\n" + GOOD)).pop()
    assert "did you mean 'fine'?" in lines(write(GOOD + "[quality.fin]")).pop()


def test_levels_are_validated_even_when_not_chosen(write) -> None:
    file = write(GOOD + "[quality.fine.fluid]\nspacingg = 1\nviscosity = -1\n[quality.draft.clock]\nstep = 9")
    expected = ["draft.clock.step = 9.0 s", "fine.fluid.viscosity = -1", "fine.fluid.spacingg = 1"]
    for quality in (None, "fine"):
        found = lines(file, quality=quality)
        assert len(found) == len(expected)
        assert all(any(f"quality.{part}" in line for line in found) for part in expected)


def test_settings_are_toml_values_else_texts(write) -> None:
    file = write(GOOD)
    scene = load(
        file,
        Scene,
        overrides=["grains[0].radius=3e-3", "grains.1.repeats=5", "fluid.collision=bgk", "fluid.gravity=[0,1]"],
    )
    assert scene.grains[0].radius == 0.003
    assert scene.grains[1].repeats == 5
    assert scene.fluid.collision == "bgk"
    assert scene.fluid.gravity == (0.0, 1.0)


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("fluid.spacng=1", "--set: fluid.spacng = 1: unknown key; did you mean 'spacing'?"),
        ("flud.spacing=1", "--set: flud: unknown section; did you mean 'fluid'?"),
        ("fluid.spacing", "--set: 'fluid.spacing': is not section.key=value"),
        ("=3", "is not section.key=value"),
        ("fluid.spacing=7", "--set: fluid.spacing = 7 m: is out of range"),
        ("grains[7].radius=1", "--set: grains[7]: no such entry of a list (allowed: 0 to 1)"),
        (
            "grains.radius=1",
            "--set: grains.radius: no such entry of a list (allowed: 0 to 1); name one, as in grains[0].radius=…",
        ),
        ("grains[7].members=1", "name one, as in grains[0].members=…"),
        ("fluid.stirred=perhaps", "fluid.stirred = 'perhaps': is neither true nor false; give true or false"),
        ("clock.step=9", "--set: clock.step = 9.0 s: is longer than the run"),
    ],
)
def test_a_wrong_setting_is_blamed_on_set(write, setting: str, words: str) -> None:
    found = lines(write(GOOD), overrides=[setting])
    assert len(found) == 1
    assert words in found[0]


def test_sections_are_frozen() -> None:
    with pytest.raises(InputError, match="with_"):
        Disc(radius=1.0).radius = 2.0


POSITIVE = st.floats(min_value=1e-9, max_value=1.0)
DISCS = st.fixed_dictionaries({"kind": st.just("disc"), "radius": POSITIVE})
PAIRS = st.lists(st.tuples(POSITIVE, POSITIVE), max_size=3)
CLUMPS = st.fixed_dictionaries({"kind": st.just("clump"), "members": PAIRS})
TABLES = st.fixed_dictionaries(
    {"clock": st.fixed_dictionaries({"duration": POSITIVE, "step": st.just(1e-9)})},
    optional={"grains": st.lists(st.one_of(DISCS, CLUMPS), max_size=3), "size": POSITIVE},
)


@given(TABLES)
def test_the_full_scene_written_and_read_is_the_same_scene(table: dict) -> None:
    scene = validate(Scene, table)
    assert validate(Scene, json.loads(json.dumps(scene_as_dict(scene)))) == scene


NAMES = st.sampled_from(["a", "b", "c"])
NESTED = st.recursive(st.integers(), lambda inner: st.dictionaries(NAMES, inner, max_size=3), max_leaves=6)
TREES = st.dictionaries(NAMES, NESTED, max_size=3)


@given(TREES, TREES)
def test_what_is_laid_over_is_there_and_nothing_given_changes(base: dict, over: dict) -> None:
    before = json.dumps([base, over])
    merged = merge(base, over)
    assert merge(merged, over) == merged  # once is enough
    assert json.dumps([base, over]) == before
    assert all(holds(merged, (name,)) for name in over)
    assert merge(base, {}) == base


@given(TREES, st.lists(NAMES, min_size=1, max_size=3), st.integers())
def test_what_is_assigned_is_found_there(table: dict, names: list[str], value: int) -> None:
    assigned = assign(table, tuple(names), value)
    for name in names:
        assigned = assigned[name]
    assert assigned == value


@given(st.lists(st.one_of(st.from_regex(r"[a-z_]+", fullmatch=True), st.integers(0, 99)), min_size=1, max_size=20))
def test_keys_written_and_parsed_are_the_same(parts: list) -> None:
    key = ("root", *parts)
    assert parse_key(dotted(key)) == key
    assert parse_setting(f"{dotted(key)}=1") == (key, 1)


@pytest.mark.parametrize("text", ["a." * 2000 + "b=1", "a=" + "[" * 5000, "a=" + "[" * 100 + "]" * 100])
def test_what_is_nested_without_end_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="without end"):
        parse_setting(text)


def test_digits_that_count_nothing_are_text() -> None:
    digits = "9" * 5000  # more than Python makes a number of
    assert parse_setting(f"a={digits}") == (("a",), digits)
    assert parse_setting(f"a.{digits}=1") == (("a", digits), 1)
    assert parse_setting("a.\N{SUPERSCRIPT TWO}=1") == (("a", "\N{SUPERSCRIPT TWO}"), 1)


def test_all_keys_of_a_scene_are_known() -> None:
    keys = {dotted(key) for key in every_key(Scene)}
    assert {"fluid", "fluid.spacing", "grains.radius", "grains.members", "clock.step"} <= keys


def test_words_are_one_of_the_choices_beside_numbers() -> None:
    assert Fluid(spacing=0.1, viscosity="auto").viscosity == "auto"
    with pytest.raises(InputError) as caught:
        validate(Fluid, {"spacing": 0.1, "viscosity": "automatic"})
    assert 'allowed: "auto", > 0' in str(caught.value)


@pytest.mark.parametrize("default", ["[1, 2, 3]", "{ a = 1 }", "3", "true"])
def test_a_default_level_that_is_no_name_is_said(write, default: str) -> None:
    (said,) = lines(write(f"quality_default = {default}\n" + GOOD))
    assert "quality_default" in said
    assert 'is not the name of a level (allowed: draft, standard, fine); write it as "draft"' in said


def test_a_byte_order_mark_is_no_part_of_a_file(write) -> None:
    assert load(write("\ufeff" + GOOD), Scene) == load(write(GOOD), Scene)
    (said,) = lines(write("\ufeff" + GOOD + "wrong"))  # the twin: what is wrong is said as without it
    assert "\ufeff" not in said
