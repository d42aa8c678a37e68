"""Waves of small height: as fast as gravity and the shear modulus of an unstirred lattice have it, exact without."""

import math

import numpy as np
import pytest
from scipy.optimize import curve_fit

from continuum_sph import build, check
from continuum_sph.validation.tanks import tank_scene
from continuum_sph.water.kernel_correction import lattice_shear
from continuum_sph.water.smoothing import RATIO, WENDLAND
from porescale.common.core.constants import GRAVITY

WIDE, DEEP, SPACING, HEIGHT, PUSH = 1.0, 0.5, 0.05, 0.01, 0.02  # m, of the push s
K = math.pi / WIDE  # 1/m, of the slowest swing
EXACT = math.sqrt(GRAVITY * K * math.tanh(K * DEEP))  # 1/s


def tank(**numerics):
    """Water at rest in a tank, its surface free."""
    water = {"viscosity": 0.0, "column": [{"width": WIDE, "height": DEEP}]}
    return tank_scene(WIDE, 0.8, SPACING, 2.4, water=water, numerics={"spacing": SPACING} | numerics)


def frequency(scene):
    """That of the slowest swing, 1/s, which a push sets going: of the mean place across, by a sine that fades."""
    sim = build(scene)
    mass, speed = float(sim.masses[0]), HEIGHT * GRAVITY / EXACT

    def push(time, positions, velocities, out):
        if time < PUSH:
            x, y = K * positions.T
            part = mass * speed * K / (math.cosh(K * DEEP) * PUSH)
            out[:, 0], out[:, 1] = -part * np.sin(x) * np.cosh(y), part * np.cos(x) * np.sinh(y)

    sim.force(push)
    times, places = [], []
    for until in np.arange(PUSH, 2.4, 0.02):
        sim.run(until=until)
        times.append(sim.time)
        places.append(sim.positions[:, 0].mean() - 0.5 * WIDE)

    def swing(time, height, rate, phase, middle, fades):
        return height * np.exp(-fades * time) * np.sin(rate * time + phase) + middle

    found, _ = curve_fit(swing, np.array(times), np.array(places), p0=[min(places), EXACT, 0.0, 0.0, 0.05])
    return found[1]


def test_a_gentle_wave_is_exact_with_corrected_gradients_and_as_stiff_as_its_lattice_without():
    """Exact: linear waves.  The profile of ten rows is known to (k spacing)²/24 = 0.1 %, and a sine that fades to a
    twentieth of its height leaves 0.5 % of its period open.  Without: energies of shear and of weight, as
    docs/theory/water.md has them; linear theory of a modulus that grows with depth, its displacements those of water:
    an upper bound of the lattice's share, by a tenth of it."""
    shear = lattice_shear(WENDLAND, RATIO * SPACING, SPACING)
    deep = 0.5 * (DEEP**2 / 2.0 + (math.cosh(2.0 * K * DEEP) - 1.0) / (4.0 * K * K))
    share = 4.0 * shear * K * K * deep / math.sinh(K * DEEP) ** 2
    assert frequency(tank(gradient="corrected")) == pytest.approx(EXACT, rel=0.006)
    plain = frequency(tank())
    assert plain == pytest.approx(EXACT * math.sqrt(1.0 + share), rel=0.1 * 0.5 * share + 0.006)
    assert plain > 1.05 * EXACT  # the check that fails: water without a lattice's shear


def test_check_says_how_much_too_fast_gentle_waves_are():
    name = "gentle waves are too fast by, where shallow"

    def said(scene):
        return {row.name: row.value for rows in check(scene).groups.values() for row in rows}

    assert said(tank())[name] == pytest.approx(100.0 * (math.sqrt(1.0 + 2.0 * 0.1034) - 1.0), rel=1e-3)
    assert name not in said(tank(gradient="corrected"))


@pytest.mark.parametrize(("ratio", "shear"), [(1.375, 0.1034), (1.5, 0.0234), (1.6, -0.0241), (2.0, 0.0095)])
def test_the_shear_of_a_lattice_is_that_of_its_sums_at_any_spacing(ratio, shear):
    for spacing in (1e-3, 0.7):  # four digits of the numbers above
        assert lattice_shear(WENDLAND, ratio * spacing, spacing) == pytest.approx(shear, abs=6e-5)
