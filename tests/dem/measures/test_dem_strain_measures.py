"""What is measured in a strained cell is that of the cell: contacts, stress, porosity, motion and fields."""

import numpy as np
import pytest

from porescale.builders.parts.grain_instruments import _moving
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.measures.coarse_graining import CoarseGrained, Raster
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.fabric import fabric
from porescale.dem.measures.porosity import disc_areas, porosity
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress, kinetic_stress
from porescale.validation.dem.bodies import random_cell

LAW = Linear(1e7, 20.0, 5e6, 10.0, 0.5)
EPS = np.finfo(float).eps


@pytest.fixture
def sheared():
    """A cell strained in all components until it is dense, with a tilt of a third of its width."""
    grains = random_cell(LAW, seed=3)
    dt = grains.stable_step()
    grains.steering.strain_cell(xx=-0.2 / (900 * dt), yy=-0.16 / (900 * dt), xy=0.35 / (900 * dt))
    grains.step(dt, count=900)
    return grains


def whole(grains, at):
    """A rectangle as large as the cell, with its lower left corner ``at`` (m): it holds the cell once wherever."""
    width, height, _ = grains.period
    return Region(at, (at[0] + width, at[1] + height))


PLACES = ((0.0, 0.0), (0.013, -0.031), (-0.4, 0.77))


def test_contacts_of_a_strained_cell_are_those_of_its_next_step(sheared):
    grains = sheared
    found = contacts(grains)
    assert found.count > grains.discs.count
    grains.step(grains.last_dt)
    force, torque = found.resultants(grains.discs.count)
    # At most seven terms of the largest force in another order, and distances across the cell, 0.1 m, times k.
    worst = 8 * EPS * float(np.abs(found.force).max()) + 4 * EPS * 0.1 * LAW.stiffness
    np.testing.assert_allclose(force, grains.discs.force, rtol=0, atol=worst)
    np.testing.assert_allclose(torque, grains.discs.torque, rtol=0, atol=worst * 0.01)


@pytest.mark.parametrize("at", PLACES)
def test_love_weber_stress_of_a_strained_cell_is_the_stress_that_it_works_with(sheared, at):
    grains, area = sheared, sheared.period[0] * sheared.period[1]
    found = contacts(grains)
    stress = contact_stress(whole(grains, at), found, grains.period)
    grains.step(grains.last_dt)  # its load is that of the contacts found
    load = -grains.steering.load[:4].reshape(2, 2) / area
    # Forces err by k times eps of a metre (images of images), branches by eps of a metre over 0.02 m of each.
    each = np.abs(found.force).max() * 0.02
    worst = found.count / area * (4 * EPS * LAW.stiffness * 0.02 + 100 * EPS * each)
    np.testing.assert_allclose(stress, load, rtol=0, atol=worst)
    assert worst < 1e-6 * np.abs(load).max()


def test_images_without_the_tilt_or_in_the_cell_of_before_have_another_stress(sheared):  # the twin that must fail
    grains = sheared
    found, (width, height, _) = contacts(grains), grains.period
    region = Region((0.013, 0.7 * height), (0.013 + 0.4 * width, 1.2 * height))  # over the upper side
    right = contact_stress(region, found, grains.period)
    for wrong in ((width, height), grains.box.period):
        assert np.abs(contact_stress(region, found, wrong) - right).max() > 0.01 * np.abs(right).max()


def test_parts_of_a_strained_cell_add_up_to_it(sheared):
    grains, found = sheared, contacts(sheared)
    width, height, _ = grains.period
    quarters = [
        Region((a * width / 3 - 0.2, b * height / 2 + 0.1), ((a + 1) * width / 3 - 0.2, (b + 1) * height / 2 + 0.1))
        for a in range(3)
        for b in range(2)
    ]
    d, period = grains.discs, grains.period
    # Areas err by eps of an area a metre away, over the squared radius of each.
    assert np.sum([disc_areas(it, d.position, d.radius, period) for it in quarters], axis=0) == pytest.approx(
        d.area, rel=1e-12
    )
    parts = np.mean([contact_stress(it, found, period) for it in quarters], axis=0)
    np.testing.assert_allclose(parts, contact_stress(whole(grains, (0.0, 0.0)), found, period), rtol=1e-11)
    counts = [fabric(found, it, period).contacts for it in quarters]
    assert sum(counts) == fabric(found, whole(grains, (0.0, 0.0)), period).contacts
    for at in PLACES:
        solid = float(d.area.sum()) / (width * height)
        assert porosity(whole(grains, at), d.position, d.radius, period) == pytest.approx(1.0 - solid, abs=1e-12)


