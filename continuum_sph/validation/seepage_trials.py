"""Small bodies of soil with water in their pores, which validations, tests and cases set up and watch.  SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage import Drain, Frame, PoreFlow, Resistance, Seepage, skeleton_of
from continuum_sph.seepage.overlap import Overlap
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.validation.soil_trials import RATIO, in_tank
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import SUPPORT, Smoothing
from continuum_sph.water.state import VY, Layer
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import PairList, square_lattice

Floats = NDArray[np.float64]

WATER = 1000.0  # kg/m³
GRAINS = 2650.0  # kg/m³
SKIN = 0.15  # of the smoothing length
COLUMNS = 8  # particles across a periodic column: two cutoffs of 2h + skin and a little


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
        """E, Pa, of M = E (1 - ν)/{(1 + ν)(1 - 2ν)}."""
        nu = self.poisson
        return self.modulus * (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu)

    def seconds(self, factor: float) -> float:
        """Time (s) of a time factor T_v = c_v t/H²."""
        return factor * self.height**2 / self.consolidation

    def excess(self, z: Floats, factor: float) -> Floats:
        """Exact u/u0 at heights z (m): sin(πz/H) exp(-π² T_v)."""
        result: Floats = np.sin(np.pi * z / self.height) * np.exp(-(np.pi**2) * factor)
        return result


def sides(width: float, height: float, spacing: float, ratio: float = RATIO) -> Floats:
    """Wall particles under and over a periodic column, (n, 2) m, as deep as kernels of ``ratio`` spacings reach."""
    return tank_walls(width, height, spacing, math.ceil(SUPPORT * ratio - 0.5 - 1e-9), sides=False, lid=True)


def water_in(
    ground: SoilFlow | Frame,
    x: Floats,
    pressure: Floats,
    size: tuple[float, float],
    spacing: float,
    sound_speed: float,
    resistance: Resistance,
    *,
    grains: float = GRAINS,
    permeability: float = 1e-3,
    gravity: float = 0.0,
    drained: Mapping[str, float] | None = None,
    modulus: float = 0.0,
    load: Floats | None = None,
    v: Floats | None = None,
    ratio: float = RATIO,
    **law: float | bool,
) -> Seepage:
    """Water at ``x`` (n, 2) m under ``pressure`` (n,) Pa in a periodic column (width, height) m, among the soil there.

    load (soil, 2) N/m: on the soil;  v (n, 2) m/s: of the water, none if absent;  drained : pressure (Pa) of faces that
    water passes, "floor" or "lid";  ratio : of the smoothing length to the spacing.  Each particle takes up a square of
    the spacing, grains and all.
    """
    width, height = size
    smoothing, state, n = Smoothing("wendland", ratio * spacing), Tait(WATER, sound_speed), len(x)
    walls = sides(width, height, spacing, ratio)
    options = {"diffusion": 0.0, "cut": False, "alpha": 0.0, "corrected": True} | law
    rules = Law(smoothing, spacing, (Fluid(state),), (0.0, -gravity), **options)  # type: ignore[arg-type]
    skeleton = ground.skeleton if isinstance(ground, Frame) else skeleton_of(ground, grains, permeability)
    deep = math.ceil(-float(walls[:, 1].min()) / spacing) * spacing
    box = (0.0, -deep), (width, height + deep), (True, False)
    skin = SKIN * smoothing.length
    overlap = Overlap(n, skeleton.count, smoothing.length, skin, *box)
    overlap.update(x, skeleton.x)
    rho = state.density_at(pressure)
    mass = np.concatenate((rho * spacing**2, np.full(len(walls), WATER * spacing**2)))
    layer = Layer(n, np.concatenate((x, walls)), np.zeros((n + len(walls), 2)), mass, rho)
    if v is not None:
        layer.v[:n] = v
    pairs = PairList(layer.count, skin, *box, full=True)
    flow = PoreFlow(layer, rules, pairs, skeleton=skeleton, overlap=overlap, resistance=resistance)
    for face, held in (drained or {}).items():
        below = face == "floor"
        rows = n + np.flatnonzero(walls[:, 1] < 0.0 if below else walls[:, 1] > height)
        normal = (0.0, 1.0 if below else -1.0)
        flow.drains.append(Drain(rows, (0.0, 0.0 if below else height), normal, np.full(len(rows), held)))
    whole = resistance.porosity * WATER + (1.0 - resistance.porosity) * grains
    both = Seepage(flow, ground, modulus, whole if modulus else np.inf, load=load)
    both.start()
    layer.mass[:n] = flow.porosity * rho * spacing**2
    both.start()
    return both


def loaded_column(given: Consolidation) -> SoilFlow:
    """Its soil under the uniform stress u0 that its surface bears, without water, at rest."""
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


def saturated_box(
    across: int, seed: int, *, speed: float = 0.5, permeability: float = 1e-2, share: float = 1.0
) -> Seepage:
    """A periodic box of 1 m of saturated elastic soil without gravity or walls, both layers stirred at random.

    speed : of the stirring, m/s;  share : of the step that the layers allow.
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
    ground = SoilFlow(soil, SoilLaw(smoothing, spacing, (material,), (0.0, 0.0), damping=0.0, courant=0.25 * share),
                      PairList(n, skin, *box, full=True))  # fmt: skip
    ground.start()
    skeleton = skeleton_of(ground, GRAINS, permeability)
    at = x + rng.uniform(-0.1, 0.1, x.shape) * spacing
    overlap = Overlap(n, n, smoothing.length, skin, *box)
    state = Tait(WATER, 40.0)
    rules = Law(smoothing, spacing, (Fluid(state),), (0.0, 0.0), diffusion=0.0, cut=False, courant=0.25 * share)
    layer = Layer(n, at, rng.normal(0.0, speed, x.shape), np.full(n, porosity * WATER * spacing**2), np.full(n, WATER))
    flow = PoreFlow(layer, rules, PairList(n, skin, *box, full=True), skeleton=skeleton, overlap=overlap,
                    resistance=Resistance(porosity))  # fmt: skip
    whole = porosity * WATER + material.density
    both = Seepage(flow, ground, material.column_modulus, whole / share**2)
    both.start()
    return both


