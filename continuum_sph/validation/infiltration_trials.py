"""Water that stands on dry soil and sinks into it.  SI.

Without capillarity the wetted soil above the front, at depth z, is full; at its surface stands the water that is left,
h = h0 - n z.  Darcy: n dz/dt = k (h + z)/z, so that with a = 1 - n

    t = (n/k) {z/a - (h0/a²) ln(1 + a z/h0)}

and z = √(2 k h0 t/n) at first, imbibition under a constant head (Green & Ampt 1911).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from continuum_sph.seepage import Frame, Resistance, Seepage
from continuum_sph.validation.seepage_trials import COLUMNS, WATER, water_in
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import square_lattice


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
            gravity=GRAVITY, cut=True, alpha=0.1, shifting=1.0,
        )  # fmt: skip

    def reached(self, both: Seepage) -> float:
        """Depth (m) of the front below the soil's surface."""
        return self.height - half_full(both, self.rows, COLUMNS, self.height)


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
class Imbibition:
    """Water drawn into dry soil from a face of constant head, without gravity: x_f = √(2 k h0 t/n).

    The face is the end of a column of water that moves along with it: what is pressed with ρ g h0 there has lost none
    of it where it enters the soil.  Fields as of `Infiltration`;  head : h0, m;  columns : of particles
    across;  ratio : of smoothing length to spacing, 2: water's particles lie 1/n as far apart along pores as across.
    """

    rows: int = 40
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
        """Held, dry soil in a periodic column, and water over it as much as fills its pores, under a piston."""
        spacing = self.height / self.rows
        standing = math.ceil(self.porosity * self.rows + 4) * spacing
        size = self.columns * spacing, self.height + standing
        soil = Frame(
            square_lattice((0.0, 0.0), (size[0], self.height), spacing), spacing**2, self.porosity, self.permeability
        )
        x = square_lattice((0.0, self.height), size, spacing)
        held = WATER * GRAVITY * self.head
        # At the start pressure falls to none where the soil begins
        pressure = held * (x[:, 1] - self.height) / standing
        return water_in(
            soil, x, pressure, size, spacing, self.sound_speed, Resistance(self.porosity), drained={"lid": held},
            ratio=self.ratio, cut=True, alpha=0.1,
        )  # fmt: skip

    def advance(self, both: Seepage) -> None:
        """One step, the face going along."""
        both.advance()
        (face,) = both.water.drains
        behind = both.water.layer.x[face.rows, 1]
        layers = len(behind) // self.columns
        # Rows of the face lie half a spacing and more behind it
        face.point = (0.0, float(behind.mean()) - 0.5 * layers * self.height / self.rows)

    def reached(self, both: Seepage) -> float:
        """Way (m) of the front."""
        return self.height - half_full(both, self.rows, self.columns, self.height)
