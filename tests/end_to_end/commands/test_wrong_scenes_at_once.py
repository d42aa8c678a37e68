"""Scenes are checked before a compiler is imported for them, so that a wrong one is answered at once."""

import shutil
import sys

import pytest

from tests.reference.folders import ROOT
from tests.reference.waiting import done

FIRST = {
    "porescale": "from porescale.cli.main import commands as app",
    "continuum_sph": "from continuum_sph.cli import PACKAGE\n"
    "from porescale.common.cli.application import application\napp = lambda: application(PACKAGE)",
}
SCRIPT = """\
import sys
{first}
from porescale.common.cli.application import main
code = main(app(), sys.argv[1:])
print("numba" in sys.modules)
sys.exit(code)
"""


def run(package: str, *words: object) -> tuple[int, bool, list[str]]:
    """Exit code of a command line, whether numba was imported, and the lines on stderr."""
    text = SCRIPT.format(first=FIRST[package])
    ended = done([sys.executable, "-c", text, *words], cwd=ROOT)
    assert "Traceback" not in ended.stderr, ended.stderr
    return ended.returncode, ended.stdout.splitlines()[-1] == "True", ended.stderr.splitlines()


@pytest.mark.parametrize("package", FIRST)
def test_what_is_no_scene_is_said_before_numba_is_imported(tmp_path, package):
    (tmp_path / "torn.toml").write_text("[domain\nwidth = 1\n")
    (tmp_path / "latin.toml").write_bytes("title = 'Körner'\n".encode("latin-1"))
    code, compiler, lines = run(package, "run", tmp_path / "torn.toml", "--out", tmp_path / "out")
    assert (code, compiler, len(lines)) == (2, False, 1)
    assert "torn.toml: line 1" in lines[0]
    for name, words in (("none.toml", "no scene here"), ("latin.toml", "is not UTF-8"), ("torn.toml", "line 1")):
        code, compiler, lines = run(package, "check", tmp_path / name)
        assert (code, compiler, len(lines)) == (2, False, 1)
        assert words in lines[0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["latin.toml", "torn.toml"]


WRONG = {
    "porescale": ("porescale/cli", "grains.packing.width=99", "out of the box", "fluid.viskosity=1e-6", "'viscosity'"),
    "continuum_sph": ("continuum_sph", "tank.width=0.1", "beyond the tank", "tank.hight=3", "'height'"),
}
"""By package: folder of its template; a number that others contradict and words of its fault; a key that there is
none of and what it is taken for."""


@pytest.mark.parametrize("package", FIRST)
def test_a_scene_is_checked_before_numba_is_imported_whatever_is_wrong_with_it(tmp_path, package):
    folder, number, said, key, meant = WRONG[package]
    scene = shutil.copy(ROOT / folder / "template.toml", tmp_path / "scene.toml")
    for words in (["check", scene], ["run", scene, "--out", tmp_path / "out"]):
        code, compiler, lines = run(package, *words, "--set", number)
        assert (code, compiler) == (2, False)
        assert said in "".join(lines)
    code, compiler, lines = run(package, "run", scene, "--set", key, "--set", "time.end=-1", "--out", tmp_path / "out")
    assert (code, compiler, len(lines)) == (2, False, 2)
    assert f"did you mean {meant}" in "".join(lines)
    assert "out of range" in "".join(lines)
    # The twin: the question can be answered otherwise, here by what counts the machine's threads.
    code, compiler, lines = run(package, "run", scene, "--threads", 0, "--out", tmp_path / "out")
    assert (code, compiler, len(lines)) == (2, True, 1)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("package", "case"), [("porescale", "column_collapse"), ("continuum_sph", "collapsing_water_column")]
)
def test_what_only_a_run_needs_check_does_not_wait_for(package, case):
    script = SCRIPT.replace('print("numba" in sys.modules)', "print(sorted(set(sys.modules) & set(HEAVY)))")
    code = f"HEAVY = {HEAVY}\n{script.format(first=FIRST[package])}"
    ended = done([sys.executable, "-c", code, "check", case], cwd=ROOT)
    assert (ended.returncode, ended.stdout.splitlines()[-1]) == (0, "[]"), ended.stderr
    ended = done([sys.executable, "-c", f"import scipy, h5py\n{code}", "check", case], cwd=ROOT)  # the twin
    assert ended.stdout.splitlines()[-1] == "['h5py', 'scipy']"


HEAVY = ("numba", "scipy", "h5py", "matplotlib", "contourpy", "PIL", "av")
