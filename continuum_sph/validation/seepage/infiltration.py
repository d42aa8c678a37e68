"""Water that stands on dry soil and sinks into it, or is drawn in from a constant head.  SI.

Without capillarity the wetted soil above the front, at depth z, is full; at its surface stands the water that is left,
h = h0 - n z.  Darcy: n dz/dt = k (h + z)/z, so that with a = 1 - n

    t = (n/k) {z/a - (h0/a²) ln(1 + a z/h0)}

and z = √(2 k h0 t/n) at first, imbibition from a constant head (Green & Ampt 1911).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from continuum_sph.seepage import Frame, PoreFlow, Resistance, Seepage
from continuum_sph.validation.seepage.setups import ALPHA, COLUMNS, WATER, water_in
from continuum_sph.water.step import Flow
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()


def half_full(both: Seepage, rows: int, columns: int, height: float) -> float:
    """Lowest height (m) at which a level across a column's soil is half full of water and its grains; ``height`` (m) of
    the soil, ``rows`` by ``columns`` of particles, where none is."""
    layer, h = both.water.layer, both.water.law.smoothing.length
    n = layer.fluid
    volume = layer.mass[:n] / (both.water.porosity * layer.density)
    heights = np.linspace(0.0, height, 40 * rows + 1)
    q = np.abs(heights[:, None] - layer.x[:n, 1]) / h
    kernel = (np.maximum(0.0, 2.0 - q) ** 3 - 4.0 * np.maximum(0.0, 1.0 - q) ** 3) / (6.0 * h)
    full = kernel @ volume * rows / (columns * height)
    wet = np.flatnonzero(full > 0.5)
    return float(heights[wet[0]]) if wet.size else height


@dataclass(frozen=True)
class Infiltration:
    """rows : particles over the soil's height;  height : of the soil, standing : h0, of the water on it, m;
    permeability m/s;  sound_speed m/s."""

    rows: int = 30
    height: float = 0.3
    standing: float = 0.15
    permeability: float = 0.03
    sound_speed: float = 40.0
    porosity: float = 0.4

    def time(self, depth: float) -> float:
        """When (s) the front is at ``depth`` (m)."""
        a, h0 = 1.0 - self.porosity, self.standing
        return float(self.porosity / self.permeability * (depth / a - h0 / a**2 * np.log(1.0 + a * depth / h0)))

    def front(self, time: float) -> float:
        """Depth (m) of the front at ``time`` (s) while water still stands on the soil."""
        return float(brentq(lambda z: self.time(z) - time, 0.0, self.standing / self.porosity))

    def build(self) -> Seepage:
        """Held, dry soil in a periodic column, and still water on it that is let go."""
        spacing = self.height / self.rows
        size = COLUMNS * spacing, self.height + self.standing
        soil = Frame(
            square_lattice((0.0, 0.0), (size[0], self.height), spacing), spacing**2, self.porosity, self.permeability
        )
        x = square_lattice((0.0, self.height), size, spacing)
        return water_in(
            soil, x, WATER * GRAVITY * (size[1] - x[:, 1]), size, spacing, self.sound_speed, Resistance(self.porosity),
            gravity=GRAVITY, cut=True, alpha=ALPHA, shifting=1.0,
        )  # fmt: skip

    def reached(self, both: Seepage) -> float:
        """Depth (m) of the front below the soil's surface."""
        return self.height - half_full(both, self.rows, COLUMNS, self.height)


SINKING = Infiltration()
SINKING_TIMES = (0.3, 0.8)  # s


def way_of_the_front() -> float:
    """Way of the wetting front between two times over what it is exactly."""
    both, places = SINKING.build(), []
    for time in SINKING_TIMES:
        while both.time < time:
            both.advance()
        places.append(SINKING.reached(both))
    return (places[1] - places[0]) / (SINKING.front(SINKING_TIMES[1]) - SINKING.front(SINKING_TIMES[0]))


