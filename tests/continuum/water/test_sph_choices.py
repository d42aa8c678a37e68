"""Each choice of method does what it is for, and only that."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.builders.parts.water import water_flow
from continuum_sph.validation.water import setups as trials
from continuum_sph.water.density import LINEAR
from continuum_sph.water.energy_budget import budget
from continuum_sph.water.eos.adiabatic import AdiabaticGas
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.eos.printed import PrintedGas, printed_gas
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.image_walls import STEEPEST, facing, image_velocity
from continuum_sph.water.kernel_correction import FULL, NONE, inverse
from continuum_sph.water.smoothing import WENDLAND, kernel_slope
from continuum_sph.water.step import Flow
from continuum_sph.water.viscosity import artificial, central, laminar, mutual
from porescale.common.schema.sections import validate

eps = np.finfo(float).eps


CORRECTED = {"corrected": True, "noise": LINEAR}
"""Corrected gradients, and what takes one of density: one choice, so that one pass is compiled for all that have it."""


def column(walls="slip", particles="pressure", end=1.0, **numerics):
    """A column of 5 by 10 particles that fills its tank's width, at rest."""
    scene = trials.column_scene(0.1, tank=(0.5, 1.2), column=(0.5, 1.0), **numerics)
    given = scene.model_dump()
    given["tank"] |= {"walls": walls, "wall_particles": particles}
    return water_flow(validate(type(scene), given))


def stirred(**choices):
    """A box without walls, disordered, with other choices than its own."""
    flow = trials.open_box(12, seed=3)
    flow.layer.keep_budget()
    flow.law = replace(flow.law, **choices)
    flow.start()
    return flow


@pytest.mark.parametrize("gas", [AdiabaticGas(1.2, 1e5), PrintedGas(1.2, 1e5), Tait(1000.0, 50.0)])
def test_state_laws_invert_and_their_energy_is_the_work_of_their_pressure(gas):
    rho = gas.density * np.array([0.8, 1.0, 1.2])
    np.testing.assert_allclose(gas.density_at(gas.pressure(rho)), rho, rtol=1e-12)
    step = 1e-5 * gas.density
    slope = (gas.energy(rho + step) - gas.energy(rho - step)) / (2.0 * step)
    # central difference over 1e-5: (1e-5)²/6 times a third derivative below 100 of the scale, round-off 1e-16/1e-5
    np.testing.assert_allclose(slope, gas.pressure(rho) / rho**2, rtol=1e-8, atol=1e-8 * gas.stiffness / gas.density**2)
    sound2 = (gas.pressure(gas.density + step) - gas.pressure(gas.density - step)) / (2.0 * step)
    assert sound2 == pytest.approx(gas.sound_speed**2, rel=1e-8)


def test_the_printed_gas_has_no_pressure_beyond_its_pole():
    assert printed_gas(1.0 + 1.0 / 1.4, 1e5, 1.4)[0] == np.inf
    assert np.isfinite(printed_gas(1.7, 1e5, 1.4)[0])
    assert PrintedGas(1.0, 1e5, 1.4).pressure(np.array([1.8]))[0] == np.inf
    assert np.isfinite(AdiabaticGas(1.0, 1e5, 1.4).pressure(np.array([1.8]))[0])


def test_viscosity_between_two_fluids_is_the_harmonic_mean():
    def shared(a, b):
        return mutual(a, b, 1.0, 1.0, 1.0) / central(laminar(1.0, 1.0, 1.0, 1.0), 1.0, 1.0)

    assert shared(2.0, 2.0) == 2.0
    assert shared(1e-3, 1e3) == pytest.approx(2e-3, rel=1e-5)
    assert shared(0.0, 5.0) == shared(0.0, 0.0) == 0.0
    assert artificial(0.1, 0.0, 10.0, 0.1, 0.1, -0.5, 0.01, 2000.0) > 0.0


def test_corrected_gradients_of_linear_fields_are_exact_in_disorder():
    flow = stirred(**CORRECTED)
    layer = flow.layer
    # density linear in the box, but where its sides meet
    x = layer.x
    layer.predicted[:] = 1000.0 + 30.0 * x[:, 0] - 20.0 * x[:, 1]
    flow.evaluate(0.0, 0.0)
    inner = (np.abs(x - 0.5) < 0.2).all(axis=1)
    assert inner.sum() > 15
    np.testing.assert_allclose(
        flow.density_gradient[: len(x)][inner], np.tile([30.0, -20.0], (inner.sum(), 1)), atol=1e-9
    )
    assert np.abs(layer.matrix[inner, :3] - [1.0, 0.0, 1.0]).max() > 0.05  # plain sums would have been this far off


