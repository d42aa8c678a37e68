"""Rock: samples stand without load, plates bear what the sample bears, breaks are counted, curves are read."""

from __future__ import annotations

import numpy as np
import pytest

from porescale.dem.discs import make_discs
from porescale.dem.experiments_rock import DENSITY, GAP, PRESSED, STIFFNESS, law, packing, sample
from porescale.dem.rock import Curve, load, rock
from porescale.ground.check import InputError

COUNT = 40


def few(kind):
    return sample(kind, 1, COUNT)


@pytest.mark.parametrize("kind", ["discs", "triangles", "cells"])
def test_a_sample_stands_by_itself_until_it_is_loaded(kind):
    made = few(kind)
    made.grains.step(made.grains.stable_step(), count=50)
    # Every contact bears its back tension and nothing else: round-off of some thousand N/m.
    assert np.abs(made.grains.discs.force).max() < 1e-9 * made.tension
    assert made.bonds > COUNT
    assert made.plates[1].number == made.grains.steering.clumps.count - 1


def test_polygons_are_bonded_at_both_ends_of_a_side_by_what_they_are_pressed():
    made = few("cells")
    assert made.tension == pytest.approx(STIFFNESS * PRESSED, rel=0.02)
    assert made.naive_strength == pytest.approx(made.tension / made.diameter)


def test_a_sample_that_is_pulled_bears_tension_and_breaks():
    made = few("discs")
    curve = load(made, 0.04, 2.0, moments=100)
    assert curve.strain[-1] == pytest.approx(0.04, rel=1e-9)
    assert 0.05 < curve.strength() / made.naive_strength < 1.0
    assert 0.05 < curve.stiffness() / STIFFNESS < 1.0
    breaks = made.grains.bonds.breaks(made.grains)
    assert len(breaks) == curve.broken[-1] > 0
    assert np.all(np.diff(curve.broken) >= 0)
    assert all(0.0 < each.time <= curve.time[-1] for each in breaks)
    assert curve.stress[-1] < 0.5 * curve.strength()  # a strand of so few discs may hold on for long


def test_a_curve_is_read_up_to_its_peak_either_way():
    strain = np.linspace(0.0, -1.0, 101)[1:]
    stress = np.where(strain > -0.5, 3.0 * strain, -0.2)
    curve = Curve(strain, strain, stress, np.zeros(100, np.int64), np.zeros(100))
    assert curve.strength() == pytest.approx(3.0 * 0.49)
    assert curve.stiffness() == pytest.approx(3.0)


def test_samples_without_sense_are_refused():
    discs, side = packing(1, COUNT)
    size = (side, side)
    with pytest.raises(InputError, match="no such rock"):
        rock("bricks", discs, (0.0, 0.0), size, law(), DENSITY)
    with pytest.raises(InputError, match="pressed"):
        rock("cells", discs, (0.0, 0.0), size, law(), DENSITY, gap=GAP)
    with pytest.raises(InputError, match="gap"):
        rock("cells", discs, (0.0, 0.0), size, law(), DENSITY, pressed=PRESSED)
    loose = make_discs([(0.3, 0.3), (0.6, 0.6)], 0.02, DENSITY)
    with pytest.raises(InputError, match="nothing touches"):
        rock("discs", loose, (0.0, 0.0), (1.0, 1.0), law(), DENSITY)