def permeated(permeability: float, gradient: float, *, law: str = "constant", porosity: float = 0.4) -> Seepage:
    """Held soil in a periodic box of 12 spacings of 1 cm, its water driven along x by a hydraulic ``gradient``.

    porosity : of the soil, whose permeability is given at 0.4;  water lies at random in it.
    """
    across, spacing, given = 12, 0.01, 0.4
    side = across * spacing
    box, smoothing = ((0.0, 0.0), (side, side), (True, True)), Smoothing("wendland", RATIO * spacing)
    rng = np.random.default_rng(4)
    frame = Frame(square_lattice((0.0, 0.0), (side, side), spacing), spacing**2, porosity, permeability)
    x = (
        frame.skeleton.x + rng.uniform(0.0, 1.0, 2) * spacing + rng.uniform(-0.1, 0.1, frame.skeleton.x.shape) * spacing
    ) % side
    n, skin = len(x), SKIN * smoothing.length
    rules = Law(smoothing, spacing, (Fluid(Tait(WATER, 10.0)),), (gradient * GRAVITY, 0.0), diffusion=0.0, cut=False)
    layer = Layer(n, x, np.zeros((n, 2)), np.full(n, porosity * WATER * spacing**2), np.full(n, WATER))
    flow = PoreFlow(
        layer, rules, PairList(n, skin, *box, full=True), skeleton=frame.skeleton,
        overlap=Overlap(n, n, smoothing.length, skin, *box), resistance=Resistance(given, law),
    )  # fmt: skip
    both = Seepage(flow, frame)
    both.start()
    return both


