"""The soil as the water equations need it: positions, velocities and permeability of its grains."""

from dataclasses import dataclass, field

import numpy as np

from continuum_sph.seepage.sheet_pile import Foot
from continuum_sph.soil import SoilFlow
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.core.types import Floats

HEAVIEST = 1e300  # kg/m: stands for the infinite mass of soil that is held, as nothing times it is nothing


@parallel_kernel
def show_soil(x, v, mass, density, solid, grains, resisting, burden):
    """Overwrites ``burden`` (s, 8), all that water reads of a soil particle, in one cache line: place m, grains m²,
    resisting m s, mass kg/m, velocity m/s, volume with its pores m².

    density (s,), solid: see `Skeleton`."""
    for s in prange(mass.shape[0]):
        burden[s, 0] = x[s, 0]
        burden[s, 1] = x[s, 1]
        burden[s, 2] = grains[s]
        burden[s, 3] = resisting[s]
        burden[s, 4] = min(HEAVIEST, mass[s])
        burden[s, 5] = v[s, 0]
        burden[s, 6] = v[s, 1]
        burden[s, 7] = grains[s] * solid / density[s]


@parallel_kernel
def weigh(resisting, values, shown):
    """Overwrites ``shown`` (s, 2): ``values`` (s, 2) times ``resisting`` (s,) m s."""
    for s in prange(resisting.shape[0]):
        shown[s, 0] = resisting[s] * values[s, 0]
        shown[s, 1] = resisting[s] * values[s, 1]


@dataclass
class Skeleton:
    """Views of a soil's arrays, all (soil, …), and what water needs besides.

    x m;  v m/s;  acceleration m/s²;  force N/m, overwritten by water;  mass kg/m, infinite for soil that is held;
    density : of soil without its water, and ``solid``, of its grains, kg/m³: a particle's volume is that of its grains
    times solid over density;  grains : volume of solid, m² (per metre of depth), constant;  permeability : k, m/s;
    swelling (soil, 2) : see `soil.stress.deform`, None where pores swell by sums over the soil's mean velocity;  foot :
    of a pile, see `sheet_pile.Foot`, or None.
    """

    x: Floats
    v: Floats
    acceleration: Floats
    force: Floats
    mass: Floats
    density: Floats
    solid: float
    grains: Floats
    permeability: Floats
    swelling: Floats | None = None
    foot: Foot | None = None
    plain: Floats = field(init=False)  # grains/k, m s
    resisting: Floats = field(init=False)  # the same as water has it, with what a pile's foot makes of it
    held: bool = field(init=False)  # whether it cannot move, whatever acts on it
    burden: Floats = field(init=False)  # (soil, 8) what a water particle reads of its partners
    shown: Floats = field(init=False)  # (soil, 2) of these what it reads anew, times resisting

    def __post_init__(self) -> None:
        count = len(self.x)
        for name in ("v", "acceleration", "force"):
            assert getattr(self, name).shape == (count, 2), name
        for name in ("mass", "density", "grains", "permeability"):
            assert getattr(self, name).shape == (count,), name
        self.plain = self.grains / self.permeability
        self.resisting = self.plain.copy()
        self.held = bool(np.isinf(self.mass).any())
        self.burden, self.shown = np.zeros((count, 8)), np.zeros((count, 2))

    def resist(self) -> None:
        """Take up how the soil resists where it is now."""
        if self.foot is not None:
            self.foot.ease(self.x, self.plain, self.resisting)

    def show(self) -> None:
        """Take places and velocities of now into ``burden``."""
        self.resist()
        show_soil(self.x, self.v, self.mass, self.density, self.solid, self.grains, self.resisting, self.burden)

    def weigh(self, values: Floats) -> Floats:
        """``values`` (soil, 2) times ``resisting``, in ``shown``."""
        weigh(self.resisting, values, self.shown)
        return self.shown

    @property
    def count(self) -> int:
        """Number of soil particles."""
        return len(self.x)


def skeleton_of(flow: SoilFlow, density: float, permeability: Floats | float) -> Skeleton:
    """The skeleton of a soil flow whose grains have ``density`` (kg/m³) and which has ``permeability`` k (m/s)."""
    soil, n = flow.soil, flow.soil.soil
    k = np.broadcast_to(np.asarray(permeability, np.float64), n).copy()
    mass = soil.mass[:n]
    own = soil.density[:n]
    skeleton = Skeleton(soil.x[:n], soil.v[:n], soil.acceleration, soil.force, mass, own, density, mass / density, k)
    if flow.law.bounded:
        skeleton.swelling = soil.swelling = np.zeros((n, 2))
    return skeleton


class Frame:
    """Soil that does not move: in the place of a soil flow where only the water matters.

    x : (n, 2) m;  volume : of a particle, grains and pores, m²;  porosity;  permeability : k, m/s.
    """

    next_step = np.inf

    def __init__(self, x: Floats, volume: float, porosity: float, permeability: Floats | float) -> None:
        self.step, self.time = 0, 0.0
        count = len(x)
        v, acceleration, force = (np.zeros((count, 2)) for _ in range(3))
        grains = np.full(count, (1.0 - porosity) * volume)
        k = np.broadcast_to(np.asarray(permeability, np.float64), count).copy()
        share = np.full(count, 1.0 - porosity)
        self.skeleton = Skeleton(x, v, acceleration, force, np.full(count, np.inf), share, 1.0, grains, k)

    def start(self) -> None:
        """Do nothing: held ground has no accelerations."""

    def begin(self, step: float) -> None:
        """Do nothing: held ground does not move."""

    def strain(self, step: float) -> None:
        """Do nothing: held ground does not deform."""

    def push(self) -> None:
        """Do nothing: held ground is not accelerated."""

    def end(self, step: float) -> None:
        """Do nothing: held ground has no velocity."""
