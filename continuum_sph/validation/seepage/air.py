"""Water that stands on soil full of air: how fast it sinks in, by what the air does.  SI.

All pores below the front, L - z of soil, are full of air.  Water stands h = h0 - n z on the soil and fills z of it;
u = dz/dt is its velocity in the pores, n u on the soil, so what drives it is

    (z + n h) du/dt = g (h + z) - P/ρ - g n u z/k - (1 - n²) u²/2

with inertia of both parts, weight, the pressure P of the air at the front, Darcy's drag, and the pressure that water
gives up where it speeds up from n u to u.  Air that cannot leave:  P = p0 {(L/(L - z))^γ - 1}, plus a third of its drag
on the way to the floor;  air that leaves through the floor:  P = r g ρ n u (L - z)/k, r = μ_a/μ_w its drag.  Without
air and inertia that is Green & Ampt 1911.  Trapped air holds water up: it sinks to g (h + z) = P/ρ and no farther.

A level front is stable as long as the air bears less than the water that stands on the soil (White, Colombera & Philip,
Soil Sci. Soc. Am. J. 40 (1976) 824): P < ρ g h, flux above k; beyond it fingers of water go down and air comes up.
"""

import functools
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from continuum_sph.builders.parts.air import AIR, specific_weights
from continuum_sph.seepage import Frame, Resistance, Seepage
from continuum_sph.validation.seepage.setups import ALPHA, COLUMNS, WATER, pore_flow
from continuum_sph.water.density import LINEAR
from continuum_sph.water.eos.adiabatic import AdiabaticGas
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VISCOSITY = 1.002e-3  # Pa s, of water


@dataclass(frozen=True)
class TrappedAir:
    """rows : particles over the soil's height L;  height, standing : L and h0, m;  permeability m/s, of water;
    sound_speed : of the water, m/s;  gas : the air;  viscosity : μ_a, Pa s;  chamber : empty height (m) below the soil
    that air leaves to, none: a closed floor;  filled : whether there is air at all."""

    rows: int = 20
    height: float = 0.3
    standing: float = 0.39
    permeability: float = 0.03
    sound_speed: float = 37.0
    porosity: float = 0.4
    gas: AdiabaticGas = field(default_factory=lambda: AdiabaticGas(10.0, 5e3))
    viscosity: float = 1.81e-5
    chamber: float = 0.0
    filled: bool = True

    @property
    def spacing(self) -> float:
        """Spacing of the particles, m."""
        return self.height / self.rows

    def resisted(self, depth: float, speed: float) -> float:
        """P (Pa) of the air at a front at ``depth`` z (m) that moves at ``speed`` u (m/s)."""
        left = self.height - depth
        drag = WATER * GRAVITY * self.porosity * speed * left / self.permeability * self.viscosity / VISCOSITY
        if not self.filled:
            return 0.0
        return drag if self.chamber else self.squeezed(depth) + drag / 3.0

    def squeezed(self, depth: float) -> float:
        """Pressure (Pa) of trapped air above a front at ``depth`` (m)."""
        return float(self.gas.base * ((self.height / (self.height - depth)) ** self.gas.exponent - 1.0))

    def front(self, time: float) -> float:
        """Depth (m) of the front at ``time`` (s)."""
        n = self.porosity

        def rates(_: float, state: Floats) -> list[float]:
            """Speed and acceleration of a front at the depth and with the speed of ``state``, m, m/s."""
            z, u = state
            h = self.standing - n * z
            push = GRAVITY * (h + z) - self.resisted(z, u) / WATER - 0.5 * (1.0 - n * n) * u * u
            return [u, (push - GRAVITY * n * u * z / self.permeability) / (z + n * h)]

        found = solve_ivp(rates, (0.0, time), [0.0, 0.0], method="LSODA", rtol=1e-9, atol=1e-12)
        return float(found.y[0, -1])

    def build(self) -> Seepage:
        """Held soil in a periodic column, air in it at rest, still water on it that is let go."""
        spacing, below = self.spacing, round(self.chamber / self.spacing) * self.spacing
        top = below + self.height
        width, whole = COLUMNS * spacing, top + self.standing
        ground = Frame(
            square_lattice((0.0, below), (width, top), spacing), spacing**2, self.porosity, self.permeability
        )
        wet = square_lattice((0.0, top), (width, whole), spacing)
        pores = ground.skeleton.x if self.filled else np.zeros((0, 2))
        state = Tait(WATER, self.sound_speed)
        rho = np.concatenate((
            state.density_at(WATER * GRAVITY * (whole - wet[:, 1])), np.full(len(pores), self.gas.density)
        ))  # fmt: skip
        n, smoothing = len(rho), Smoothing("wendland", RATIO * spacing)
        walls = tank_walls(width, whole, spacing, 3, sides=False, lid=True)
        fluids = (Fluid(state, VISCOSITY), Fluid(self.gas, self.viscosity))
        law = Law(
            smoothing, spacing, fluids if self.filled else fluids[:1], (0.0, -GRAVITY), alpha=ALPHA,
            diffusion=0.04, noise=LINEAR, corrected=True, cut=True,
        )  # fmt: skip
        mass = np.concatenate((rho * spacing**2, np.full(len(walls), WATER * spacing**2)))
        material = np.zeros(len(mass), np.int64)
        material[len(wet) : n] = AIR
        x = np.concatenate((wet, pores, walls))
        layer = Layer(n, x, np.zeros_like(x), mass, rho, material=material)
        box = (0.0, -3.0 * spacing), (width, whole + 3.0 * spacing), (True, False)
        flow = pore_flow(layer, law, ground.skeleton, Resistance(self.porosity), *box)
        if self.filled:
            flow.specific_weight = specific_weights(material[:n], law, GRAVITY)
        flow.lower[1] = 0.0
        both = Seepage(flow, ground)
        both.start()
        layer.mass[:n] = flow.porosity * rho * spacing**2
        both.start()
        return both

    def reached(self, both: Seepage) -> float:
        """Depth (m) at which a level across the soil is half full of water and its grains."""
        layer, h = both.water.layer, both.water.law.smoothing.length
        water = layer.material[: layer.fluid] != AIR
        volume = (layer.mass[: layer.fluid] / (both.water.porosity * layer.density))[water]
        y = layer.x[: layer.fluid, 1][water] - round(self.chamber / self.spacing) * self.spacing
        heights = np.linspace(0.0, self.height, 40 * self.rows + 1)
        q = np.abs(heights[:, None] - y) / h
        kernel = (np.maximum(0.0, 2.0 - q) ** 3 - 4.0 * np.maximum(0.0, 1.0 - q) ** 3) / (6.0 * h)
        full = np.flatnonzero(kernel @ volume > 0.5 * COLUMNS * self.spacing)
        return float(self.height - heights[full[0]]) if full.size else 0.0

    def run(self, time: float) -> Seepage:
        """Advance the column to ``time`` (s), and return it."""
        both = self.build()
        while both.time < time:
            both.advance()
        return both


