"""Readings of a flow: stream function and flux agree with each other, and every reading with flows that are known."""

import numpy as np
import pytest

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


def test_walls_are_stream_lines_of_a_cavity_and_its_flux_is_a_difference():
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
    assert observe.flux(psi, (8, 0), (8, 12)) == pytest.approx(psi[12, 8])
    assert observe.flux(psi, (8, 12), (8, 0)) == pytest.approx(-psi[12, 8])
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
    for x in (0, 7.3, 10, 20):
        assert observe.flux(psi, (x, 0), (x, n)) == pytest.approx(total, rel=3.2e-3)
    assert observe.flux(psi, (0, 0), (20, 0)) == 0


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


def test_vorticity_of_a_turning_body_is_twice_its_rate_and_of_a_shear_its_slope():
    y, x = np.mgrid[0:5, 0:7] + 0.5
    np.testing.assert_allclose(observe.vorticity(-0.1 * y, 0.1 * x), 0.2, rtol=0, atol=20 * EPS)
    np.testing.assert_allclose(observe.vorticity(0.3 * y, 0 * x), -0.3, rtol=0, atol=20 * EPS)
    assert observe.vorticity(x, y).shape == (4, 6)


def test_bilinear_fields_are_read_exactly_up_to_the_sides():
    y, x = np.mgrid[0:5, 0:7] + 0.5
    points = np.random.default_rng(3).uniform([0, 0], [7, 5], (50, 2))
    values = 1 + 2 * x - y + 0.5 * x * y
    expected = 1 + 2 * points[:, 0] - points[:, 1] + 0.5 * points[:, 0] * points[:, 1]
    # A dozen roundings of numbers up to 30.
    np.testing.assert_allclose(observe.at_points(values, points), expected, rtol=0, atol=12 * 30 * EPS)
    assert observe.at_points(np.ones((1, 1)), [(0.2, 0.9)]) == 1


def test_points_outside_of_the_box_are_refused():
    with pytest.raises(ValueError, match=r"\(7.1, 2\) is outside of the box of 7 by 5 cells"):
        observe.at_points(np.zeros((5, 7)), [(1, 1), (7.1, 2)])


@pytest.mark.parametrize("operator", ["trt", "mrt", "central", "bgk"])
@pytest.mark.parametrize("steps", [4000, 4001])
def test_stress_of_a_sheared_layer_is_viscosity_times_slope(operator, steps):
    h, nu, speed = 10, 1 / 6, 0.02
    fluid = Fluid(3, h, 1.0, operator=operator, sides=Sides("periodic", "periodic", top_speed=speed))
    for _ in range(steps):
        fluid.advance()
    normal, shear = observe.shear_stress(fluid)
    # Exact but for the start, forgotten by exp(-pi² nu steps/h²) = exp(-65), and round-off of sums of size 1.
    np.testing.assert_allclose(shear, nu * speed / h, rtol=0, atol=30 * EPS)
    assert np.abs(normal).max() < (speed / h) ** 2  # the next order of the expansion is quadratic in the slope


@pytest.mark.parametrize("operator", ["trt", "mrt", "central", "bgk"])
def test_stress_of_a_driven_channel_balances_its_force(operator):
    h, force = 10, (1e-5, 0.0)
    fluid = Fluid(3, h, 0.8, operator=operator, force=force, smagorinsky=0.1, sides=Sides("periodic", "periodic"))
    for _ in range(8000):
        fluid.advance()
    _, shear = observe.shear_stress(fluid)
    y = np.arange(h) + 0.5
    # The momentum balance is exact at any viscosity, the eddies' included, but for the start: exp(-pi² 0.1 8000/100).
    np.testing.assert_allclose(shear, (force[0] * (h / 2 - y))[:, None].repeat(3, 1), rtol=0, atol=30 * EPS)
