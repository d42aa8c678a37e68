"""Whatever is asked of the commands: success, or clear lines and exit code 2; no traceback, no hang, nothing strewn."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import commands
from porescale.common.cli.application import application, main
from porescale.common.compiled import jit
from tests.reference.command_lines import Line, made
from tests.reference.folders import ROOT, complaints_in
from tests.reference.waiting import done

LINES = int(os.environ.get("PORESCALE_LINES", "40"))
"""How many lines the quick test tries; ten times as many in the slow one, and a share of them as processes."""
PATIENCE = 120
"""Seconds after which a line counts as hung; none takes more than a few."""
WRITTEN = ("out", "run", "scene.toml")
"""What a line may write: its --out, and the run that it resumes."""


@pytest.fixture(autouse=True)
def quiet(tmp_path_factory, monkeypatch):
    """Packings and rates apart from the user's, and threads as they were."""
    before = jit.threads()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    yield
    jit.set_threads(before)


def files(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file() and path.name != ".lock"}


def in_process(line: Line, folder: Path, capfd: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit code and stderr of a line, run here within the time that it is given."""
    app = commands() if line.package == "porescale" else application(CONTINUUM)

    def hung(number: int, frame: object) -> None:
        raise TimeoutError(f"{line.words} hangs")

    before, place = signal.signal(signal.SIGALRM, hung), Path.cwd()
    signal.alarm(PATIENCE)
    os.chdir(folder)
    capfd.readouterr()
    try:
        code = main(app, line.words)
    finally:
        os.chdir(place)
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    return code, capfd.readouterr().err


def as_process(line: Line, folder: Path) -> tuple[int, str]:
    """The same as a process of its own."""
    words = [sys.executable, "-m", line.package, *line.words]
    path = {**os.environ, "PYTHONPATH": str(ROOT)}
    ended = done(words, PATIENCE, cwd=folder, env=path, stdin=subprocess.DEVNULL, errors="replace")
    return ended.returncode, ended.stderr


def judged(line: Line, code: int, said: str) -> None:
    """AssertionError unless the line ended well or in clear words."""
    lines = complaints_in(said)
    assert "Traceback" not in said, said
    assert code in (0, 2), (line.words, code, said)
    if code == 2:
        assert lines, line.words
        assert all(part.strip() and len(part) < 2000 for part in lines), said


def tried(seed: int, folder: Path, run: Callable[[Line, Path], tuple[int, str]]) -> int:
    """The exit code of a seed's line; AssertionError, naming the seed, for what none may do."""
    folder.mkdir()
    place = folder / "here"
    place.mkdir()
    (folder / "kept.txt").write_text("kept")
    line = made(seed, place)
    before = files(folder)
    try:
        code, said = run(line, place)
        judged(line, code, said)
        after = files(folder)
        changed = {path for path in before | after if before.get(path) != after.get(path)}
        may = tuple(str(place / name) for name in (WRITTEN if code == 0 else ("run",)))
        assert all(str(path).startswith(may) for path in changed), (line.words, changed)
    except BaseException as error:
        error.add_note(f"seed {seed}: {line.package} {line.words}")
        raise
    return code


def test_lines_end_well_or_in_clear_words(tmp_path, capfd):
    codes = [tried(seed, tmp_path / str(seed), lambda *one: in_process(*one, capfd)) for seed in range(LINES)]
    assert codes.count(2) > LINES / 4
    sound = Line("porescale", ("check", str(ROOT / "cases" / "piston")))
    assert in_process(sound, tmp_path, capfd)[0] == 0


@pytest.mark.slow
def test_many_lines_end_well_or_in_clear_words(tmp_path, capfd):
    for seed in range(1000, 1000 + 10 * LINES):
        tried(seed, tmp_path / str(seed), lambda *one: in_process(*one, capfd))


@pytest.mark.slow
def test_processes_end_well_or_in_clear_words(tmp_path):
    codes = [tried(seed, tmp_path / str(seed), as_process) for seed in range(5000, 5000 + LINES // 4)]
    assert 2 in codes


def test_a_command_that_lets_an_error_out_is_caught():  # the twin that must fail
    line = Line("porescale", ("check",))
    with pytest.raises(AssertionError):
        judged(line, 1, "Traceback (most recent call last): …")
    with pytest.raises(AssertionError):
        judged(line, 2, "")
    with pytest.raises(AssertionError):
        judged(line, -11, "")
