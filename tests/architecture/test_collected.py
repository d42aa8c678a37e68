"""Every test stands where pytest looks for it: folders of some names, `build` among them, it passes over."""

import fnmatch
from collections.abc import Sequence
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]


def passed_over(files: Sequence[Path], patterns: Sequence[str]) -> list[Path]:
    """Those of ``files``, below the folder of the tests, in a folder that pytest does not go into."""
    return [it for it in files if any(fnmatch.fnmatch(part, one) for part in it.parts[:-1] for one in patterns)]


def test_no_folder_of_tests_is_passed_over(request: pytest.FixtureRequest) -> None:
    files = [it.relative_to(TESTS) for it in TESTS.rglob("test_*.py")]
    assert len(files) > 300
    patterns = request.config.getini("norecursedirs")
    assert passed_over(files, patterns) == []
    hidden = Path("build", "test_scene_grains.py")  # the check that must fail
    assert passed_over([*files, hidden], patterns) == [hidden]
