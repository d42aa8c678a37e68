"""Density of water among grains: diffusion leaves its weight alone; shifting takes that of the place, and books it."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.validation.seepage.sheet_pile import held_ground
from continuum_sph.water.state import BY_SHIFTING

eps = np.finfo(float).eps
GRAVITY = 9.81


@pytest.fixture(scope="module")
def soaked():
    """(flow, rates of density with and without shifting, power) of disordered water at rest in ground that is held, its
    fastest particle said to move at 1 m/s, at the start of a step."""
    both = held_ground((1.0, 1.0), 0.1, [], 1e-2)
    flow, layer, n = both.water, both.water.layer, both.water.layer.fluid
    layer.x[:n] += np.random.default_rng(3).uniform(-0.02, 0.02, (n, 2))
    flow.law = replace(flow.law, shifting=1.0, gravity=(0.0, -GRAVITY))
    layer.density[:] = flow.law.state.settled_density(1.0 - layer.x[:n, 1], GRAVITY)
    layer.keep_budget()
    both.start()
    layer.predicted[:] = layer.density
    flow.max_speed = 1.0
    for _ in range(2):  # the pass over pairs takes the drift of the evaluation before
        flow.evaluate(0.0, 0.0)
    shifted, power, drift = layer.rate.copy(), layer.power.copy(), layer.drift.copy()
    layer.drift[:] = 0.0
    flow.evaluate(0.0, 0.0)
    np.testing.assert_array_equal(layer.drift, drift)
    return flow, shifted, layer.rate.copy(), power


def test_density_changes_by_what_drift_meets(soaked):
    flow, shifted, still, _ = soaked
    met = (flow.layer.drift * flow.density_gradient).sum(axis=1)
    assert flow.porosity.max() < 0.7
    # sums of some 30 terms, of ρ each, as quick as diffusion at the pace of sound
    allowed = 100 * 30 * eps * max(np.abs(still).max(), np.abs(shifted).max())
    assert np.abs(shifted - still - met).max() < allowed
    assert np.abs((shifted - still) / flow.porosity - met).max() > 1e3 * allowed  # the twin that must fail


def test_the_budget_has_the_work_of_shifting(soaked):
    flow, shifted, still, power = soaked
    layer, n = flow.layer, flow.layer.fluid
    mass, drift = layer.mass[:n], layer.drift
    # what compression gains of it and what weight does on the way
    gained = mass * layer.pressure[:n] / layer.density**2 * (shifted - still)
    lifted = mass * GRAVITY * drift[:, 1]
    allowed = 100 * 30 * eps * (mass * layer.pressure[:n] / layer.density**2 * np.abs(shifted)).max()
    assert np.abs(power[:, BY_SHIFTING] - (gained + lifted)).max() < allowed
    divided = (power[:, BY_SHIFTING] - lifted) / flow.porosity
    assert np.abs(divided - gained).max() > 1e3 * allowed  # the twin that must fail


def test_diffusion_sees_no_noise_in_the_weight_of_water_at_rest():
    """Its gradient is exact for linear fields to walls and into corners.  Tait's law of exponent 7 has the slope change
    by 6 g Δx/c² from row to row, 0.65 % here with 30 m/s: half of that, beside a zig-zag as high as a row's difference.
    Gradients of half a neighbourhood, as first rows had, are 15 times as much."""
    both = held_ground((1.0, 1.0), 0.1, [], 1e-2)
    flow, layer, n = both.water, both.water.layer, both.water.layer.fluid
    flow.law = replace(flow.law, diffusion=0.02, gravity=(0.0, -GRAVITY))

    def fastest(zigzag):
        """Largest rate of density, kg/(m³ s), at rest under heads that zig-zag by so much, m, from row to row."""
        row = np.rint(layer.x[:n, 1] / 0.1 - 0.5)
        layer.density[:] = flow.law.state.settled_density(1.0 - layer.x[:n, 1] + zigzag * (-1.0) ** row, GRAVITY)
        both.start()
        return float(np.abs(layer.rate[:n]).max())

    assert fastest(0.0) < 0.5 * 6.0 * GRAVITY * 0.1 / 30.0**2 * fastest(0.1)
