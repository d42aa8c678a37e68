"""Scenes that are nearly right are accepted or refused in lines: no mutant of a shipped one ends with a traceback."""

import sys

import pytest

from porescale.common.core.errors import Fault, InputError
from tests.reference.faults import nearly

COUNT = 60
"""Mutants of the quick test, a few of each scene; python -m tests.reference.faults.nearly does thousands."""


@pytest.fixture(scope="module")
def every():
    """Every shipped scene."""
    return nearly.sources()


def test_nearly_right_scenes_are_checked_or_refused(every):
    ends = [nearly.judged(every[seed % len(every)], seed) for seed in range(COUNT)]
    assert {"checked", "refused"} == set(ends)


def test_a_refusal_without_a_word_is_a_failure(every, monkeypatch, capsys):
    def refused(words):
        def scene_of(*_, **__):
            raise InputError(words)

        return scene_of

    monkeypatch.setattr(nearly, "sources", lambda: every[:1])
    monkeypatch.setattr(sys, "argv", ["nearly", "--count", "2"])
    monkeypatch.setattr(nearly, "validate", refused([]))  # the twin that must fail: a refusal that is empty
    assert nearly.judged(every[0], 0) == nearly.WORDLESS
    assert nearly.main() == 1
    assert f"seed 1: {nearly.WORDLESS}" in capsys.readouterr().out
    monkeypatch.setattr(nearly, "validate", refused(Fault("width", 1, "is too small")))
    assert nearly.main() == 0


def test_a_mutant_is_the_same_for_the_same_seed(every):
    table = every[0][2]
    assert nearly.mutant(table, 5) == nearly.mutant(table, 5) != nearly.mutant(table, 6)


def test_a_check_that_fails_otherwise_is_caught(every, monkeypatch):  # the twin that must fail
    file, package, table = every[0]

    class Broken(type(package)):
        """A package whose check divides by nothing."""

        def report(self, scene):
            raise ZeroDivisionError

    broken = object.__new__(Broken)
    object.__setattr__(broken, "scene", package.scene)
    monkeypatch.setattr(nearly, "mutant", lambda table, seed: table)
    with pytest.raises(ZeroDivisionError):
        nearly.judged((file, broken, table), 0)