def air_pressure(both: Seepage) -> float:
    """Mean pressure (Pa) of the air over the volume that it takes up."""
    layer, n = both.water.layer, both.water.layer.fluid
    air = layer.material[:n] == AIR
    volume = layer.mass[:n][air] / layer.density[air]
    return float((volume * layer.pressure[:n][air]).sum() / volume.sum())


VALIDATIONS = Validations()

CLOSED, OPEN = TrappedAir(), TrappedAir(chamber=0.15)
WATCHED = 0.3  # s: the air bears less than the water on the soil, so the front is level
PLACE = 0.25  # spacings to which a front is located: a tenth of the 2.5 between rows of water in pores


@functools.cache
def sunk(given: TrappedAir, time: float = WATCHED) -> tuple[float, float, float]:
    """(depth of the front, m, mean pressure of the air, Pa, change of the masses of water and air over their own)."""
    both = given.build()
    layer, n = both.water.layer, both.water.layer.fluid
    air = layer.material[:n] == AIR
    before = layer.mass[:n][~air].sum(), layer.mass[:n][air].sum()
    while both.time < time:
        both.advance()
    after = layer.mass[:n][~air].sum(), layer.mass[:n][air].sum()
    lost = max(abs(b - a) / a for a, b in zip(before, after, strict=True) if a > 0.0)
    return given.reached(both), air_pressure(both) if given.filled else 0.0, float(lost)


def late(given: TrappedAir, law: TrappedAir | None = None) -> tuple[float, float]:
    """(exact, found) depth of the front by the ``law`` of one column in another, m."""
    return (law or given).front(WATCHED), sunk(given)[0]


@VALIDATIONS.row(
    "continuum.infiltration_into_trapped_air",
    source="derived: momentum of the water that stands and of that in the soil, Darcy's drag, p V^γ of the air below "
    "(`continuum_sph.validation.seepage.air`); without air and inertia Green & Ampt 1911",
    because="a front is a row of particles, 2.5 spacings apart in pores, whose place is known to a tenth of that: 0.25 "
    "of a way of 6.3 spacings",
    tolerance=PLACE / 6.3,
    slow=True,
)
def closed_row() -> Measured:
    """Depth of the front after 0.3 s where air cannot leave, m; error over the exact one."""
    return Measured.relative(*late(CLOSED))


@VALIDATIONS.row(
    "continuum.infiltration_that_drives_air_out",
    source="derived: the same, air leaving through the floor against its own drag, μ_a/μ_w of the water's",
    because="a quarter of a spacing, as above, of a way of 8.9 spacings",
    tolerance=PLACE / 8.9,
    slow=True,
)
def open_row() -> Measured:
    """Depth of the front after 0.3 s where air leaves below, m; error over the exact one."""
    return Measured.relative(*late(OPEN))


def squeezed(given: TrappedAir, exponent: float | None = None) -> float:
    """(p0 + p) V^γ over p0 V0^γ, V what the front leaves of the soil;  exponent: γ."""
    depth, pressure, _ = sunk(given)
    power = given.gas.exponent if exponent is None else exponent
    return float((1.0 + pressure / given.gas.base) * (1.0 - depth / given.height) ** power)


@VALIDATIONS.row(
    "continuum.trapped_air_is_compressed",
    source="exact: p V^γ of a gas that keeps its heat, V by the place of the front",
    because="a quarter of a spacing in the 13.7 that the front leaves, times γ = 1.403",
    tolerance=1.403 * PLACE / 13.7,
    slow=True,
)
def squeezed_row() -> Measured:
    """(p0 + p) V^γ over that at the start, after 0.3 s."""
    return Measured.absolute(1.0, squeezed(CLOSED))


@VALIDATIONS.row(
    "continuum.mass_of_three_phases",
    source="exact: particles keep their mass, grains their volume",
    because="sums of at most 370 masses, in the same order: none",
    tolerance=0.0,
    slow=True,
)
def mass_row() -> Measured:
    """Change of the mass of water and of air in 0.3 s, the larger, over their own."""
    return Measured.absolute(0.0, max(sunk(CLOSED)[2], sunk(OPEN)[2]))
