"""The force on a disc that oscillates in a ring, and the linear theory that it is compared with."""

import numpy as np
from scipy.special import kv

from porescale.validation.coupling.oscillating import (
    DENSITY,
    RADIUS,
    RATIO,
    VISCOSITY,
    force_in_a_ring,
    measured_force,
    pulsation,
    scene,
)
from tests.validation.tolerances import tolerance


def stokes(radius: float, omega: float) -> complex:
    """Stokes 1851: without a ring."""
    k = np.sqrt(1j * omega / VISCOSITY) * radius
    return complex(-1j * omega * DENSITY * np.pi * radius**2 * (1 + 4 * kv(1, k) / (k * kv(0, k))))


def test_theory_is_that_of_stokes_where_the_ring_is_far():
    # What a ring of N radii adds falls as its confinement, 1/N²: 2e-3 at 30 and more with the layer's own width.
    far, free = force_in_a_ring(RADIUS, 50 * RADIUS, 5.0, VISCOSITY, DENSITY), stokes(RADIUS, 5.0)
    assert abs(far / free - 1) < 5 / 50**2
    # The twin that must fail: a ring of two radii is felt.
    assert abs(force_in_a_ring(RADIUS, 2 * RADIUS, 5.0, VISCOSITY, DENSITY) / free - 1) > 1


def test_theory_without_viscosity_is_the_added_mass_in_a_ring():
    # m' = rho pi a² (b² + a²)/(b² - a²) (Lamb 1932, 43); viscosity adds the layer's width over the radius, 2 %, several
    # times over.
    omega = 1e4
    force = force_in_a_ring(RADIUS, 2 * RADIUS, omega, VISCOSITY, DENSITY)
    added = -1j * omega * DENSITY * np.pi * RADIUS**2 * 5 / 3
    layer = np.sqrt(2 * VISCOSITY / omega) / RADIUS
    assert abs(force / added - 1) < 5 * layer
    assert abs(force / (added * 3 / 5) - 1) > 5 * layer  # the twin: that of a cylinder in open water


def test_a_disc_oscillates_as_in_linear_theory():
    measured, allowed = measured_force(scene()), tolerance("coupling.disc_oscillates_in_a_ring")
    exact = force_in_a_ring(RADIUS, RATIO * RADIUS, pulsation(), VISCOSITY, DENSITY)
    assert abs(measured / exact - 1) < allowed
    # The twins that must fail: a tenth more viscosity, and a ring that is a twentieth wider.
    thick = force_in_a_ring(RADIUS, RATIO * RADIUS, pulsation(), 1.1 * VISCOSITY, DENSITY)
    wide = force_in_a_ring(RADIUS, 1.05 * RATIO * RADIUS, pulsation(), VISCOSITY, DENSITY)
    assert abs(measured / thick - 1) > allowed
    assert abs(measured / wide - 1) > allowed
