"""Diffusion of density leaves a hydrostatic column alone and is taken down within steps that allow it."""

import numpy as np
import pytest

from continuum_sph.benchmarks.endurance import still
from continuum_sph.builders.parts.water import water_flow
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.water.setups import column_scene
from continuum_sph.water import parameters as laws
from continuum_sph.water.density import HYDROSTATIC, PLAIN, diffusion_share, noise_scale
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import CUBIC, WENDLAND, Smoothing, kernel_slope
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.neighbors import PairList, square_lattice

SPACING, RATIO, DEPTH, GRAVITY = 0.05, 1.3, 1.0, 9.81
H = RATIO * SPACING
WATER = Tait(1000.0, 44.3)


def column_rates(noise):
    """Rates of density of rows of a column at rest, from the floor, without walls, by the pass over pairs at the pace
    of sound, kg/(m³ s): (20,), the same all along a row."""
    x = square_lattice((0.0, 0.0), (ACROSS * SPACING, DEPTH), SPACING)
    rho = WATER.settled_density(DEPTH - x[:, 1], GRAVITY)
    law = Law(
        Smoothing("wendland", H), SPACING, (Fluid(WATER),), (0.0, -GRAVITY), diffusion=0.1, noise=noise, cut=False
    )
    layer = Layer(len(x), x, np.zeros_like(x), rho * SPACING**2, rho)
    box = (0.0, -DEPTH), (ACROSS * SPACING, 2.0 * DEPTH)
    flow = Flow(layer, law, PairList(len(x), 0.2 * H, *box, (True, False), full=True))
    flow.start()
    row = np.rint(x[:, 1] / SPACING - 0.5).astype(int)
    found = np.array([layer.rate[row == each] for each in range(20)])
    np.testing.assert_allclose(found, found[:, :1] * np.ones(ACROSS), atol=ROUND)
    return found[:, 0]


ACROSS = 10  # particles, more than a kernel is wide
ROUND = 100 * 1000.0 * np.finfo(float).eps * 0.2 * WATER.sound_speed / H * 3.5
"""Of a rate: a hundred roundings of ρ in a pair's difference times what multiplies it, see below."""


def test_hydrostatic_column_takes_no_diffusion_inside_nor_at_its_surface():
    # Trapezoid over a pair: |Δy|³/12 |ρ'''|, ρ = ρ0 (1 + b d)^(1/6), b = 6 g/c0²: ρ''' < 55/216 ρ0 b³.  A pair's
    # share of the sum: strength Σ V |∇W|/r < strength 3.5/h², Δy < 2h.
    b = 6.0 * GRAVITY / WATER.sound_speed**2
    allowed = 0.2 * WATER.sound_speed / H * 3.5 * (2 * H) ** 3 / 12 * 55 / 216 * WATER.density * b**3
    found = column_rates(HYDROSTATIC)
    assert np.abs(found).max() < allowed
    # Half a pair's difference, g ρ0 Δy/c0² of the next row alone, is 1e5 times what is allowed.
    assert allowed < 1e-4 * np.abs(column_rates(PLAIN)[[0, -1]]).min()
    assert abs(found.sum()) < 20 * ROUND


def test_plain_diffusion_drains_the_floor_into_the_surface():  # the twin that must fail
    found = column_rates(PLAIN)
    # The next row alone, H = 1.3 of a row below: strength times its difference of density times V Σ |∇W|/r.
    beside = np.hypot(np.arange(-2, 3), 1.0) / RATIO
    passed = 0.2 * H * WATER.sound_speed * WATER.density * GRAVITY * SPACING / WATER.sound_speed**2
    passed *= SPACING**2 * sum(-kernel_slope(WENDLAND, q, H) for q in beside if q < 2.0)
    assert found[-1] > passed
    assert found[0] < -0.9 * passed  # Tait: water at the floor is stiffer
    assert np.abs(found[5:15]).max() < 0.01 * 2.0 * passed  # inside, above and below make up for each other
    assert abs(found.sum()) < 20 * ROUND


def growth(share):
    """Largest amplification per step of a wave of which diffusion takes this share: `parameters.CALMED`."""
    return float(np.abs(np.roots([1.0, 3.0 * share - 1.0, -3.0 * share, share])).max())


def alternating(kind, ratio):
    """h² Σ V |∇W|/r (1 - cos k·x) of the fastest wave on a lattice, h = ``ratio`` spacings."""
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(-6, 7), np.arange(-6, 7)))
    q = np.hypot(i, j) / ratio
    slopes = np.array([-kernel_slope.py_func(kind, each, ratio) if 0.0 < each < 2.0 else 0.0 for each in q])
    waves = np.linspace(0.0, np.pi, 9)
    return max(float((slopes * (1.0 - np.cos(a * i + b * j))).sum()) for a in waves for b in waves) * ratio**2


@pytest.mark.parametrize("kind", [CUBIC, WENDLAND])
@pytest.mark.parametrize("ratio", [1.0, 1.3, 2.0, 3.0])
@pytest.mark.parametrize("delta", [0.1, 0.2])
def test_shortest_waves_of_density_die_within_the_allowed_step(kind, ratio, delta):
    smoothing = Smoothing("cubic" if kind == CUBIC else "wendland", ratio * SPACING)
    law = Law(smoothing, SPACING, (Fluid(WATER),), (0.0, -GRAVITY), diffusion=delta, courant=0.5)
    pace = WATER.sound_speed / smoothing.length
    step = law.limits(0.0, pace)[0]
    assert growth(2.0 * delta * pace * alternating(kind, ratio) * step) <= 1.0 + 1e-12


