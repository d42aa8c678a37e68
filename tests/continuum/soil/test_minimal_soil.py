"""The smallest statement of a step of soil does what the kernels do."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.benchmarks.minimal_soil import Ground, soil_step
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.soil.stress import EXCESS, XX, XY, YY
from continuum_sph.water.smoothing import Smoothing
from porescale.common.neighbors import PairList, square_lattice

ACROSS, SIDE, STEPS = 10, 1.0, 4
SAND = Material(1e6, 1600.0, sin_dilatancy=0.2, cohesion_intercept=500.0)


def stirred(material: Material) -> tuple[SoilFlow, Ground]:
    """Soil under pressure in a periodic box, stirred at random, twice."""
    spacing, rng = SIDE / ACROSS, np.random.default_rng(5)
    smoothing = Smoothing("wendland", 1.3 * spacing)
    x = square_lattice((0.0, 0.0), (SIDE, SIDE), spacing)
    n = len(x)
    x += rng.uniform(-0.1, 0.1, x.shape) * spacing
    stress = np.tile([8e3, 1e4, 4.5e3, 5e3], (n, 1)) * rng.uniform(0.9, 1.1, (n, 1))
    soil = Soil(
        n, x, rng.normal(0.0, 0.03, x.shape), np.full(n, material.density * spacing**2), np.full(n, material.density),
        stress,
    )  # fmt: skip
    law = SoilLaw(smoothing, spacing, (material,), (0.0, 0.0), damping=0.0, diffusion=0.0, spacing_recovery=0.0)
    pairs = PairList(n, 0.15 * smoothing.length, (0.0, 0.0), (SIDE, SIDE), (True, True), full=True)
    flow = SoilFlow(soil, law, pairs)
    flow.start()
    plane = soil.stress[:, [XX, XY, XY, YY]].reshape(n, 2, 2)
    return flow, Ground(
        soil.x.copy(), soil.v.copy(), soil.acceleration.copy(), soil.mass, soil.density.copy(), plane,
        soil.spread[:, EXCESS].copy(),
    )  # fmt: skip


@pytest.mark.parametrize("material", [SAND, replace(SAND, yields=False)], ids=["yields", "elastic"])
def test_the_smallest_soil_does_what_the_kernels_do(material):
    flow, plain = stirred(material)
    _, other = stirred(replace(material, stiffness=material.stiffness * (1.0 + 1e-9)))  # the check that must fail
    soil, h = flow.soil, flow.law.smoothing.length
    first = plain.stress.copy()
    for _ in range(STEPS):
        step = flow.next_step
        flow.advance(step)
        soil_step(plain, material, SIDE, h, step)
        soil_step(other, replace(material, stiffness=material.stiffness * (1.0 + 1e-9)), SIDE, h, step)
    found = soil.stress[:, [XX, XY, XY, YY]].reshape(-1, 2, 2)
    assert (soil.plastic_shear.max() > 1e-5) == material.yields
    assert np.abs(found - first).max() > 1e2
    # A gradient is a sum of 25 terms v/spacing of some ten roundings, a stress that times E Δt, for each step; places
    # that err by a rounding more turn up in the next step's sums no larger.
    allowed = STEPS * 250 * 2.2e-16 * material.stiffness * step * np.abs(soil.v).max() * ACROSS
    assert np.abs(plain.stress - found).max() < allowed
    assert np.abs(other.stress - found).max() > allowed
    pushed = allowed * 25 * ACROSS / material.density
    assert np.abs(plain.acceleration - soil.acceleration).max() < pushed
    away = plain.x - soil.x
    assert np.abs(away - SIDE * np.rint(away / SIDE)).max() < STEPS**2 * step**2 * pushed + 4 * 2.2e-16
