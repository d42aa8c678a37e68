"""What cannot go well is refused before it starts, or stopped with the particle and the reason."""

import pytest

from continuum_sph.benchmarks.extremes import EXTREMES
from porescale.common.evidence.extremes import REFUSED, STOPPED


def found(axis, value):
    return next(it for it in EXTREMES.chosen([axis]) if it.value == value).tried()


@pytest.mark.parametrize(
    ("axis", "value", "key"),
    [
        ("Mach number", "0.4", "water.sound_speed"),
        ("neighbours, wendland", "9", "numerics.smoothing_ratio"),
        ("neighbours, cubic", "9", "numerics.smoothing_ratio"),
    ],
)
def test_what_cannot_go_well_is_refused_by_its_key(axis, value, key):
    row = found(axis, value)
    assert row.end == REFUSED
    assert key in row.said


@pytest.mark.parametrize(("value", "named"), [("position lost", "7"), ("thrown down at 3 c0", "particle")])
def test_what_leaves_sense_is_stopped_and_named(value, named):
    row = found("leaving the domain", value)
    assert row.end == STOPPED
    assert named in row.said
