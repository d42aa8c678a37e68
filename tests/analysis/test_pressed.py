"""How stiffness grows with pressure: not at all where no contact closes, and where some do."""

import math

import numpy as np
import pytest

from porescale.analysis.material import EXPONENT
from porescale.analysis.pressed import FURTHER, stiffness_numbers
from porescale.dem.contact.linear import Linear
from porescale.dem.measures.network import LOOSE, confined, elasticity
from porescale.dem.prepare.compaction import DEEPEST

LAW = Linear(3e5, damping=20.0, tangential_stiffness=1.5e5, friction=0.5)
SIDE, RADIUS, OVERLAP = 6, 1e-3, 1e-3  # discs along an edge; m; of a diameter, at a pressure of 3^(1/2) OVERLAP k
PRESSURE = math.sqrt(3.0) * OVERLAP * LAW.stiffness


def lattice(gap: float = 0.0) -> tuple[np.ndarray, np.ndarray, tuple[float, float]]:
    """Positions, radii and box of a triangular lattice under PRESSURE; one disc of nine is short of its neighbours by
    ``gap`` diameters."""
    apart = 2.0 * RADIUS * (1.0 - OVERLAP)
    box = SIDE * apart, SIDE * math.sqrt(0.75) * apart
    rows = [((i + 0.5 * (j % 2)) * apart, (j + 0.5) * box[1] / SIDE) for j in range(SIDE) for i in range(SIDE)]
    radius = np.full(SIDE**2, RADIUS)
    if gap:
        radius[[i + SIDE * j for j in (0, 3) for i in (0, 3)]] -= 2.0 * RADIUS * (OVERLAP + gap)
    return np.array(rows), radius, box


def test_a_lattice_all_of_whose_discs_touch_does_not_stiffen():
    discs = lattice()
    found = stiffness_numbers(*discs, LAW, PRESSURE)
    assert (found["stiffness"], found["Poisson's ratio"]) == elasticity(*discs, LAW)
    # places and springs stay, a lattice being at rest by symmetry; M is known to the ties that hold discs in place
    assert found[EXPONENT] == pytest.approx(0.0, abs=LOOSE)


def test_contacts_that_close_on_the_way_stiffen_it_by_as_much_as_their_springs_have():
    gap = 1.2 * OVERLAP  # open under PRESSURE, closed under FURTHER times as much
    position, radius, box = lattice(gap)
    found = stiffness_numbers(position, radius, box, LAW, PRESSURE)
    closed = lattice()
    open_, all_ = (confined(*elasticity(*it, LAW)) for it in ((position, radius, box), closed))
    # in the end all springs hold, as in the lattice of equal discs, from which discs lie less than gap + OVERLAP away
    assert found[EXPONENT] == pytest.approx(math.log(all_ / open_) / math.log(FURTHER), abs=gap + OVERLAP)
    assert found[EXPONENT] > 0.1


def test_contacts_too_soft_to_be_pressed_further_have_no_exponent():
    soft = Linear(PRESSURE / (0.6 * DEEPEST), damping=20.0, tangential_stiffness=1.5e5, friction=0.5)
    found = stiffness_numbers(*lattice(), soft, PRESSURE)
    assert found["stiffness"] > 0.0
    assert math.isnan(found[EXPONENT])
