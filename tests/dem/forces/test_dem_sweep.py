"""The sweep over blocks adds the same numbers in the same order as the loop over the list."""

import numpy as np
import pytest

from porescale.common.neighbors.pair_list import PairList
from porescale.dem.arrays import Pairs, contact_arrays
from porescale.dem.contact.linear import Linear, LinearKernel
from porescale.dem.forces import threads as sweep
from porescale.dem.forces.batch import pair_forces, scratch
from porescale.dem.forces.pairs import start_forces
from porescale.dem.motion.periodic_cell import Still

LAW = Linear(1e6, 5.0, 3e5, 4.0, 0.4)


def overlapping_discs(seed, count=30):
    """Arguments of the loop: discs pressed together, in no order, with contacts between most neighbours."""
    rng = np.random.default_rng(seed)
    position, radius = rng.uniform(0.0, 0.1, (count, 2)), 0.01 * rng.uniform(0.5, 1.0, count)
    pairs = PairList(count, 2e-3, (0.0, 0.0), (0.1, 0.1), carried=1)
    pairs.build(position, radius)
    law = LinearKernel(LAW.row()[None, None], 1.0, None)
    moving = rng.normal(0.0, 1.0, (count, 2)), rng.normal(0.0, 100.0, count)
    given = rng.normal(0.0, 10.0, (count, 2)), rng.normal(0.0, 1.0, count)
    return contact_arrays(position, *moving, radius, np.ones(count)), pairs, law, given


def listed(pairs, springs):
    """The pair list as kernels take it, with these springs (m, 1) m."""
    return Pairs(pairs.start, pairs.partner, springs, np.zeros((0, 2)), 0.0)


@pytest.mark.parametrize("block", [1, 4, 7, 30, 64])
def test_blocks_of_any_size_give_the_bits_of_the_loop(block, monkeypatch):
    monkeypatch.setattr(sweep, "BLOCK", block)
    discs, pairs, law, given = overlapping_discs(block)
    count, cell = len(discs.radius), Still(0.0, 0.0)
    force, torque, springs = np.zeros((count, 2)), np.zeros(count), pairs.carried.copy()
    loop = discs._replace(force=force, torque=torque, external_force=given[0], external_torque=given[1])
    start_forces.py_func(loop)
    columns = scratch(1)
    pair_forces.py_func(loop, listed(pairs, springs), law, 1e-5, cell, *(it[0] for it in columns))
    far_start, incoming_start = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    total = sweep.list_far.py_func(pairs.start, pairs.partner, far_start, incoming_start, np.zeros(0, np.int64))
    incoming, far = np.zeros(total, np.int64), np.zeros((total, 4))
    assert sweep.list_far.py_func(pairs.start, pairs.partner, far_start, incoming_start, incoming) == total
    assert sorted(incoming) == list(range(total))
    again, twist, kept = np.full((count, 2), np.nan), np.full(count, np.nan), pairs.carried.copy()
    blocks = loop._replace(force=again, torque=twist)
    around = np.zeros((0, 0, 3)), np.zeros((0, 0), np.uint8)
    threads = sweep.Threads(*around, *columns, far_start, incoming_start, incoming, far)
    sweep.far_forces.py_func(blocks, listed(pairs, kept), law, 1e-5, cell, threads)
    sweep.near_forces.py_func(blocks, listed(pairs, kept), law, 1e-5, cell, threads)
    if block < 30:
        assert total > 0
        assert np.isfinite(far[:, 0]).any()
    for one, other in ((force, again), (torque, twist), (springs, kept)):
        np.testing.assert_array_equal(one, other)
    assert np.abs(springs).max() > 0.0


def test_the_external_force_added_last_gives_other_bits():  # the twin that must fail
    discs, pairs, law, given = overlapping_discs(4)
    count = len(discs.radius)
    force, torque, wrong = np.zeros((count, 2)), np.zeros(count), np.zeros((count, 2))
    loop = discs._replace(force=force, torque=torque, external_force=given[0], external_torque=given[1])
    start_forces.py_func(loop)
    for total in (force, wrong):
        again, columns = loop._replace(force=total), [it[0] for it in scratch(1)]
        pair_forces.py_func(again, listed(pairs, pairs.carried.copy()), law, 1e-5, Still(0.0, 0.0), *columns)
    wrong += given[0]
    np.testing.assert_allclose(force, wrong, rtol=1e-9, atol=1e-6)
    assert (force != wrong).any()


def test_small_systems_and_one_thread_go_through_one_loop():
    pairs = overlapping_discs(0)[1]
    small = sweep.ThreadChoice(30).now(pairs, 4, budget=True)
    assert isinstance(small, sweep.Serial)
    assert small.partial.shape == (1, 4, 3)


def test_a_large_system_with_an_energy_budget_goes_block_by_block(monkeypatch):
    monkeypatch.setattr(sweep, "SERIAL_BELOW", 10)
    monkeypatch.setattr(sweep, "threads", lambda: 1)
    _, pairs, _, _ = overlapping_discs(0)
    sweeps = sweep.ThreadChoice(30)
    assert isinstance(sweeps.now(pairs, 0, budget=False), sweep.Serial)
    assert isinstance(sweeps.now(pairs, 0, budget=True), sweep.Threads)
    assert isinstance(sweeps.now(pairs, 0, budget=True, alone=True), sweep.Serial)
    monkeypatch.setattr(sweep, "threads", lambda: 2)
    assert isinstance(sweeps.now(pairs, 0, budget=False), sweep.Threads)
