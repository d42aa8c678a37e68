"""Soil that shears where its particles crowd swells: by how much, and where not."""

import math

import numpy as np
import pytest

from continuum_sph.soil import Material
from continuum_sph.soil.parameters import STREWN, even_crowd
from continuum_sph.soil.state import GXX, SHEAR_RATE
from continuum_sph.soil.stress import CROWD, XX, YY
from continuum_sph.validation.soil.setups import RATIO, body
from continuum_sph.water.smoothing import NAMES, Smoothing, kernel_slope, kernel_value
from porescale.common.neighbors import square_lattice

SPACING, STEP, SHEAR = 0.1, 1e-5, 2.0  # m, s, 1/s
ELASTIC = Material(1e7, 1600.0, yields=False)


def gained(closer, rate, **law):
    """(p of a step gained amid a block, Pa, its `CROWD`, share by which its density grew) when it is sheared.

    closer : distances over the spacing;  rate : of shear, 1/s.
    """
    x = square_lattice((-0.7, -0.7), (0.7, 0.7), SPACING) * closer
    flow = body(x, SPACING, ELASTIC, (1e4, 1e4, 0.0, 6e3), **law)
    soil, amid = flow.soil, int(np.argmin(np.hypot(*(x - 0.5 * SPACING * closer).T)))
    soil.v[:, 0] = rate * soil.x[:, 1]
    soil.acceleration[:] = 0.0
    before, density = soil.stress[amid].copy(), float(soil.density[amid])
    flow.begin(STEP)
    flow.strain(STEP)
    now = soil.stress[amid]
    assert soil.record[amid, SHEAR_RATE] == pytest.approx(abs(rate), rel=1e-9)
    assert abs(soil.record[amid, GXX]) < 1e-9  # nothing but shear
    p = 0.5 * float(now[XX] + now[YY] - before[XX] - before[YY])
    return p, float(soil.spread[amid, CROWD]), float(soil.density[amid]) / density - 1.0


@pytest.mark.parametrize("closer", [0.9, 0.95])
def test_crowded_soil_that_is_sheared_gains_the_pressure_of_its_excess(closer):
    p, crowd, grown = gained(closer, SHEAR)
    excess = crowd / (STREWN * even_crowd(Smoothing("wendland", RATIO * SPACING), SPACING)) - 1.0
    area = ELASTIC.stiffness / (2.0 * (1.0 + ELASTIC.poisson) * (1.0 - 2.0 * ELASTIC.poisson))
    assert excess > 0.05
    # p of 1e4 Pa is rounded, and gradients are linear to 1e-12 of the shear
    assert p == pytest.approx(area * SHEAR * STEP * excess, abs=1e-11 * (1e4 + area * SHEAR * STEP))
    assert abs(grown) < 1e-12  # density follows velocities alone, whose gradients are linear to that


@pytest.mark.parametrize("given", [{"closer": 1.0, "rate": SHEAR}, {"closer": 0.9, "rate": 0.0},
                                   {"closer": 0.9, "rate": SHEAR, "spacing_recovery": 0.0}])  # fmt: skip
def test_an_even_lattice_soil_without_shear_and_soil_that_does_not_part_gain_none(given):
    assert abs(gained(**given)[0]) < 1e-11 * 1e4  # Pa: rounded as above


def crowd(x, smoothing):
    """Sum of `CROWD` at the origin of particles ``x`` (n, 2), one to an area of 1, in the plainest way."""
    kind, h = smoothing.kind, smoothing.length
    slopes = [kernel_slope(kind, float(np.hypot(*at)) / h, h) for at in x if np.hypot(*at) > 0.0]
    return -sum(slopes) / (2.0 * np.pi * kernel_value(kind, 0.0, h))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("ratio", [1.35, 1.7, 2.0])
def test_triangles_of_as_many_particles_crowd_as_the_lattice_does(name, ratio):
    side, steps = math.sqrt(2.0 / math.sqrt(3.0)), range(-9, 10)
    triangles = [(side * (i + 0.5 * j), side * 0.5 * math.sqrt(3.0) * j) for i in steps for j in steps]
    square = [(i, j) for i in steps for j in steps]
    smoothing = Smoothing(name, ratio)
    even = even_crowd(smoothing, 1.0)
    assert crowd(square, smoothing) == pytest.approx(even, rel=1e-12)
    assert 1.0 / STREWN < crowd(triangles, smoothing) / even < 0.5 * (1.0 + STREWN)  # far from swelling
