"""Rock: samples stand without load, plates bear what the sample bears, breaks are counted, curves are read."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.bodies.bonding import bond, pieces
from porescale.dem.bodies.frames import framed, polygon
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.measures.network import stiffness, voigt
from porescale.dem.prepare.rock import Curve, load, rock
from porescale.validation.dem.rock import DENSITY, GAP, PRESSED, STIFFNESS, law, packing, sample

COUNT, SEED = 40, 3
SQUARE = np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.01), (0.0, 0.01)])


def few(kind):
    return sample(kind, SEED, COUNT)


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
    assert curve.strain[-1] == pytest.approx(0.04 * (1.0 - 0.5 / 100), rel=1e-9)  # mean of the last hundredth
    assert 0.05 < curve.strength() / made.naive_strength < 1.0
    assert 0.05 < curve.stiffness() / STIFFNESS < 1.0
    breaks = made.grains.bonds.breaks(made.grains.segments)
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


@pytest.mark.parametrize("kind", ["discs", "cells"])
def test_springs_at_rest_are_softer_than_if_all_followed_one_strain(kind):
    made = few(kind)
    assert 0.1 * STIFFNESS < stiffness(made) < voigt(made)


def test_a_row_of_bonded_discs_is_as_stiff_as_its_springs_in_series():
    # Two discs between two plates: three springs, so stress over strain is (k/3) (length/height).
    size = (0.08, 0.04)
    row = make_discs([(0.02, 0.02), (0.06, 0.02)], 0.02 * (1.0 + 1e-6), DENSITY)
    made = rock("discs", row, (0.0, 0.0), size, law(), DENSITY)
    assert made.bonds == 3
    # The ties of loose bodies, 1e-9 of a spring, and overlaps of 2e-6 are all that is left out.
    assert stiffness(made) / STIFFNESS == pytest.approx(2.0 / 3.0, rel=1e-5)


def test_pieces_are_what_bonds_hold_together():
    grains = framed(None, [polygon(np.add(SQUARE, (x, 0.0)), 0.001, DENSITY) for x in (0.0, 0.0119, 0.0238, 0.1)],
                    law(), Box((-1.0, -1.0), (1.0, 1.0), "open", "open", "open", "open"))  # fmt: skip
    assert bond(grains) == 4
    number = pieces(grains)
    assert number.tolist() == [0] * 12 + [1] * 4
    whole = grains.bonds.whole.copy()
    whole[grains.bonds.partners(grains.segments).max(axis=1) >= 8] = 0
    assert pieces(grains, whole).tolist() == [0] * 8 + [1] * 4 + [2] * 4
    assert pieces(grains).tolist() == number.tolist()


def test_samples_without_sense_are_refused():
    discs, size = packing(SEED, COUNT)
    with pytest.raises(InputError, match="no such rock"):
        rock("bricks", discs, (0.0, 0.0), size, law(), DENSITY)
    with pytest.raises(InputError, match="pressed"):
        rock("cells", discs, (0.0, 0.0), size, law(), DENSITY, gap=GAP)
    with pytest.raises(InputError, match="gap"):
        rock("cells", discs, (0.0, 0.0), size, law(), DENSITY, pressed=PRESSED)
    loose = make_discs([(0.3, 0.3), (0.6, 0.6)], 0.02, DENSITY)
    with pytest.raises(InputError, match="nothing touches"):
        rock("discs", loose, (0.0, 0.0), (1.0, 1.0), law(), DENSITY)
