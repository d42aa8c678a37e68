"""A layer of elastic soil under a load that water bears at first: Terzaghi's consolidation.  SI."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from continuum_sph.seepage import Resistance, Seepage
from continuum_sph.soil import Material, SoilFlow
from continuum_sph.soil.material import unconfined
from continuum_sph.validation.seepage.biot_column import excess_pressures
from continuum_sph.validation.seepage.setups import COLUMNS, GRAINS, WATER, water_in
from continuum_sph.validation.soil.setups import in_tank
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()


@dataclass(frozen=True)
class Consolidation:
    """A layer of elastic soil on a porous base, drained there and at its surface, which bears a load u0.

    rows : of particles over the height;  height m;  modulus : plane-strain M, Pa;  permeability m/s;  ratio : of the
    water's stiffness, K_w/(n M);  start : u0, Pa, excess pressure in the middle.
    """

    rows: int = 40
    height: float = 1.0
    modulus: float = 1e7
    permeability: float = 5e-3
    ratio: float = 200.0
    start: float = 1e3
    porosity: float = 0.4
    poisson: float = 0.3

    @property
    def consolidation(self) -> float:
        """c_v = k M/(ρ_f g), m²/s."""
        return self.permeability * self.modulus / (WATER * GRAVITY)

    @property
    def stiffness(self) -> float:
        """Young's modulus of the layer, Pa."""
        return unconfined(self.modulus, self.poisson)

    def seconds(self, factor: float) -> float:
        """Time (s) of a time factor T_v = c_v t/H²."""
        return factor * self.height**2 / self.consolidation

    def excess(self, z: Floats, factor: float) -> Floats:
        """Exact u/u0 at heights z (m): sin(πz/H) exp(-π² T_v)."""
        result: Floats = np.sin(np.pi * z / self.height) * np.exp(-(np.pi**2) * factor)
        return result


def loaded_column(given: Consolidation) -> SoilFlow:
    """The soil layer under the uniform stress u0 that its surface bears, without water, at rest."""
    spacing = given.height / given.rows
    material = Material(
        given.stiffness, (1.0 - given.porosity) * GRAINS, given.poisson, yields=False, porosity=given.porosity
    )
    size = (COLUMNS * spacing, given.height)
    x = square_lattice((0.0, 0.0), size, spacing)
    k0 = material.rest
    uniform = given.start * np.array([k0, 1.0, 0.0, material.poisson * (1.0 + k0)])
    flow = in_tank(x, np.tile(uniform, (len(x), 1)), size, spacing, material, gravity=0.0, sides="none")
    return flow


def consolidating(given: Consolidation) -> Seepage:
    """The layer at the moment the load u0 has been put on: water bears u0 sin(πz/H), soil the rest."""
    ground = loaded_column(given)
    soil, n = ground.soil, ground.soil.soil
    # What its own stress pushes a uniformly pressed body with is the load that its surface bears.
    load = -soil.mass[:n, None] * soil.acceleration
    material = ground.law.materials[0]
    u = given.start * given.excess(soil.x[:n, 1], 0.0)
    k0 = material.rest
    soil.stress[:n] -= u[:, None] * np.array([k0, 1.0, 0.0, material.poisson * (1.0 + k0)])
    # Water and soil pass each other at Darcy's velocity from the start, and together displace nothing.
    z = soil.x[:n, 1]
    rate = given.permeability * given.start * np.pi / (WATER * GRAVITY * given.height)
    soil.v[:n, 1] = -rate * (1.0 - np.cos(np.pi * z / given.height))
    v = soil.v[:n].copy()
    v[:, 1] -= rate * np.cos(np.pi * z / given.height) / given.porosity
    spacing = given.height / given.rows
    sound = (given.ratio * given.porosity * given.modulus / WATER) ** 0.5
    size = (COLUMNS * spacing, given.height)
    both = water_in(
        ground, soil.x[:n].copy(), u, size, spacing, sound, Resistance(given.porosity),
        permeability=given.permeability, drained={"floor": 0.0, "lid": 0.0}, modulus=given.modulus,
        load=load, v=v,
    )  # fmt: skip
    return both


def isochrones(given: Consolidation, factors: Sequence[float]) -> list[tuple[float, Floats, Floats]]:
    """(T_v, heights m, u/u0) of the particles of a consolidating layer at each of rising time ``factors``."""
    both = consolidating(given)
    layer = both.water.layer
    found = []
    for factor in factors:
        while both.time < given.seconds(factor):
            both.advance()
        n = layer.fluid
        z, u = layer.x[:n, 1], layer.pressure[:n] / given.start
        found.append((both.time * given.consolidation / given.height**2, z.copy(), u.copy()))
    return found


