"""Measures of grains against slow, obvious twins, and where the answer is known."""

import math
from typing import Any

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.measures import coarse_graining as graining
from porescale.dem.measures.coarse_graining import CoarseGrained, Raster
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.fabric import coordination, fabric, rattlers
from porescale.dem.measures.loads import on_discs, on_surface
from porescale.dem.measures.motion import motion
from porescale.dem.measures.porosity import disc_areas, porosity, void_ratio
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import kinetic_stress, principal
from tests.dem.measures.test_dem_contacts import dense_discs

RNG = np.random.default_rng(0)


@pytest.mark.parametrize("periodic", [False, True])
def test_parts_of_discs_in_a_rectangle_are_those_counted_by_points(periodic):
    region, n = Region((0.2, 0.1), (1.1, 0.9)), 600
    period = (1.7, 1.9) if periodic else (0.0, 0.0)
    at, radius = RNG.uniform(-0.5, 1.5, (25, 2)), RNG.uniform(0.05, 0.8, 25)
    found = disc_areas(region, at, radius, period)
    x = region.lower[0] + region.size[0] * (np.arange(n) + 0.5) / n
    y = region.lower[1] + region.size[1] * (np.arange(n) + 0.5) / n
    images = [(a * period[0], b * period[1]) for a in range(-2, 3) for b in range(-2, 3)] if periodic else [(0.0, 0.0)]
    for k in range(len(at)):
        inside = sum(
            (np.hypot(x[None] - at[k, 0] - a, y[:, None] - at[k, 1] - b) < radius[k]).mean() for a, b in images
        )
        # A rim of length 2 pi r crosses 2 pi r/h cells, wrong by up to half each way, at random: sqrt of their number.
        rim = math.sqrt(2 * math.pi * radius[k] * n) / n**2 * region.area
        assert found[k] == pytest.approx(inside * region.area, abs=4 * rim)


def test_a_region_far_away_in_periods_holds_the_same():
    at, radius, period = RNG.uniform(0, 1, (9, 2)), np.full(9, 0.1), (1.0, 1.0)
    here, there = Region((0.1, 0.1), (0.7, 0.9)), Region((7.1, -3.9), (7.7, -3.1))
    np.testing.assert_allclose(disc_areas(here, at, radius, period), disc_areas(there, at, radius, period), atol=1e-15)
    assert porosity(here, at + 5.0, radius, period) == pytest.approx(porosity(here, at, radius, period), abs=1e-14)


def test_void_ratio_and_regions_that_are_none():
    assert void_ratio(0.2) == pytest.approx(0.25)
    assert math.isinf(void_ratio(1.0))
    with pytest.raises(InputError, match=r"region.upper.*right of and above"):
        Region((0.0, 1.0), (1.0, 1.0))


@pytest.mark.parametrize(("start", "branch", "share"), [
    ((0.5, 0.5), (0.2, 0.1), 1.0), ((0.5, 0.5), (1.0, 0.0), 0.5), ((-1.0, 0.5), (4.0, 0.0), 0.25),
    ((0.5, -0.5), (0.0, 2.0), 0.5), ((-0.5, -0.5), (1.0, 1.0), 0.5), ((2.0, 2.0), (1.0, 0.0), 0.0),
])  # fmt: skip
def test_shares_of_branches(start, branch, share):
    found = Region((0.0, 0.0), (1.0, 1.0)).share_of_branch(np.array([start]), np.array([branch]))
    assert found[0] == pytest.approx(share, abs=1e-15)


def test_shares_of_neighbouring_regions_add_up():
    start, branch = RNG.uniform(0, 1, (40, 2)), RNG.normal(0, 0.3, (40, 2))
    parts = [Region((0.25 * i, 0.5 * j), (0.25 * (i + 1), 0.5 * (j + 1))) for i in range(4) for j in range(2)]
    total = sum(part.share_of_branch(start, branch, (1.0, 1.0)) for part in parts)
    np.testing.assert_allclose(total, 1.0, atol=1e-13)  # eight clippings, branches of a hundredth of the box and more


def test_rattlers_fall_out_one_after_another():
    found = contacts(dense_discs())
    count = int(max(found.first.max(), found.second.max())) + 1
    loose = rattlers(found, count, 2)
    touching: dict[int, set[tuple[int, int]]] = {k: set() for k in range(count)}
    for i, j, wall, force in zip(found.first, found.second, found.surface, found.normal_force, strict=True):
        if force > 0:
            touching[int(i)].add((int(j), int(wall)))
            if j >= 0:
                touching[int(j)].add((int(i), -1))
    alive = set(range(count))
    while out := {k for k in alive if sum(j < 0 or j in alive for j, _ in touching[k]) < 2}:
        alive -= out
    assert set(np.flatnonzero(~loose)) == alive
    assert not rattlers(found, count, 2, np.ones(count, bool)).any()
    whole = Region((-1.0, -1.0), (1.0, 1.0))
    mean = np.mean([sum(j < 0 or j in alive for j, _ in touching[k]) for k in alive])
    assert coordination(found, whole, np.zeros((count, 2)), (0.0, 0.0), loose) == pytest.approx(float(mean))


