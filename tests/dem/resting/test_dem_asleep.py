"""Discs that sleep: they stay, they wake, and what is saved of them goes on to the same bits."""

import numpy as np
import pytest

import porescale as ps
from porescale import Scene
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_budget
from porescale.dem.resting import sleep_kernels as kernels
from porescale.dem.resting.sleep import Sleep
from porescale.validation.dem import sleep as lab

LONG = round(20 * lab.AFTER / 1.5e-5)


def at_rest(energy: bool = False) -> tuple[Grains, np.ndarray]:
    grains, weights = lab.heap()
    if energy:
        state, box = grains.state(), grains.box
        grains = Grains(grains.discs, lab.LAW, box, energy=True)
        grains.restore(state | {"book": np.zeros_like(grains.budget), "book_start": np.zeros(0)})
    lab.asleep(grains, weights)
    return grains, weights


def fall_asleep(grains: Grains, weights: np.ndarray) -> float:
    dt = grains.stable_step()
    for _ in range(LONG):
        grains.step(dt, weights)
    return dt


def test_a_heap_at_rest_sleeps_and_nothing_moves_any_more():
    grains, weights = at_rest()
    dt = fall_asleep(grains, weights)
    assert grains.sleep.count == grains.discs.count
    place, load = grains.discs.position.copy(), grains.wall_load.copy()
    grains.step(dt, weights, count=200)
    assert np.array_equal(place, grains.discs.position)
    assert np.array_equal(load, grains.wall_load)
    # The floor bears the heap but for what sleepers may be out of balance by, all of them at most.
    assert -load[:, 1].sum() == pytest.approx(-weights[:, 1].sum(), rel=lab.SHARE)


def test_sleep_takes_no_more_than_it_says():
    grains, weights = at_rest()
    fall_asleep(grains, weights)
    # Kinetic energy of v = share sqrt(W r/m), of centre and rim: share² W r (1/2 + 1/4).
    size = np.hypot(*weights.T) * grains.discs.radius
    assert (grains.sleep.removed <= 0.75 * lab.SHARE**2 * size).all()


@pytest.mark.slow
def test_the_energy_budget_closes_as_it_does_without_sleep():
    # The heap comes to rest, sleeps, and is woken: what sleep takes is in the budget as lost to drag.
    residuals = []
    for sleeps in (True, False):
        grains, weights = at_rest(energy=True)
        grains.discs.velocity[:, 0] = 0.02
        if not sleeps:
            grains.sleep = None
        fall_asleep(grains, weights)
        budget = energy_budget(grains, (0.0, -GRAVITY))
        residuals.append(abs(budget["residual (J/m)"]))
        moved = 0.5 * float(grains.discs.mass.sum()) * 0.02**2
    assert residuals[0] <= residuals[1] + 1e-3 * moved


def test_a_disc_thrown_on_a_sleeping_heap_wakes_it():
    found = lab.struck(seconds=0.045)
    assert found.asleep[0] < found.grains.discs.count / 2
    assert found.asleep[1] > found.grains.discs.count / 2


def test_sleep_ends_when_the_plate_that_holds_vanishes():
    grains, weights = lab.heap()
    x = 0.5 * grains.box.upper[0]
    plate = Plate(x, -1.0, 1.0)
    fewer = grains.discs.position[:, 0] + grains.discs.radius < x
    held = Grains(make_discs(grains.discs.position[fewer], grains.discs.radius[fewer], lab.DENSITY), lab.LAW,
                  Box((0.0, 0.0), grains.box.upper, top="open"), plates=[plate])  # fmt: skip
    dt = held.stable_step()
    held.step(dt, weights[fewer], count=20_000, drag=50.0)
    lab.asleep(held, weights[fewer])
    fall_asleep(held, weights[fewer])
    assert held.sleep.count == fewer.sum()
    assert held.plate_force.any()
    held.remove_plate("plate")
    height = held.discs.position[:, 1].mean()
    fall_asleep(held, weights[fewer])
    assert held.discs.position[:, 1].mean() < height - 1e-3 * lab.RADIUS


