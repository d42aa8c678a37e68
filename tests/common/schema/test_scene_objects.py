"""Scenes as objects of Python: the messages of files, changed copies, equality, pickles."""

import copy
import pickle
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pydantic
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porescale.common.core.errors import Fault
from porescale.common.schema.diff import diff
from porescale.common.schema.scene import SceneBase
from porescale.common.schema.scene_file import parse_setting, setting_text
from porescale.common.schema.sections import Section, load, quantity, validate
from tests.reference.scenes import refusals


class Probe(Section):
    x: float = quantity("m", ge=0, le=1, help="place")
    name: str = ""


class Fluid(Section):
    spacing: float = quantity("m", gt=0, le=1, help="cell size")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0))

    @pydantic.model_validator(mode="before")
    @classmethod
    def _folder(cls, table: Any, info: pydantic.ValidationInfo) -> Any:
        if isinstance(table, dict) and (name := table.pop("read", None)):  # a key that is a file, as circles are
            table["spacing"] = float(((info.context or {}).get("folder") or Path()).joinpath(name).read_text())
        return table

    def _faults(self) -> list[Fault]:
        return [Fault("velocity", None, "is of a spacing that is none")] if self.spacing == 0.5 else []


class Scene(SceneBase):
    title: str = ""
    fluid: Fluid | None = None
    probe: tuple[Probe, ...] = ()


WRONG: dict[str, Any] = {"flud": {}, "fluid": {"spacin": 1, "velocity": ["1 kg", 2]}, "probe": [{"x": 3}, {"x": 0}]}


def test_python_has_the_messages_of_files_every_fault_at_once() -> None:
    found = refusals(lambda: Scene(**WRONG))
    assert found == refusals(lambda: validate(Scene, WRONG))
    assert "fluid.spacin = 1: unknown key; did you mean 'spacing'?" in found
    assert len(found) == 5  # the spacing is missing, too
    assert refusals(lambda: Fluid(spacin=1, spacing=1)) == ["spacin = 1: unknown key; did you mean 'spacing'?"]
    assert refusals(lambda: Scene(probe=[{"x": 2}], fluid={"spacing": 0.5})) == [
        "fluid.velocity: is of a spacing that is none",
        "probe[0].x = 2 m: is out of range (allowed: >= 0 and <= 1 m); give the place in this range",
    ]


def test_lists_of_another_length_and_numbers_that_are_not_whole_are_refused_in_plain_words() -> None:
    class Picture(Section):
        limits: tuple[float, float] = (0.0, 1.0)
        fields: tuple[str, ...] = pydantic.Field(("speed",), min_length=1, description="which fields")
        size: int = pydantic.Field(10, description="long side")
        number: int = pydantic.Field(1, description="how many there are")
        name: str = pydantic.Field("a", min_length=1)

    assert refusals(lambda: Picture(limits=[0, 1, 2], fields=[], size="x", number=1.5, name="")) == [
        "limits = [0, 1, 2]: has 3 entries where at most 2 belong",
        "fields = []: has 0 entries where at least 1 belongs; give which fields",
        "size = 'x': is not a whole number; give the long side",
        "number = 1.5: is not a whole number; give how many there are",
        "name = '': is empty",
    ]


def test_nested_sections_are_no_doors_of_their_own(tmp_path: Path) -> None:
    """Without the mark of its ``__init__`` pydantic would call that of every nested section, and lose the folder."""
    (tmp_path / "spacing.txt").write_text("0.25")
    assert validate(Scene, {"fluid": {"read": "spacing.txt"}}, folder=tmp_path).fluid.spacing == 0.25

    class Door(Fluid):
        def __init__(self, /, **keys: Any) -> None:
            super().__init__(**keys)

    class Deep(SceneBase):
        fluid: Door

    with pytest.raises(FileNotFoundError):  # the check that must fail
        validate(Deep, {"fluid": {"read": "spacing.txt"}}, folder=tmp_path)


def test_sections_tables_arrays_and_texts_make_the_same_scene() -> None:
    whole = Scene(fluid=Fluid(spacing="1 mm", velocity=(1, 2)), probe=(Probe(x=1), {"x": "1 cm"}))
    assert whole == Scene(fluid={"spacing": 1e-3, "velocity": np.array([1.0, 2.0])}, probe=[{"x": 1}, Probe(x=0.01)])
    assert whole != Scene(fluid={"spacing": 1e-3, "velocity": [1, 2.5]}, probe=[{"x": 1}, {"x": 0.01}])
    assert Scene(**whole.to_dict()) == whole
    assert whole.with_({"fluid.velocity": np.float64(1.0) * np.ones(2)}).fluid.velocity == (1.0, 1.0)


