"""Damping that is bounded bears a small share of the strength, and stress then diffuses where soil yields alone."""

import math

import numpy as np
import pytest

from continuum_sph.builders.parts.soil import soil_law
from continuum_sph.soil import Material
from continuum_sph.soil.momentum import DAMPED_BY, HELD_BACK
from continuum_sph.soil.state import SHEAR_RATE, VOLUME
from continuum_sph.soil.stress import CROWD, XX, XY, YY
from continuum_sph.validation.soil.setups import RATIO, body
from continuum_sph.validation.tanks import level_ground, tank_scene
from continuum_sph.water.smoothing import kernel_slope
from porescale.common.neighbors import square_lattice


def braking(speed, bounded=True, yielding=1.0):
    """(accelerations that damping makes, most that its bound allows), m/s², of strewn soil at random speeds, m/s.

    yielding : rate of plastic shear strain, 1/s.
    """
    spacing = 0.1
    x = square_lattice((-0.5, -0.5), (0.5, 0.5), spacing)
    x += np.random.default_rng(2).uniform(-0.2, 0.2, x.shape) * spacing
    random = np.random.default_rng(1).uniform(-speed, speed, x.shape)
    found = []
    for damping in (0.2, 0.0):
        material = Material(1e6, 1600.0, yields=False)
        flow = body(x, spacing, material, (3000.0, 1000.0, 500.0, 800.0), damping=damping, bounded=bounded)
        flow.soil.v[:] = random
        flow.soil.acceleration[:] = 0.0
        flow.begin(0.0)
        flow.strain(0.0)
        flow.soil.record[:, SHEAR_RATE] = yielding
        flow.push()
        found.append(flow.soil.acceleration.copy())
    soil, h = flow.soil, flow.law.smoothing.length
    apart = np.hypot(*np.moveaxis(soil.x[:, None] - soil.x[None], -1, 0))
    np.fill_diagonal(apart, 10.0)
    push = np.vectorize(lambda r: -kernel_slope("wendland", r, h))(apart)
    volume = soil.record[:, VOLUME]
    largest = np.hypot(0.5 * (soil.stress[:, XX] - soil.stress[:, YY]), soil.stress[:, XY])
    most = DAMPED_BY * volume / soil.mass * (push * (largest[:, None] + largest) @ volume)
    return np.hypot(*(found[0] - found[1]).T), most


@pytest.mark.parametrize("speed", [1e-3, 1.0, 1e3])
def test_damping_stays_within_its_share_of_the_shear_stress_at_any_speed(speed):
    taken, most = braking(speed)
    assert (taken <= most * (1.0 + 1e-9)).all()  # round-off of stress that it is the difference from
    assert taken.max() > 0.0


def test_beyond_the_bound_it_knows_no_speed_and_below_it_is_linear():
    slow, slower = braking(2e-6)[0], braking(1e-6)[0]
    fast, faster = braking(1e4)[0], braking(2e4)[0]
    assert slow.max() == pytest.approx(2.0 * slower.max(), rel=1e-5)
    assert faster.max() == pytest.approx(fast.max(), rel=1e-2)  # pairs that hardly approach are not bound


def test_without_it_damping_knows_no_bound():  # the twin that must fail
    taken, most = braking(1e3, bounded=False)
    assert taken.max() > 10.0 * most.max()


def test_where_nothing_yields_damping_knows_no_bound():
    free = braking(10.0, bounded=False, yielding=0.0)[0]
    assert (braking(10.0, yielding=0.0)[0] == free).all()


def test_damping_bears_of_a_slip_what_the_row_says():
    """Sums over the pairs of a lattice, turned: all push against a slip, over what as much pressure would."""
    against = across = 0.0
    for turned in np.linspace(0.0, 0.5 * np.pi, 90, endpoint=False):
        for i in range(-4, 5):
            for j in range(-4, 5):
                r, direction = math.hypot(i, j), math.atan2(j, i) + turned
                share = r * r * float(kernel_slope(1, r / RATIO, RATIO))
                against += share * abs(math.sin(direction) * math.cos(direction))
                across += share * math.cos(direction) ** 2
    assert pytest.approx(DAMPED_BY * against / across, rel=1e-3) == HELD_BACK  # 90 directions: 1e-4


def diffused(bounded):
    """Rates (60, 5) of diffusion of stress and volume in a block of uneven density that shears within its strength."""
    strong = Material(1e7, 1600.0, sin_friction=0.9)
    flow = body(square_lattice((-0.5, -0.3), (0.5, 0.3), 0.1), 0.1, strong, (3e3, 1e4, 2e3, 4e3), bounded=bounded)
    flow.soil.density *= 1.0 + 0.2 * np.sin(9.0 * flow.soil.x[:, 0])
    flow.soil.v[:, 0] = 2.0 * flow.soil.x[:, 1]
    flow.start()
    flow.strain(1e-9)
    flow.push()
    return flow.soil.spread[:, : CROWD - 1]


def test_nothing_diffuses_in_soil_that_shears_within_its_strength():
    assert not diffused(True).any()
    assert diffused(False).any()  # the twin


def test_a_scene_that_says_bounded_has_it():
    ground = {"body": [level_ground(0.4, 0.3)], "numerics": {"damping_of": "bounded"}}
    law = soil_law(tank_scene(1.0, 0.5, 0.02, lid=False, soil=ground))
    assert (law.bounded, law.printed_damping, law.damping) == (True, False, 0.2)
