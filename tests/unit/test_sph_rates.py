"""The fast pass over pairs and the one that knows every choice are the same sums."""

from __future__ import annotations

import numpy as np
import pytest

from continuum_sph import rates_plain
from continuum_sph.rates import rates
from continuum_sph.rates_plain import plain_rates
from continuum_sph.scene.build import flow_of
from continuum_sph.scene.trials import column_scene, open_box

eps = np.finfo(float).eps


def both(flow, fast):
    """(acceleration, rate, power) by `plain_rates`, compiled or plain, and by `rates`."""
    layer, law, pairs = flow.layer, flow.law, flow.pairs
    where = (layer.fluid, pairs.start, flow.split, pairs.partner, layer.record, layer.ghost)
    kind, h, (gx, gy), delta = law.smoothing.kind, law.smoothing.length, law.gravity, 2.0 * law.diffusion
    surveyed = (None, None) if flow.bare else (layer.matrix, flow.slant)
    found = []
    for name in ("fast", "all"):
        acceleration, rate = np.zeros((layer.fluid, 2)), np.zeros(layer.fluid)
        power, smoothed = np.zeros((layer.fluid, 6)), np.zeros((layer.fluid, 2))
        if name == "fast":
            fast(
                *where, layer.material, *surveyed, layer.drift, layer.mass, flow.table, flow.choices,
                acceleration, rate, power, kind, h, None if flow.bare else gx, gy, law.alpha,
                None if flow.bare else law.beta, law.softening, delta * h, law.calm, law.sticky, *pairs.period, 1e-3,
            )  # fmt: skip
        else:
            rates(
                *where, layer.facing, layer.material, layer.length, layer.matrix, flow.slant, layer.drift, layer.mass,
                flow.table, flow.choices, acceleration, rate, smoothed, power, kind, h, gx, gy, law.alpha, law.beta,
                law.softening, delta * h, law.calm, law.sticky, law.xsph, *pairs.period, 1e-3,
            )  # fmt: skip
        found.append((acceleration, rate, power))
    return found


def walled(walls, **numerics):
    """Water on its way down, all kinds of walls about it."""
    scene = column_scene(0.125, tank=(1.5, 1.5), column=(1.0, 1.0), pressure="released", viscosity=5.0, **numerics)
    flow = flow_of(scene.model_copy(update={"tank": scene.tank.model_copy(update={"walls": walls})}))
    for _ in range(20):
        flow.advance()
    return flow


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize(
    "flow",
    [
        walled("slip"),
        walled("floor and lid stick"),
        walled("floor and lid stick", gradient="corrected", diffusion_of="linear", shifting=2.0),
        walled("slip", diffusion_of="plain"),
        open_box(12, seed=1),
    ],
)
def test_fast_sums_are_the_slow_ones(flow, compiled, monkeypatch):
    fast = plain_rates if compiled else plain_rates.py_func
    if not compiled:  # what it calls as plain Python too: compiled functions take vectors only from kernels
        for name in ("artificial", "haste_of", "laminar", "pace", "slope_shape", "slope_scale"):
            monkeypatch.setattr(rates_plain, name, getattr(rates_plain, name).py_func)
    # Round-off: 30 terms of some ten operations each, none more than a hundred times the largest sum.
    for quick, slow in zip(*both(flow, fast), strict=True):
        np.testing.assert_allclose(quick, slow, rtol=0, atol=100 * 30 * 10 * eps * np.abs(slow).max())


def test_more_artificial_viscosity_is_told_apart():  # the twin that must fail
    flow = walled("slip")
    (quick, *_), _ = both(flow, plain_rates)
    object.__setattr__(flow.law, "alpha", 1.01 * flow.law.alpha)
    _, (slow, *_) = both(flow, plain_rates)
    assert np.abs(quick - slow).max() > 1e6 * eps * np.abs(slow).max()
