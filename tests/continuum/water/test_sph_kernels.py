"""Kernels, equation of state and viscosity obey what defines them."""

import numpy as np
import pytest

from continuum_sph.builders.initial_pressure import released_pressure
from continuum_sph.validation.water.channels import couette, poiseuille
from continuum_sph.validation.water.drop_swing import drop_period
from continuum_sph.validation.water.kernels import LATTICE
from continuum_sph.water.eos.liquid import Tait, tait
from continuum_sph.water.smoothing import (
    CUBIC,
    RATIO,
    WENDLAND,
    Smoothing,
    kernel_slope,
    kernel_value,
    value_scale,
    value_shape,
)
from continuum_sph.water.viscosity import artificial, laminar

eps = np.finfo(float).eps


def paper_spline(s):
    """Eq. 8 of Maeda & Sakai 2004 as printed, h = 1."""
    scale = 15.0 / (7.0 * np.pi)
    if s < 1.0:
        return scale * (2.0 / 3.0 - s * s + 0.5 * s**3)
    return scale * (2.0 - s) ** 3 / 6.0 if s <= 2.0 else 0.0


@pytest.mark.parametrize("kind", [CUBIC, WENDLAND])
def test_a_kernel_is_its_scale_times_its_shape(kind):
    for q in np.linspace(0.0, 2.5, 26):  # ten roundings of numbers below 4
        parts = value_scale(kind, 0.3) * value_shape(kind, q)
        assert parts == pytest.approx(kernel_value(kind, q, 0.3), abs=40 * eps * value_scale(kind, 0.3))
    assert value_shape(kind, 1.0) != pytest.approx(value_shape(kind, 1.001), abs=40 * eps)  # the twin that must fail


def test_cubic_spline_is_the_papers():
    for s in np.linspace(0.0, 2.5, 51):
        assert kernel_value(CUBIC, s, 1.0) == pytest.approx(paper_spline(s), abs=20 * eps)


@pytest.mark.parametrize("kind", [CUBIC, WENDLAND])
def test_kernels_end_at_two_smoothing_lengths_and_scale_with_them(kind):
    assert kernel_value(kind, 2.0, 1.0) == 0.0
    assert kernel_value(kind, 2.3, 1.0) == 0.0
    assert kernel_slope(kind, 2.3, 1.0) == 0.0
    assert kernel_value(kind, 0.7, 0.01) == pytest.approx(1e4 * kernel_value(kind, 0.7, 1.0), rel=1e-14)
    assert kernel_slope(kind, 0.7, 0.01) == pytest.approx(1e8 * kernel_slope(kind, 0.7, 1.0), rel=1e-14)
    assert np.isfinite(kernel_slope(kind, 0.0, 1.0))


@pytest.mark.parametrize("kind", [CUBIC, WENDLAND])
def test_plain_python_and_compiled_agree(kind):
    for q in (0.0, 0.3, 1.0, 1.7, 2.2):
        assert kernel_value.py_func(kind, q, 0.3) == pytest.approx(kernel_value(kind, q, 0.3), rel=1e-14)
        assert kernel_slope.py_func(kind, q, 0.3) == pytest.approx(kernel_slope(kind, q, 0.3), rel=1e-14)


def test_lattice_weakness_of_the_gradient_is_the_number_the_validations_use():
    h = RATIO
    i, j = np.meshgrid(np.arange(-4, 5), np.arange(-4, 5))
    total = sum(-kernel_slope(WENDLAND, np.hypot(a, b) / h, h) * b * b for a, b in zip(i.flat, j.flat, strict=True))
    assert 1.0 - total == pytest.approx(LATTICE, abs=5e-5)  # its last digit


def test_smoothing_knows_its_reach():
    assert Smoothing("wendland", 0.1).support == pytest.approx(0.2)
    assert Smoothing("cubic", 0.1).kind == CUBIC


@pytest.mark.parametrize("exponent", [7.0, 1.4])
def test_pressure_and_density_are_inverse_and_sound_is_their_slope(exponent):
    law = Tait(1000.0, 50.0, exponent)
    for ratio in (0.97, 1.0, 1.03):
        p, power = tait(ratio, law.stiffness, exponent)
        assert p == pytest.approx(float(law.pressure(np.array(1000.0 * ratio))), rel=1e-9, abs=1e-6)
        assert float(law.density_at(np.array(p))) == pytest.approx(1000.0 * ratio, rel=1e-12)
        # central difference over 2e-6: third derivative 210 B times 1e-12/6, round-off B 1e-16/1e-6
        up, down = (tait.py_func(ratio + d, law.stiffness, exponent)[0] for d in (1e-6, -1e-6))
        assert (up - down) / 2e-3 == pytest.approx(50.0**2 * power, rel=1e-8)