def test_correction_fades_where_neighbours_lie_on_one_side():
    assert inverse(1.0, 0.0, 1.0, NONE, FULL) == (1.0, 0.0, 1.0, 0.0)
    assert inverse(0.9, 0.0, 0.2, NONE, FULL) == (1.0, 0.0, 1.0, 1.0)
    xx, xy, yy, rest = inverse(0.95, 0.05, 0.9, NONE, FULL)
    assert rest == 0.0
    assert np.array([[xx, xy], [xy, yy]]) @ [[0.95, 0.05], [0.05, 0.9]] == pytest.approx(np.eye(2), abs=4 * eps)


@pytest.mark.parametrize("choices", [{}, CORRECTED])
def test_momentum_is_kept_with_and_without_corrected_gradients(choices):
    flow = stirred(**choices)
    before, scale = trials.momentum(flow), float((flow.layer.mass[:, None] * np.abs(flow.layer.v)).sum())
    for _ in range(20):
        flow.advance()
    # 144 particles, 20 steps of 30 roundings each, like a random walk, six times
    assert np.abs(trials.momentum(flow) - before).max() < 6.0 * (20 * 30 * 144) ** 0.5 * eps / 144 * scale


@pytest.mark.parametrize("choices", [{}, CORRECTED, {"noise": 2}, {"noise": 0}])
def test_the_budget_of_energies_closes(choices):
    flow = stirred(**choices)
    before = budget(flow)
    for _ in range(100):
        flow.advance()
    after = budget(flow)
    lost = before["total energy"] - after["total energy"]
    assert lost > 0.0
    # Power is that of one instant of a step of 0.25 h/c: of what changes over h/c it misses (Δt c/h)²/2 = 3 %
    assert abs(after["energy balance"] - before["energy balance"]) < 0.03 * lost


def test_a_budget_without_heat_does_not_close():  # the twin that must fail
    flow = stirred()
    before = budget(flow)["total energy"]
    for _ in range(100):
        flow.advance()
    assert before - budget(flow)["total energy"] > 0.1 * before


def test_shifting_evens_out_a_clump_and_leaves_a_lattice_and_a_surface_alone():
    flow = stirred(shifting=1.0)
    flow.layer.v[:] = 0.0
    flow.max_speed = 1.0

    def spread():
        flow.evaluate(0.0, 0.0)
        return float(np.hypot(*flow.concentration_gradient.T).mean())

    before = spread()
    for _ in range(30):
        flow.layer.x += 0.01 * flow.layer.drift
        now = spread()
    assert now < 0.3 * before
    still = column(shifting=1.0)
    still.max_speed = 1.0
    still.evaluate(0.0, 0.0)
    top = still.layer.x[: still.layer.fluid, 1] > 0.7  # rows that see the surface; in its corners normals lean
    assert np.abs(still.layer.drift[top, 1]).max() < 0.01
    assert np.abs(still.layer.drift[~top]).max() < 0.02  # walls and compression: a lattice otherwise


def test_density_filter_keeps_uniform_density_and_smooths_noise():
    flow = stirred(filter_every=1)
    layer = flow.layer
    layer.density[:] = 1003.0
    flow.filter()
    np.testing.assert_allclose(layer.density, 1003.0, rtol=30 * eps)
    noise = np.random.default_rng(1).normal(0.0, 1.0, len(layer.density))
    layer.density += noise
    flow.filter()
    assert np.std(layer.density) < 0.6 * np.std(noise)


def test_smoothing_length_follows_density_as_eq_52():
    flow = stirred(varied=True)
    flow.law = replace(flow.law, alpha=0.0)
    start = flow.layer.density.copy()
    for _ in range(40):
        flow.advance()
    layer = flow.layer
    # d ln h = -d ln ρ/2 stepped by Euler: (Δ ln ρ)²/4 a step at most
    change = np.abs(np.log(layer.density / start)).max()
    np.testing.assert_allclose(layer.length, flow.law.smoothing.length * (start / layer.density) ** 0.5, rtol=change**2)
    assert np.ptp(layer.length) > 0.0