def test_the_anisotropy_of_dense_discs_is_that_of_their_directions():
    found = contacts(dense_discs())
    whole = Region((-1.0, -1.0), (1.0, 1.0))
    made = fabric(found, whole)
    assert np.trace(made.tensor) == pytest.approx(1.0, rel=1e-14)
    loaded = found.chosen(found.normal_force > 0)
    # The second harmonic of the density of directions is half the anisotropy, to the round-off of a mean of hundreds.
    second = np.mean((loaded.normal[:, 0] + 1j * loaded.normal[:, 1]) ** 2)
    assert abs(second) == pytest.approx(0.5 * made.anisotropy, rel=1e-12)
    assert fabric(found, Region((5.0, 5.0), (6.0, 6.0))).contacts == 0


def test_forces_and_moments_on_surfaces_and_discs():
    grains = dense_discs()
    found = contacts(grains)
    x, y, moment = on_surface(found, "bottom")
    assert y < 0
    assert on_surface(found, "bottom", (0.05, 0.0))[2] == pytest.approx(moment - 0.05 * y, rel=1e-12)
    force, torque = found.resultants(grains.discs.count)
    np.testing.assert_array_equal(on_discs(found, grains.discs, [3, 5])[:, :2], force[[3, 5]])
    assert on_discs(found, grains.discs, [3])[0, 2] == torque[3]
    assert x == pytest.approx(found.of("bottom").force[:, 0].sum())


def test_the_motion_of_a_shear_and_of_too_few():
    at = RNG.uniform(0, 1, (6, 2))
    gradient = np.array([[0.3, -1.2], [0.5, -0.3]])
    found = motion(at, at @ gradient.T + [1.0, 2.0], RNG.uniform(0.5, 1, 6))
    np.testing.assert_allclose(found.gradient, gradient, atol=1e-13)
    assert found.rotation == pytest.approx(0.85, abs=1e-13)
    assert np.isnan(motion(at[:2], at[:2], np.ones(2)).gradient).all()
    assert np.isnan(motion(at[:0], at[:0], np.ones(0)).velocity).all()


def test_pressure_of_a_gas_of_discs():
    grains = dense_discs()
    found = kinetic_stress(Region((-1.0, -1.0), (2.0, 2.0)), grains.discs)
    d = grains.discs
    off = d.velocity - np.average(d.velocity, axis=0, weights=d.mass)
    np.testing.assert_allclose(found, (d.mass[:, None] * off).T @ off / 9.0, rtol=1e-12)
    assert principal(np.array([[3.0, 0.0], [0.0, 1.0]]))[:2] == (2.0, 1.0)


@pytest.mark.parametrize(("periodic", "conserve"), [(False, False), (False, True), (True, True)])
def test_fields_are_those_of_a_slow_twin(periodic, conserve, monkeypatch):
    grains = dense_discs()
    found, d = contacts(grains), grains.discs
    raster = Raster.over((0.0, 0.0), (0.1, 0.1), 0.0125, 0.02, (periodic, periodic))
    fields = CoarseGrained(raster, d, found, conserve=conserve)
    x, y = raster.centres

    def weights(at: Any) -> Any:
        total = np.zeros((len(y), len(x)))
        for a in (-0.1, 0.0, 0.1) if periodic else (0.0,):
            for b in (-0.1, 0.0, 0.1) if periodic else (0.0,):
                q = np.minimum(np.hypot(x[None] - at[0] - a, y[:, None] - at[1] - b) / 0.02, 1.0)
                total += 5 / (math.pi * 0.02**2) * (1 + 3 * q) * (1 - q) ** 3
        return total / (total.sum() * raster.cell) if conserve and total.any() else total

    density = sum(m * weights(at) for m, at in zip(d.mass, d.position, strict=True))
    np.testing.assert_allclose(fields.density, density, rtol=1e-11, atol=1e-9)
    momentum = sum(m * weights(at)[..., None] * v for m, at, v in zip(d.mass, d.position, d.velocity, strict=True))
    np.testing.assert_allclose(fields.velocity * density[..., None], momentum, rtol=1e-9, atol=1e-7)
    along, part = np.polynomial.legendre.leggauss(8)
    stress: Any = 0.0
    for k in range(found.count):
        for s, share in zip(0.5 * (1 + along), 0.5 * part, strict=True):
            at = d.position[found.first[k]] + s * found.branch[k]
            stress = stress + share * weights(at)[..., None, None] * np.outer(found.force[k], found.branch[k])
    np.testing.assert_allclose(fields.contact_stress, stress, rtol=1e-9, atol=1e-9 * np.abs(stress).max())
    if conserve and not periodic:  # the kernels as plain Python: numba does not check bounds
        compiled: list[Any] = [graining.spread, graining.spread_motion]
        monkeypatch.setattr(graining, "spread", compiled[0].py_func)
        monkeypatch.setattr(graining, "spread_motion", compiled[1].py_func)
        plain = CoarseGrained(raster, d, found, conserve=conserve)
        np.testing.assert_allclose(plain.density, fields.density, rtol=1e-13)
        np.testing.assert_allclose(plain.solid_fraction, fields.solid_fraction, rtol=1e-13)


def test_a_raster_finer_than_its_kernel_only():
    with pytest.raises(InputError, match=r"width.*fall between"):
        Raster.over((0.0, 0.0), (1.0, 1.0), 0.1, 0.05)