def realised_modulus(given: Consolidation) -> float:
    """Stiffness M (Pa) of its soil without water, by a load q put on at once.

    The column then swings about the settlement q H/M with the period 4 H/√(M/ρ): the mean over two periods is that.
    """
    flow = loaded_column(given)
    soil, n = flow.soil, flow.soil.soil
    load = -soil.mass[:n, None] * soil.acceleration
    soil.stress[:] = 0.0
    soil.force[:] = load
    flow.start()
    top = np.flatnonzero(soil.x[:n, 1] > given.height * (1.0 - 1.0 / given.rows))
    start, spacing = soil.x[top, 1].mean(), given.height / given.rows
    density = (1.0 - given.porosity) * GRAINS
    end, moved, time = 8.0 * given.height / (given.modulus / density) ** 0.5, 0.0, 0.0
    while time < end:
        step = min(flow.next_step, end - time)
        flow.advance(step)
        moved += (start - soil.x[top, 1].mean()) * step
        time += step
    # The top row's centres lie half a spacing below the surface.
    return float(given.start * (given.height - 0.5 * spacing) * end / moved)


FACTORS = (0.01, 0.05, 0.1, 0.2, 0.3)
CELLS = 100  # of the finite differences: the middle of the layer at T_v = 0.01 differs by 0.0003 with half as many
LAYER = Consolidation(rows=20, permeability=1e-3, ratio=100.0)


def with_inertia(given: Consolidation, factors: Sequence[float]) -> tuple[Floats, list[Floats]]:
    """(Heights m; u/u0 there at each of rising time ``factors``) of Biot's equations."""
    z = (np.arange(CELLS) + 0.5) * given.height / CELLS
    pressures = excess_pressures(
        [given.seconds(factor) for factor in factors], given.start * given.excess(z, 0.0), given.height,
        modulus=given.modulus, permeability=given.permeability, porosity=given.porosity,
        stiffness=given.ratio * given.modulus, soil=(1.0 - given.porosity) * GRAINS, water=given.porosity * WATER,
        gravity=GRAVITY,
    )  # fmt: skip
    return z, [u / given.start for u in pressures]


def middles(given: Consolidation, factors: Sequence[float]) -> list[float]:
    """u/u0 in the middle of the layer at time ``factors``, by Biot's equations."""
    z, found = with_inertia(given, factors)
    return [float(np.interp(0.5 * given.height, z, u)) for u in found]


@functools.cache
def consolidation(given: Consolidation = LAYER, factors: tuple[float, ...] = FACTORS) -> tuple[list[float], float]:
    """(u/u0 in the middle, at the ``factors`` by Terzaghi's rate of decay; largest error over all isochrones)."""
    middle, worst, reached = [], 0.0, isochrones(given, factors)
    heights, exact = with_inertia(given, [time for time, _, _ in reached])
    for factor, (time, z, u), there in zip(factors, reached, exact, strict=True):
        near = np.abs(z / given.height - 0.5) < 0.6 / given.rows
        middle.append(float(u[near].mean() * np.exp(np.pi**2 * (time - factor))))
        worst = max(worst, float(np.abs(u - np.interp(z, heights, there)).max()))
    return middle, worst


@VALIDATIONS.row(
    "continuum.consolidation",
    source="Biot 1956 in one dimension, by finite differences: Terzaghi's u = u0 sin(πz/H) exp(-π² T_v), figure 10 of "
    "Maeda & Sakai 2004 with M in place of its B, and up to 0.006 that inertia and the stiffness of water add",
    because="2 % was required, which 20 rows meet: what sums and the drained base leave is of second order in the "
    "spacing (seepage.consolidation), 0.06 with half as many rows and 0.004 with twice as many, largest at T_v = 0.01",
    tolerance=0.02,
    slow=True,
)
def consolidation_row() -> Measured:
    """u/u0 in the middle; the error is the largest over the isochrones, 20 particles over the height."""
    middle, worst = consolidation()
    return Measured(middles(LAYER, FACTORS), middle, worst)


@VALIDATIONS.row(
    "continuum.consolidation_modulus",
    source="plane strain: M = E (1 - ν)/{(1 + ν)(1 - 2ν)}, by loading the soil alone",
    because="the surface lies half a spacing of 1/20 above its particles' centres, uncertain to half of that again",
    tolerance=0.25 / 20,
    slow=True,
)
def modulus_row() -> Measured:
    """Load over mean settlement per height of a column that swings under it, over M."""
    return Measured.absolute(1.0, realised_modulus(LAYER) / LAYER.modulus)


SOFT = (1.0, 4.0)


@functools.cache
def soft_decay(ratio: float) -> float:
    """u/u0 in the middle at T_v = 0.1 where water is ``ratio`` times as stiff as soil, K_w/(n M)."""
    (middle,), _ = consolidation(replace(LAYER, ratio=ratio), (0.1,))
    return middle


@VALIDATIONS.row(
    "continuum.consolidation_with_compressible_water",
    source="storage 1/M + n/K_w: c_v falls to c_v/(1 + n M/K_w), by Biot's equations as continuum.consolidation",
    because="twice what the layer with stiff water has at that time, 0.0026 (seepage.consolidation)",
    tolerance=0.0052,
    slow=True,
)
def soft_row() -> Measured:
    """u/u0 in the middle at T_v = 0.1 for K_w/(n M) = 1 and 4."""
    exact = [middles(replace(LAYER, ratio=ratio), (0.1,))[0] for ratio in SOFT]
    return Measured.absolute(exact, [soft_decay(ratio) for ratio in SOFT])
