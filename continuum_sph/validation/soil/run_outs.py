"""How far columns of dry soil run out that are let go, against experiments in channels.

A column H high stands between a slippery wall and a plate that vanishes; its base L is rough.  Laws are those of Lube,
Huppert, Sparks & Freundt (Phys. Rev. E 72 (2005) 041301: sand, sugar, rice) and of Lajeunesse, Monnier & Homsy (Phys.
Fluids 17 (2005) 103302: glass beads), with the constants that Lagrée, Staron & Popinet (J. Fluid Mech. 686 (2011) 378)
give: (L∞ - L)/L = c a below a hand-over, d a^(2/3) above, a = H/L.

Nothing is fitted.  A slope of a material lies at its angle of repose, and soil without dilatancy slides on slopes
beyond tan β = sin φ, so sin φ is the tangent of that angle: 30° of sand and 22° of glass beads, as is usual of them
(the experiments' own angles were not looked up).
"""

import functools
import math
from dataclasses import dataclass

import numpy as np

from continuum_sph.builders.parts.soil import geostatic
from continuum_sph.soil import Material, Rate, SoilFlow
from continuum_sph.validation.soil.setups import in_tank, run_until
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

ASPECTS = (0.5, 1.0, 2.0, 4.0)
"""H/L."""
ROWS = 40
LARGENESS = 0.1  # m, root of a column's area: nothing hangs on it but where friction grows with the rate of shear
DENSITY = 1600.0  # kg/m³
STIFFNESS = 500.0  # E over ρ g H: strains of 2e-3
SECONDS = 5.0  # √(H/g): from 4 to 5 the front goes on by a hundredth at most
APART = 1.5  # spacings: particles farther ahead of the next do not belong to the front


@dataclass(frozen=True)
class Grains:
    """A material and its law of run-out.

    repose : angle of a slope that it comes to rest on, degrees;  squat, tall : c and d;  hand_over : a where one law
    gives way to the other.
    """

    repose: float
    squat: float
    tall: float
    hand_over: float

    def law(self, aspect: float) -> float:
        """(L∞ - L)/L of an experiment with an ``aspect`` H/L."""
        return self.squat * aspect if aspect < self.hand_over else self.tall * aspect ** (2.0 / 3.0)


SAND = Grains(30.0, 1.2, 1.9, 2.3)
BEADS = Grains(22.0, 1.8, 2.3, 3.0)


def faster(grains: Grains, slow: float, fast: float, inertial_number: float, diameter: float) -> Rate:
    """Friction of ``grains`` that grows by as much as from a slope of ``slow`` to one of ``fast``, degrees;
    diameter : m."""
    growth = math.tan(math.radians(fast)) - math.tan(math.radians(slow))
    return Rate(min(1.0, math.tan(math.radians(grains.repose)) + growth), inertial_number, diameter)


RUBBING_BEADS = faster(BEADS, 20.90, 32.76, 0.279, 1e-3)
"""Glass beads of 1 mm: Jop, Forterre & Pouliquen, Nature 441 (2006) 727."""
RUBBING_SAND = faster(SAND, 27.0, 43.4, 1.1, 0.8e-3)
"""Sand of 0.8 mm: Forterre & Pouliquen, J. Fluid Mech. 486 (2003) 21: β 0.65, L 2.03 d, without the offset of their
law; I0 = 5 β d/(2 L √(φ cos θ)) as Jop et al. have it, with a solid fraction φ of 0.6."""


PLATES = 2.0 * math.tan(math.radians(10.4)) / 0.045
"""2 tan δ/W, 1/m, of glass beads on glass (Jop, Forterre & Pouliquen, J. Fluid Mech. 541 (2005) 167) in the channel of
Lajeunesse et al., taken for 45 mm wide (not looked up)."""


def let_go(
    aspect: float, rows: int, repose: float, rate: Rate | None = None, plates: float | None = None
) -> tuple[SoilFlow, float, float]:
    """(a column at its release, its base m, its spacing m): ``rows`` to the root of its area, ``aspect`` H/L,
    ``repose`` degrees, ``rate`` of its friction;  plates : 2 tan δ/W, 1/m, of side walls beside which damping is
    bounded, so that nothing else brakes it."""
    height = LARGENESS * math.sqrt(aspect)
    spacing = height / round(rows * math.sqrt(aspect))
    base = spacing * round(height / aspect / spacing)
    stiffness = STIFFNESS * DENSITY * GRAVITY * height
    material = Material(stiffness, DENSITY, sin_friction=math.tan(math.radians(repose)), rate=rate)
    x = square_lattice((0.0, 0.0), (base, height), spacing)
    tank = (base * (3.0 + 4.0 * aspect), 1.3 * height)
    flow = in_tank(
        x, geostatic(height - x[:, 1], material), tank, spacing, material,
        side_friction=plates or 0.0, bounded=plates is not None,
    )  # fmt: skip
    return flow, base, spacing


