"""Bands of soil that softens: what two rows share, how wide a band is, what damping bears across it."""

import math

import numpy as np
import pytest

from continuum_sph.soil import Material, Softening
from continuum_sph.soil import flow as flow_module
from continuum_sph.soil.momentum import SOFTENING
from continuum_sph.soil.softening import MOST, average, averages_of, band_width
from continuum_sph.soil.state import VOLUME
from continuum_sph.validation.soil.setups import DENSITY, RATIO, body
from continuum_sph.validation.soil.softening import BRAKE, PACE
from continuum_sph.water.smoothing import SUPPORT, Smoothing, kernel_slope
from porescale.common.compiled.jit import set_threads
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import square_lattice

SPACING = 0.1
H = RATIO * SPACING
CLAY = Material(1e6, 1600.0, sin_friction=0.0, cohesion_intercept=1e3, softening=Softening(0.0, 200.0, 0.1))
EPS = float(np.finfo(np.float64).eps)


def clay(material=CLAY, **law):
    """A block whose particles are strewn, of uneven density and so of uneven volume."""
    x = square_lattice((-0.5, -0.5), (0.5, 0.5), SPACING)
    x += np.random.default_rng(3).uniform(-0.2, 0.2, x.shape) * SPACING
    flow = body(x, SPACING, material, (1e3, 1e3, 0.0, 1e3), **law)
    flow.soil.density *= 1.0 + 0.1 * np.sin(9.0 * flow.soil.x[:, 0])
    flow.begin(0.0)
    return flow


def mean_by_all_pairs(flow, values):
    """The mean of `average` by the loops of its definition."""
    soil = flow.soil
    found = np.zeros(soil.soil)
    for i in range(soil.soil):
        weights = np.zeros(soil.soil)
        for j in range(soil.soil):
            r = math.dist(soil.x[i], soil.x[j])
            if r < SUPPORT * H and soil.material[i] == soil.material[j]:
                weights[j] = soil.record[j, VOLUME] * (1.0 - (r / (SUPPORT * H)) ** 2)
        found[i] = (weights * values).sum() / weights.sum()
    return found


def averaged(flow, sheared):
    soil, mean = flow.soil, np.full(flow.soil.soil, np.nan)
    average(soil.soil, soil.record, soil.material, sheared, mean, flow.near)
    return mean


@pytest.mark.parametrize("materials", [1, 2])
def test_strain_grows_by_the_mean_of_neighbours_of_the_same_material(materials):
    flow = clay()
    flow.soil.material[:] = np.arange(flow.soil.count) % materials
    sheared = np.random.default_rng(4).uniform(0.0, 1.0, flow.soil.soil)
    # sums of at most 30 positive terms of at most 1
    np.testing.assert_allclose(averaged(flow, sheared), mean_by_all_pairs(flow, sheared), rtol=60 * EPS)


def test_even_strain_stays_and_no_mean_leaves_its_values():
    flow = clay()
    np.testing.assert_allclose(averaged(flow, np.full(flow.soil.soil, 0.3)), 0.3, rtol=60 * EPS)
    sheared = np.zeros(flow.soil.soil)
    sheared[44] = 1.0  # of one particle: some for each neighbour, nowhere more than it has
    found = averaged(flow, sheared)
    assert found.min() >= 0.0
    assert found.max() < 0.3
    assert (found > 0.0).sum() > 12


@pytest.mark.parametrize("averages", [1, 2, 3])
def test_a_step_adds_what_it_sheared_averaged_so_often(averages, monkeypatch):
    taken = []

    def noted(soil, record, material, sheared, mean, near):
        taken.append(sheared.copy())
        average(soil, record, material, sheared, mean, near)

    def stepped():
        flow = clay(averages=averages)
        flow.soil.v[:, 0] = np.sign(flow.soil.x[:, 1])
        flow.start()
        for _ in range(40):
            flow.advance()
        before = flow.soil.plastic_shear.copy()
        taken.clear()
        flow.advance()
        return flow, flow.soil.plastic_shear - before

    monkeypatch.setattr(flow_module, "average", noted)
    flow, grown = stepped()
    assert len(taken) == averages
    wanted = taken[0]
    assert wanted.max() > 1e-4
    for _ in range(averages):
        wanted = mean_by_all_pairs(flow, wanted)
    # the sum before has lost as many digits as it is larger
    np.testing.assert_allclose(grown, wanted, rtol=60 * averages * EPS, atol=4 * EPS)
    set_threads(2)
    again, same = stepped()
    np.testing.assert_array_equal(same, grown)
    np.testing.assert_array_equal(again.soil.stress, flow.soil.stress)


