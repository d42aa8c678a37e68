"""The pass over pairs, compiled for what a scene asks for, is the sums that its equations say."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.builders.parts.water import water_flow
from continuum_sph.validation.water import channels as trials
from continuum_sph.validation.water.fluids import drop
from continuum_sph.validation.water.setups import column_scene, open_box
from continuum_sph.water import surface_tension
from continuum_sph.water.density import LINEAR, PLAIN
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from porescale.common.schema.sections import validate
from tests.reference.continuum.sph_rates import pair_sums
from tests.reference.continuum.uncompiled import WATER, uncompile

eps = np.finfo(float).eps
HALF = 1e-3  # s


def walled(walls, particles="pressure", steps=20, **numerics):
    """Water on its way down, all kinds of walls about it."""
    scene = column_scene(0.125, tank=(1.5, 1.5), column=(1.0, 1.0), pressure="released", viscosity=5.0, **numerics)
    given = scene.model_dump()
    given["tank"] |= {"walls": walls, "wall_particles": particles}
    given["output"] |= {"energy": True}
    flow = water_flow(validate(type(scene), given))
    for _ in range(steps):
        flow.advance()
    return flow


def mixed(**choices):
    """A drop of another fluid, stirred, in a box without walls; with other choices than its own."""
    flow = drop(12, 0.25)
    rng = np.random.default_rng(5)
    flow.layer.x[:] = (flow.layer.x + rng.uniform(-0.02, 0.02, flow.layer.x.shape)) % 1.0
    flow.layer.v[:] = rng.normal(size=flow.layer.v.shape)
    return begun(flow, **choices)


def boxed(**choices):
    """A box without walls, disordered, with other choices than its own."""
    return begun(open_box(12, seed=1), **choices)


def begun(flow, **choices):
    flow.law = replace(flow.law, **choices)
    flow.layer.keep_budget()
    flow.start()
    return flow


def two_fluids_between_walls():
    """A column half of which is another fluid, at walls that hold."""
    flow = walled("stick", steps=0)
    n = flow.layer.fluid
    flow.layer.material[:n] = flow.layer.x[:n, 0] > 0.5
    return stirred(flow, fluids=(*flow.law.fluids, Fluid(Tait(900.0, 40.0), 2.0)))


def stirred(flow, **choices):
    """A flow with random velocities, which it has without a step."""
    n = flow.layer.fluid
    flow.layer.v[:n] = np.random.default_rng(2).normal(size=(n, 2))
    return begun(flow, **choices)


def evolved(flow, steps=20, least=1e-4):
    """A flow some steps on: its smoothing lengths differ, and are already those of the next step."""
    for _ in range(steps):
        flow.advance()
    layer = flow.layer
    lengths = layer.length[: layer.fluid]
    assert np.ptp(lengths) > least * lengths.max()
    assert np.abs(lengths - layer.lengths[: layer.fluid, 0]).max() > 1e-9 * lengths.max()
    return flow


def channel():
    """Water on its way down between walls that hold, periodic along them."""
    flow = trials.channel(1.0, 10, 1e-2, 20.0, force=1.0, lid_speed=0.5)
    rng, fluid = np.random.default_rng(4), flow.layer.fluid
    flow.layer.x[:fluid] += rng.uniform(-0.02, 0.02, (fluid, 2))
    flow.layer.x[:fluid, 0] += 0.03  # some of the last column are beyond the period
    flow.layer.v[:fluid] = rng.normal(size=(fluid, 2))
    return begun(flow, diffusion=0.1)


FLOWS = {
    "slip": lambda: walled("slip"),
    "stick": lambda: walled("floor and lid stick"),
    "all": lambda: begun(
        walled("floor and lid stick", gradient="corrected", diffusion_of="linear", shifting=2.0), gravity=(1.0, -9.81)
    ),
    "corrected": lambda: walled("stick", gradient="corrected"),
    "shifted": lambda: walled("slip", shifting=2.0),
    "plain noise": lambda: walled("slip", diffusion_of="plain"),
    "xsph": lambda: stirred(walled("slip", steps=0, xsph=0.4)),
    "images": lambda: walled("slip", "images"),
    "images that hold": lambda: walled("stick", "images", gradient="corrected"),
    "images, xsph": lambda: walled("slip", "images", xsph=0.4),
    "walls, lengths of their own": lambda: evolved(walled("stick", steps=0, smoothing_length="evolved")),
    "channel": channel,
    "box": boxed,
    "gravity sideways, beta, noise floor": lambda: boxed(gravity=(3.0, -9.81), beta=2.0, noise_speed=0.1),
    "cohesion": lambda: boxed(fluids=(Fluid(Tait(1000.0, 40.0), 1.0, 1e-2),)),
    "varied": lambda: boxed(varied=True, xsph=0.3),
    "two fluids": lambda: mixed(corrected=False, shifting=0.0),
    "two fluids, corrected": lambda: mixed(noise=LINEAR, gravity=(0.0, -2.0)),
    "two fluids, all": lambda: mixed(varied=True, xsph=0.2, beta=1.0, noise=PLAIN),
    "two fluids without friction": lambda: mixed(
        fluids=(Fluid(Tait(0.1, 30.0), 0.0, 1e-7), Fluid(Tait(1.0, 10.0))), corrected=False
    ),
    "two fluids between walls": two_fluids_between_walls,
}


def found(flow, *, with_budget=True):
    """(acceleration, rate, smoothed, power) by the step's own call of the pass, from records as they are."""
    layer = flow.layer
    if with_budget:
        layer.keep_budget()
    for name in ("acceleration", "rate", "smoothed"):
        getattr(layer, name)[:] = 0.0
    flow.sum_pairs(HALF)
    power = layer.power.copy() if with_budget else np.zeros((layer.fluid, 6))
    return layer.acceleration.copy(), layer.rate.copy(), layer.smoothed.copy(), power