def test_settled_density_balances_gravity_and_the_specs_profile_is_near():
    law, g = Tait(1000.0, 10.0 * (2 * 9.81) ** 0.5), 9.81
    depth = np.linspace(0.0, 1.0, 10001)
    rho = law.settled_density(depth, g)
    slope = np.gradient(law.pressure(rho), depth)[1:-1]
    # second-order difference over 1e-4 m of a profile whose curvature is 3 % of its slope per metre
    np.testing.assert_allclose(slope, rho[1:-1] * g, rtol=1e-6)
    # p = ρ0 g depth leaves out the weight of the compression: g depth/2c0² = 1/400 of the density's departure, and as
    # much of second order.
    departure = np.abs(rho - law.density_at(1000.0 * g * depth)).max() / (rho.max() - 1000.0)
    assert 1 / 800 < departure < 1 / 200


def test_viscosity_brakes_and_never_drives():
    assert laminar(1e-3, 1e-4, 1e-3, -50.0) == pytest.approx(-2.0 * 1e-3 * 1e-4 * 1e-3 * 50.0)
    assert artificial(0.1, 0.2, 10.0, 0.1, 0.01, 0.5, 0.01, 2000.0) == 0.0  # parting
    mu = 0.1 * -0.5 / (0.01 + 0.01 * 0.01)
    expected = (-0.1 * 10.0 * mu + 0.2 * mu * mu) / 1000.0  # eq. 36 with the h that the print leaves out
    assert artificial(0.1, 0.2, 10.0, 0.1, 0.01, -0.5, 0.01, 2000.0) == pytest.approx(expected)
    assert artificial.py_func(0.1, 0.2, 10.0, 0.1, 0.01, -0.5, 0.01, 2000.0) == pytest.approx(expected)
    assert expected > 0.0


def leapfrog_growth(phase, extrapolated):
    """Largest amplification of sound per step at ω Δt = ``phase`` in the scheme of `continuum_sph.water.step`.

    Unknowns v½, ρ, D, D_before: ρ* = ρ + Δt(2D - D_before) (or ρ + Δt D), D' = ω v½, ρ' = ρ + Δt D', v' = v½ - ω Δt ρ*.
    """
    v, rho, last, before = np.eye(4)
    predicted = rho + 2.0 * last - before if extrapolated else rho + last
    rate = phase * v
    matrix = np.array([v - phase * predicted, rho + rate, rate, last])
    # v here is v½ at the step's middle: its kick uses ρ* at the step's end
    return float(np.abs(np.linalg.eigvals(matrix)).max())


@pytest.mark.parametrize("phase", [0.01, 0.1, 0.3, 0.5, 0.65])
def test_sound_is_stable_with_extrapolated_density_and_grows_without(phase):
    assert leapfrog_growth(phase, extrapolated=True) <= 1.0 + 4 * eps
    assert leapfrog_growth(phase, extrapolated=False) > 1.0
    if phase in (0.1, 0.3):  # the leading term that `step` states; the next is of relative order phase²
        assert 1.0 - leapfrog_growth(phase, extrapolated=True) == pytest.approx(0.5 * phase**4, rel=8 * phase**2)


def test_exact_solutions_meet_their_walls_and_starts():
    y = np.linspace(0.0, 1.0, 41)
    assert np.abs(poiseuille(y, 0.0, 1.0, 8.0, 1.0)).max() < 1e-5  # series cut at n = 200: 1/(200)³ of 1
    assert poiseuille(y, 10.0, 1.0, 8.0, 1.0)[20] == pytest.approx(1.0)
    np.testing.assert_allclose(couette(y, 10.0, 1.0, 2.0, 1.0), 2.0 * y, atol=1e-12)
    p = released_pressure(np.array([0.0, 1.0, 0.3]), np.array([0.5, 0.5, 2.0]), 1.0, 2.0, 1000.0, 9.81)
    assert 0.0 < p[0] < 1000.0 * 9.81 * 1.5  # less than at rest
    # face: terms beyond n = 400 sum to 2H/(π² 400) = 1/1000 of H; top: exactly 0 but for cos(π/2) rounding
    assert abs(p[1]) < 1000.0 * 9.81 * 2.0 / 1000.0
    assert abs(p[2]) < 1e-8


def test_a_drop_of_stiff_liquid_has_lambs_period_and_a_soft_one_is_slower():
    lamb = 2.0 * np.pi * np.sqrt(1.1 * 0.2**3 / 6.0)
    assert drop_period(0.2, 1.0, 1.0, 0.1, 1e5) == pytest.approx(lamb, rel=1e-8)
    x2 = (2.0 * np.pi / lamb * 0.2 / 10.0) ** 2
    # J₂/x J₂' = 1/2 (1 + x²/12 + …): the drop's part of the mass grows by that, the period by half
    expected = 1.0 + x2 / 24.0 / 1.1
    assert drop_period(0.2, 1.0, 1.0, 0.1, 10.0) / lamb == pytest.approx(expected, abs=x2**2 / 48.0)
