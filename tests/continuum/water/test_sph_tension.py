"""Tension between two fluids: its kernels against sums over all pairs, and the exact swing of a viscous drop."""

import numpy as np
import pytest

from continuum_sph.validation.water import fluids as trials_fluids
from continuum_sph.validation.water.drop_swing import drop_swing, swing_period
from continuum_sph.validation.water.fluids import OUTER, TENSION
from continuum_sph.water.state import RHO, VOLUME

RADIUS = 0.2  # m
LAMB = 2.0 * np.pi * ((1.0 + OUTER) * RADIUS**3 / (6.0 * TENSION)) ** 0.5  # s


def pairs_of(flow):
    """x_i - x_j (n, n, 2), W and (1/r) dW/dr (n, n) of Wendland's C2 kernel in the periodic box of 1 m."""
    x, h = flow.layer.x, flow.law.smoothing.length
    out = x[:, None] - x[None]
    out -= np.round(out)
    q = np.hypot(out[..., 0], out[..., 1]) / h
    rest = np.clip(1.0 - 0.5 * q, 0.0, None)
    return out, 7.0 / (4.0 * np.pi * h**2) * rest**4 * (1.0 + 2.0 * q), -35.0 / (4.0 * np.pi * h**4) * rest**3


@pytest.fixture(scope="module")
def strewn():
    """A drop of strewn particles whose tension has been evaluated, without anything else."""
    flow = trials_fluids.strewn(20, 0.25, 1.2, 5)
    flow.layer.acceleration[:] = 0.0
    flow.pull()
    return flow


def test_curvature_is_the_mean_of_the_interfaces_middle(strewn):
    _, value, _ = pairs_of(strewn)
    known = (strewn.curvature != 0.0) * strewn.layer.record[:, VOLUME] * strewn.normal[:, 2] ** 4
    below = (value * known).sum(axis=1)
    sums = np.divide((value * known) @ strewn.curvature, below, out=np.zeros_like(below), where=below > 0.0)
    expected = np.where(strewn.normal[:, 2] > 0.0, sums, 0.0)
    np.testing.assert_allclose(strewn.middle, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_a_particle_feels_its_partners_pressures_higher_by_the_jump(strewn):
    layer, (out, _, slope) = strewn.layer, pairs_of(strewn)
    matrix = 0.5 * (layer.matrix[:, None] + layer.matrix[None])
    turned = np.stack(
        (
            matrix[..., 0] * out[..., 0] + matrix[..., 1] * out[..., 1],
            matrix[..., 1] * out[..., 0] + matrix[..., 2] * out[..., 1],
        ),
        axis=-1,
    )
    # pressure falls by σ κ, κ = ∇·n with n into fluid 1, on the way into it
    jump = TENSION * strewn.middle[None] * (layer.material[None] - layer.material[:, None])
    thrust = layer.record[None, :, VOLUME] * slope * jump
    expected = -(thrust[..., None] * turned).sum(axis=1) / layer.record[:, RHO, None]
    np.testing.assert_allclose(layer.acceleration, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    assert np.abs(expected).max() > 0.1 * TENSION / RADIUS / OUTER * 20.0  # of σ/R over a spacing


def test_without_viscosity_a_kicked_drop_swings_as_lambs():
    t = np.array([0.1, 0.37, 0.9]) * LAMB
    swing = drop_swing(t, RADIUS, TENSION, (1.0, OUTER), (1e-12, 1e-13))
    # layers √(2ν/ω) = 3e-7 m thick take their share of R
    np.testing.assert_allclose(swing, np.sin(2.0 * np.pi * t / LAMB) * LAMB / (2.0 * np.pi), atol=1e-5 * LAMB)


def test_a_drop_in_next_to_nothing_is_damped_by_the_strain_of_its_own_potential_flow():
    """exp(-4νt/R²) in the plane, n = 2, to first order: Lamb, art. 355 has (n - 1)(2n + 1) in space, here 2n(n - 1)."""
    nu = 1e-4
    period = 2.0 * np.pi * (RADIUS**3 / 6.0) ** 0.5
    t = np.array([0.25, 1.25]) * period
    early, late = drop_swing(t, RADIUS, TENSION, (1.0, 1e-9), (nu, 1e-13))
    # the next order is that of the layer below a free surface, (ν/ωR²)^(1/2) of the damping
    damping = 4.0 * nu * period / RADIUS**2
    assert np.log(early / late) == pytest.approx(damping, rel=3.0 * (nu * period / (2.0 * np.pi * RADIUS**2)) ** 0.5)


def test_layers_between_two_fluids_slow_a_drop_by_the_root_of_their_viscosity():
    slow = [swing_period(RADIUS, TENSION, (1.0, OUTER), (mu, 0.1 * mu)) / LAMB - 1.0 for mu in (1e-5, 4e-5, 1.6e-4)]
    # a step of 1/200 of a period crossed by a straight line, (2π/200)²/8 of it at most, is 1e-4 of a step
    assert slow[1] / slow[0] == pytest.approx(2.0, rel=0.05)
    assert slow[2] / slow[1] == pytest.approx(2.0, rel=0.05)