def difference(quick, slow):
    """Largest difference of each, in units of what round-off may be: 30 terms of some ten operations each, none more
    than a hundred times the largest sum."""
    allowed = [100 * 30 * 10 * eps * np.abs(b).max() for b in slow]
    return [
        np.abs(a - b).max() / most if most else np.abs(a).max() for a, b, most in zip(quick, slow, allowed, strict=True)
    ]


PLAIN_FIRST = ("shifted", "corrected", "images, xsph", "gravity sideways, beta, noise floor", "varied", "two fluids")
"""Flows of which every choice is compiled in some other of them: in plain Python, which compiles nothing, from the
start; compiled among the slow tests."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in PLAIN_FIRST else []) for name in FLOWS]
)
def test_sums_are_those_of_the_equations(name):
    flow = FLOWS[name]()
    assert max(difference(found(flow), pair_sums(flow, HALF))) <= 1.0


@pytest.mark.parametrize("name", PLAIN_FIRST)
def test_sums_in_plain_python_are_those_of_the_equations(name, monkeypatch):
    uncompile(monkeypatch, *WATER, surface_tension)
    flow = FLOWS[name]()
    assert max(difference(found(flow), pair_sums(flow, HALF))) <= 1.0


@pytest.mark.parametrize("name", ["stick", "all", "images that hold", "two fluids, all"])
def test_compiled_sums_run_in_plain_python_too(name, monkeypatch):
    flow = FLOWS[name]()
    uncompile(monkeypatch, *WATER)
    assert max(difference(found(flow), pair_sums(flow, HALF))) <= 1.0


@pytest.mark.parametrize(
    "name", ["slip", "channel", "two fluids, corrected", pytest.param("all", marks=pytest.mark.slow)]
)
def test_a_budget_changes_no_bit_of_the_flow(name):
    # Of those of every day other tests compile the pass without a budget: walls of either kind, and all gradients.
    flow = FLOWS[name]()
    flow.layer.has_budget = False
    flow.count()  # the pass of flows that keep none has no masses either
    without = found(flow, with_budget=False)
    for a, b in zip(found(flow)[:3], without[:3], strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize(
    ("name", "other"),
    [("slip", {"alpha": 1.01}), ("xsph", {"xsph": 1.01}), ("stick", {"diffusion": 1.01}), ("box", {"alpha": 1.01})],
)
def test_a_hundredth_more_is_noticed(name, other):  # the twin that must fail
    flow = FLOWS[name]()
    quick = found(flow)
    ((key, more),) = other.items()
    flow.law = replace(flow.law, **{key: more * getattr(flow.law, key)})
    assert max(difference(quick, pair_sums(flow, HALF))) > 1e3
