"""Scenes that are nearly right are accepted or refused in lines: no mutant of a shipped one ends with a traceback."""

import pytest

from tests.reference import nearly

COUNT = 60
"""Mutants of the quick test, a few of each scene; python -m tests.reference.nearly does thousands."""


@pytest.fixture(scope="module")
def every():
    """Every shipped scene."""
    return nearly.sources()


def test_nearly_right_scenes_are_checked_or_refused(every):
    ends = [nearly.judged(every[seed % len(every)], seed) for seed in range(COUNT)]
    assert {"checked", "refused"} == set(ends)


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
