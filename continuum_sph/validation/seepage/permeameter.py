"""Water driven upwards through soil: Darcy's flux, and the gradient at which the soil boils.  SI."""

import functools
from dataclasses import dataclass

import numpy as np

from continuum_sph.builders.parts.faces import FARTHEST
from continuum_sph.seepage import Frame, Resistance, Seepage
from continuum_sph.soil import Material, SoilFlow
from continuum_sph.soil.material import unconfined
from continuum_sph.soil.stress import YY
from continuum_sph.validation.seepage.setups import COLUMNS, GRAINS, WATER, water_in
from continuum_sph.validation.soil.setups import in_tank
from continuum_sph.water.state import VY
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()


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
            material = Material(
                unconfined(self.modulus, nu), (1.0 - self.porosity) * GRAINS, nu, porosity=self.porosity
            )
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


PERMEABILITIES = (1e-2, 1e-3, 1e-4, 1e-5)
"""k, m/s: four decades, with water of 30 m/s and up, as much faster as the soil is tighter: the same steps for all."""


@functools.cache
def darcy(permeability: float, gradient: float = 0.5, steps: int = 1600) -> float:
    """Flux through held soil over k i, water at rest at the start."""
    column = Permeameter(permeability=permeability, sound_speed=0.6 / permeability)
    both = column.build(gradient)
    for _ in range(steps):
        both.advance()
    return upward(both, 0.2 * column.height, 0.8 * column.height) / (permeability * gradient)


@VALIDATIONS.row(
    "continuum.permeameter",
    source="Darcy 1856: q = k i, upwards through 20 rows of soil under water, between faces of given pressure",
    because="held to 1 %; grains and drag are summed over a lattice that is 1 to 0.0011; rows that come in through "
    "the base or out of the soil have moved by 0.05 spacings with k 1e-2 and are pushed back by as much head at each "
    "end, 2 · 0.05/(20 · 0.5)",
    tolerance=0.01,
    slow=True,
)
def permeameter_row() -> Measured:
    """q/(k i) for k of 1e-2 to 1e-5 m/s, i 0.5."""
    return Measured.absolute(1.0, [darcy(k) for k in PERMEABILITIES])


BOILING = Permeameter(held=False)
RAMP = (0.85, 1.1, 0.18)  # of i_c from, to, in s


@functools.cache
def ramp(column: Permeameter = BOILING) -> tuple[Floats, Floats, Floats]:
    """(gradient over i_c, mean upright stress in the soil over that without flow, mean speed of the soil m/s) while the
    gradient rises steadily."""
    low, high, seconds = RAMP
    both = column.build(low * column.critical, low * column.critical)
    ground = both.ground
    assert isinstance(ground, SoilFlow)
    soil, n = ground.soil, ground.soil.soil
    weight = column.critical * WATER * GRAVITY * column.height  # submerged, at the base
    rows = []
    while both.time < seconds:
        part = low + (high - low) * both.time / seconds
        both.water.faces[0].pressure[:] = column.base(part * column.critical)
        both.advance()
        volume = soil.mass[:n] / soil.density
        upright = float((volume * soil.stress[:n, YY]).sum() / volume.sum()) / (0.5 * weight)
        rows.append((part, upright, float(np.abs(soil.v[:n, 1]).mean())))
    part, upright, speed = np.array(rows).T
    return part, upright, speed


def boiling(column: Permeameter = BOILING) -> tuple[float, float, float]:
    """(gradient over i_c at which the mean upright stress in the soil would vanish, from its fall between 0.9 and 0.97;
    speed of the soil at 0.97 and at the end, m/s)."""
    part, upright, speed = ramp(column)
    chosen = (part > 0.9) & (part < 0.97)
    slope, start = np.polyfit(part[chosen], upright[chosen], 1)
    return float(-start / slope), float(speed[chosen][-1]), float(speed[-1])


@VALIDATIONS.row(
    "continuum.boiling_gradient",
    source="Terzaghi 1922: i_c = (G_s - 1)(1 - n)",
    because="held to 5 %; pore pressure follows the rise of 1.4 i_c a second H²/2c_v = 0.01 s late, and the base "
    "loses some 1 % of its head to the 0.2 spacings that water has come in by",
    tolerance=0.05,
    slow=True,
)
def boiling_row() -> Measured:
    """Gradient over i_c at which upward flow takes the soil's weight."""
    found, _, _ = boiling()
    return Measured.absolute(1.0, found)


LIFTS = (1.05, 1.1, 1.2)
"""Gradients of the head at the base, over the critical one."""


@functools.cache
def lift(part: float, column: Permeameter = BOILING) -> tuple[float, float, float]:
    """(Impulse of the face, less the weight, over (p0 - weight) t;  mean upward speed of the soil, m/s, when half of
    the water has passed that passes in a run, and at its end) under a head of ``part`` i_c; at the start pore pressures
    bear the soil, and nothing moves."""
    both = column.build(part * column.critical, column.critical)
    layer, ground, face = both.water.layer, both.ground, both.water.faces[0]
    assert isinstance(ground, SoilFlow)
    water, soil, n, soils = layer.mass[: layer.fluid], ground.soil, layer.fluid, ground.soil.soil
    width, grains, spacing = COLUMNS * column.height / column.rows, soil.mass[:soils], column.height / column.rows
    weight = GRAVITY * float(water.sum() + grains.sum()) / width
    taken, halfway, passed = 0.0, 0.0, 0.0
    while passed < FARTHEST * spacing:
        both.advance()
        # What is left without weight and water is that of the floor: forces within the soil cancel.
        held = grains * (soil.acceleration[:, 1] + GRAVITY) - both.water.skeleton.force[:, 1]
        taken += both.next_step * float(held.sum()) / width
        speed = float(grains @ soil.v[:soils, 1] / grains.sum())
        halfway = speed if passed < 0.5 * FARTHEST * spacing else halfway
        passed = float((layer.x[face.columns, 1] - both.water.home[face.columns, 1]).mean())
    gained = float(water @ layer.v[:n, 1] + grains @ soil.v[:soils, 1]) / width - taken
    return gained / ((column.base(part * column.critical) - weight) * both.time), halfway, speed


def push_error(part: float, column: Permeameter = BOILING) -> float:
    """What of the head ``part`` i_c at the base is missing (< 0) or too much in the momentum of soil and water, over
    it: of what is more than the weight the head is 1/(1 - 1/part) times."""
    return (lift(part, column)[0] - 1.0) * (1.0 - 1.0 / part)


@VALIDATIONS.row(
    "continuum.ground_lifted_by_a_face",
    source="Newton's second law: soil and water gain (p0 - weight) t from a base of the pressure p0, which bears them "
    "alone; heads of 1.05, 1.1, 1.2 i_c",
    because="a quarter of a spacing of water, which no particles stand for, lies before the face in the mean of a run, "
    "and takes as much of the head as of the 20 spacings over which it falls",
    tolerance=0.5 * FARTHEST / BOILING.rows,
    slow=True,
)
def lift_row() -> Measured:
    """Momentum of soil and water, less what the floor has given the soil, less that due to the head, as a share of what
    the head would give, when water has passed the face by half a spacing."""
    return Measured.absolute([0.0] * len(LIFTS), [push_error(part) for part in LIFTS])
