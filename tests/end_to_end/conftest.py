"""What end-to-end tests share: packings and rates kept apart from the user's, and one small run with all its files."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from porescale.cli.main import PACKAGE
from porescale.common.cli.application import application, main
from porescale.common.compiled import jit
from tests.reference.folders import complaints_in
from tests.reference.scenes import COLUMN, write


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Packings and rates are kept apart from the user's; compiled kernels are not: their folder is set by now."""
    assert "NUMBA_CACHE_DIR" in os.environ
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        yield folder


@pytest.fixture(scope="session")
def porescale() -> Callable[..., int]:
    """Run a command line in this process; gives its exit code.  One thread, unless it says otherwise."""

    def run(*words: object) -> int:
        before = jit.threads()
        try:
            return main(application(PACKAGE), [str(word) for word in words])
        finally:
            jit.set_threads(before)

    return run


@pytest.fixture
def complaints(capsys: pytest.CaptureFixture[str]) -> Callable[[], list[str]]:
    """Gives the lines on stderr since the last call, but for warnings and progress."""
    return lambda: complaints_in(capsys.readouterr().err)


@pytest.fixture(scope="session")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scene file of a small column behind a gate that lifts."""
    return write(tmp_path_factory.mktemp("scenes") / "column.toml", COLUMN)


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory, scene: Path, porescale: Callable[..., int]) -> Path:
    """The run folder of that scene, from start to end without interruption, on one thread."""
    made = tmp_path_factory.mktemp("runs") / "untouched"
    assert porescale("run", scene, "--out", made, "--threads", 1, "--quiet") == 0
    return made
