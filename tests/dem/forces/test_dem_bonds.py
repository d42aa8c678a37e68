"""Bonds by back tension: what they cancel, between whom, when and where they break, and their energy."""

import numpy as np
import pytest

from porescale.benchmarks import dem_polygons as bench_segments
from porescale.common.core.errors import InputError
from porescale.dem.bodies.bonding import bond, segments_now
from porescale.dem.bodies.frames import framed, polygon
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces import bonds
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.energy import energy_budget
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.validation.dem.segments import OPEN, THICKNESS, mixed_cloud, regular

K, R = 1e6, 0.01
LAW = Linear(K)
BOX = Box((-1.0, -1.0), (1.0, 1.0), **OPEN)
REST = Moved()


def row(count=4, overlap=1e-4, box=BOX, law=LAW, **more):
    """Discs side by side along x, each pressed into the next."""
    at = np.column_stack(((2.0 * R - overlap) * np.arange(count), np.zeros(count)))
    return Grains(make_discs(at, R, 2000.0), law, box, **more)


def test_bonding_cancels_what_presses_and_the_row_stands_without_confinement():
    grains = row()
    assert bond(grains) == 3
    before = grains.discs.position.copy()
    grains.step(grains.stable_step(), count=2000)
    # The back tension is the force of the law to the bit, along the same way.
    np.testing.assert_allclose(grains.discs.position, before, rtol=0, atol=1e-15)
    loose = row()
    loose.step(loose.stable_step(), count=2000)
    assert np.ptp(loose.discs.position[:, 0]) > np.ptp(before[:, 0]) + 0.01  # the twin that must fail


def test_walls_are_not_bonded():
    box = Box((-R + 1e-4, -1.0), (1.0, 1.0), right="open", bottom="open", top="open")
    grains = row(box=box)
    assert bond(grains) == 3
    grains.step(1e-6)
    assert grains.discs.force[0, 0] == pytest.approx(K * 1e-4, rel=1e-9)  # what the wall goes on pressing with
    np.testing.assert_allclose(grains.discs.force[1:], 0.0, atol=1e-9)


def test_only_chosen_bodies_are_bonded_and_none_twice():
    grains = row()
    assert bond(grains, [0, 1, 3]) == 1
    assert bond(grains) == 2
    assert bond(grains) == 0
    assert grains.bonds.count == 3
    with pytest.raises(InputError, match="no such disc"):
        bond(grains, [4])
    with pytest.raises(InputError, match="no such clump"):
        bond(grains, [Clump(0)])


def pulled(grains, last, speed, steps):
    """Hold the first disc, move the last along x, and break what breaks."""
    grains.hold(0)
    grains.hold(last)
    grains.discs.velocity[last] = (speed, 0.0)
    grains.step(1e-6, count=steps)


def test_breaks_are_counted_placed_and_timed():
    grains = row(count=2)
    bond(grains)
    pulled(grains, 1, 0.1, 1200)  # the overlap of 1e-4 m is gone after 1e-3 s
    (found,) = grains.bonds.breaks(grains.segments)
    assert grains.bonds.count == 0
    assert found.time == pytest.approx(1e-3, abs=1e-6)
    assert found.place == pytest.approx((R, 0.0), abs=1e-7)
    assert found.discs == (0, 1)
    assert not np.any(grains.discs.force)


def test_a_bond_under_friction_keeps_the_limit_of_the_pressed_contact():
    law = Linear(K, 0.0, K, 0.0, 0.3)
    grains = row(count=2, law=law)
    bond(grains)
    grains.hold(slice(None))
    grains.discs.velocity[1] = (0.0, 0.01)
    grains.step(1e-5, count=1000)  # slides by 1e-4: the overlap falls by 2.5e-7 of the way, 0.25 %
    grains.step(1e-5)
    assert grains.withheld[1, 1] == pytest.approx(-0.3 * K * 1e-4, rel=5e-3)


@pytest.mark.parametrize("steps", [2000, 8000])
def test_energy_of_a_row_that_is_pulled_until_it_breaks_is_accounted_for(steps):
    grains = row(count=6, law=Linear(K, 30.0), energy=True)
    bond(grains)
    seconds = 4e-3
    grains.steering.control(0, REST, REST, REST)
    grains.steering.control(5, Moved(0.5), REST, REST)
    grains.step(seconds / steps, count=steps)
    budget = energy_budget(grains)
    assert len(grains.bonds.breaks(grains.segments)) >= 1
    # The break is met up to a step late, when it still bears b: b v dt of b d0, and dashpots lag by half a step.
    assert abs(budget["residual (J/m)"]) < 4.0 * 0.5 * seconds / steps / 1e-4 * budget["turned over (J/m)"]


