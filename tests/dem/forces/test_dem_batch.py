"""Contacts answered many at once: the bits of a loop over pairs, one contact after another."""

import numpy as np
import pytest

from porescale.common.neighbors.pair_list import PairList
from porescale.dem.arrays import Pairs, contact_arrays
from porescale.dem.contact.budget import BUDGET, FRICTION, NORMAL_DASHPOT, ROLLING_FRICTION
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.law import row_numbers, springs_of
from porescale.dem.contact.linear import Linear
from porescale.dem.forces.batch import BATCH, pair_forces, scratch
from porescale.dem.forces.pairs import contact_force, contact_kinematics, relative_velocity
from porescale.dem.motion.periodic_cell import LOAD, Still, Straining, add_load, image

DT = 1e-5
COUNT = 400
LAWS = {
    "linear": Linear(1e6, 5.0, 3e5, 4.0, 0.4),
    "rolling": Linear(1e6, 5.0, 3e5, 4.0, 0.4, rolling_friction=0.2, rolling_stiffness=2e5, rolling_damping=1.0),
    "smooth": Linear(1e6, 5.0),
    "overlap": Linear(1e6, 500.0, 3e5, 4.0, 0.4, release="overlap"),
    "hertz": Hertz(1e7, 0.3, 0.2, friction=0.4),
}


def one_after_another(d, pairs, law, dt, cell):
    """Add the contacts of a half list: the plainest loop, in Python."""
    shared = row_numbers.py_func(law.table[0, 0], law)
    for i in range(len(d.radius)):
        own = np.zeros(3)
        for k in range(pairs.start[i], pairs.start[i + 1]):
            j = pairs.partner[k]
            dx, dy = image.py_func(*(d.position[j] - d.position[i]), cell)
            if np.hypot(dx, dy) >= d.radius[i] + d.radius[j]:
                pairs.history[k] = 0.0
                continue
            speed = relative_velocity.py_func(i, j, dx, dy, d.velocity, cell)
            way = contact_kinematics.py_func(dx, dy, *speed, d.spin[i], d.spin[j], d.radius[i], d.radius[j])
            overlap = d.radius[i] + d.radius[j] - np.sqrt(dx * dx + dy * dy)
            mass = d.body_mass[i] * d.body_mass[j] / (d.body_mass[i] + d.body_mass[j])
            p = shared if d.material is None else row_numbers.py_func(law.table[d.material[i], d.material[j]], law)
            fx, fy, moment_i, moment_j = contact_force.py_func(
                i, k, overlap, way, mass, p, pairs.history, d.budget, law, dt
            )
            add_load.py_func(fx, fy, dx, dy, cell)
            own += (fx, fy, moment_i)
            d.force[j] -= (fx, fy)
            d.torque[j] += moment_j
        d.force[i] += own[:2]
        d.torque[i] += own[2]


def crowd(law, *, materials=1, budget=False):
    """Discs pressed together in no order, one of them as large as twenty, some with springs from before: the arrays of
    both kernels, and the law."""
    rng = np.random.default_rng(3)
    position, radius = rng.uniform(0.0, 0.1, (COUNT, 2)), 0.002 * rng.uniform(0.5, 1.0, COUNT)
    position[0], radius[0] = 0.05, 0.04
    rows = np.array([[law.row() * (1.0 + 0.1 * (a + b)) for a in range(materials)] for b in range(materials)])
    taken = law.kernel(rows, law.friction or None, law.rolling_friction or None)
    pairs = PairList(COUNT, 2e-3, (0.0, 0.0), (0.1, 0.1), carried=springs_of(taken))
    pairs.build(position, radius)
    moving = rng.normal(0.0, 1.0, (COUNT, 2)), rng.normal(0.0, 100.0, COUNT)
    kind = rng.integers(0, materials, COUNT).astype(np.uint8) if materials > 1 else None
    discs = contact_arrays(
        position, *moving, radius, rng.uniform(1.0, 2.0, COUNT), kind, np.zeros((COUNT, BUDGET)) if budget else None
    )
    springs = np.zeros(pairs.carried.shape)
    if law.friction > 0.0:
        springs[:] = 1e-6 * rng.normal(size=springs.shape)
    return discs, Pairs(pairs.start, pairs.partner, springs, np.zeros((0, 2)), 0.0), taken


def found(how, discs, pairs, law, cell):
    """Force, torque, springs, energy budget and load of the cell after ``how``."""
    mine = discs._replace(force=np.zeros((COUNT, 2)), torque=np.zeros(COUNT))
    if discs.budget is not None:
        mine = mine._replace(budget=np.zeros((COUNT, BUDGET)))
    if isinstance(cell, Straining):
        cell = cell._replace(load=np.zeros(LOAD))
    listed = pairs._replace(history=pairs.history.copy())
    how(mine, listed, law, DT, cell)
    return mine.force, mine.torque, listed.history, mine.budget, cell.load if isinstance(cell, Straining) else None


def batches(discs, *arguments):
    """All pairs by the kernel."""
    pair_forces(discs, *arguments, *(it[0] for it in scratch(1, discs.budget is not None)))


def same(ones, others):
    """Whether all arrays are the same bits, zeros with their signs."""
    return all(a is b is None or a.tobytes() == b.tobytes() for a, b in zip(ones, others, strict=True))


@pytest.mark.parametrize("name", LAWS)
def test_batches_give_the_bits_of_one_after_another(name):
    discs, pairs, law = crowd(LAWS[name])
    assert np.diff(pairs.start).max() > BATCH  # a row of several batches, and batches of several rows
    plain = found(one_after_another, discs, pairs, law, Still(0.0, 0.0))
    assert np.count_nonzero(plain[0]) > COUNT
    assert same(found(batches, discs, pairs, law, Still(0.0, 0.0)), plain)


@pytest.mark.parametrize("cell", [Still(0.1, 0.1), Straining(0.1, 0.1, 0.02, -0.3, 2.0, 0.2, np.zeros(LOAD))])
def test_so_do_they_with_materials_in_periodic_and_strained_cells(cell):
    discs, pairs, law = crowd(LAWS["rolling"], materials=3)
    assert same(found(batches, discs, pairs, law, cell), found(one_after_another, discs, pairs, law, cell))


@pytest.mark.parametrize("name", LAWS)
def test_what_contacts_lose_is_booked_at_the_lower_disc(name):
    discs, pairs, law = crowd(LAWS[name], budget=True)
    pairs.history[:] = 0.0  # springs that are released are booked before the contacts of a batch: in another order
    one, other = (found(how, discs, pairs, law, Still(0.0, 0.0)) for how in (batches, one_after_another))
    assert same(one, other)
    assert np.count_nonzero(one[3][:, NORMAL_DASHPOT]) > COUNT // 4
    assert np.any(one[3][:, FRICTION]) == (name != "smooth")
    assert np.any(one[3][:, ROLLING_FRICTION]) == (name == "rolling")


def test_another_order_of_contacts_gives_other_bits():  # the twin that must fail
    discs, pairs, law = crowd(LAWS["linear"])
    turned = pairs._replace(partner=pairs.partner.copy(), history=pairs.history.copy())
    for i in range(COUNT):
        row = slice(pairs.start[i], pairs.start[i + 1])
        turned.partner[row], turned.history[row] = pairs.partner[row][::-1], pairs.history[row][::-1].copy()
    one = found(batches, discs, pairs, law, Still(0.0, 0.0))
    other = found(batches, discs, turned, law, Still(0.0, 0.0))
    np.testing.assert_allclose(one[0], other[0], rtol=1e-9, atol=1e-6)
    assert not same(one[:2], other[:2])
