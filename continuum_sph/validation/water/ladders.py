"""Convergence of water: flows with exact answers at several spacings.  h is a fixed number of spacings.

Plain sums are exact on the lattice of the start (`continuum_sph.water.kernel_correction`), so that no error stays.
"""

from continuum_sph.validation.water.channels import channel_error
from continuum_sph.validation.water.flows import vortex_error
from continuum_sph.validation.water.hydrostatics import hydrostatic
from continuum_sph.validation.water.sound import sound_period
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()
ACROSS = (10, 20, 40)


@LADDERS.ladder(
    "water.taylor_green",
    title="Largest relative error of the speed of decaying vortices, Reynolds number 100, with all corrections",
    along="particles in a period",
    levels=(20, 28, 40, 56),
    expected=1.0,
    within=0.0,
    because="corrected sums are of second order, shifting of first: first order at least",
)
def vortices(across: float) -> float:
    """Until 0.67 of the speed is left."""
    return vortex_error(int(across))


def _channel(kind: str) -> None:
    """The ladder of a channel that starts up."""

    @LADDERS.ladder(
        f"water.{kind}_start_up",
        title=f"Largest error over the final speed of plane {kind.capitalize()} flow that starts up, at five times",
        along="particles across",
        levels=ACROSS,
        expected=1.0,
        within=0.0,
        because="smoothing is of second order; near walls, where neighbours are of two kinds, sums are of first: first"
        " order at least",
    )
    def error(across: float) -> float:
        """Error of the channel with corrected gradients."""
        return channel_error(kind, int(across))


for flow in ("poiseuille", "couette"):
    _channel(flow)


@LADDERS.ladder(
    "water.pressure_at_rest",
    title="Largest error of pressure of a column at rest after 4 s, over that at the floor",
    along="rows of particles",
    levels=ACROSS,
    because="no order is expected: pressure is right to the weight of half of the row at the surface, 0.5/N, but"
    " artificial viscosity falls with the spacing, so a finer column comes to rest later",
)
def pressure(rows: float) -> float:
    """Largest error of pressure over that at the floor after 4 s, with corrected gradients."""
    return hydrostatic(4.0, rows=int(rows))[0]


@LADDERS.ladder(
    "water.period_of_sound",
    title="Relative error of the period of a standing wave",
    along="particles in a wave",
    levels=(16, 32, 64),
    expected=2.0,
    within=0.1,
    because="sums that are exact on the lattice smooth over h, which is of second order",
)
def sound(across: float) -> float:
    """Period over that of the continuous wave, less 1, without corrected gradients."""
    return abs(sound_period(int(across))[0] / 0.1 - 1.0)
