"""Cases are found by name from any folder, in a checkout and where only the packages are installed."""

import os
import shlex
import shutil
from pathlib import Path

import pytest

from porescale.common.api import shipped
from porescale.common.core.errors import InputError
from tests.reference.folders import CASES


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_folder_with_a_readme_is_a_case():
    assert [case.name for case in shipped.cases()] == sorted(path.parent.name for path in CASES.glob("*/README.md"))


def test_a_case_says_what_runs_it():
    found = {case.name: case for case in shipped.cases()}
    assert found["column_collapse"].command == "porescale run column_collapse"
    assert found["collapsing_water_column"].command == "continuum-sph run collapsing_water_column"
    assert found["demseg_disc"].command == "porescale demseg run demseg_disc"
    assert found["rock"].command.split() == ["python", os.path.relpath(CASES / "rock" / "rock.py")]
    assert {case.kind for case in found.values()} == {"scene", "deck", "script"}
    assert all(case.title and "\n" not in case.title for case in found.values())


def test_every_script_and_scene_named_is_there(elsewhere):
    for case in shipped.cases():
        assert all(shipped.find_case(name) is not None for name in case.scenes)
        if case.kind == "script":
            assert Path(case.command.removeprefix("python ")).is_file()


def test_a_case_is_found_by_name_from_any_folder(elsewhere):
    assert shipped.find_case("column_collapse") == CASES / "column_collapse"
    assert shipped.find_case("clump") == CASES / "clump" / "clump.toml"  # its only scene
    assert shipped.find_case("micro_to_macro/bed.toml") == CASES / "micro_to_macro" / "bed.toml"
    assert shipped.find_case("demseg_control/moved") == CASES / "demseg_control" / "moved"


@pytest.mark.parametrize(
    "name", ["", ".", "..", "../cases/piston", "no_such_case", "piston/none.toml", "x" * 5000, "a\0b", "/", "README.md"]
)
def test_what_is_no_case_is_none(elsewhere, name):
    assert shipped.find_case(name) is None


def test_a_path_that_exists_wins(elsewhere):
    (elsewhere / "piston").mkdir()
    assert shipped.scene_path("piston") == Path("piston")
    (elsewhere / "piston").rmdir()
    assert shipped.scene_path("piston") == CASES / "piston"


@pytest.mark.parametrize(
    ("name", "program", "said"),
    [
        ("colum_collapse", "", "did you mean the case 'column_collapse'?"),
        ("rock", "", "python"),
        ("demseg_disc", "", "porescale demseg run demseg_disc"),
        ("micro_to_macro", "", "micro_to_macro/bed.toml"),
        ("piston", "continuum-sph", "porescale run piston"),
    ],
)
def test_a_case_that_cannot_be_run_so_says_what_can(elsewhere, name, program, said):
    with pytest.raises(InputError) as refused:
        shipped.scene_path(name, program)
    (fault,) = refused.value.faults
    assert said in fault.repair


@pytest.mark.parametrize("name", ["demseg_disc", "rock", "micro_to_macro"])
def test_a_case_by_its_path_says_what_can_run_it_as_by_its_name(elsewhere, name):
    with pytest.raises(InputError, match="of a case, no scene") as refused:
        shipped.scene_path(CASES / name)
    assert refused.value.faults[0].repair == fault_by_name(name).repair


def fault_by_name(name):
    with pytest.raises(InputError) as refused:
        shipped.scene_path(name)
    return refused.value.faults[0]


def test_the_only_scene_of_a_case_is_found_by_the_path_of_its_folder(elsewhere):
    assert shipped.scene_path(CASES / "clump") == CASES / "clump" / "clump.toml"


def test_any_deck_says_what_runs_it(elsewhere):
    shutil.copytree(CASES / "demseg_disc", elsewhere / "my deck")
    for given in ("my deck", "demseg_control/moved"):
        with pytest.raises(InputError, match="is a deck of DEMseg, no scene") as refused:
            shipped.scene_path(given)
        assert f"porescale demseg run {shlex.quote(given)}" in refused.value.faults[0].repair
    (elsewhere / "my deck" / "scene.toml").touch()
    assert shipped.scene_path("my deck") == Path("my deck")


def test_what_is_near_to_no_case_is_left_to_the_reader_of_files(elsewhere):
    assert shipped.scene_path("something else") == Path("something else")
    (elsewhere / "pistol.toml").write_text("", encoding="utf-8")
    assert shipped.scene_path("pistol") == Path("pistol")  # its reader asks whether pistol.toml is meant


def test_an_installed_package_has_them_beside_it_and_one_without_has_none(tmp_path, monkeypatch):
    monkeypatch.setattr(shipped, "__file__", str(tmp_path / "porescale" / "common" / "api" / "shipped.py"))
    assert shipped.cases_folder() is None
    shutil.copytree(CASES / "piston", tmp_path / "cases" / "piston")
    assert shipped.cases_folder() is None  # a folder "cases" of someone else's
    shutil.copytree(CASES / "piston", tmp_path / "porescale_cases" / "piston")
    assert shipped.find_case("piston") == tmp_path / "porescale_cases" / "piston"
    (tmp_path / "pyproject.toml").touch()
    shutil.rmtree(tmp_path / "porescale_cases")
    assert shipped.find_case("piston") == tmp_path / "cases" / "piston"
