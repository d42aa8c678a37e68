"""Scenes of porescale from Python: by name, by path, from sections; their errors are public."""

import pickle
from pathlib import Path

import pytest

import porescale as ps


def line(act) -> str:
    with pytest.raises(ps.InputError) as caught:
        act()
    (only,) = caught.value.faults
    return only.line()


def test_a_case_has_a_name_and_a_path_precedes_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = ps.load("column_collapse")
    assert (scene.name, scene.source.quality) == ("column_collapse", "draft")
    own = tmp_path / "column_collapse"
    own.mkdir()
    (own / "scene.toml").write_text(scene.source.file.read_text().replace("0.5 s", "0.25 s").replace("title", "#"))
    assert ps.load("column_collapse").source.file.resolve() == own / "scene.toml"
    (own / "scene.toml").unlink()  # a folder without a scene is none of the shipped ones
    assert "no scene here" in line(lambda: ps.load("column_collapse"))


def test_an_unknown_name_gives_the_nearest_in_one_line() -> None:
    assert "did you mean the case 'column_collapse'?" in line(lambda: ps.load("colum_colapse"))
    assert "looked for a file or folder" in line(lambda: ps.load("qqq"))
    assert "is a case of continuum-sph" in line(lambda: ps.load("collapsing_water_column"))


def test_settings_are_texts_or_a_mapping() -> None:
    texts = ps.load("column_collapse", quality="fine", settings=["contact.friction=0.25", "gravity=[0, -5]"])
    assert texts == ps.load(
        "column_collapse", quality="fine", settings={"contact.friction": 0.25, "gravity": (0, -5.0)}
    )
    assert texts != ps.load("column_collapse", quality="fine")
    wrong = line(lambda: ps.load("column_collapse", settings={"contact.fricton": 1}))
    assert wrong == line(lambda: ps.load("column_collapse", settings=["contact.fricton=1"]))
    assert "did you mean 'friction'" in wrong
    assert "leave it out" in line(lambda: ps.load("column_collapse", settings={"contact.friction": None}))


def test_scenes_of_python_are_those_of_files() -> None:
    scene = ps.load("column_collapse")
    assert ps.Scene(**{name: getattr(scene, name) for name in scene.model_fields_set}) == scene
    assert ps.Scene(**scene.to_dict()) == scene
    with pytest.raises(ps.InputError) as caught:
        ps.Scene(domain={"widht": 1, "height": "3 s"}, fluid={"viscocity": 1})
    found = str(caught.value)
    assert "domain.widht = 1: unknown key; did you mean 'width'?" in found
    assert "fluid.viscocity = 1: unknown key; did you mean 'viscosity'?" in found
    assert "time: is missing" in found
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene
    assert type(again) is ps.Scene


def test_errors_and_warnings_are_public() -> None:
    assert issubclass(ps.InputError, ps.PorescaleError)
    assert issubclass(ps.Unstable, ps.PorescaleError)
    assert issubclass(ps.PorescaleWarning, UserWarning)
