"""Parameters of the particles of a flow, and the time steps that they allow."""

import math
from dataclasses import dataclass
from functools import cached_property

from continuum_sph.water.eos.law import StateLaw
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.kernel_correction import lattice_gradient, lattice_shear
from continuum_sph.water.smoothing import Smoothing
from continuum_sph.water.viscosity import STIFFER

RULES = ("sound", "acceleration", "viscosity", "capillarity")
ALTERNATING = 3.5
"""h² Σ V |∇W|/r = 2π h² W(0) of Wendland's kernel (of the cubic spline 2.9): 2 δ c0/h times this is the rate at which
diffusion takes down the shortest waves of density, the fastest."""
CALMED = 2.0 / 7.0
"""Largest share s of such a wave that one step may take: with extrapolated rates (`step`) it changes by z a step,
z³ - z² + s (3z² - 3z + 1) = 0, whose root z = -1 is at s = 2/7, and it grows beyond."""


@dataclass(frozen=True)
class Law:
    """Parameters of the particles of a flow, in SI.

    smoothing : kernel and h;  spacing : of the particles, m;  fluids : by the numbers that particles carry;
    gravity : (x, y) m/s²;  alpha, beta, softening : artificial viscosity;  diffusion : δ, and noise, what it takes for
    noise (`density.NAMES`), noise_speed (m/s) at which pairs close in noise that counts, 0: all does (`density`);
    xsph : ε;  shifting : s;  corrected : gradients of `kernel_correction`, else plain ones times
    ``lattice``;  varied : h follows density (eq. 52);
    filter_every : steps between filters of density (eq. 27), 0 never;  sticky : no-slip walls;  images : image walls
    (eqs 50, 51), else walls that take the pressure from the fluid;  tension : σ between two fluids, N/m;
    cut : no negative pressure;  courant : the 0.25 of eq. 49.
    """

    smoothing: Smoothing
    spacing: float
    fluids: tuple[Fluid, ...]
    gravity: tuple[float, float]
    alpha: float = 0.0
    beta: float = 0.0
    softening: float = 0.01
    diffusion: float = 0.1
    noise: int = 1
    noise_speed: float = 0.0
    xsph: float = 0.0
    shifting: float = 0.0
    corrected: bool = False
    varied: bool = False
    filter_every: int = 0
    sticky: bool = False
    images: bool = False
    tension: float = 0.0
    cut: bool = True
    courant: float = 0.25

    @property
    def state(self) -> StateLaw:
        """State law of the first fluid."""
        return self.fluids[0].state

    @property
    def quickest(self) -> float:
        """Largest speed of sound of the fluids at rest, m/s."""
        return max(fluid.state.sound_speed for fluid in self.fluids)

    @property
    def interface_speed(self) -> float:
        """√{(K_a + K_b)/2ρ_a}, K = ρ c² bulk moduli: sound of a fluid's particles that have another's for half of their
        neighbours, m/s, the largest of any two; 0 for one fluid.

        Gas between water moves with its own mass against the water's stiffness: its own sound would allow steps that
        let an interface of 1000 : 1 make energy out of nothing.
        """
        states = [fluid.state for fluid in self.fluids]
        moduli = [state.density * state.sound_speed**2 for state in states]
        return max(
            (
                (0.5 * (moduli[a] + moduli[b]) / states[a].density) ** 0.5
                for a in range(len(states))
                for b in range(len(states))
                if a != b
            ),
            default=0.0,
        )

    @cached_property
    def lattice(self) -> float:
        """What plain gradients are multiplied by: exact for linear fields on the square lattice of the start."""
        return float(lattice_gradient(self.smoothing.kind, self.smoothing.length, self.spacing))

    @cached_property
    def shear(self) -> float:
        """Shear modulus over pressure of water whose lattice was not stirred yet: `kernel_correction.lattice_shear`."""
        if self.corrected:
            return 0.0
        return float(lattice_shear(self.smoothing.kind, self.smoothing.length, self.spacing))

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Constants of `limits`: number of the first bound, least c/h (1/s), third and fourth bound (s)."""
        h, infinite = self.smoothing.length, math.inf
        thickest = max(fluid.viscosity / fluid.state.density for fluid in self.fluids)
        if len(self.fluids) > 1:
            thickest *= STIFFER
        lightest = min(fluid.state.density for fluid in self.fluids)
        spread = 2.0 * self.diffusion * ALTERNATING
        return (
            min(self.courant, CALMED / spread) if spread > 0.0 else self.courant,
            self.interface_speed / h,
            0.125 * h * h / thickest if thickest > 0.0 else infinite,
            0.25 * (lightest * h**3 / (2.0 * math.pi * self.tension)) ** 0.5 if self.tension > 0.0 else infinite,
        )

    @cached_property
    def step_at_rest(self) -> float:
        """The step allowed where nothing is accelerated or pressed, s."""
        return min(self.limits(0.0, self.quickest / self.smoothing.length))

    def limits(self, acceleration: float, sound_rate: float) -> tuple[float, float, float, float]:
        """Steps allowed by sound, acceleration (m/s²), viscosity and capillary waves, s: eq. 49, h²/ν in the third.

        0.25/max(c/h), 0.25 √(h/|a|), 0.125 h²/ν (of two fluids less, `viscosity.STIFFER`), 0.25 √(ρ h³/2πσ) (Brackbill,
        Kothe & Zemach 1992);  ``sound_rate``: the largest c/h, 1/s.  The diffusion of density goes by sound, too, and
        allows 2/(49 δ) in place of 0.25, less where δ > 0.163.
        """
        courant, least, viscous, capillary = self.bounds
        sound_rate = max(sound_rate, least)
        return (
            courant / sound_rate if sound_rate > 0.0 else math.inf,
            self.courant * (self.smoothing.length / acceleration) ** 0.5 if acceleration > 0.0 else math.inf,
            viscous,
            capillary,
        )