def test_shortest_waves_of_density_grow_at_the_step_of_sound_alone():  # the twin that must fail
    assert growth(2.0 * 0.2 * alternating(WENDLAND, RATIO) * 0.25) > 1.05
    assert growth(2.0 / 7.0) == pytest.approx(1.0)


def test_little_diffusion_leaves_the_step_to_sound():
    law = Law(Smoothing("wendland", H), SPACING, (Fluid(WATER),), (0.0, -GRAVITY), diffusion=0.1)
    assert law.limits(0.0, 100.0)[0] == 0.25 / 100.0


def fastest_at_rest():
    """Largest speed over that of sound in 3000 steps of water at rest with the strongest diffusion of density, or the
    first beyond Mach 0.1."""
    flow, largest = water_flow(column_scene(SPACING, tank=(0.5, 1.2), column=(0.5, DEPTH), density_diffusion=0.2)), 0.0
    for _ in range(3000):
        flow.advance()
        largest = max(largest, flow.max_speed / flow.law.state.sound_speed)
        if not largest < 0.1:
            break
    return largest


def test_water_rests_under_the_strongest_diffusion():
    # A settling row falls by less than a fiftieth of the depth H: √(2 g H/50) = c0 √(1/50)/10 = 0.014 c0.
    assert fastest_at_rest() < 0.014


def test_water_flies_off_at_the_step_of_sound_alone(monkeypatch):  # the twin that must fail
    monkeypatch.setattr(laws, "CALMED", np.inf)
    assert not fastest_at_rest() < 0.1


def share(approach, noise_speed):
    """Pace of a pair over that of sound."""
    return float(diffusion_share.py_func(approach, *noise_scale.py_func(noise_speed, H)))


def test_densities_diffuse_at_the_pace_at_which_pairs_close():
    # From noise that counts on, at a distance of h, as published; a tenth as fast a tenth as quickly; nothing at rest.
    assert share(0.0, 1e-3) == 0.0
    assert share(1e-3 * H, 1e-3) == share(-1e-3 * H, 1e-3) == share(1.0, 1e-3) == 1.0
    assert share(1e-4 * H, 1e-3) == share(-1e-4 * H, 1e-3) == pytest.approx(0.1)


def test_without_a_floor_of_noise_all_diffuses_as_published():  # the twin that must fail
    assert share(0.0, 0.0) == share(1e-9, 0.0) == 1.0


def test_noise_counts_from_a_share_of_the_weight_of_the_water():
    # Sound of a pressure p' moves at p'/(ρ c0), c0 = 10 √(2 g H) if not said: 1e-3 g H/c0.
    scene = column_scene(SPACING, tank=(0.5, 1.2), column=(0.5, DEPTH))
    assert water_flow(scene).law.noise_speed == pytest.approx(1e-3 * GRAVITY * DEPTH / (200.0 * GRAVITY * DEPTH) ** 0.5)
    assert (
        water_flow(column_scene(SPACING, tank=(0.5, 1.2), column=(0.5, DEPTH), noise_floor=0.0)).law.noise_speed == 0.0
    )


def at_rest(**numerics):
    """Largest rate of density of a column that stands still, densities off by up to a hundredth, kg/(m³ s)."""
    flow = water_flow(column_scene(SPACING, tank=(0.5, 1.2), column=(0.5, DEPTH), **numerics))
    flow.layer.predicted[:] *= 1.0 + 0.01 * np.random.default_rng(1).random(flow.layer.fluid)
    flow.evaluate(0.0, 0.0)
    return float(np.abs(flow.layer.rate).max())


@pytest.mark.parametrize("diffusion_of", ["hydrostatic", "linear", "plain"])
def test_water_that_does_not_move_keeps_its_densities(diffusion_of):
    assert at_rest(diffusion_of=diffusion_of) == 0.0


@pytest.mark.parametrize("diffusion_of", ["hydrostatic", "linear", "plain"])
def test_at_the_pace_of_sound_it_does_not(diffusion_of):  # the twin that must fail
    # A hundredth of the shortest wave's rate, 2 δ c0/h 3.5, of a hundredth of 1000 kg/m³.
    assert at_rest(diffusion_of=diffusion_of, noise_floor=0.0) > 0.01 * 0.7 * WATER.sound_speed / H * 10.0


def creep(**numerics):
    """Height that still water gains or loses from step 100 000, when the lattice has settled, to 150 000, m."""
    water = Simulation(still(**numerics))
    water.advance(100_000)
    settled = water.series()["mean height (m)"]
    water.advance(50_000)
    return abs(water.series()["mean height (m)"] - settled)


STAYS = 1e-3 * DEPTH * 50_000 / 1e6
"""A thousandth of the depth in a million steps."""


@pytest.mark.slow
def test_still_water_does_not_creep():
    assert creep() < STAYS  # 0.016 mm of 0.05


@pytest.mark.slow
def test_still_water_gives_way_with_a_shorter_smoothing_length():  # the twin that must fail: 0.093 mm
    assert creep(smoothing_ratio=1.35) > STAYS


@pytest.mark.slow
def test_still_water_creeps_at_the_pace_of_sound():  # the twin that must fail: 0.11 mm
    assert creep(noise_floor=0.0) > STAYS
