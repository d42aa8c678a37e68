"""The stream function of a flow agrees with what passes sections, and the velocities of faces with their sides."""

import numpy as np

from porescale.lbm import fields as observe
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid

EPS = np.finfo(float).eps
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")


def closed_eddy(nx=8, ny=6, seed=1):
    """Cell velocities whose face fluxes come from a random stream function that is zero on the walls."""
    psi = np.zeros((ny + 1, nx + 1))
    psi[1:-1, 1:-1] = np.random.default_rng(seed).uniform(-1, 1, (ny - 1, nx - 1))
    return psi, np.diff(psi, axis=0), -np.diff(psi, axis=1)


def test_a_stream_function_does_not_depend_on_the_way_when_no_cell_stores_fluid(monkeypatch):
    psi, u, v = closed_eddy()
    monkeypatch.setattr(observe, "face_velocities", lambda *_: (u, v))
    found = observe.stream_function(Fluid(8, 6, 0.7), np.zeros((6, 8)), np.zeros((6, 8)))
    # Sums of at most 14 numbers of size 2.
    np.testing.assert_allclose(found, psi, rtol=0, atol=28 * EPS)
    along_left_then_right = np.concatenate([np.zeros((7, 1)), -np.cumsum(v, axis=1)], axis=1)
    np.testing.assert_allclose(found, along_left_then_right, rtol=0, atol=28 * EPS)


def test_walls_are_stream_lines_of_a_cavity():
    fluid = Fluid(16, 16, 0.7, sides=Sides(top_speed=0.02))
    for _ in range(3000):
        fluid.advance()
    _, ux, uy = fluid.fields()
    psi = observe.stream_function(fluid, ux, uy)
    assert not psi[0].any()
    assert not psi[:, 0].any()
    # Fluxes through faces are means of two cells: second order, (1/16)² of the largest; so is what the start left.
    assert np.abs(psi[-1]).max() < np.abs(psi).max() / 16**2
    assert np.abs(psi[:, -1]).max() < np.abs(psi).max() / 16**2
    assert psi.min() < -0.02  # the lid moves right, so the fluid below it turns clockwise: psi grows toward the lid


def test_what_a_velocity_side_lets_in_passes_every_section():
    n = 12
    y = np.arange(n) + 0.5
    profile = np.stack([0.06 * y * (n - y) / n**2, 0 * y], 1)
    given = {"left_velocity": profile, "right_velocity": profile}
    fluid = Fluid(20, n, 0.8, sides=Sides("velocity", "velocity", **given))
    for _ in range(4000):
        fluid.advance()
    _, ux, uy = fluid.fields()
    psi = observe.stream_function(fluid, ux, uy)
    total = profile[:, 0].sum()
    # Mass is conserved, volume to order Ma²: the pressure drop over half the channel, 3 * 8 nu u/n² * 10 = 3.1e-3.
    np.testing.assert_allclose(psi[-1] - psi[0], total, rtol=3.2e-3)
    assert not psi[0].any()


def test_faces_of_periodic_slip_and_pressure_sides_are_what_these_sides_are():
    ux, uy = np.random.default_rng(2).uniform(-1, 1, (2, 3, 4))
    u, v = observe.face_velocities(Fluid(4, 3, 0.7, sides=PERIODIC), ux, uy)
    np.testing.assert_array_equal(u[:, 0], u[:, -1])
    np.testing.assert_array_equal(v[0], 0.5 * (uy[0] + uy[-1]))
    u, v = observe.face_velocities(Fluid(4, 3, 0.7, sides=Sides("pressure", "wall", "slip", "pressure")), ux, uy)
    np.testing.assert_array_equal(u[:, 0], ux[:, 0])
    np.testing.assert_array_equal(v[-1], uy[-1])
    assert not v[0].any()
    assert not u[:, -1].any()