def test_stress_of_contacts_and_of_motion_is_the_pressure_of_the_cell(sheared):
    grains = sheared
    grains.discs.velocity -= grains.discs.mass @ grains.discs.velocity / grains.discs.mass.sum()
    kinetic = kinetic_stress(whole(grains, (0.0, 0.0)), grains.discs, grains.period)
    d, (width, height, _) = grains.discs, grains.period
    exact = np.einsum("i,ia,ib->ab", d.mass, d.velocity, d.velocity) / (width * height)
    np.testing.assert_allclose(kinetic, exact, rtol=1e-10, atol=1e-12 * np.abs(exact).max())


def test_motion_of_a_region_is_that_of_the_strain_wherever_it_lies(sheared):
    grains = sheared
    grains.discs.velocity[:] = 0.0  # all of it affine
    gradient = grains.steering.gradient()
    for lower in ((0.01, 0.01), (0.09, 0.08), (-0.03, 0.05)):  # over the sides of the cell, too
        region = Region(lower, (lower[0] + 0.05, lower[1] + 0.05))
        areas = disc_areas(region, grains.discs.position, grains.discs.radius, grains.period)
        found = _moving(grains, region, areas)
        # Round-off of positions of 0.1 m times the rate over the 0.02 m that they are apart.
        np.testing.assert_allclose(found.gradient, gradient, rtol=0, atol=100 * EPS * np.abs(gradient).max())


def test_discs_cut_by_an_edge_are_beside_it_not_a_period_away():
    # Velocities affine in x: a disc left of the region, reaching in, would tilt the fit if it were taken at x + period.
    at = np.array([(x, y) for x in np.arange(0.5, 10.0) for y in np.arange(0.5, 4.0)])
    region = Region((3.7, 0.0), (6.7, 4.0))
    near, far = region.about(at, (10.0, 0.0)), region.near(at, (10.0, 0.0))
    reaching = disc_areas(region, at, np.full(len(at), 0.5), (10.0, 0.0)) > 0.0
    np.testing.assert_array_equal(near[reaching], at[reaching])
    assert (far[reaching] != at[reaching]).any()  # the twin that must fail


def test_fields_of_a_strained_cell_are_sums_over_its_images(sheared):
    grains = sheared
    (width, height, tilt), gradient = grains.period, grains.steering.gradient()
    raster = Raster.over((-0.02, 0.01), (0.1, 0.13), 0.02, 0.035)
    fields = CoarseGrained(raster, grains.discs, contacts(grains), conserve=False, cell=grains.cell)
    d, c = grains.discs, 0.035
    x, y = raster.centres
    turns = [(a * width + b * tilt, b * height) for a in range(-4, 5) for b in range(-3, 4)]
    for j, i in ((0, 0), (3, 2), (5, 5)):
        rho, momentum = 0.0, np.zeros(2)
        for shift in turns:
            at = d.position + shift
            q = np.hypot(*(at - (x[i], y[j])).T) / c
            w = np.where(q < 1.0, 5.0 / (np.pi * c**2) * (1 + 3 * q) * np.clip(1 - q, 0, None) ** 3, 0.0) * d.mass
            rho += float(w.sum())
            momentum += w @ (d.velocity + at @ gradient.T)
        assert fields.density[j, i] == pytest.approx(rho, rel=1e-11)
        np.testing.assert_allclose(fields.velocity[j, i], momentum / rho, rtol=1e-10)


def test_fields_of_what_is_affine_have_the_strain_rate_of_the_cell(sheared):
    grains = sheared
    grains.discs.velocity[:] = 0.0
    gradient = grains.steering.gradient()
    raster = Raster.over(grains.box.lower, grains.box.upper, 0.01, 0.04)
    fields = CoarseGrained(raster, grains.discs, contacts(grains), conserve=False, cell=grains.cell)
    np.testing.assert_allclose(fields.velocity_gradient, np.broadcast_to(gradient, (*raster.shape[::-1], 2, 2)))
    assert np.abs(fields.kinetic_stress).max() == 0.0


def test_a_tilt_of_whole_widths_is_none():
    # The same lattice of images, said otherwise: what is inside of a region cannot depend on it.
    at = np.random.default_rng(1).uniform(-5.0, 5.0, (40, 2))
    region = Region((0.2, 0.3), (1.1, 1.7))
    discs = make_discs(at, 0.2, 1.0)
    one = disc_areas(region, discs.position, discs.radius, (2.0, 3.0))
    np.testing.assert_allclose(disc_areas(region, at, discs.radius, (2.0, 3.0, 4.0)), one, atol=1e-14)
    assert np.abs(disc_areas(region, at, discs.radius, (2.0, 3.0, 1.0)) - one).max() > 0.01
