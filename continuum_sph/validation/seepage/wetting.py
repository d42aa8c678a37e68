"""A dry levee of held ground, wetted from one side by a level that rises.  SI."""

from dataclasses import dataclass

import numpy as np

from continuum_sph.builders.parts.instruments import surface_height
from continuum_sph.scene.instruments import LevelSection
from continuum_sph.seepage import Reservoir, Seepage
from continuum_sph.validation.seepage.dam import held_between, water_there
from continuum_sph.validation.seepage.setups import WATER
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.neighbors import square_lattice


@dataclass(frozen=True)
class Levee:
    """A trapezoid on an impervious base, dry, with water on its left.

    spacing m;  height, crest m;  slope : horizontal over vertical, of both sides;  level m : of the water, which has
    risen before it can enter the soil;  basin m : width of the water before the toe, and of the floor behind the other;
    permeability m/s;  sound_speed m/s;  ratio : of smoothing length to spacing.
    """

    spacing: float = 0.02
    height: float = 0.34
    crest: float = 0.2
    slope: float = 2.0
    level: float = 0.28
    basin: float = 0.3
    permeability: float = 0.1
    sound_speed: float = 25.0
    ratio: float = 2.0

    @property
    def base(self) -> float:
        """Width of the base, m."""
        return self.crest + 2.0 * self.slope * self.height

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the tank, m."""
        width = 2.0 * self.basin + self.base
        return round(width / self.spacing) * self.spacing, round(1.2 * self.height / self.spacing) * self.spacing

    def top(self, x: Floats) -> Floats:
        """Height (m) of the levee's surface at ``x`` (n,) m, 0 beside it."""
        way = np.minimum(x - self.basin, self.basin + self.base - x) / self.slope
        heights: Floats = np.clip(way, 0.0, self.height)
        return heights

    @property
    def ground(self) -> Floats:
        """Particles of the soil, (n, 2) m."""
        at = square_lattice((0.0, 0.0), self.size, self.spacing)
        within: Floats = at[at[:, 1] < self.top(at[:, 0])]
        return within

    def build(self) -> Seepage:
        """Dry, water at rest before it, about to be let in."""
        width, height = self.size
        at = square_lattice((0.0, 0.0), (width, height), self.spacing)
        outside = (at[:, 1] >= self.top(at[:, 0])) & (at[:, 1] < self.level) & (at[:, 0] < 0.5 * width)
        water, gap, start = at[outside], 3.0 * self.spacing, np.zeros(1)
        pools = [
            Reservoir("outer", 0.0, self.basin - gap, 0.0, start, np.array([self.level]), (True, False)),
            Reservoir("inner", width - self.basin + gap, width, 0.0, start, np.zeros(1), (False, True)),
        ]
        most = round(width / self.spacing) * (round(self.level / self.spacing) + 2)
        return held_between(
            self.size, self.spacing, self.ground, water, WATER * GRAVITY * (self.level - water[:, 1]), pools,
            self, most,
        )  # fmt: skip

    def line(self, both: Seepage) -> tuple[Floats, Floats]:
        """(places x, heights) of the wetting line, m, at every spacing from the water's edge on the slope on."""
        cloud = water_there(both, self.spacing, self.size[0])
        x = np.arange(self.basin + self.slope * self.level, self.basin + self.base, self.spacing)
        return x, np.array(
            [surface_height(LevelSection(name="", x=place, breadth=4.0 * self.spacing), cloud) for place in x]
        )


def sag(x: Floats, heights: Floats, level: float) -> tuple[float, float]:
    """(way of the front on the base from the water's edge at x[0], m;  how much the wetting line sags: 1/2 less its
    mean height over the ``level`` (m) that it starts from).

    0 is a straight line, 1/6 the wave of a dam that breaks (Ritter 1892), -1/6 a parabola that stands upright at its
    foot, -0.049 the exact solution of Boussinesq's equation for water that enters dry ground (Barenblatt 1952).
    """
    wet = heights > 0.0
    last = len(x) if wet.all() else int(np.argmin(wet))
    if last < 3:
        return 0.0, 0.0
    line = np.concatenate(([level], heights[1:last], [0.0]))
    places = np.append(x[:last], x[last - 1] + 0.5 * (x[1] - x[0]))
    way = float(places[-1] - places[0])
    return way, float(0.5 - np.trapezoid(line, places) / (way * level))


BOUSSINESQ = 1.616
"""Way of the front over √(k h0 t/n), n ∂h/∂t = k ∂(h ∂h/∂x)/∂x, h = h0 at an upright face; its sag is -0.049."""