def test_squares_in_a_wall_of_bricks_stand_and_break_along_the_joint():
    edge = np.array([(0.0, 0.0), (R, 0.0), (R, R), (0.0, R)])
    apart = R + 2.0 * THICKNESS - 2e-5
    bricks = [polygon(edge + np.array([k * apart, 0.0]), THICKNESS, 2000.0) for k in range(3)]
    bricks.append(polygon(edge + np.array([0.5 * apart, apart]), THICKNESS, 2000.0))
    grains = framed(None, bricks, LAW, BOX)
    bond(grains)
    grains.steering.watch(*(Clump(k) for k in range(4)))
    grains.step(1e-6)
    # Weights of +1 and -1 at corners that face each other, each K d in round-off.
    np.testing.assert_allclose([line.contact[:2] for line in grains.steering.record()], 0.0, atol=1e-9 * K * R)
    for k in range(3):
        grains.steering.control(Clump(k), REST, REST, REST)
    grains.steering.control(Clump(3), REST, Moved(0.1), REST)
    grains.step(1e-6, count=300)
    broken = grains.bonds.breaks(grains.segments)
    assert len(broken) >= 2
    assert all(each.place[1] == pytest.approx(R + THICKNESS, abs=THICKNESS) for each in broken)
    grains.step(1e-6)
    assert grains.steering.record()[3].contact[1] == pytest.approx(0.0, abs=1e-9 * K * R)


@pytest.mark.parametrize("compiled", [True, False])
def test_kernels_do_the_same_as_plain_python(compiled):
    grains = mixed_cloud(0.5, pace=1.0)
    grains.step(5e-6, count=3000)
    bond(grains)
    d, listed, made = grains.discs, segments_now(grains), grains.bonds.now(0.0, 0)
    assert made.ends[:, 2].any()
    force, torque = np.zeros((d.count, 2)), np.zeros(d.count)
    run = bonds.pull_bonds if compiled else bonds.pull_bonds.py_func
    run(d.position, d.radius, force, torque, listed, made, 0, 1e-6, grains.cell)
    energy = (bonds.stored_in_bonds if compiled else bonds.stored_in_bonds.py_func)(
        d.position, d.radius, listed, made, grains.cell
    )
    back = np.zeros(len(made.back))
    run = bonds.pressing if compiled else bonds.pressing.py_func
    run(d.position, d.radius, grains.body_mass, grains.material, made.ends, listed, grains.contact, grains.cell, back)
    np.testing.assert_array_equal(back, made.back)
    # Forces that are equal and opposite sum to nothing; energies are those of k d^2.
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-12 * np.abs(back).max())
    assert energy == pytest.approx(-float(np.sum(back**2)) / 1e7, rel=1e-6)


def test_a_cell_with_bonds_cannot_be_strained():
    grains = row(box=Box((-1.0, -1.0), (1.0, 1.0), *("periodic",) * 4))
    bond(grains)
    with pytest.raises(InputError, match="bonds"):
        grains.steering.strain_cell()
    strained = row(box=Box((-1.0, -1.0), (1.0, 1.0), *("periodic",) * 4))
    strained.steering.strain_cell()
    with pytest.raises(InputError, match="strained"):
        bond(strained)


def test_frames_that_do_not_touch_are_not_bonded():
    grains = framed(None, [regular(4, (0.0, 0.0)), regular(5, (0.05, 0.0))], LAW, BOX)
    assert bond(grains, [Clump(0), Clump(1)]) == 0


@pytest.mark.parametrize("what", ["outline", "each", "hexagons"])
def test_the_list_of_contacts_has_segments_corners_and_bonds_and_sums_to_the_forces(what):
    if what == "hexagons":
        grains = bench_segments.hexagons(9)
        grains.steering.clumps.spin[:] = np.linspace(-30.0, 30.0, 9)
        grains.step(1e-7, count=20)
    else:
        grains = mixed_cloud(0.5, pace=1.0, rule=what)
        grains.step(5e-6, count=3000)
    bond(grains)
    dt = grains.last_dt
    grains.step(dt, count=20)
    found = contacts(grains)
    force, torque = found.resultants(grains.discs.count)
    grains.step(dt)
    assert len(found.first) > (60 if what == "hexagons" else 3)
    assert (found.normal_force < 0.0).any()
    assert (found.spring != 0.0).any()
    # Sums of the same forces in another order.
    scale = np.abs(grains.discs.force).max()
    np.testing.assert_allclose(force, grains.discs.force, rtol=0, atol=1e-13 * scale)
    np.testing.assert_allclose(torque, grains.discs.torque, rtol=0, atol=1e-13 * scale * R)
