"""Scenes that are nearly right are accepted or refused in lines: no mutant of a shipped one ends with a traceback."""

import sys
from dataclasses import replace

import pytest

from porescale.common.api.report import Report
from porescale.common.core.errors import Fault, InputError
from tests.reference.faults import nearly
from tests.reference.faults.nearly import CONTINUUM, PORESCALE

COUNT = 60
"""Mutants of the quick test, a few of each scene; python -m tests.reference.faults.nearly does thousands."""


@pytest.fixture(scope="module")
def every():
    """Every shipped scene."""
    return nearly.sources()


def test_nearly_right_scenes_are_checked_or_refused(every):
    tables = {it.name: [table for _, of, table in every if of is it] for it in (PORESCALE, CONTINUUM)}
    ends = []
    for seed in range(COUNT):
        source = every[seed % len(every)]
        ends.append(nearly.judged(source, seed, others=tables[source[1].name]))
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


def test_a_key_of_a_scene_is_drawn_from_its_schema(every):
    (source,) = (it for it in every if it[0].parent.name == "column_collapse")
    schema = nearly.schema_of(PORESCALE.scene())
    mutants = [nearly.mutant(source[2], seed, schema, [source[2]]) for seed in range(1200)]
    assert {"cpu", "gpu"} <= {it["run"].get("device") for it in mutants if "run" in it}  # not a key of the scene
    assert not any("run" in nearly.mutant(source[2], seed) for seed in range(1200))  # the twin: nobody told of them


def test_what_check_accepts_and_no_run_begins_is_found(every, monkeypatch):
    file, package, table = every[0]
    monkeypatch.setattr(nearly, "mutant", lambda table, *_: table)

    def changed(**parts):
        """The package with other parts."""
        return file, replace(package, **parts), table

    def refuse(scene):
        raise InputError(Fault("width", 1, "is too small"))

    def nothing(scene):
        report = Report("")
        report.row("width", float("nan"))
        return report

    monkeypatch.setattr(nearly, "MOST_BYTES", float("inf"))
    assert nearly.judged(changed(build=refuse), 0, build=True) == nearly.LATE
    assert nearly.judged(changed(report=nothing), 0) == nearly.NO_NUMBER
    assert nearly.judged(changed(build=lambda scene: None), 0, build=True) == "built"  # the twin
    monkeypatch.setattr(nearly, "LONG", 0.0)
    assert nearly.judged(changed(), 0) == nearly.SLOW


def test_a_check_that_fails_otherwise_is_caught(every, monkeypatch):  # the twin that must fail
    file, package, table = every[0]

    class Broken(type(package)):
        """A package whose check divides by nothing."""

        def report(self, scene):
            raise ZeroDivisionError

    broken = object.__new__(Broken)
    object.__setattr__(broken, "scene", package.scene)
    monkeypatch.setattr(nearly, "mutant", lambda table, *_: table)
    with pytest.raises(ZeroDivisionError):
        nearly.judged((file, broken, table), 0)
