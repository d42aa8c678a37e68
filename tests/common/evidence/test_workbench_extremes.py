"""A try of an extreme ends in one of three ways, and says why."""

import json

import pytest

from porescale.common.core.errors import Fault, InputError, Unstable
from porescale.common.evidence.extremes import REFUSED, RIGHT, STABLE, STOPPED, Extreme, Extremes, Verdict, write


def refused():
    raise InputError(Fault("water.depth", -1.0, "is negative", "m", ">= 0"))


def stopped():
    raise Unstable("particle 7", "speed", 99.0, "m/s", 10, 0.5, "raise water.sound_speed")


def broken():
    raise ZeroDivisionError


TRIES = Extremes(
    [Extreme("depth", "mild", lambda: "calm"), Extreme("depth", "absurd", refused), Extreme("speed", "high", stopped)]
)


def test_each_end_is_told_with_its_reason(tmp_path):
    rows = [it.tried() for it in TRIES.chosen([])]
    assert [row.end for row in rows] == [STABLE, REFUSED, STOPPED]
    assert rows[0].said == "calm"
    assert "water.depth = -1.0 m: is negative" in rows[1].said
    assert "speed = 99 m/s at particle 7" in rows[2].said
    write(tmp_path / "made", "command", rows)
    assert [row["end"] for row in json.loads((tmp_path / "made/extremes.json").read_text())] == [r.end for r in rows]
    assert "| depth | absurd | **refused** |" in (tmp_path / "made/extremes.md").read_text()
    assert (tmp_path / "made/extremes.png").read_bytes().startswith(b"\x89PNG")


def test_what_is_judged_is_right_or_no_more_than_stable():
    for right, end in ((True, RIGHT), (False, STABLE)):
        row = Extreme("depth", "known", lambda right=right: Verdict("2 % off", right)).tried()
        assert (row.end, row.said) == (end, "2 % off")


def test_tries_are_chosen_by_what_is_varied():
    assert [it.value for it in TRIES.chosen(["speed"])] == ["high"]
    with pytest.raises(InputError, match="spede: no such axis"):
        TRIES.chosen(["spede"])


def test_a_fault_of_ours_is_not_an_end():
    with pytest.raises(ZeroDivisionError):
        Extreme("depth", "ours", broken).tried()
