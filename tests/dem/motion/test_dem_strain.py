"""Strained cells: what is affine stays so, images change nothing, stress and energy are those of the strain."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.batch import pair_forces, scratch
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import kinetic_energy, max_overlap
from porescale.dem.motion import affine_strain as strain
from porescale.dem.motion.periodic_cell import Still, Straining
from porescale.dem.steering import COMPONENTS
from porescale.validation.dem.bodies import lattice, random_cell
from tests.reference.dem.restarted import differing, saved_on_the_way
from tests.reference.dem.stored import stored

LAW = Linear(1e7, 20.0, 5e6, 10.0, 0.5)
EPS = np.finfo(float).eps


@pytest.mark.parametrize("component", COMPONENTS)
def test_an_affine_strain_of_a_lattice_leaves_it_homogeneous(component):
    # 1 % in 400 steps: no disc leaves the affine motion but for round-off of distances across the cell, eps of 0.12 m,
    # in six contacts of k = 1e7 N/m, all one way for 400 dt = 0.025 s, on 0.78 kg/m.
    grains = lattice(Linear(1e7, 0.0, 0.0), 6)
    before = grains.discs.position.copy()
    dt = grains.stable_step()
    grains.steering.strain_cell(**{component: -0.01 / (400 * dt)})
    grains.step(dt, count=400)
    (width, _), (tilt, height) = grains.steering.edges()
    start = grains.box.period
    moved = np.array([[width / start[0], tilt / start[1]], [0.0, height / start[1]]])
    assert np.abs(grains.discs.velocity).max() < EPS * 0.12 * 6 * 1e7 / 0.78 * 400 * dt
    np.testing.assert_allclose(grains.discs.position, before @ moved.T, rtol=0, atol=400 * EPS * start[0] * 10)


def test_discs_without_the_affine_velocity_do_not_stay_homogeneous():  # the twin that must fail
    grains = lattice(Linear(1e7, 0.0, 0.0), 6)
    before, dt = grains.discs.position.copy(), grains.stable_step()
    grains.steering.strain_cell(xy=0.01 / (400 * dt))
    grains.discs.velocity[:, 0] = -0.01 / (400 * dt) * grains.discs.position[:, 1]  # at rest in the laboratory
    grains.step(dt, count=20)
    (width, _), (tilt, height) = grains.steering.edges()
    moved = np.array(
        [[width / grains.box.period[0], tilt / grains.box.period[1]], [0.0, height / grains.box.period[1]]]
    )
    assert np.abs(grains.discs.position - before @ moved.T).max() > 1e-5


def test_the_choice_of_images_changes_no_force():
    grains = random_cell(LAW, seed=3)
    grains.steering.strain_cell(xx=-0.3, yy=0.2, xy=2.0)
    grains.step(grains.stable_step(), count=200)
    d, pairs = grains.discs, grains.current_pairs()
    (width, _), (tilt, height) = grains.steering.edges()
    turns = np.random.default_rng(0).integers(-3, 4, d.position.shape)
    cell = np.array([[width, 0.0], [tilt, height]])
    sums = []
    for position, lean in ((d.position, tilt), (d.position + turns @ cell, tilt), (d.position, tilt - 2 * width)):
        force, torque, load = np.zeros((d.count, 2)), np.zeros(d.count), np.zeros(5)
        now = Straining(width, height, lean, -0.3, 2.0, 0.2, load)
        discs = grains.disc_arrays()._replace(position=position, force=force, torque=torque)
        listed = grains.pair_arrays()._replace(history=pairs.carried.copy())
        pair_forces(discs, listed, grains.contact, 1e-5, now, *(it[0] for it in scratch(1)))
        sums.append((force, torque, load))
    # Distances of 1e-2 m from numbers of up to 1 m: eps each, times k.
    for other in sums[1:]:
        np.testing.assert_allclose(other[0], sums[0][0], rtol=0, atol=20 * EPS * LAW.stiffness)
        np.testing.assert_allclose(other[2], sums[0][2], rtol=1e-9, atol=d.count * 20 * EPS * LAW.stiffness * 0.02)
    assert np.abs(sums[0][0]).max() > 1.0


def test_images_without_the_tilt_are_other_forces():  # the twin that must fail
    grains = lattice(LAW, 6)
    grains.steering.strain_cell(xy=2.0)
    grains.step(1e-5, count=400)
    d, pairs = grains.discs, grains.current_pairs()
    (width, _), (tilt, height) = grains.steering.edges()
    found = []
    for lean in (tilt, 0.0):
        force, torque = np.zeros((d.count, 2)), np.zeros(d.count)
        discs = grains.disc_arrays()._replace(force=force, torque=torque)
        listed = grains.pair_arrays()._replace(history=pairs.carried.copy())
        now = Straining(width, height, lean, 0.0, 2.0, 0.0, np.zeros(5))
        pair_forces(discs, listed, grains.contact, 1e-5, now, *(it[0] for it in scratch(1)))
        found.append(force)
    assert np.abs(found[0] - found[1]).max() > 1.0


def test_a_strain_of_nothing_is_a_cell_that_stands_still():
    still, strained = random_cell(LAW, seed=1), random_cell(LAW, seed=1)
    strained.steering.strain_cell()
    for grains in (still, strained):
        grains.step(2e-5, count=300)
    # The kick is written differently: one rounding a step of velocities of 1 m/s, and collisions enlarge it by 10 each.
    np.testing.assert_allclose(strained.discs.position, still.discs.position, rtol=0, atol=1e-11)


@pytest.mark.parametrize("rates", [{"xx": -2.0}, {"yy": 1.5}, {"xy": 3.0}, {"xx": -2.0, "yy": 1.0, "xy": -4.0}])
def test_the_work_of_the_cell_is_the_energy_it_gains(rates):
    law = Linear(1e7)
    errors = []
    for halves in (1, 2):
        grains = random_cell(law, seed=5)
        dt = 4e-6 / halves
        grains.steering.strain_cell(**rates)
        grains.step(dt)
        start = kinetic_energy(grains.discs) + stored(grains)
        work = grains.steering.cell[strain.WORK]
        grains.step(dt, count=2500 * halves)
        gained = kinetic_energy(grains.discs) + stored(grains) - start
        work = grains.steering.cell[strain.WORK] - work
        assert abs(gained) > 1e-3 * start
        errors.append(abs(work - gained) / (start + abs(gained)))
    # Speeds lag positions by half a step: the energy errs by w dt of what contacts hold, w dt = 0.014 with k/m = 1.3e7.
    assert errors[0] < 0.014
    assert errors[1] < max(0.7 * errors[0], 1e-4)


def test_momentum_of_a_sheared_cell_is_kept_relative_to_the_strain():
    # m c' = F - m G c: sum m c stays at zero where it is zero, as forces cancel to round-off.
    grains = random_cell(LAW, seed=2)
    grains.discs.velocity -= grains.discs.mass @ grains.discs.velocity / grains.discs.mass.sum()
    grains.steering.strain_cell(xy=5.0, xx=-1.0)
    grains.step(grains.stable_step(), count=2000)
    scale = float(grains.discs.mass @ np.hypot(*grains.discs.velocity.T))
    assert np.abs(grains.discs.mass @ grains.discs.velocity).max() < 2000 * EPS * scale


def test_a_list_that_follows_the_strain_misses_no_contact():
    thin, thick = random_cell(LAW, seed=4, skin=1e-3), random_cell(LAW, seed=4, skin=1.2e-2)
    for grains in (thin, thick):
        grains.steering.strain_cell(xx=-3.0, yy=2.0, xy=10.0)
        grains.step(1e-5, count=3000)  # a shear of 0.3
    assert thin.pairs.builds > 2 * thick.pairs.builds > 2
    np.testing.assert_array_equal(thin.discs.position, thick.discs.position)


def test_a_lattice_that_goes_round_touches_its_images_again():
    # After a shear of one whole width per height the images are the same ones again: forces return to round-off.
    grains = lattice(Linear(1e7), 6)
    grains.hold(slice(None))
    dt = 1e-5
    grains.steering.strain_cell()
    grains.step(dt)
    first = grains.steering.cell_pressure()
    width, height = grains.box.period
    grains.steering.strain_cell(xy=width / height / (4000 * dt))
    grains.step(dt, count=4000)
    grains.steering.strain_cell()
    grains.step(dt)
    assert grains.steering.edges()[1][0] == pytest.approx(width, rel=1e-12)
    # Overlaps of 2e-6 m from sums of 4000 roundings of 0.1 m: 4000 * 1e-17/2e-6.
    np.testing.assert_allclose(grains.steering.cell_pressure(), first, rtol=0, atol=1e-7 * abs(first[0]))


@pytest.mark.parametrize("before", [1, 250])
def test_a_restart_of_a_strained_cell_equals_the_uninterrupted_run(before, tmp_path):
    def made():
        grains = random_cell(LAW, seed=7)
        grains.steering.strain_cell(xy=6.0, pressure=(2e4, 1e4), limit=3.0)
        return grains

    through, first, second = made(), made(), made()
    through.step(1e-5, count=800)
    assert not differing(through, saved_on_the_way(first, second, 1e-5, 800, before, tmp_path))


@pytest.mark.parametrize("dashpot", [0.0, 100.0])
def test_stress_control_brings_a_lattice_to_the_stress(dashpot):
    grains = lattice(Linear(1e7, dashpot, 0.0), 6)
    grains.steering.strain_cell(pressure=(4e3, 7e3), shear_stress=500.0, limit=10.0)
    grains.step(grains.stable_step(), count=1500)
    pxx, pxy, pyy = grains.steering.cell_pressure()
    # A share of the rest goes each step, with dashpots dt K/(dt K + 2 C) = 0.4 of it, times C11/K = 3/8 or C66/K = 1/8:
    # 1500 steps leave exp(-1500 * 0.5 * 0.4/8).
    np.testing.assert_allclose([pxx, -pxy, pyy], [4e3, 500.0, 7e3], rtol=1e-9)
    assert np.abs(grains.discs.velocity).max() < 1e-9


@pytest.mark.parametrize(("share", "stable"), [(1.9, True), (6.0, False)])
def test_stress_control_diverges_beyond_its_bound(share, stable):
    # The bound takes K = k sum d^2/A for a modulus that is 3/8 of it here: beyond 4/(3/8) it must fail.  A share of 1.9
    # leaves sqrt(1 - 3/8 share (1 - share/4)) = 0.79 a step, see servo.py.
    grains = lattice(Linear(1e7), 6)
    grains.steering.strain_cell(pressure=(3e3, None), limit=1.0)
    grains.steering._plan[0, strain.SHARE] = share
    grains.step(grains.stable_step(), count=3)
    start = abs(grains.steering.cell_pressure()[0] - 3e3)
    grains.step(grains.last_dt, count=30)
    end = abs(grains.steering.cell_pressure()[0] - 3e3)
    assert (end < 0.1 * start) if stable else (end > 0.5 * start)


def test_a_cell_without_contacts_shrinks_under_pressure_at_its_limit():
    discs = make_discs([[0.05, 0.05], [0.15, 0.15]], 0.01, 2500.0)
    grains = Grains(discs, LAW, Box((0.0, 0.0), (0.2, 0.2), *("periodic",) * 4))
    grains.steering.strain_cell(pressure=(100.0, None), limit=0.5)
    grains.step(1e-4, count=100)
    assert grains.steering.gradient()[0, 0] == -0.5
    assert grains.steering.edges()[0][0] == pytest.approx(0.2 * (1 - 0.5e-4) ** 100, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"pressure": (1.0, None)}, "cell.limit"),
        ({"pressure": (1.0, None), "limit": 1.0, "share": 2.5}, "cell.share"),
        ({"xx": 1.0, "pressure": (1.0, None), "limit": 1.0}, "both a rate and a stress"),
    ],
)
def test_a_strain_without_sense_is_refused(given, key):
    with pytest.raises(InputError, match=key):
        lattice(LAW, 6).steering.strain_cell(**given)


def test_only_a_cell_that_is_periodic_both_ways_can_be_strained():
    grains = Grains(make_discs([[0.5, 0.5]], 0.01, 2500.0), LAW, Box((0.0, 0.0), (1.0, 1.0)))
    with pytest.raises(InputError, match="all sides are periodic"):
        grains.steering.strain_cell(xx=1.0)


def test_kernels_do_the_same_as_plain_python():
    made = []
    for plain in (False, True):
        grains = random_cell(LAW, seed=6)
        grains.steering.strain_cell(xy=1.0, pressure=(1e3, None), limit=1.0)
        grains.step(1e-5, count=3)
        d, cell = grains.discs, grains.steering.now()
        run = (lambda kernel: kernel.py_func) if plain else (lambda kernel: kernel)
        load = np.zeros(5)
        now = Straining(*(float(v) for v in cell.state[:3]), 0.1, 0.2, 0.3, load)
        discs = grains.disc_arrays()
        run(pair_forces)(discs, grains.pair_arrays(), grains.contact, 1e-5, now, *(it[0] for it in scratch(1)))
        run(strain.steer_deforming)(d.velocity, d.mass, 1, 1e-5, cell)
        run(strain.affine_kick_drift)(discs, 0.1, 0.2, 0.3, 0.4, 1e-5)
        run(strain.strain)(cell.state, 1e-5)
        room = run(strain.room_square)(cell.state)
        left = run(strain.left_affine)(d.position, grains.pairs.list_position, room, cell.state)
        made.append((d.position, d.velocity, cell.state, np.array([room, left]), load))
    for one, other in zip(*made, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-13)  # llvm may contract sums in other order than Python


def test_a_cell_that_stands_still_has_no_drift():
    assert strain.drift_of(Still(1.0, 1.0)) == (0.0, 0.0, 0.0)


def test_overlaps_across_a_sheared_boundary_are_what_they_are():
    grains = lattice(LAW, 6)
    grains.hold(slice(None))
    grains.steering.strain_cell(xy=50.0)
    grains.step(1e-5, count=1000)  # a shear of 1/2: rows have gone from one hollow almost to the next
    grains.check()  # with the tilt left out some would be 30 % deep
    found = max_overlap(grains).share
    (width, _), (tilt, height) = grains.steering.edges()
    at = grains.discs.position
    apart = [
        np.hypot(*((at[None] - at[:, None]) + (a * width + b * tilt, b * height)).transpose(2, 0, 1))
        for a in range(-3, 4)
        for b in (-1, 0, 1)
    ]
    nearest = min(float(d[d > 1e-9].min()) for d in apart)
    assert found == pytest.approx((0.02 - nearest) / 0.01, rel=1e-9)
