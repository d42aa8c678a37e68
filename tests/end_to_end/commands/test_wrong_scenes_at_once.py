"""Scenes are checked before a compiler is imported for them, so that a wrong one is answered at once."""

import json
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
import contextlib, io, json, sys
{first}
from porescale.common.cli.application import main
ended = []
for words in json.loads(sys.argv[1]):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
        code = main(app(), words)
    ended.append((code, "numba" in sys.modules, said.getvalue().splitlines()))
print(json.dumps(ended))
"""


def run(package: str, *lines: list[object]) -> list[tuple[int, bool, list[str]]]:
    """Of command lines, one after the other in one process: exit code, whether numba was imported by then, and the
    lines on stderr."""
    text, words = SCRIPT.format(first=FIRST[package]), json.dumps([[*map(str, line)] for line in lines])
    ended = done([sys.executable, "-c", text, words], cwd=ROOT)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "Traceback" not in ended.stdout
    return [tuple(it) for it in json.loads(ended.stdout)]


@pytest.mark.parametrize("package", FIRST)
def test_what_is_no_scene_is_said_before_numba_is_imported(tmp_path, package):
    (tmp_path / "torn.toml").write_text("[domain\nwidth = 1\n")
    (tmp_path / "latin.toml").write_bytes("title = 'Körner'\n".encode("latin-1"))
    names = ("none.toml", "latin.toml", "torn.toml")
    checks = (["check", tmp_path / name] for name in names)
    found = run(package, ["run", tmp_path / "torn.toml", "--out", tmp_path / "out"], *checks)
    said = ("torn.toml: line 1", "no scene here", "is not UTF-8", "line 1")
    for (code, compiler, lines), words in zip(found, said, strict=True):
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
    out = ["--out", tmp_path / "out"]
    *contradicted, unknown, twin = run(
        package,
        ["check", scene, "--set", number],
        ["run", scene, *out, "--set", number],
        ["run", scene, "--set", key, "--set", "time.end=-1", *out],
        ["run", scene, "--threads", 0, *out],
    )
    for code, compiler, lines in contradicted:
        assert (code, compiler) == (2, False)
        assert said in "".join(lines)
    code, compiler, lines = unknown
    assert (code, compiler, len(lines)) == (2, False, 2)
    assert f"did you mean {meant}" in "".join(lines)
    assert "out of range" in "".join(lines)
    # The twin: the question can be answered otherwise, here by what counts the machine's threads.
    code, compiler, lines = twin
    assert (code, compiler, len(lines)) == (2, True, 1)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("package", "case"), [("porescale", "column_collapse"), ("continuum_sph", "collapsing_water_column")]
)
def test_what_only_a_run_needs_check_does_not_wait_for(package, case):
    text = LOADED.format(first=FIRST[package], heavy=HEAVY)
    ended = done([sys.executable, "-c", text, "check", case], cwd=ROOT)
    assert (ended.returncode, ended.stdout.splitlines()[-2:]) == (0, ["[]", "['h5py', 'scipy']"]), ended.stderr


LOADED = """\
import sys
{first}
from porescale.common.cli.application import main
code = main(app(), sys.argv[1:])
loaded = lambda: print(sorted(set(sys.modules) & set({heavy})))
loaded()
import scipy, h5py
loaded()  # the twin
sys.exit(code)
"""
HEAVY = ("numba", "scipy", "h5py", "matplotlib", "contourpy", "PIL", "av")
