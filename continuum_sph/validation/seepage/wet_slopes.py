"""Endless layers of saturated soil on a slope, in still water and with water that seeps along them.  SI.

Without dilatancy soil shears along a slope where τ = σ' sin φ.  In still water its weight less buoyancy both drives and
holds, (1 - n)(ρ_s - ρ_w) g = γ', so the limit is tan β = sin φ as in air.  Water that flows along the slope with its
surface in that of the soil has no pressure to give along it: the whole weight γ_sat drives and γ' holds,
tan β = γ'/γ_sat sin φ, about half of it.  Beyond, soil and water go together: what drives less what holds over γ_sat/g.

In a layer that repeats along the slope still water has no level.  Its pressure along the slope is put as the force that
it is: none on the water, of its weight, and -(1 - n) ρ_w g sin β on the soil.
"""

import functools
import math
from dataclasses import dataclass, replace

from continuum_sph.builders.parts.soil import geostatic
from continuum_sph.seepage import Resistance, Seepage
from continuum_sph.soil import Material, Rate, SoilFlow
from continuum_sph.validation.seepage.setups import ALPHA, COLUMNS, GRAINS, WATER, water_in
from continuum_sph.validation.soil.setups import in_tank
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()


@dataclass(frozen=True)
class WetSlope:
    """degrees : β;  seeping : water flows along the slope, else it is still;  rows : particles over the depth;
    friction : sin φ;  permeability m/s;  stiffness : E, Pa;  sound_speed : of the water, m/s;  depth : m;
    grains : their density, kg/m³;  poisson : ν;  rate : how friction grows with the rate of shear, None where it does
    not;  bounded : the soil's damping."""

    degrees: float
    seeping: bool
    rows: int = 20
    friction: float = 0.5
    porosity: float = 0.4
    permeability: float = 1e-2
    stiffness: float = 2e6
    sound_speed: float = 45.0
    depth: float = 1.0
    grains: float = GRAINS
    poisson: float = 0.3
    rate: Rate | None = None
    bounded: bool = False

    @property
    def buoyant(self) -> float:
        """Buoyant density of the soil, γ'/g, kg/m³."""
        return (1.0 - self.porosity) * (self.grains - WATER)

    @property
    def whole(self) -> float:
        """Density of the saturated soil, γ_sat/g, kg/m³."""
        return self.porosity * WATER + (1.0 - self.porosity) * self.grains

    def driving(self, seeping: bool) -> float:
        """Weight that drives over that which holds."""
        return self.whole / self.buoyant if seeping else 1.0

    def limit(self) -> float:
        """Slope from which on it shears, degrees."""
        return math.degrees(math.atan(self.friction / self.driving(self.seeping)))

    def acceleration(self, seeping: bool | None = None) -> float:
        """Acceleration of soil and water beyond the limit, m/s², negative below it;  seeping: other than its own."""
        tilt, seeping = math.radians(self.degrees), self.seeping if seeping is None else seeping
        return (
            GRAVITY * self.buoyant / self.whole
            * (self.driving(seeping) * math.sin(tilt) - self.friction * math.cos(tilt))
        )  # fmt: skip

    def shown(self, acceleration: float, seeping: bool | None = None) -> float:
        """Friction τ/σ' that slows the layer, by its acceleration (m/s²);  seeping : other than its own."""
        tilt, seeping = math.radians(self.degrees), self.seeping if seeping is None else seeping
        slowed = acceleration / (GRAVITY * self.buoyant / self.whole)
        return (self.driving(seeping) * math.sin(tilt) - slowed) / math.cos(tilt)

    def build(self) -> tuple[Seepage, SoilFlow]:
        """Both layers, and the soil of them, at rest with the stress of the weight across."""
        spacing, tilt, n, depth = self.depth / self.rows, math.radians(self.degrees), self.porosity, self.depth
        size = (COLUMNS * spacing, 2.0 * depth)
        solid = (1.0 - n) * self.grains
        material = Material(self.stiffness, solid, self.poisson, sin_friction=self.friction, porosity=n, rate=self.rate)
        x = square_lattice((0.0, 0.0), (size[0], depth), spacing)
        across = GRAVITY * math.cos(tilt)
        # σ_xx = σ_yy is what shearing along the slope leads to: soil that is not there yet contracts and presses water.
        stress = geostatic(depth - x[:, 1], replace(material, density=self.buoyant), across, 1.0)
        ground = in_tank(
            x, stress, size, spacing, material, gravity=GRAVITY, tilt=tilt, sides="none", bounded=self.bounded
        )
        if not self.seeping:
            along = GRAVITY * math.sin(tilt) * self.buoyant / material.density
            ground.law = replace(ground.law, gravity=(along, -across))
        both = water_in(
            ground, x.copy(), WATER * across * (depth - x[:, 1]), size, spacing, self.sound_speed, Resistance(n),
            grains=self.grains, permeability=self.permeability, gravity=across, modulus=material.column_modulus,
            alpha=ALPHA, cut=True,
        )  # fmt: skip
        if self.seeping:
            both.water.law = replace(both.water.law, gravity=(GRAVITY * math.sin(tilt), -across))
        both.start()
        return both, ground

    def slides(self, early: float = 0.2, late: float = 0.6) -> tuple[float, float]:
        """(mean acceleration of the soil between two times, m/s²;  its mean speed at the second, m/s)."""
        both, ground = self.build()
        soil, marks = ground.soil, []
        for time in (early, late):
            while both.time < time:
                both.advance()
            marks.append((both.time, float(soil.v[: soil.soil, 0].mean())))
        (t0, v0), (t1, v1) = marks
        return (v1 - v0) / (t1 - t0), v1


