"""The project speaks of itself alone: what its texts say is theirs, not that of a list of tasks somewhere else."""

import re
import subprocess

import pytest

from tests.architecture.sources import ROOT

ELSEWHERE = re.compile(
    r"\bthe issue(?:'s|s| asks)|\bspec/|\bas spec\b|\bthe spec\b|DEVELOPERS\.md|\bseed 0\d\d\b", re.IGNORECASE
)
TEXTS = {".py", ".md", ".toml"}


def strangers(text: str) -> list[str]:
    """Words of ``text`` that mean something outside the project."""
    return ELSEWHERE.findall(text)


def test_texts_name_nothing_outside() -> None:
    named = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    files = [ROOT / name for name in named.stdout.splitlines()] or list(ROOT.rglob("*"))
    texts = [file for file in files if file.suffix in TEXTS and file.is_file() and file.name != "test_words.py"]
    assert len(texts) > 100
    found = {str(file.relative_to(ROOT)): said for file in texts if (said := strangers(file.read_text("utf-8")))}
    assert not found


@pytest.mark.parametrize("text", ["the issue's 3 %", "as spec and tutorial print it", "see DEVELOPERS.md"])
def test_a_stranger_is_found(text: str) -> None:
    assert strangers(text)


def test_plain_words_pass() -> None:
    assert not strangers("the specimen held to 3 %; an issue of the paper")