def test_a_saved_state_goes_on_to_the_same_bits():
    grains, weights = at_rest()
    dt = fall_asleep(grains, weights)
    top = int(np.argmax(grains.discs.position[:, 1]))
    grains.sleep.wake_disc(grains, top)
    grains.step(dt, weights)
    assert 0 < grains.sleep.count < grains.discs.count
    other, _ = at_rest()
    other.restore(grains.state())
    for _ in range(700):
        for it in (grains, other):
            it.step(dt, weights)
    assert np.array_equal(grains.sleep.asleep, other.sleep.asleep)
    for name in ("position", "velocity", "spin", "angle", "force"):
        assert np.array_equal(getattr(grains.discs, name), getattr(other.discs, name)), name
    assert np.array_equal(grains.pairs.carried, other.pairs.carried)


def test_clumps_know_no_sleep():
    grains, weights = lab.heap()
    grains.steering.bind([[0, 1]], lab.DENSITY)
    with pytest.raises(InputError, match="free discs"):
        Sleep(grains, np.hypot(*weights.T))


def test_a_scene_refuses_sleep_beside_what_knows_none():
    table = {
        "domain": {"width": 1, "height": 1}, "time": {"end": 1},
        "output": {"snapshot_interval": 1, "series_interval": 1},
        "grains": {"density": 2500, "grain": [{"x": 0.5, "y": 0.5, "diameter": 0.1}]},
        "contact": {"stiffness": 1e5, "restitution": 0.5}, "sleep": {"share": 0.05},
    }  # fmt: skip
    assert validate(Scene, table).sleep.share == 0.05
    with pytest.raises(InputError, match="does not know"):
        validate(Scene, table | {"control": [{"grain": 0, "x": {"velocity": 1.0}}]})
    with pytest.raises(InputError, match="without weight"):
        validate(Scene, table | {"gravity": (0.0, 0.0)})


@ps.contact_law(keys={"stiffness": "N/m", "damping": "N s/m"})
def own_law(overlap, closing, radius, mass, p):
    return max(0.0, p.stiffness * overlap + p.damping * closing)


@pytest.mark.parametrize(
    "contact",
    [
        {"law": "hertz", "young": 1e8, "poisson": 0.2, "restitution": 0.3},
        {"law": own_law, "stiffness": 1e5, "damping": 3},
    ],
    ids=["hertz", "own"],
)
def test_grains_sleep_whose_stiffness_depends_on_their_radius(contact):
    # Their stiffest contact is that of the smallest radius there is, not of none, on which no time at rest would be
    # long enough.
    scene = Scene(
        domain={"width": 0.05, "height": 0.05}, time={"end": 0.5},
        output={"snapshot_interval": 0.5, "series_interval": 0.5},
        grains={"density": 2500, "grain": [{"x": 0.02, "y": 0.003, "diameter": 0.006}]},
        contact=contact, sleep={},
    )  # fmt: skip
    simulation = ps.build(scene)
    simulation.run()
    assert simulation.series()["grains asleep ()"] == 1.0


def test_kernels_run_as_plain_python():
    asleep, called = np.array([1, 1, 0, 1], np.uint8), np.array([0, 1, 0, 0], np.uint8)
    start, partner = np.array([0, 1, 2, 3, 3]), np.array([1, 2, 3], np.int32)
    role, quiet = np.zeros(4, np.uint8), np.ones(4)
    kernels.find_border.py_func(asleep, start, partner, role)
    assert role.tolist() == [0, 1, 2, 1]
    kernels.wake.py_func(asleep, called, start, partner, quiet)
    assert asleep.tolist() == [0, 0, 0, 1]
    assert not called.any()
    pairs = [np.zeros(5, np.int64), np.zeros(2, np.int32), np.zeros(2, np.int64)]
    assert kernels.list_part.py_func(asleep, False, np.arange(4), np.arange(4), start, partner, *pairs) == 3
    assert pairs[1].tolist() == [1, 2]  # as far as there is room
