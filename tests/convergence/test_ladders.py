"""Every ladder's order holds, as `study convergence` runs it; the quick ones each time."""

from dataclasses import replace

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.evidence.convergence import Ladder

QUICK = ("lbm.", "dem.restitution", "dem.energy_of_an_impact", "dem.period")
"""Beginnings of the names of those that take less than a second or two."""


def ladders() -> list[Ladder]:
    """All of both packages."""
    found = []
    for package in (PORESCALE, CONTINUUM):
        assert package.convergence is not None
        found += list(package.convergence())
    return found


def marked(ladder: Ladder) -> object:
    """A ladder as a parameter, slow unless it is quick."""
    marks = [] if ladder.name.startswith(QUICK) and ladder.name != "dem.restitution_by_hertz" else [pytest.mark.slow]
    return pytest.param(ladder, id=ladder.name, marks=marks)


@pytest.mark.parametrize("ladder", [marked(it) for it in ladders() if it.expected is not None])
def test_the_order_holds(ladder: Ladder) -> None:
    row = ladder.run()
    assert row.holds, f"order {row.measured}, at least {ladder.expected} - {ladder.within}: {row.errors}"
    # The check that must fail: an error beside that stays at all levels, ten times the largest one.
    stays = max(row.errors)
    spoiled = replace(ladder, measure=lambda level: dict(zip(row.levels, row.errors, strict=True))[level] + stays * 10)
    assert not spoiled.run().holds