def front(x: Floats, spacing: float, from_place: float) -> float:
    """How far (m) soil at ``x`` (n, 2) m reaches, but for particles beyond a gap of `APART` spacings, looked for from
    ``from_place`` (m) on."""
    along = np.sort(x[:, 0])
    along = along[along > from_place]
    gaps = np.flatnonzero(np.diff(along) > APART * spacing)
    return float(along[gaps[0]] if len(gaps) else along[-1]) + 0.5 * spacing


@functools.cache
def run_out(
    aspect: float, repose: float, rows: int = ROWS, rate: Rate | None = None, plates: float | None = None
) -> float:
    """(L∞ - L)/L of soil with an angle of repose, degrees, a ``rate`` of its friction and ``plates`` as of `let_go`."""
    flow, base, spacing = let_go(aspect, rows, repose, rate, plates)
    run_until(flow, SECONDS * math.sqrt(LARGENESS * math.sqrt(aspect) / GRAVITY))
    return front(flow.soil.x[: flow.soil.soil], spacing, 0.5 * base) / base - 1.0


def run_outs(grains: Grains, rows: int = ROWS, rate: Rate | None = None) -> Floats:
    """Run-outs (4,) of columns of ``grains`` for `ASPECTS`, over those of the law;  rate : of their friction."""
    return np.array([run_out(aspect, grains.repose, rows, rate) / grains.law(aspect) for aspect in ASPECTS])


LOOSE = 0.5 * (SAND.tall * 2.0 ** (2.0 / 3.0) / (SAND.squat * 2.0) - 1.0)
"""What the laws leave open: half of what parts the two of sand at a = 2, where both are drawn."""
DEGREE = math.radians(1.0) * 2.0 / math.sin(math.radians(2.0 * BEADS.repose))
"""What a degree of the angle of repose, as well as it is known, is worth where run-out goes as its 1/tan."""


def run_out_row(name: str, grains: Grains, experiments: str) -> None:
    """Add the row of the run-outs of ``grains``, of which there are ``experiments``."""
    squat = f"{grains.squat:g} a to a = {grains.hand_over:g}"
    source = f"{experiments}; {squat}, {grains.tall:g} a^(2/3) beyond; {grains.repose:g}°"

    @VALIDATIONS.row(
        f"continuum.soil_runs_out_as_{name}",
        source=source,
        because="the laws are drawn through points that scatter: where one gives way to the other those of sand are "
        "26 % apart, of which half; angles of repose are known to a degree, 5 % of beads' run-out if it goes as 1/tan; "
        "root of the sum of squares",
        tolerance=math.hypot(LOOSE, DEGREE),
        slow=True,
    )
    def row() -> Measured:
        """Run-outs (L∞ - L)/L of columns of H/L 0.5, 1, 2 and 4, 40 rows to the root of their area."""
        return Measured.relative(
            [grains.law(aspect) for aspect in ASPECTS], [run_out(aspect, grains.repose) for aspect in ASPECTS]
        )


run_out_row("sand", SAND, "Lube et al. 2005: sand, sugar, rice in a channel")
run_out_row("beads", BEADS, "Lajeunesse et al. 2005: glass beads in a channel")


@VALIDATIONS.row(
    "continuum.soil_runs_out_between_plates",
    source="Lajeunesse et al. 2005: glass beads in a channel, 1.8 a to a = 3, 2.3 a^(2/3) beyond; friction that grows "
    "from 22° with the rate of shear (Jop et al. 2006), plates 45 mm apart that rub by tan 10.4° (Jop et al. 2005)",
    because="as of beads whose friction knows neither rate nor plates",
    tolerance=math.hypot(LOOSE, DEGREE),
    slow=True,
)
def plates_row() -> Measured:
    """Run-outs (L∞ - L)/L of columns of H/L 0.5, 1, 2 and 4, 40 rows to the root of their area, damping bounded."""
    return Measured.relative(
        [BEADS.law(aspect) for aspect in ASPECTS],
        [run_out(aspect, BEADS.repose, ROWS, RUBBING_BEADS, PLATES) for aspect in ASPECTS],
    )