def test_images_stick_or_slip_as_eqs_50_and_51_say():
    face = facing(np.array([[0.3, -0.05], [-0.05, -0.05]]), (0.0, 0.0), (1.0, 1.0))
    np.testing.assert_allclose(face[0], [0.3, 0.0, 0.0, 1.0])
    np.testing.assert_allclose(face[1, 2:], [0.5**0.5, 0.5**0.5])  # a corner faces both ways
    near = image_velocity(0.3, 0.1, 2.0, -1.0, 0.3, -0.05, face[0], True)
    assert near == pytest.approx((3.0, -1.5))  # β = 1 + 0.05/0.1
    assert image_velocity(0.3, 0.01, 2.0, -1.0, 0.3, -0.05, face[0], True) == pytest.approx(
        (2.0 * STEEPEST, -1.0 * STEEPEST)
    )
    assert image_velocity(0.3, 0.1, 2.0, -1.0, 0.3, -0.05, face[0], False) == pytest.approx((2.0, -1.5))


@pytest.mark.parametrize("walls", ["slip", "stick"])
@pytest.mark.parametrize("particles", ["pressure", "images"])
def test_either_kind_of_wall_holds_water_at_rest(walls, particles):
    flow = trials.run_until(column(walls, particles, artificial_viscosity=0.1), 0.5)
    assert flow.stopped == 0
    assert np.hypot(*flow.layer.v.T).max() < 0.01 * flow.law.quickest
    assert flow.layer.x[: flow.layer.fluid, 1].max() == pytest.approx(0.95, abs=0.02)


@pytest.mark.parametrize("particles", ["pressure", "images"])
def test_water_slides_along_slip_and_is_held_by_stick(particles):
    speeds = []
    for walls in ("slip", "stick"):
        flow = column(walls, particles, artificial_viscosity=0.0)
        flow.law = replace(flow.law, fluids=(replace(flow.law.fluids[0], viscosity=100.0),), gravity=(0.0, 0.0))
        flow.layer.density[:] = 1000.0
        flow.layer.v[: flow.layer.fluid, 1] = 0.01
        flow.start()
        for _ in range(20):
            flow.advance()
        low = flow.layer.x[: flow.layer.fluid, 1] < 0.7
        side = (flow.layer.x[: flow.layer.fluid, 0] < 0.1) & low & (flow.layer.x[: flow.layer.fluid, 1] > 0.3)
        speeds.append(float(flow.layer.v[: flow.layer.fluid, 1][side].mean()))
    assert speeds[1] < 0.8 * speeds[0]


def test_cohesion_of_eq_54_pulls_particles_together():
    a, state = 1e-6, Tait(1000.0, 20.0)
    flow = stirred(fluids=(Fluid(state, 0.0, cohesion=a),), alpha=0.0)  # nothing moves: beta adds nothing
    layer = flow.layer
    layer.v[:] = 0.0
    layer.predicted[:] = 1000.0
    flow.evaluate(0.0, 0.0)
    h, mass = flow.law.smoothing.length, layer.mass[0]
    away = layer.x[:, None] - layer.x[None]
    away -= np.rint(away)
    slope = np.array([kernel_slope(WENDLAND, q, h) for q in np.hypot(away[..., 0], away[..., 1]).ravel() / h])
    # eq. 54 beside pressures that vanish at ρ0: dv_i = 2 (a/m²) Σ m_j ∇_i W, times the number of plain sums
    expected = flow.law.lattice * 2.0 * a / mass * (slope.reshape(away.shape[:2])[..., None] * away).sum(axis=1)
    np.testing.assert_allclose(layer.acceleration, expected, atol=1e-12 * np.abs(expected).max())


@pytest.fixture
def only_chosen(monkeypatch):
    """Flows have chosen what kernels take, and have called none: nothing is compiled."""
    monkeypatch.setattr(Flow, "start", Flow.choose)


def test_kernels_are_handed_nothing_that_a_scene_does_not_need(only_chosen):
    def handed(flow):
        near = flow.near(flow.kind)
        all_of = (*flow.fluids[1:], *flow.walls, *flow.gradients, flow.smoothed, *flow.budget)
        return any(it is not None for it in (*all_of, near.period_x, near.period_y))

    assert not handed(column())
    for choice in ({"walls": "stick"}, {"particles": "images"}, {"xsph": 0.1}, {"shifting": 1.0}):
        assert handed(column(**choice))


def test_filters_and_shifts_are_built_only_where_chosen(only_chosen):
    flow = column()
    assert not flow.surveyed
    assert column(gradient="corrected").surveyed
    assert column(shifting=1.0).surveyed
    assert column(diffusion_of="linear").surveyed