def test_soil_that_does_not_soften_has_none_of_it(monkeypatch):
    monkeypatch.setattr(flow_module, "average", None)
    flow = clay(Material(1e6, 1600.0, sin_friction=0.0, cohesion_intercept=1e3))
    flow.soil.v[:, 0] = np.sign(flow.soil.x[:, 1])
    flow.start()
    for _ in range(20):
        flow.advance()
    assert flow.sheared.size == 0
    assert flow.soil.plastic_shear.max() > 1e-4
    with pytest.raises(TypeError):  # the twin
        clay().strain(1e-4)


def row_weights(ratio):
    """Weights of rows of a square lattice in the mean, from a particle's own on."""
    reach = range(-4, 5)
    return [sum(max(0.0, 1.0 - (i * i + j * j) / (SUPPORT * ratio) ** 2) for i in reach) for j in range(5)]


@pytest.mark.parametrize("ratio", [1.2, RATIO, 1.7])
def test_a_slip_that_two_rows_share_softens_by_the_width_of_a_band(ratio):
    own, following, *others = row_weights(ratio)
    whole = own + 2.0 * (following + sum(others))
    strain = 0.5 * (own + following) / whole  # half of the slip over a spacing in each row
    assert band_width(Smoothing("wendland", ratio * SPACING), SPACING) == pytest.approx(SPACING / strain, rel=30 * EPS)
    twice = np.convolve(
        [*others[::-1], following, own, following, *others], [*others[::-1], following, own, following, *others]
    )
    strain = 0.5 * (twice[8] + twice[9]) / whole**2
    width = band_width(Smoothing("wendland", ratio * SPACING), SPACING, 2)
    assert width == pytest.approx(SPACING / strain, rel=60 * EPS)
    strain = 0.5 * (own + following) / whole
    # one row that took all of the slip would soften by a sixth more, where without the mean it were by twice as much
    assert 1.0 < own / whole / strain < 1.17


def test_a_band_of_particles_is_as_wide_as_averages_can_make_it():
    smoothing = Smoothing("wendland", H)
    widths = [band_width(smoothing, SPACING, n) for n in range(1, MOST + 1)]
    assert widths == sorted(widths)
    # averages of weights with the variance s² spread as a Gaussian's do: √(2π n) s
    once = np.array(row_weights(RATIO))
    variance = 2.0 * (once * np.arange(5) ** 2).sum() / (once[0] + 2.0 * once[1:].sum())
    assert widths[-1] == pytest.approx(SPACING * math.sqrt(2.0 * math.pi * MOST * variance), rel=1.0 / MOST)
    assert averages_of(smoothing, SPACING, 0.1 * widths[0]) == averages_of(smoothing, SPACING, 1.01 * widths[0]) == 1
    assert averages_of(smoothing, SPACING, 1.01 * widths[4]) == 5
    assert averages_of(smoothing, SPACING, 100.0 * widths[-1]) == MOST


def step_gradient(row, ratio):
    """Gradient, over the slip a spacing, that particles of a row see of a slip between rows -1 and 0."""
    crossed = whole = 0.0
    for i in range(-4, 5):
        for j in range(-4, 5):
            if i or j:
                slope = float(kernel_slope(1, math.hypot(i, j) / ratio, ratio))
                crossed += slope * abs(j) * ((row + j < 0) != (row < 0))
                whole += slope * j * j
    return crossed / whole


def test_particles_see_a_slip_as_a_gradient_of_two_rows_and_some_of_the_next():
    found = [step_gradient(row, RATIO) for row in (-2, -1, 0, 1)]
    assert found == pytest.approx([0.05, 0.45, 0.45, 0.05], abs=0.005)  # digits that the theory says
    assert sum(found) == pytest.approx(1.0, abs=40 * EPS)  # none beyond: the kernel ends at 2.75 spacings


def test_damping_bears_of_a_slip_what_the_row_says():
    """Shear stress between two rows that slip past each other by 1 m/s, with the gradients that particles see of it."""
    gradient = {row: step_gradient(row, RATIO) for row in range(-4, 4)}
    stress = 0.0
    for i in range(-4, 5):
        for above in range(4):
            for below in range(-4, 0):
                apart, r = above - below, math.hypot(i, above - below)
                left = 1.0 - 0.5 * (gradient[above] + gradient[below]) * apart
                stress -= left * i * i * float(kernel_slope(1, r / RATIO, RATIO)) / (r * r + SOFTENING * RATIO**2)
    assert pytest.approx(stress * DENSITY * math.sqrt(GRAVITY) * PACE, rel=0.01) == BRAKE  # a factor of two digits
