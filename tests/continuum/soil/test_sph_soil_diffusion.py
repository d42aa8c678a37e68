"""Diffusion of stress and of volume in sheared soil: what it evens out, keeps and leaves alone, at any shear."""

import numpy as np
import pytest

from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.soil import flow as flow_module
from continuum_sph.soil.state import GXX, SHEAR_RATE, VOLUME
from continuum_sph.soil.stress import CROWD, GROWN, YY, Straining, deform
from continuum_sph.validation.soil.setups import RATIO, body
from continuum_sph.water.smoothing import Smoothing, kernel_slope
from porescale.common.core.errors import InputError
from porescale.common.neighbors import PairList, square_lattice

SPACING = 0.1
ELASTIC = Material(1e7, 1600.0, yields=False)
EPS = np.finfo(float).eps


def block():
    return body(square_lattice((-0.5, -0.3), (0.5, 0.3), SPACING), SPACING, ELASTIC, (3e3, 1e4, 2e3, 4e3))


def uneven():
    """A block of uneven densities, sheared, as it is pushed; and its volumes before, m²."""
    flow = block()
    soil = flow.soil
    soil.density *= 1.0 + 0.2 * np.sin(9.0 * soil.x[:, 0] + 5.0 * soil.x[:, 1])
    soil.v[:, 0] = 2.0 * soil.x[:, 1]
    flow.start()
    return flow, soil.record[: soil.soil, VOLUME].copy()


def test_volumes_diffuse_where_soil_is_sheared_and_their_sum_stays():
    flow, volume = uneven()
    soil, law = flow.soil, flow.law
    grown = soil.spread[:, GROWN]
    wanted = np.zeros(60)
    for i in range(60):
        for j in range(60):
            if i != j:
                r = float(np.hypot(*(soil.x[i] - soil.x[j])))
                rate = 0.5 * (soil.record[i, SHEAR_RATE] + soil.record[j, SHEAR_RATE])
                slope = kernel_slope(law.smoothing.kind, r / law.smoothing.length, law.smoothing.length)
                pace = law.diffusion * law.smoothing.length**2 * rate * law.spacing**2
                wanted[i] -= pace * slope * (volume[j] - volume[i])
    rounding = 60 * np.finfo(float).eps * np.abs(grown).max()  # sums of at most 60 terms, each opposite in its pair
    np.testing.assert_allclose(grown, wanted, rtol=0, atol=10 * rounding)
    assert abs(grown.sum()) < 60 * rounding
    assert (grown * volume).sum() < -1e3 * rounding * volume.max()  # Σ V² falls: evened out, not sharpened
    soil.record[: soil.soil, 12:] = 0.0  # nothing strains: what is left of a step is diffusion
    mass = soil.mass[: soil.soil]
    deform(
        soil.density, soil.stress, soil.material, flow.table, soil.matrix, soil.spread,
        soil.separation_strain, soil.plastic_shear, np.zeros(0), soil.swelling, soil.record,
        Straining(1e-3, 1e-3, 1.0, law.most, 0.0, law.even, False, law.bearing),
    )  # fmt: skip
    np.testing.assert_allclose(mass / soil.density, volume + 1e-3 * grown, rtol=4 * np.finfo(float).eps)


def test_volumes_of_soil_at_rest_do_not_diffuse():  # the twin: uneven, not sheared
    flow = block()
    flow.soil.density *= 1.0 + 0.2 * np.sin(9.0 * flow.soil.x[:, 0])
    flow.start()
    assert not flow.soil.spread[:, GROWN].any()