STILL, SEEPING = WetSlope(28.0, False), WetSlope(16.0, True)
RESTING = (WetSlope(25.0, False), WetSlope(12.0, True))


@functools.cache
def slides(given: WetSlope) -> tuple[float, float]:
    """(acceleration, m/s², and speed, m/s) of a wet layer on a slope."""
    return given.slides()


def friction(given: WetSlope, seeping: bool | None = None) -> float:
    """Friction that slows a wet layer, τ/σ', by the acceleration that it shows;  seeping: as if it were so."""
    return given.shown(slides(given)[0], seeping)


def at_three_spacings(*given: WetSlope) -> Measured:
    """Friction of each with 20, 40 and 80 rows, beside sin φ."""
    found = [friction(replace(it, rows=rows)) for it in given for rows in (20, 40, 80)]
    return Measured.relative(given[0].friction, found)


WITHIN = 0.02
HELD = "2 % as required; half of the row at the floor, of 20, is held by it, which is 0.5/20 of what drives"


@VALIDATIONS.row(
    "continuum.soil_slides_under_water",
    source="exact: buoyancy takes the same share of what drives and of what holds: limit tan β = sin φ, 26.6°, as in "
    "air; on 28° a layer goes with γ'/γ_sat g (sin β - sin φ cos β)",
    because=HELD,
    tolerance=WITHIN,
    slow=True,
)
def still_row() -> Measured:
    """Friction τ/σ' of an endless layer on a slope in still water, with 20, 40 and 80 rows, by its acceleration."""
    return at_three_spacings(STILL)


@VALIDATIONS.row(
    "continuum.soil_slides_with_seepage",
    source="exact: water that flows along a slope bears none of its weight: limit tan β = γ'/γ_sat sin φ, 14.0°; on "
    "16° a layer goes with g (sin β - γ'/γ_sat sin φ cos β)",
    because=HELD,
    tolerance=WITHIN,
    slow=True,
)
def seeping_row() -> Measured:
    """The same of an endless layer with water flowing along it."""
    return at_three_spacings(SEEPING)


@VALIDATIONS.row(
    "continuum.soil_slides_wet_with_bounded_damping",
    source="exact: both limits above; damping that is bounded, and pores that swell as the stress of soil takes it to",
    because="half of the 2 % that is required, chosen so that layers whose pores swell by sums over the soil's mean "
    "velocity fail: 1.5 and 2.3 % off with 20 rows",
    tolerance=0.5 * WITHIN,
    slow=True,
)
def bounded_row() -> Measured:
    """Friction of both layers with 20, 40 and 80 rows."""
    return at_three_spacings(*(replace(given, bounded=True) for given in (STILL, SEEPING)))


@VALIDATIONS.row(
    "continuum.soil_rests_below_its_wet_limits",
    source="exact: 25° in still water and 12° with seepage lie below 26.6° and 14.0°",
    because="speed of what slides for 0.6 s at a fortieth of g sin 12°: half of the row at the floor is soft",
    tolerance=0.6 * GRAVITY * math.sin(math.radians(12.0)) / 40,
    slow=True,
)
def resting_row() -> Measured:
    """Speed of two layers below their limits after 0.6 s, m/s."""
    return Measured.absolute(0.0, [abs(slides(given)[1]) for given in RESTING])
