"""Columns of held soil in which water rises, sinks and drains, held to Richards' equation.  SI.

Errors are mean distances of S_e over the height from finite differences on 300 cells.  A front is known to a row: of N
rows that is a mean error of half a row, 0.5/N, at most.  K between neighbours up to 2.6 rows apart is a mean, so fronts
are smeared by rows, too: the first order in 1/N.  Profiles without a front are of the second.
"""

import functools
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from continuum_sph.seepage.overlap import Overlap
from continuum_sph.unsaturated import Moisture, Outside, VanGenuchten
from continuum_sph.unsaturated.outside import Level
from continuum_sph.unsaturated.richards import EFFECTIVE, HEAD, properties_of, unity
from continuum_sph.validation.unsaturated.richards import Column, VanGenuchtenMualem, relaxed
from continuum_sph.water.bundles import Neighbours
from continuum_sph.water.smoothing import RATIO, SUPPORT, WENDLAND
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import PairList, square_lattice

VALIDATIONS = Validations()
WATER = 1000.0  # kg/m³
COLUMNS = 8
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
        water = Moisture(
            law, properties, (1.0 - self.porosity) * areas, np.full(count, self.permeability), self.porosity
        )
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
        part = (soil.saturation(head) - self.residual) / (1.0 - self.residual)
        return column.y, np.asarray(part, np.float64)


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
        heights = np.asarray((np.arange(given.rows) + 0.5) * given.spacing, np.float64)
        return heights, np.asarray(found, np.float64)

    @property
    def heads(self) -> Floats:
        """H of the pieces of soil, (s,) m; a view."""
        return self.water.state[:, HEAD]


def error(given: Soaking, seconds: float) -> float:
    """Mean distance of the effective saturations of ``given`` from those of finite differences after ``seconds``."""
    run = given.build().advance(seconds)
    y, found = run.profile()
    at, known = given.reference(seconds)
    return float(np.abs(found - np.interp(y, at, known)).mean())


RISING, SINKING = Soaking(below=0.0), Soaking(above=0.65)
DRAINING = Soaking(dry=0.0, below=0.0)
RISEN, SUNK, DRAINED = 120.0, 60.0, 300.0
"""s: the front is half-way up; has sunk through two thirds; nearly all has drained that does."""
SPACINGS = (10, 20, 40)  # rows


@functools.cache
def errors(given: Soaking, seconds: float) -> tuple[float, ...]:
    """`error` at the three spacings, coarse to fine."""
    return tuple(error(replace(given, rows=rows), seconds) for rows in SPACINGS)


def held(found: tuple[float, ...]) -> Measured:
    """Errors over half a row's share of the height, none of them more than half of that of twice the spacing."""
    shares = [error * rows / 0.5 for error, rows in zip(found, SPACINGS, strict=True)]
    falls = [fine / coarse for coarse, fine in pairwise(found)]
    worst = max(*(share for share in shares), *(fall / FALL for fall in falls))
    return Measured([0.0] * len(found), list(found), worst)


FALL = 0.65
"""Of the error that is left at half the spacing: a half of the first order, and a front's place within its row."""
BECAUSE = (
    "the mean error over half a row's share of the height, 0.5/N, and the fall of the error at half the spacing over "
    "0.65, a half for the first order and a front's place within its row, are at most 1"
)


@VALIDATIONS.row(
    "continuum.capillary_rise",
    source="Richards' equation by finite differences (Celia et al. 1990), van Genuchten 1980, Mualem 1976",
    because=BECAUSE,
    tolerance=1.0,
    slow=True,
)
def rise_row() -> Measured:
    """Errors of S_e as water rises into soil of S_e 0.15 over a water table; 10, 20, 40 rows."""
    return held(errors(RISING, RISEN))


@VALIDATIONS.row(
    "continuum.unsaturated_infiltration",
    source="Richards' equation by finite differences (Celia et al. 1990), van Genuchten 1980, Mualem 1976",
    because=BECAUSE,
    tolerance=1.0,
    slow=True,
)
def infiltration_row() -> Measured:
    """Errors of S_e as water that stands 5 cm on soil of S_e 0.15 sinks in; 10, 20, 40 rows."""
    return held(errors(SINKING, SUNK))


@VALIDATIONS.row(
    "continuum.drainage",
    source="Richards' equation by finite differences (Celia et al. 1990), van Genuchten 1980, Mualem 1976",
    because=BECAUSE + "; without a front the error is of the second order and far below",
    tolerance=1.0,
    slow=True,
)
def drainage_row() -> Measured:
    """Errors of S_e as full soil drains to a water table at its floor; 10, 20, 40 rows."""
    return held(errors(DRAINING, DRAINED))
