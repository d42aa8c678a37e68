"""Tolerances of what is measured on grains catch the error next door (test_dem_validation runs the rows)."""

import math
from copy import deepcopy

import numpy as np
import pytest

from porescale.common.evidence.validations import Measured
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress
from porescale.validation.dem import measures as measured
from porescale.validation.dem import setups as lab
from porescale.validation.dem.bodies import random_cell
from tests.validation.tolerances import tolerance


@pytest.fixture(scope="module")
def heap():
    return measured.heap()


def test_a_region_half_a_diameter_wider_has_another_porosity():
    off = measured.square_lattice_porosity((0.0, 0.0), (2.25, 2.0)) - (1.0 - math.pi / 4.0)
    assert abs(off) > 1e10 * tolerance("dem.porosity_of_a_square_lattice")


def test_a_column_still_moving_does_not_carry_its_load():
    found, exact = measured.column_stress(*measured.loaded_column(settled=10.0))
    assert Measured.relative(exact, found).error > 100 * tolerance("dem.stress_of_a_loaded_column")


def test_a_contact_counted_whole_makes_too_much_stress():
    # Half of a branch in the region, all of it counted: the stress would be twice what the load says.
    grains, width = measured.loaded_column()
    y = grains.discs.position[:, 1]
    half = Region((0.0, y[3]), (width, 0.5 * (y[3] + y[4])))
    found = contacts(grains)
    one = found.chosen((found.first == 3) & (found.second == 4))
    share = contact_stress(half, found)[1, 1]
    exact = measured.column_stress(grains, width)[1][3]
    assert share == pytest.approx(exact, rel=tolerance("dem.stress_of_a_loaded_column"))
    whole = float(one.force[0, 1] * one.branch[0, 1]) / half.area
    assert whole == pytest.approx(2.0 * exact, rel=1e-9)


def test_a_lattice_pressed_from_one_side_is_not_isotropic():
    stress, _, fabric = measured.lattice_stress(measured.pressed_lattice(stretch=0.1))
    limit = tolerance("dem.hexagonal_packing_under_pressure")
    assert abs(stress[0, 0] / stress[1, 1] - 1.0) > 1e4 * limit
    assert abs(fabric.tensor[0, 0] - 0.5) > 1e4 * limit


def test_kernels_cut_off_at_walls_lose_mass(heap):
    assert np.abs(measured.totals(heap, conserve=False) - 1.0).max() > 0.05


def test_momentum_is_not_balanced_without_the_walls_nor_on_a_coarser_grid(heap):
    fields = measured.heap_fields(heap, 64)
    assert measured.imbalance(fields, walls=False) > 100 * tolerance("dem.coarse_grained_momentum")
    assert measured.imbalance(measured.heap_fields(heap, 16)) > tolerance("dem.coarse_grained_momentum")


def test_the_imbalance_falls_with_the_square_of_the_spacing(heap):
    # Central differences: 4 for half the spacing; a quarter less where the largest value moves between the points.
    coarse, fine = (measured.imbalance(measured.heap_fields(heap, cells)) for cells in (8, 16))
    assert 3.0 < coarse / fine < 5.0


def test_a_gradient_of_the_mean_velocity_strains_where_none_is(heap):
    fields = measured.heap_fields(measured.turned(deepcopy(heap)), 8)
    dx, dy = fields.raster.spacing
    velocity = fields.velocity
    along = (velocity[1:-1, 2:, 1] - velocity[1:-1, :-2, 1]) / (2.0 * dx)
    up = (velocity[2:, 1:-1, 0] - velocity[:-2, 1:-1, 0]) / (2.0 * dy)
    shear = np.nanmax(np.abs(0.5 * (along + up)))
    assert shear > 1e6 * tolerance("dem.rigid_rotation_has_no_strain_rate")


def test_a_rectangle_as_large_as_the_cell_was_has_another_stress():
    grains = random_cell(measured.Linear(lab.STIFFNESS), 3)
    dt = grains.stable_step()
    grains.steering.strain_cell(xx=-0.18 / (900 * dt), yy=-0.14 / (900 * dt), xy=0.35 / (900 * dt))
    grains.step(dt, count=900)
    box, found = grains.box.upper, contacts(grains)
    stress = contact_stress(Region((0.0, 0.0), box), found, grains.period)
    grains.step(dt)
    exact = -grains.steering.load[:4].reshape(2, 2) / (grains.period[0] * grains.period[1])
    assert np.abs(stress - exact).max() > 1e6 * tolerance("dem.stress_of_a_strained_cell") * np.abs(exact).max()
