"""What is no scene at all is said before a compiler is imported for it, by every command that takes one."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FIRST = {
    "porescale": "from porescale.app.main import commands as app",
    "continuum_sph": "from continuum_sph.app import PACKAGE\n"
    "from porescale.workbench.application import application\napp = lambda: application(PACKAGE)",
}
SCRIPT = """\
import sys
{first}
from porescale.workbench.application import main
code = main(app(), sys.argv[1:])
print("numba" in sys.modules)
sys.exit(code)
"""


def asked(package: str, *words: object) -> tuple[int, bool, list[str]]:
    """Exit code of a command line, whether numba was imported, and the lines on stderr."""
    text = SCRIPT.format(first=FIRST[package])
    done = subprocess.run(
        [sys.executable, "-c", text, *map(str, words)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert "Traceback" not in done.stderr, done.stderr
    return done.returncode, done.stdout.splitlines()[-1] == "True", done.stderr.splitlines()


@pytest.mark.parametrize("package", FIRST)
def test_what_is_no_scene_is_said_before_numba_is_imported(tmp_path, package):
    (tmp_path / "torn.toml").write_text("[domain\nwidth = 1\n")
    (tmp_path / "latin.toml").write_bytes("title = 'Körner'\n".encode("latin-1"))
    code, compiler, lines = asked(package, "run", tmp_path / "torn.toml", "--out", tmp_path / "out")
    assert (code, compiler, len(lines)) == (2, False, 1)
    assert "torn.toml: line 1" in lines[0]
    for name, words in (("none.toml", "no scene here"), ("latin.toml", "is not UTF-8"), ("torn.toml", "line 1")):
        code, compiler, lines = asked(package, "check", tmp_path / name)
        assert (code, compiler, len(lines)) == (2, False, 1)
        assert words in lines[0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["latin.toml", "torn.toml"]


def test_a_scene_that_is_judged_brings_its_rooms_along(tmp_path):  # the twin: the question can be answered otherwise
    (tmp_path / "scene.toml").write_text("[domain]\nwidth = 1\nheight = 1\n")
    code, compiler, lines = asked("porescale", "check", tmp_path)
    assert (code, compiler) == (2, True)
    assert lines