def test_a_scene_does_not_change() -> None:
    scene = Scene(fluid={"spacing": 1e-3})
    assert refusals(lambda: setattr(scene.fluid, "spacing", 2.0)) == [
        "spacing = 2.0: cannot be assigned, a scene never changes; "
        'make a changed copy, scene.with_({"SECTION.spacing": VALUE})'
    ]
    assert "did you mean 'spacing'" in refusals(lambda: setattr(scene.fluid, "spacin", 2.0))[0]
    assert "with_" in refusals(lambda: delattr(scene, "title"))[0]
    assert scene.fluid.spacing == 1e-3


def test_a_changed_copy_has_the_messages_of_settings(tmp_path: Path) -> None:
    file = tmp_path / "dam.toml"
    file.write_text("[fluid]\nspacing = 0.1\n[[probe]]\nx = 0.5\n")
    scene = load(file, Scene)
    before = scene.to_dict()
    changed = scene.with_({"fluid.spacing": "2 mm", "probe.0.x": 0.25, "title": "t"})
    assert (changed.fluid.spacing, changed.probe[0].x, changed.title, changed.name) == (2e-3, 0.25, "t", "dam")
    assert scene.to_dict() == before
    assert changed == load(file, Scene, overrides=changed.source.settings)
    for key, value in (
        ("fluid.spacin", 1),
        ("fluid.spacing", "2 s"),
        ("probe[1].x", 0),
        ("flud.spacing", 1),
        ("fluid", 3),
    ):
        asked = refusals(lambda key=key, value=value: load(file, Scene, overrides=[setting_text(key, value)]))
        told = refusals(lambda key=key, value=value: scene.with_({key: value}))
        assert told == [line.removeprefix("--set: ") for line in asked]
    assert refusals(lambda: scene.with_({"no key": 1})) == ["'no key': is not section.key; write it as \"time.end\""]
    assert len(refusals(lambda: scene.with_({"fluid.spacing": 3, "probe[0].x": -1, "titel": "a"}))) == 3


def test_sections_come_and_go() -> None:
    bare = Scene(title="bare")
    full = bare.with_({"fluid.spacing": 0.25, "probe": [{"x": 0.5}, Probe(x=0.75, name="b")]})
    assert full == Scene(title="bare", fluid={"spacing": 0.25}, probe=[{"x": 0.5}, {"x": 0.75, "name": "b"}])
    assert full.with_({"fluid": None, "probe": None}) == bare
    assert bare.with_({"fluid": None, "fluid.spacing": None}) == bare
    assert refusals(lambda: full.with_({"fluid.spacing": None})) == [
        "fluid.spacing: is missing (allowed: > 0 and <= 1 m); add spacing = … (cell size)"
    ]
    assert refusals(lambda: full.with_({"fluid.spacin": None}))[0].startswith("fluid.spacin: unknown key; did you mean")
    assert "cannot be taken out" in refusals(lambda: full.with_({"probe[0]": None}))[0]


def test_names_of_files_go_on_meaning_the_same_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "spacing.txt").write_text("0.25")
    (tmp_path / "scene.toml").write_text('[fluid]\nread = "spacing.txt"\n')
    monkeypatch.chdir(tmp_path)
    scene = load("scene.toml", Scene)
    monkeypatch.chdir("/")
    assert scene.with_({"title": "a"}).with_({"title": ""}) == scene
    assert pickle.loads(pickle.dumps(scene)).with_({"title": "a"}).fluid.spacing == 0.25
    assert scene.with_({"fluid.read": None, "fluid.spacing": 0.5e-1}) == Scene(fluid={"spacing": 0.05})


