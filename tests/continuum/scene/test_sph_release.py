"""Pressure of fluids just let go: the exact one of a column, none to move fluid at rest, and no knock at a bubble."""

import numpy as np
import pytest

from continuum_sph.builders.initial_pressure import lattice_pressure, released_pressure
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import square_lattice


@pytest.mark.parametrize(("size", "lid"), [((0.5, 1.0), True), ((0.5, 1.2), False)])
def test_a_full_tank_has_the_pressure_of_rest(size, lid):
    x = square_lattice((0.0, 0.0), (0.5, 1.0), 0.05)
    found = lattice_pressure(x, np.full(len(x), 1000.0), 0.05, GRAVITY, size, lid)
    # linear: five-point differences are exact, what is left is the round-off of the solver
    np.testing.assert_allclose(found, 1000.0 * GRAVITY * (1.0 - x[:, 1]), atol=1e-8)


@pytest.mark.parametrize("across", [20, 40])
def test_a_column_with_a_free_face_has_the_series_pressure(across):
    x = square_lattice((0.0, 0.0), (1.0, 2.0), 1.0 / across)
    found = lattice_pressure(x, np.full(len(x), 1000.0), 1.0 / across, GRAVITY, (4.0, 3.0), True)
    exact = released_pressure(x[:, 0], x[:, 1], 1.0, 2.0, 1000.0, GRAVITY)
    # First order at the corner of face and floor, where the gradient has a logarithm: a twentieth of a spacing's head
    assert np.abs(found - exact).max() < 0.1 * 1000.0 * GRAVITY / across
    hydrostatic = 1000.0 * GRAVITY * (2.0 - x[:, 1])
    assert np.abs(hydrostatic - exact).max() > 10.0 * 1000.0 * GRAVITY / across  # the twin that must fail


def test_acceleration_is_continuous_across_a_layer_of_light_fluid():
    x = square_lattice((0.0, 0.0), (0.4, 1.0), 0.05)
    light = (x[:, 1] > 0.3) & (x[:, 1] < 0.5)
    density = np.where(light, 1.0, 1000.0)
    p = lattice_pressure(x, density, 0.05, GRAVITY, (0.4, 1.0), False)
    # layers that span the tank cannot move: the pressure carries their weight, half of each of two neighbours
    rows = p.reshape(-1, 8)
    weights = density.reshape(-1, 8)[:, 0]
    steps = 0.5 * (weights[:-1] + weights[1:]) * GRAVITY * 0.05
    np.testing.assert_allclose(-np.diff(rows, axis=0), np.broadcast_to(steps[:, None], (19, 8)), rtol=1e-9)
