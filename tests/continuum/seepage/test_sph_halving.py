"""Water that comes into ground is parted in two where it is too heavy for its pores; nothing is lost by that."""

from types import SimpleNamespace

import numpy as np
import pytest

from continuum_sph.builders.sanity import JumpCheck, Now
from continuum_sph.seepage.halving import COPIED, halve
from continuum_sph.seepage.mixture import LINES, POROSITY, ROOM, SLIP_X, SLIP_Y, SOIL
from continuum_sph.water.state import Layer
from porescale.common.core.errors import Unstable

WHOLE = 10.0  # kg/m, a spacing of 0.1 m
WATER, PORES, WAITING = 4, 0.4, 3


def water():
    """Four particles in ground, the second of open water, the third on its surface, and three that wait."""
    n = WATER + WAITING
    x = np.column_stack((np.arange(n) * 0.1, np.full(n, 0.3)))
    v = np.arange(2.0 * n).reshape(n, 2)
    mass = np.array([4.0, WHOLE, WHOLE, WHOLE] + [0.0] * WAITING)
    layer = Layer(n, x, v, mass, np.full(n, 1000.0))
    for k, name in enumerate(COPIED):
        getattr(layer, name)[:WATER] = np.random.default_rng(k).random(getattr(layer, name)[:WATER].shape)
    layer.density[:] = 1000.0
    pores = np.zeros((LINES, n))
    pores[POROSITY], pores[ROOM], pores[SOIL, :WATER] = PORES, 1.0, [1.0, 1.0, 0.75, 1.0]
    pores[SLIP_X, 1], pores[SLIP_Y, 1] = 3e-3, -4e-3
    flow = SimpleNamespace(layer=layer, pores=pores, porosity=pores[POROSITY], slip=pores[[SLIP_X, SLIP_Y]].T)
    flow.excess = np.linspace(0.0, 0.1, n)
    return flow


def sums(layer):
    """Mass, momentum, first moment and energy of motion."""
    mass = layer.mass
    return np.array([mass.sum(), *(mass @ layer.v), *(mass @ layer.x), mass @ (layer.v**2).sum(axis=1)])


def test_halves_have_the_mass_momentum_centre_and_energy_of_the_whole():
    flow = water()
    layer = flow.layer
    before, wide = sums(layer), np.sqrt(WHOLE / (PORES * 1000.0))
    halve(flow, WHOLE, 0)
    np.testing.assert_allclose(sums(layer), before, rtol=1e-15, atol=1e-15 * before.max())
    # the one on the surface is left whole; the last has no way through the soil: one above the other
    np.testing.assert_array_equal(layer.mass, [4.0, 5.0, 10.0, 5.0, 5.0, 5.0, 0.0])
    np.testing.assert_allclose(layer.x[4] - layer.x[1], 0.5 * wide * np.array([0.6, -0.8]), rtol=1e-12)
    np.testing.assert_allclose(layer.x[5] - layer.x[3], [0.0, 0.5 * wide], atol=1e-15)
    for name in COPIED:
        np.testing.assert_array_equal(getattr(layer, name)[[4, 5]], getattr(layer, name)[[1, 3]])


@pytest.mark.parametrize(("reserve", "parted"), [(3, 0), (2, 1), (1, 2), (0, 2)])
def test_particles_that_wait_for_reservoirs_are_left_to_them(reserve, parted):
    flow = water()
    halve(flow, WHOLE, reserve)
    assert np.count_nonzero(flow.layer.mass == 0.0) == WAITING - parted


def test_halves_are_not_parted_again_and_air_never_is():
    flow = water()
    flow.layer.material[3] = 1
    halve(flow, WHOLE, 0)
    mass = flow.layer.mass.copy()
    flow.pores[SOIL] = 1.0  # those that were new are enclosed, too, but the third was not parted before
    flow.pores[SOIL, 2] = 0.75
    halve(flow, WHOLE, 0)
    np.testing.assert_array_equal(flow.layer.mass, mass)
    assert mass[3] == WHOLE


def test_a_half_that_was_put_where_it_is_has_not_jumped_there():
    flow, now = water(), Now(0, 0.0, "")
    layer, looks = flow.layer, JumpCheck(0.1)
    n = layer.fluid
    layer.mass[WATER] = 1.0  # one that is taken out after the first look, and comes back as a half
    looks.check(layer.x, layer.mass, now, layer.renewed)
    layer.mass[WATER] = 0.0
    halve(flow, WHOLE, 0)
    assert layer.renewed[WATER]
    assert layer.renewed.sum() < n
    layer.x[WATER, 0] += 5.0
    looks.check(layer.x, layer.mass, now, layer.renewed)
    assert not layer.renewed.any()
    layer.x[WATER, 0] -= 5.0
    with pytest.raises(Unstable, match="way since the last look"):  # the twin that must fail
        looks.check(layer.x, layer.mass, now, layer.renewed)