def test_equal_scenes_are_one_key_and_copies_are_equal(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("[fluid]\nspacing = 0.1\n")
    scene, made = load(tmp_path / "a.toml", Scene), Scene(fluid={"spacing": "10 cm"})
    assert scene == made
    assert len({scene, made, pickle.loads(pickle.dumps(scene)), copy.copy(scene), copy.deepcopy(scene)}) == 1
    assert made.model_copy(update={"title": "b"}).with_({"fluid.spacing": 0.2}).title == "b"
    assert len({scene, made.with_({"fluid.velocity": [0, 1]})}) == 2
    assert pickle.loads(pickle.dumps(scene)).source == scene.source


TEXTS = st.text(st.characters(codec="utf-8"))
VALUES = st.recursive(
    st.booleans() | st.integers(-(2**62), 2**62) | st.floats(allow_nan=False, allow_infinity=False) | TEXTS,
    lambda below: st.lists(below, max_size=3) | st.dictionaries(TEXTS, below, max_size=3),
    max_leaves=8,
)  # fmt: skip


@given(value=VALUES)
def test_a_setting_keeps_every_bit_of_its_value(value: Any) -> None:
    assert parse_setting(setting_text("a.b[2].c", value)) == (("a", "b", 2, "c"), value)


def test_a_saved_scene_is_the_same_scene_from_its_new_place(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "spacing.txt").write_text("0.25")
    (tmp_path / "a" / "dam.toml").write_text('title = "A dam"\n[fluid]\nread = "spacing.txt"\nvelocity = [0.0, 0.0]\n')
    scene = load(tmp_path / "a" / "dam.toml", Read).with_({"probe": [{"x": 1.0 / 3.0}]})
    file = scene.save(tmp_path / "b" / "c" / "scene.toml")
    assert load(file, Read) == scene
    assert load(file, Read).with_({"title": "other"}).fluid.spacing == 0.25
    assert "velocity" not in file.read_text()  # as by default
    assert 'read = "../../a/spacing.txt"' in file.read_text()
    assert load(scene.save(tmp_path), Read) == scene  # a folder gets a scene.toml


class ReadFluid(Fluid):
    files: ClassVar[tuple[str, ...]] = ("read",)


class Read(SceneBase):
    title: str = ""
    fluid: ReadFluid | None = None
    probe: tuple[Probe, ...] = ()


def test_a_scene_is_saved_whole_or_not_at_all(tmp_path: Path) -> None:
    scene = Scene(fluid={"spacing": 0.1})
    file = scene.save(tmp_path / "a.toml")
    before = file.read_bytes()
    assert refusals(lambda: scene.save(file)) == [f"{file}: exists already; name another file, or give overwrite=True"]
    assert file.read_bytes() == before
    scene.with_({"title": "b"}).save(file, overwrite=True)
    assert load(file, Scene).title == "b"
    (tmp_path / "spacing.txt").write_text("0.25")
    made = validate(Read, {"fluid": {"read": "spacing.txt"}}, folder=tmp_path)
    (tmp_path / "spacing.txt").write_text("0.75")  # what the file says now is another scene
    assert load(made.save(tmp_path / "b.toml"), Read) == made  # its numbers are written in place of the file's name


def test_the_difference_of_two_scenes_key_by_key() -> None:
    a = Scene(title="a", fluid={"spacing": 0.1}, probe=[{"x": 0.5}])
    b = Scene(title="a", fluid={"spacing": 0.2, "velocity": (0, 1)}, probe=[{"x": 0.5}, {"x": 1, "name": "<b>"}])
    assert dict(diff(a, b, Scene)) == {
        "fluid.spacing": (0.1, 0.2),
        "fluid.velocity": ((0.0, 0.0), (0.0, 1.0)),
        "probe[1].x": (None, 1.0),
        "probe[1].name": (None, "<b>"),
    }
    assert dict(diff(a, a.with_({"fluid": None}), Scene))["fluid.spacing"] == (0.1, None)
    assert not diff(a, Scene(**a.to_dict()), Scene)
    assert repr(diff(a, a, Scene)) == "no difference"
    assert len(repr(diff(a, b, Scene)).splitlines()) == 3
    assert str(diff(a, b, Scene)).splitlines()[0] == "fluid.spacing   0.1 -> 0.2 m"
    assert "&lt;b&gt;" in diff(a, b, Scene)._repr_html_()
    card = SimpleNamespace(card={"scene": b.to_dict(), "scene_file": None})
    assert diff(a, card, Scene) == diff(a, b, Scene)
    assert "is neither a scene" in refusals(lambda: diff(a, 3, Scene))[0]


def test_what_a_scene_shows_of_itself_is_short() -> None:
    scene = Scene(title="x" * 300, fluid={"spacing": 0.1}, probe=[{"x": 0.5}] * 500)
    shown = repr(scene).splitlines()
    assert len(shown) <= 3
    assert max(map(len, shown)) <= 120
    assert shown[1:] == ["sections: fluid, probe (500)", "fluid.spacing = 0.1 m"]
    assert repr(scene.fluid) == "Fluid(spacing=0.1 m)"
    assert scene._repr_html_().count("<tr>") < 10
    assert "cell size" in scene._repr_html_()