def swing_of_stress(most):
    """Largest σ_zz amid a block after ten steps of 0.6 ms sheared at 20 1/s, if it zig-zags by 1 Pa at the start."""
    x = square_lattice((0.0, 0.0), (1.4, 1.4), 0.1)
    amid = np.abs(x - 0.7).max(axis=1) < 0.2
    flow = body(x, 0.1, Material(1e4, 1590.0, sin_friction=0.0), (0.0, 0.0, 0.0, 0.0))
    flow.law = type("Law", (type(flow.law),), {"most": most})(**vars(flow.law)) if most else flow.law
    soil, n = flow.soil, flow.soil.soil
    soil.stress[:n, 3] = np.where((np.round(x / 0.1 - 0.5).sum(axis=1) % 2) > 0, 1.0, -1.0)
    for _ in range(10):
        soil.v[:n] = np.column_stack((20.0 * x[:, 1], np.zeros(n)))
        soil.x[:n], soil.acceleration[:] = x, 0.0
        flow.advance(6e-4)
    return float(np.abs(soil.stress[:n, 3][amid]).max())


def test_stress_diffusion_calms_stress_however_fast_soil_is_sheared():
    assert swing_of_stress(None) < 1.0


def test_diffusion_that_follows_any_shear_swings_ever_wider():  # the twin that must fail
    assert swing_of_stress(float("inf")) > 10.0


def exchanged(crowd, known=True, seed=3):
    """Volumes (60,) of random size before and after the exchange of one step, as much longer than the last as one may
    be, sheared far beyond what it may follow.

    crowd : particles where a lattice has one;  known : the bound goes by it.
    """
    flow = body(square_lattice((-0.5, -0.3), (0.5, 0.3), SPACING) / crowd**0.5, SPACING, ELASTIC, (0.0, 0.0, 0.0, 0.0))
    soil, step = flow.soil, 1e-3
    soil.density *= np.random.default_rng(seed).uniform(0.5, 1.5, soil.soil)
    soil.v[:, 0] = 1e4 * soil.x[:, 1]
    flow.begin(0.0)
    flow.push()
    soil.spread[:, CROWD] *= known
    flow.strain(step)
    flow.push()
    assert soil.record[:, SHEAR_RATE].max() <= flow.law.most / step * (1.0 + 4.0 * EPS)
    before = soil.record[: soil.soil, VOLUME].copy()
    return before, before + flow_module.LASTING * step * soil.spread[:, GROWN]


@pytest.mark.parametrize("crowd", [1, 2, 4, 8])
def test_volumes_stay_between_those_around_however_fast_soil_is_sheared(crowd):
    before, after = exchanged(crowd)
    assert before.min() < after.min() < after.max() < before.max()
    assert after.sum() == pytest.approx(before.sum(), rel=60 * EPS)


def test_volumes_of_crowded_soil_swing_where_the_bound_does_not_know_it():  # the twin that must fail
    before, after = exchanged(8, known=False)
    assert after.min() < 0.5 * before.min()


def first_volume(short):
    """Least volume (m²) after a step as long as may be, of uneven soil sheared at near its speed of sound.

    short : of the step before, over that; 0: the start.
    """
    flow = body(square_lattice((-0.5, -0.3), (0.5, 0.3), SPACING), SPACING, ELASTIC, (1e4, 1e4, 0.0, 6e3))
    soil = flow.soil
    soil.density *= 1.0 + 0.2 * np.sin(9.0 * soil.x[:, 0] + 5.0 * soil.x[:, 1])
    soil.v[:, 0] = 300.0 * soil.x[:, 1]
    flow.start()
    if short:
        flow.advance(short * flow.next_step)
    flow.advance()
    return float((soil.mass / soil.density).min())


@pytest.mark.parametrize("short", [0.0, 1e-3])
def test_a_step_longer_than_the_last_exchanges_no_more_than_there_is(short, monkeypatch):
    assert first_volume(short) > 0.5 * SPACING**2
    monkeypatch.setattr(flow_module, "LASTING", np.inf)  # the twin that must fail
    assert first_volume(short) < 0.0