@dataclass(frozen=True)
class Permeameter:
    """Soil under a layer of water, through which water is driven upwards from a porous base.

    rows : of particles over the soil's height;  height : of the soil, cover : of the water above, m;  permeability m/s;
    held : soil that cannot move, else with a modulus M, Pa, and friction;  sound_speed : of the water, m/s.
    """

    rows: int = 20
    height: float = 0.1
    cover: float = 0.03
    permeability: float = 5e-3
    held: bool = True
    modulus: float = 1e6
    sound_speed: float = 60.0
    porosity: float = 0.4

    @property
    def critical(self) -> float:
        """i_c = (G_s - 1)(1 - n)."""
        return (GRAINS / WATER - 1.0) * (1.0 - self.porosity)

    def base(self, gradient: float) -> float:
        """Pressure (Pa) at the base for a hydraulic ``gradient`` in the soil."""
        return WATER * GRAVITY * (self.height + self.cover + gradient * self.height)

    def build(self, gradient: float, first: float = 0.0) -> Seepage:
        """The column under its weight in water whose base is at a ``gradient``, which has not begun to flow.

        first : gradient of the pressures at the start, when the soil is at rest under it.
        """
        spacing = self.height / self.rows
        size = (COLUMNS * spacing, self.height)
        x = square_lattice((0.0, 0.0), size, spacing)
        nu, ground = 0.3, None
        if not self.held:
            stiff = self.modulus * (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu)
            material = Material(stiff, (1.0 - self.porosity) * GRAINS, nu, porosity=self.porosity)
            weight = ((1.0 - self.porosity) * (GRAINS - WATER) - first * WATER) * GRAVITY
            upright, k0 = weight * (self.height - x[:, 1]), material.rest
            stress = upright[:, None] * np.array([k0, 1.0, 0.0, nu * (1.0 + k0)])
            ground = in_tank(x, stress, size, spacing, material, sides="none")
        all_of = (size[0], self.height + self.cover)
        at = square_lattice((0.0, 0.0), all_of, spacing)
        pressure = WATER * GRAVITY * (all_of[1] - at[:, 1] + first * np.maximum(0.0, self.height - at[:, 1]))
        return water_in(
            ground or Frame(x, spacing**2, self.porosity, self.permeability), at, pressure, all_of, spacing,
            self.sound_speed, Resistance(self.porosity), permeability=self.permeability, gravity=GRAVITY,
            drained={"floor": self.base(gradient), "lid": 0.0}, modulus=0.0 if self.held else self.modulus,
        )  # fmt: skip


def upward(both: Seepage, lower: float, upper: float) -> float:
    """Mean flux q of water and grains, upwards, m/s, over the water between heights ``lower`` and ``upper``, m."""
    layer = both.water.layer
    n = layer.fluid
    own = (layer.x[:n, 1] > lower) & (layer.x[:n, 1] < upper)
    volume = (layer.mass[:n] / (both.water.porosity * layer.density))[own]
    return float((volume * layer.record[:n, VY][own]).sum() / volume.sum())


def discharge(both: Seepage) -> float:
    """Mean n (v_f - v_s) along x, m/s, over the volume."""
    layer = both.water.layer
    n = layer.fluid
    volume = layer.mass[:n] / (both.water.porosity * layer.density)
    return float((volume * both.water.porosity * layer.v[:n, 0]).sum() / volume.sum())


def momentum(both: Seepage) -> Floats:
    """Of both layers, (2,) kg/s."""
    layer, soil = both.water.layer, both.water.skeleton
    water: Floats = (layer.mass[: layer.fluid, None] * layer.v[: layer.fluid]).sum(axis=0)
    grains: Floats = (soil.mass[:, None] * soil.v).sum(axis=0)
    return water + grains


def energies(both: Seepage, ground: SoilFlow) -> dict[str, float]:
    """Of both layers, J/m: kinetic, compressive, elastic (of a linear material), heat of drag, and their sum.

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
