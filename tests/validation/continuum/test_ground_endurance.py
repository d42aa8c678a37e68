"""Ground under water keeps its level and the pressure in its pores, once the stress of its start has found its rest."""

from dataclasses import replace

import pytest

from continuum_sph.benchmarks.endurance import ENDURANCES, PORES, STANDS
from porescale.common.evidence import endurance
from porescale.common.evidence.endurance import endure

GROUND = ENDURANCES["ground under water"]
STEPS = 20_000  # a fifth of which it does: 0.7 s


@pytest.mark.slow
def test_ground_under_water_keeps_level_and_pressure():
    lines = {line.quantity: line for line in endure(GROUND, STEPS)}
    assert lines[STANDS].holds
    assert lines[PORES].holds


@pytest.mark.slow
def test_before_it_has_consolidated_its_pressure_moves():  # the twin that must fail
    lines = {line.quantity: line for line in endure(replace(GROUND, before=0), STEPS)}
    assert lines[PORES].off > 2.0 * lines[PORES].allowed


@pytest.mark.slow
@pytest.mark.parametrize("name", [it.name for it in ENDURANCES])
def test_kept_and_gone_on_with_it_ends_with_the_same_numbers(name, tmp_path, monkeypatch):
    monkeypatch.setattr(endurance, "KEEP_EVERY", 0.0)
    monkeypatch.setattr(endurance, "CHECK_EVERY", 7)  # blocks between marks are kept
    it, kept = replace(ENDURANCES[name], share=1.0, before=120), tmp_path / "kept.h5"

    class Killed(Exception):
        """The process is gone."""

    def say(text: str) -> None:
        if ": 140 of 200" in text:
            raise Killed

    with pytest.raises(Killed):
        endure(it, 200, say, kept)
    numbers = [
        [replace(line, seconds=0.0) for line in lines if line.quantity != endurance.MEMORY]
        for lines in (endure(it, 200, kept=kept), endure(it, 200))
    ]
    assert numbers[0] == numbers[1]