@VALIDATIONS.row(
    "continuum.infiltration",
    source="Green & Ampt 1911 without capillarity, level sinking: t = (n/k) {z/a - (h0/a²) ln(1 + a z/h0)}, a = 1 - n",
    because="held to 3 %; a front is a row of particles, 2.5 spacings apart in pores, whose place is known to a "
    "tenth of that, 0.25 of a way of 6.8 spacings, at two times: 0.25/6.8/√2",
    tolerance=0.03,
    slow=True,
)
def infiltration_row() -> Measured:
    """Way of the wetting front from 0.3 to 0.8 s in dry soil under sinking water, over the exact one."""
    return Measured.absolute(1.0, way_of_the_front())


@dataclass(frozen=True)
class Imbibition:
    """Water drawn into dry soil from a constant head, without gravity: x_f = √(2 k h0 t/n).

    What stands on the soil is driven into it by one acceleration at a time, ρ g h0 over its mass per area: so much is
    the pressure where the soil begins, however much water is left.  Fields as of `Infiltration`;  head : h0, m;
    columns : of particles across;  ratio : of smoothing length to spacing, 2: water's particles lie 1/n as far apart
    along pores as across.
    """

    rows: int = 30
    height: float = 0.3
    head: float = 0.3
    permeability: float = 0.03
    sound_speed: float = 40.0
    porosity: float = 0.4
    columns: int = 12
    ratio: float = 2.0

    def front(self, time: float) -> float:
        """Way (m) of the front at ``time`` (s)."""
        return float((2.0 * self.permeability * self.head * time / self.porosity) ** 0.5)

    def build(self) -> Seepage:
        """Held, dry soil in a periodic column, and over it as much water as fills its pores, and four rows."""
        spacing = self.height / self.rows
        standing = math.ceil(self.porosity * self.rows + 4) * spacing
        size = self.columns * spacing, self.height + standing
        soil = Frame(
            square_lattice((0.0, 0.0), (size[0], self.height), spacing), spacing**2, self.porosity, self.permeability
        )
        x = square_lattice((0.0, self.height), size, spacing)
        both = water_in(
            soil, x, np.zeros(len(x)), size, spacing, self.sound_speed, Resistance(self.porosity), ratio=self.ratio,
            cut=True, alpha=ALPHA,
        )  # fmt: skip
        both.water.before_force = self.drive
        return both

    def drive(self, flow: Flow) -> None:
        """Add the acceleration of what stands on the soil; of water that is partly in it, of that part."""
        assert isinstance(flow, PoreFlow)
        layer, n = flow.layer, flow.layer.fluid
        above = (flow.porosity - self.porosity) / (1.0 - self.porosity)
        force = WATER * GRAVITY * self.head * self.columns * self.height / self.rows
        layer.acceleration[:n, 1] -= force / float(layer.mass[:n] @ above) * above

    def reached(self, both: Seepage) -> float:
        """Depth (m) that the wetting front has reached."""
        return self.height - half_full(both, self.rows, self.columns, self.height)


DRAWN = Imbibition()
DRAWN_TIMES = (0.3, 0.6, 0.9)  # s


def fronts(given: Imbibition = DRAWN, times: tuple[float, ...] = DRAWN_TIMES) -> list[float]:
    """Way of the wetting front over √(2 k h0 t/n) at rising ``times`` (s)."""
    both = given.build()
    found: list[float] = []
    for time in times:
        while both.time < time:
            both.advance()
        found.append(given.reached(both) / given.front(both.time))
    return found


@VALIDATIONS.row(
    "continuum.imbibition",
    source="Green & Ampt 1911 without capillarity and gravity: x_f = √(2 k h0 t/n)",
    because="held to 3 %; water starts at rest and is late by 0.01 s, 1.7 % of the way at 0.3 s, 0.6 % at 0.9 s; "
    "a row in pores is 2.5 spacings high and its place known to a tenth of that: 0.25 of 12 to 20 spacings",
    tolerance=0.03,
    slow=True,
)
def imbibition_row() -> Measured:
    """Way of the front over the exact one at 0.3, 0.6 and 0.9 s, 30 particles over the height of the soil."""
    return Measured.absolute(1.0, fronts())
