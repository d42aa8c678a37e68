"""Plane flow between plates that starts up: Poiseuille and Couette (Morris, Fox & Zhu 1997).  SI."""

import numpy as np

from continuum_sph.validation.water.kernels import SPREAD
from continuum_sph.validation.water.setups import run_until
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import PairList, square_lattice

VALIDATIONS = Validations()


def couette(y: Floats, time: float, gap: float, speed: float, viscosity: float) -> Floats:
    """Velocity (m/s) between a wall at rest (y = 0) and one that starts at ``speed`` (y = gap); ν in m²/s.

    Morris, Fox & Zhu 1997, eq. 35.
    """
    u = speed * y / gap
    for n in range(1, 200):
        decay = np.exp(-viscosity * (n * np.pi / gap) ** 2 * time)
        u = u + 2.0 * speed / (n * np.pi) * (-1) ** n * np.sin(n * np.pi * y / gap) * decay
    return u


def poiseuille(y: Floats, time: float, gap: float, force: float, viscosity: float) -> Floats:
    """Velocity (m/s) between walls at rest a time after a body ``force`` (m/s²) sets in; ν in m²/s.

    Morris, Fox & Zhu 1997, eq. 36.
    """
    u = force / (2.0 * viscosity) * y * (gap - y)
    for n in range(200):
        k = (2 * n + 1) * np.pi / gap
        u = u - 4.0 * force / (viscosity * gap * k**3) * np.sin(k * y) * np.exp(-viscosity * k * k * time)
    return u


def channel(
    gap: float,
    across: int,
    viscosity: float,
    sound_speed: float,
    *,
    force: float = 0.0,
    lid_speed: float = 0.0,
    corrected: bool = True,
) -> Flow:
    """Liquid of density 1000 between two plates that hold it, periodic along them.

    gap : m;  across : particles;  viscosity : ν, m²/s;  force : along the plates, m/s²;  lid_speed : of the upper, m/s;
    corrected : gradients.
    """
    spacing, density, layers = gap / across, 1000.0, 3
    length = 8 * spacing  # two cutoffs of 2h + skin and a little
    x = square_lattice((0.0, 0.0), (length, gap), spacing)
    walls = tank_walls(length, gap, spacing, layers, sides=False, lid=True)
    smoothing = Smoothing("wendland", RATIO * spacing)
    law = Law(
        smoothing, spacing, (Fluid(Tait(density, sound_speed), viscosity * density),), (force, 0.0),
        diffusion=0.0, sticky=True, cut=False, corrected=corrected,
    )  # fmt: skip
    v = np.zeros((len(x) + len(walls), 2))
    v[len(x) :, 0] = np.where(walls[:, 1] > gap, lid_speed, 0.0)
    count = len(v)
    layer = Layer(len(x), np.concatenate((x, walls)), v, np.full(count, density * spacing**2), np.full(len(x), density))
    margin = layers * spacing
    pairs = PairList(count, 0.2 * smoothing.length, (0.0, -margin), (length, gap + margin), (True, False), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def speed_profile(flow: Flow) -> tuple[Floats, Floats]:
    """Height (m) and velocity along the plates (m/s) of the liquid of a channel."""
    layer = flow.layer
    return layer.x[: layer.fluid, 1], layer.v[: layer.fluid, 0]


def channel_error(kind: str, across: int, viscosity_assumed: float = 1e-6, corrected: bool = True) -> float:
    """Largest error over five times, over the final speed, of plane flow starting up; gap 1 mm, ν 1e-6 m²/s."""
    gap, nu, speed = 1e-3, 1e-6, 1.25e-5
    if kind == "poiseuille":
        flow = channel(gap, across, nu, 1e-3, force=1e-4, corrected=corrected)
    else:
        flow = channel(gap, across, nu, 1e-3, lid_speed=speed, corrected=corrected)
    worst = 0.0
    for time in (0.0225, 0.045, 0.1125, 0.225, 1.0):
        run_until(flow, time)
        y, u = speed_profile(flow)
        if kind == "poiseuille":
            exact = poiseuille(y, flow.time, gap, 1e-4, viscosity_assumed)
        else:
            exact = couette(y, flow.time, gap, speed, viscosity_assumed)
        worst = max(worst, float(np.abs(u - exact).max()) / speed)
    return worst


@VALIDATIONS.row(
    "continuum.poiseuille_start_up",
    source="Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214, figure 1",
    because="walls hold a mean over the kernel, which slips by SPREAD h² u'', u'' = 8 V/gap²; left out: what goes as "
    "h³, 1e-3",
    tolerance=SPREAD * 8.0 * (RATIO / 20) ** 2 + 1e-3,
)
def poiseuille_row() -> Measured:
    """Largest error over the final speed, 20 particles across."""
    return Measured.absolute(0.0, channel_error("poiseuille", 20))


@VALIDATIONS.row(
    "continuum.couette_start_up",
    source="Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214, figure 3",
    because="the next term of the viscous sum, (SPREAD/2) h² ν u'''', adds (SPREAD/2) h²/(ν t) t² ∂²u/∂t², < 0.275 V, "
    "most at the first time",
    tolerance=0.275 * 0.5 * SPREAD * (RATIO / 20) ** 2 / 0.0225,
)
def couette_row() -> Measured:
    """Largest error over the speed of the plate, 20 particles across."""
    return Measured.absolute(0.0, channel_error("couette", 20))
