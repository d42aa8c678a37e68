"""Cases that come with the packages are listed, checked and copied from any folder."""

import json
import shutil

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE, commands
from porescale.common.api import shipped
from porescale.common.cli import application
from tests.reference.folders import CASES


@pytest.fixture
def run(tmp_path, tmp_path_factory, monkeypatch, capsys):
    """Runs a command line of porescale in an empty folder: exit code, stdout, stderr.  No run of this machine is known:
    what `check` expects would change where another test's run ends between two calls."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))

    def ran(*words, app=None):
        code = application.main(app or commands(), words)
        return code, *capsys.readouterr()

    return ran


def test_cases_are_listed_with_what_runs_them(run):
    code, out, _ = run("cases")
    assert code == 0
    assert len(out.splitlines()) == len(shipped.cases())
    line = next(it for it in out.splitlines() if it.startswith("column_collapse "))
    assert "Underwater column collapse" in line
    assert line.endswith("porescale run column_collapse")


def test_both_packages_list_the_same(run):
    rows = json.loads(run("cases", "--json")[1])
    assert rows == json.loads(run("cases", "--json", app=application.application(CONTINUUM))[1])
    assert {"name", "title", "package", "kind", "path", "scenes", "command"} == set(rows[0])


def test_without_cases_it_says_so(run, monkeypatch):
    monkeypatch.setattr(shipped, "cases", lambda: ())
    code, out, said = run("cases")
    assert (code, out, said) == (1, "", "no cases were installed with the packages\n")


def test_a_case_is_checked_by_name(run, tmp_path):
    by_name, by_path = (run("check", name, "--json") for name in ("piston", str(CASES / "piston")))
    assert by_name[0] == 0
    assert by_name == by_path
    (tmp_path / "piston").mkdir()  # a folder of that name wins, and holds no scene
    assert run("check", "piston")[0] == 2


@pytest.mark.parametrize(
    "words", [("check", "pistn"), ("run", "pistn"), ("sweep", "pistn", "--vary", "time.end=1,2"),
              ("study", "trade", "pistn"), ("study", "levels", "pistn"), ("homogenise", "pistn")],
)  # fmt: skip
def test_a_wrong_name_is_answered_with_the_nearest(run, tmp_path, words):
    code, out, said = run(*words)
    assert (code, out, len(said.splitlines())) == (2, "", 1)
    assert "did you mean the case 'piston'?" in said
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "name", ["column_collapse", "rock", "demseg_chain", "micro_to_macro", "collapsing_water_column"]
)
def test_a_case_is_copied_with_what_it_needs(run, tmp_path, name):
    code, out, said = run("new", "mine", "--from", name)
    assert (code, said) == (0, "")
    copied = {path.relative_to(tmp_path / "mine") for path in (tmp_path / "mine").rglob("*") if path.is_file()}
    there = {path.relative_to(CASES / name) for path in (CASES / name).rglob("*") if path.is_file()}
    kept = {path for path in there if path.suffix in (".toml", ".dat", ".py", ".csv") or path.name == "front.json"}
    assert copied == kept
    assert all((tmp_path / "mine" / path).read_bytes() == (CASES / name / path).read_bytes() for path in copied)
    assert "next: " in out


def test_a_copied_scene_means_the_same(run):
    run("new", "mine", "--from", "piston")
    assert run("check", "mine", "--json")[1] == run("check", "piston", "--json")[1]


def test_nothing_that_is_there_is_written_over(run, tmp_path):
    (tmp_path / "mine").mkdir()
    code, out, said = run("new", "mine", "--from", "piston")
    assert (code, out) == (2, "")
    assert said.startswith("mine: exists already")
    assert not list((tmp_path / "mine").iterdir())


def test_a_copy_is_whole_or_absent(run, tmp_path, monkeypatch):
    own, copied = shutil.copyfile, []

    def fails(source, target, **options):
        copied.append(own(source, target, **options))
        if len(copied) == 2:
            raise OSError(28, "No space left on device", str(target))
        return target

    monkeypatch.setattr(shutil, "copyfile", fails)
    code, out, said = run("new", "mine", "--from", "column_collapse")
    assert (code, out) == (2, "")
    assert "No space left on device" in said
    assert len(said.splitlines()) == 1
    assert copied
    assert not list(tmp_path.iterdir())


def test_an_unknown_case_is_answered_with_the_nearest(run, tmp_path):
    code, _, said = run("new", "mine", "--from", "pistn")
    assert code == 2
    assert "did you mean 'piston'?" in said
    assert not list(tmp_path.iterdir())


def test_decks_are_found_by_name(run, tmp_path):
    assert run("demseg", "convert", "demseg_disc")[0] == 0
    assert (tmp_path / "demseg_disc.toml").is_file()


def test_package_names_are_those_of_the_cases():
    assert {case.package for case in shipped.cases()} == {PACKAGE.name, CONTINUUM.name}


def test_python_lists_the_same_cases():
    import continuum_sph
    import porescale

    assert porescale.cases() == continuum_sph.cases() == shipped.cases()
