"""What unit tests share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest


@pytest.fixture
def one_thread() -> Iterator[None]:
    """Kernels on one thread: in scenes of a few cells waiting for a second one is all that is done."""
    from porescale.common.compiled.jit import set_threads, threads

    before = threads()
    set_threads(1)
    yield
    set_threads(before)


@pytest.fixture
def toy(tmp_path: Path, monkeypatch, capsys) -> Callable[..., tuple[int, str, list[str]]]:
    """Runs a command line in an empty folder; gives exit code, stdout, stderr lines."""
    from porescale.common.cli.application import application, main
    from tests.reference.toy_package import TOY

    monkeypatch.chdir(tmp_path)

    def _toy(*tokens: str) -> tuple[int, str, list[str]]:
        code = main(application(TOY), tokens)
        said = capsys.readouterr()
        return code, said.out, said.err.splitlines()

    return _toy