def two_kinds():
    """A block whose left half is heavy, stiff and dilates, and whose right half does neither."""
    x = square_lattice((-0.5, -0.3), (0.5, 0.3), SPACING)
    materials = (Material(1e7, 2400.0, sin_dilatancy=0.3), Material(1e6, 1200.0))
    number = (x[:, 0] > 0.0).astype(np.int64)
    density, n = np.where(number, 1200.0, 2400.0), len(x)
    soil = Soil(n, x, np.zeros((n, 2)), density * SPACING**2, density, np.tile([1e4, 2e4, 0.0, 9e3], (n, 1)), number)
    smoothing = Smoothing("wendland", RATIO * SPACING)
    law = SoilLaw(smoothing, SPACING, materials, (0.0, 0.0), spacing_recovery=0.0)
    return SoilFlow(soil, law, PairList(n, 0.15 * smoothing.length, (-1.0, -1.0), (1.0, 1.0), full=True))


STRAINED = np.array([[3.0, 20.0], [2.0, -1.5]])
"""Gradient of the velocity seen from the end of a step, 1/s: soil that dilates as it is sheared."""


def density_after(flow, monkeypatch, steps=100, step=1e-4):
    """Densities over those at the start, (soil,), of soil strained evenly, and what det F makes of them."""

    def even(soil, record, *_):
        record[:, GXX:] = STRAINED.ravel()

    monkeypatch.setattr(flow_module, "velocity_gradients", even)  # exact in corners, too
    soil, start = flow.soil, flow.soil.density.copy()
    onward = np.linalg.inv(np.eye(2) - step * STRAINED)
    flow.start()
    for _ in range(steps):
        ahead = soil.x @ onward.T
        soil.acceleration[:], soil.v[:] = 0.0, (ahead - soil.x) / step
        flow.begin(step)
        flow.strain(step)
        flow.push()
    return soil.density / start, float(np.linalg.det(onward)) ** -steps


ROUNDED = 100 * 10 * EPS  # of ten operations in each of 100 steps; what is exchanged of them only evens them out


def test_even_strain_changes_volume_exactly_also_where_two_kinds_of_soil_meet(monkeypatch):
    flow = two_kinds()
    found, exact = density_after(flow, monkeypatch)
    assert exact < 0.99
    assert flow.soil.record[:, SHEAR_RATE].min() > 10.0  # volume would be exchanged if there were any difference
    assert np.ptp(flow.soil.spread[:, YY]) > 1e3  # as stress is
    np.testing.assert_allclose(found, exact, rtol=ROUNDED)


def test_uneven_volumes_do_not_change_so(monkeypatch):  # the twin that must fail
    flow = two_kinds()
    flow.soil.density[::7] *= 1.01
    found, exact = density_after(flow, monkeypatch)
    assert np.abs(found / exact - 1.0).max() > 1e6 * ROUNDED


def test_particles_of_another_size_than_the_spacing_says_are_refused():
    flow = two_kinds()
    flow.soil.mass[3] *= 2.0
    with pytest.raises(InputError, match=r"soil.mass\[3\].*24"):
        SoilFlow(flow.soil, flow.law, flow.pairs)


def test_diffusion_by_sound_that_takes_more_than_there_is_is_refused():
    def law(restless, courant):
        return SoilLaw(
            Smoothing("wendland", 0.13), SPACING, (ELASTIC,), (0.0, 0.0), sound_diffusion=restless, courant=courant
        )

    assert law(0.0, 0.25).most == pytest.approx(1.0 / 700.0, rel=1e-15)
    assert law(0.2, 0.25).most == pytest.approx((1.0 - 0.35) / 700.0, rel=1e-14)
    assert 0.0 < law(0.57, 0.25).most < 1e-5  # 1/(7 courant) = 0.571
    with pytest.raises(InputError, match=r"soil\.numerics\.restless_diffusion = 0.58"):
        law(0.58, 0.25)
    with pytest.raises(InputError, match=r"numerics\.courant"):
        law(0.3, 0.5)
