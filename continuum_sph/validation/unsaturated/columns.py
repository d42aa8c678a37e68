"""Columns of held soil in which water rises, sinks and drains, held to Richards' equation.  SI."""

from dataclasses import dataclass, field

import numpy as np

from continuum_sph.seepage.overlap import Overlap
from continuum_sph.unsaturated import Moisture, Outside, VanGenuchten
from continuum_sph.unsaturated.outside import Level
from continuum_sph.unsaturated.richards import EFFECTIVE, HEAD, PRESSURE, properties_of, unity
from continuum_sph.validation.unsaturated.richards import Column, VanGenuchtenMualem, relaxed
from continuum_sph.water.bundles import Neighbours
from continuum_sph.water.smoothing import SUPPORT, WENDLAND
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList, square_lattice

WATER = 1000.0  # kg/m³
COLUMNS, RATIO = 8, 1.3
BEYOND = 3  # rows of places below and above the soil


@dataclass(frozen=True)
class Soaking:
    """A column of soil, periodic across, that starts with the pressure heads of ``initial`` and is open to water at its
    bottom, its top, or both.

    rows : over the height (m);  alpha 1/m, n, residual : van Genuchten's;  permeability m/s;  sound_speed : of the
    water, m/s;  dry : S_e at the start, 0: full, at rest under no load;  below, above : level (m) of the water under
    the bottom or on the top, None: closed below, air above;  relative : else k_r = 1.
    """

    rows: int = 20
    height: float = 0.6
    alpha: float = 5.0
    n: float = 3.0
    residual: float = 0.1
    permeability: float = 1e-3
    porosity: float = 0.4
    sound_speed: float = 25.0
    dry: float = 0.15
    below: float | None = None
    above: float | None = None
    relative: bool = True

    @property
    def spacing(self) -> float:
        """Spacing of the particles, m."""
        return self.height / self.rows

    def start(self, retention: VanGenuchten, y: Floats) -> Floats:
        """Pressure heads (m) at the start."""
        return np.full(len(y), -float(retention.suction(self.dry))) if self.dry > 0.0 else np.zeros(len(y))

    def build(self) -> "Run":
        """The column, about to be let go."""
        spacing, size = self.spacing, (COLUMNS * self.spacing, self.height)
        law = VanGenuchten(self.alpha, self.n, self.residual, WATER * GRAVITY, WATER * self.sound_speed**2)
        x = square_lattice((0.0, 0.0), size, spacing)
        count, h = len(x), RATIO * spacing
        margin = (BEYOND + 1) * spacing
        box = (0.0, -margin), (size[0], size[1] + margin), (True, False)
        pairs = PairList(count, 0.0, *box, full=True)
        pairs.build(x, np.full(count, h))
        near = Neighbours(pairs.start, pairs.start[1:], pairs.partner, size[0], 0.0, WENDLAND, h)
        areas = np.full(count, spacing**2)
        properties = properties_of(WATER, GRAVITY, law, spacing, unity(WENDLAND, RATIO))
        if not self.relative:
            properties = properties._replace(m=0.0)
        water = Moisture(law, properties, (1.0 - self.porosity) * areas, np.full(count, self.permeability), self.porosity)
        water.place(x, areas)
        water.fill(WATER * GRAVITY * self.start(law, x[:, 1]))
        places = square_lattice((0.0, -BEYOND * spacing), (size[0], self.height + BEYOND * spacing), spacing)
        rows = self.rows + 2 * BEYOND
        zero = np.zeros(1)
        levels = [
            Level(name, 0.0, size[0], bottom, zero, np.array([level]))
            for name, level, bottom in (("below", self.below, -margin), ("above", self.above, self.height))
            if level is not None
        ]
        overlap = Overlap(len(places), count, h, 0.0, *box)
        outside = Outside(places, rows, COLUMNS, spacing, overlap, levels)
        outside.look(x, areas, 0.0)
        assert SUPPORT * RATIO <= BEYOND
        return Run(self, water, near, outside)

    def reference(self, seconds: float, cells: int = 300) -> tuple[Floats, Floats]:
        """(heights y, effective saturations) after ``seconds`` by finite differences."""
        soil = VanGenuchtenMualem(self.alpha, self.n, self.residual, constant=not self.relative)
        law = VanGenuchten(self.alpha, self.n, self.residual, WATER * GRAVITY, WATER * self.sound_speed**2)
        top = None if self.above is None else self.above - self.height
        column = Column(soil, self.height, cells, self.permeability, self.porosity, self.below, top)
        head = relaxed(column, self.start(law, column.y), seconds, seconds / 400.0, seconds / 1e5)
        return column.y, (soil.saturation(head) - self.residual) / (1.0 - self.residual)


@dataclass
class Run:
    """A column in time."""

    given: Soaking
    water: Moisture
    near: Neighbours
    outside: Outside
    time: float = 0.0
    stages: int = field(default=0)

    def advance(self, seconds: float) -> "Run":
        """Go on for ``seconds``."""
        self.stages += self.water.advance(seconds, self.near, self.outside.outer)
        self.time += seconds
        return self

    def profile(self) -> tuple[Floats, Floats]:
        """(heights of the rows, their mean effective saturations)."""
        given = self.given
        found = self.water.state[:, EFFECTIVE].reshape(given.rows, COLUMNS).mean(axis=1)
        return (np.arange(given.rows) + 0.5) * given.spacing, found

    @property
    def heads(self) -> Floats:
        """H of the pieces of soil, (s,) m; a view."""
        return self.water.state[:, HEAD]

    @property
    def pressures(self) -> Floats:
        """p of the pieces of soil, (s,) Pa; a view."""
        return self.water.state[:, PRESSURE]


def error(given: Soaking, seconds: float) -> float:
    """Mean distance of the effective saturations of ``given`` from those of finite differences after ``seconds``."""
    run = given.build().advance(seconds)
    y, found = run.profile()
    at, known = given.reference(seconds)
    return float(np.abs(found - np.interp(y, at, known)).mean())
