"""A periodic box of saturated soil that is stirred: momentum of both layers, and energy at any permeability.  SI."""

import functools
from collections.abc import Callable

import numpy as np

from continuum_sph.seepage import Resistance, Seepage, skeleton_of
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.validation.seepage.setups import GRAINS, SKIN, WATER, pore_flow
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import PairList, square_lattice

VALIDATIONS = Validations()


def saturated_box(across: int, seed: int, *, speed: float = 0.5, permeability: float = 1e-2) -> Seepage:
    """A periodic box of 1 m of saturated elastic soil without gravity or walls, both layers stirred at random.

    speed : of the stirring, m/s.
    """
    spacing, porosity, modulus = 1.0 / across, 0.4, 1e6
    rng = np.random.default_rng(seed)
    smoothing = Smoothing("wendland", RATIO * spacing)
    material = Material(modulus, (1.0 - porosity) * GRAINS, yields=False, porosity=porosity)
    box, skin = ((0.0, 0.0), (1.0, 1.0), (True, True)), SKIN * smoothing.length
    x = square_lattice((0.0, 0.0), (1.0, 1.0), spacing)
    n = len(x)
    soil = Soil(
        n, x + rng.uniform(-0.1, 0.1, x.shape) * spacing, rng.normal(0.0, speed, x.shape),
        np.full(n, material.density * spacing**2), np.full(n, material.density), np.zeros((n, 4)),
    )  # fmt: skip
    ground = SoilFlow(soil, SoilLaw(smoothing, spacing, (material,), (0.0, 0.0), damping=0.0, courant=0.25),
                      PairList(n, skin, *box, full=True))  # fmt: skip
    ground.start()
    skeleton = skeleton_of(ground, GRAINS, permeability)
    at = x + rng.uniform(-0.1, 0.1, x.shape) * spacing
    state = Tait(WATER, 40.0)
    rules = Law(smoothing, spacing, (Fluid(state),), (0.0, 0.0), diffusion=0.0, cut=False, courant=0.25)
    layer = Layer(n, at, rng.normal(0.0, speed, x.shape), np.full(n, porosity * WATER * spacing**2), np.full(n, WATER))
    flow = pore_flow(layer, rules, skeleton, Resistance(porosity), *box)
    whole = porosity * WATER + material.density
    both = Seepage(flow, ground, material.column_modulus, whole)
    both.start()
    return both


def momentum(both: Seepage) -> Floats:
    """Linear momentum of both layers, (2,) kg/s."""
    layer, soil = both.water.layer, both.water.skeleton
    water: Floats = (layer.mass[: layer.fluid, None] * layer.v[: layer.fluid]).sum(axis=0)
    grains: Floats = (soil.mass[:, None] * soil.v).sum(axis=0)
    return water + grains


def momentum_drift(spoil: Callable[[Seepage], None] | None = None) -> float:
    """Change of momentum of a stirred, saturated box in 20 steps, over the momentum that moves.

    spoil : called after each step.
    """
    both = saturated_box(16, 1, permeability=1e-3)
    before, layer = momentum(both), both.water.layer
    scale = float((layer.mass[: layer.fluid, None] * np.abs(layer.v[: layer.fluid])).sum())
    for _ in range(20):
        both.advance()
        if spoil is not None:
            spoil(both)
    return float(np.abs(momentum(both) - before).max()) / scale


@VALIDATIONS.row(
    "continuum.momentum_of_layers",
    source="Newton's third law: pressure and drag between soil and water",
    because="20 steps, each the sums of 25 partners of 256 particles in four passes: √(20 · 25 · 256 · 4) round-offs "
    "of 2.3e-16 of changes no larger than the momentum that moves",
    tolerance=2.3e-16 * (20 * 25 * 256 * 4) ** 0.5,
    slow=True,
)
def momentum_row() -> Measured:
    """Change of the momentum of both layers, over that which moves, in a periodic box stirred at random."""
    return Measured.absolute(0.0, momentum_drift())


def energies(both: Seepage, ground: SoilFlow) -> dict[str, float]:
    """Energies of both layers, J/m: kinetic, compressive, elastic (of a linear material), heat of drag, and their sum.

    Elastic energy per volume: p²/2B + τ²/2G, p and τ centre and radius of Mohr's circle in the plane.
    """
    layer, soil, material = both.water.layer, ground.soil, ground.law.materials[0]
    n, m = layer.fluid, ground.soil.soil
    kinetic = 0.5 * float((layer.mass[:n] * (layer.v[:n] ** 2).sum(axis=1)).sum())
    kinetic += 0.5 * float((soil.mass[:m] * (soil.v[:m] ** 2).sum(axis=1)).sum())
    compressive = float((layer.mass[:n] * both.water.law.fluids[0].state.energy(layer.density)).sum())
    xx, yy, xy, _ = soil.stress[:m].T
    p, tau2 = 0.5 * (xx + yy), 0.25 * (xx - yy) ** 2 + xy**2
    stiff = material.stiffness
    density = p**2 / (2.0 * material.area_modulus * stiff) + tau2 / (2.0 * material.shear_modulus * stiff)
    elastic = float((density * soil.mass[:m] / soil.density).sum())
    heat = float(both.water.heat.sum())
    parts = {"kinetic": kinetic, "compressive": compressive, "elastic": elastic, "heat of drag": heat}
    return parts | {"sum": sum(parts.values())}


@functools.cache
def growth_of_energy(permeability: float) -> float:
    """Largest growth of kinetic, compressive and elastic energy of a stirred, saturated box over 500 steps."""
    both = saturated_box(16, 1, permeability=permeability, speed=0.05)
    ground = both.ground
    assert isinstance(ground, SoilFlow)
    start = least = energies(both, ground)["sum"]
    growth = 0.0
    for _ in range(20):
        for _ in range(25):
            both.advance()
        parts = energies(both, ground)
        free = parts["sum"] - parts["heat of drag"]
        growth, least = max(growth, free - least), min(least, free)
    return growth / start


@VALIDATIONS.row(
    "continuum.seepage_at_any_permeability",
    source="second law: drag and pressure between layers make no energy, k from 1e-1 to 1e-9 m/s",
    because="kick-drift-kick swings by (ω Δt)²/8 of what moves about its energy, ω Δt up to 0.7 in the finest waves",
    tolerance=0.7**2 / 8,
    slow=True,
)
def any_permeability_row() -> Measured:
    """Largest growth of free energy over that at the start, for five permeabilities, the step that of sound."""
    return Measured.absolute(0.0, [growth_of_energy(k) for k in (1e-1, 1e-3, 1e-5, 1e-7, 1e-9)])
