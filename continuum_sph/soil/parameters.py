"""Parameters of the particles of a soil, and the time steps that they allow."""

import functools
import math
from dataclasses import dataclass

from continuum_sph.soil.material import Material
from continuum_sph.water.smoothing import Smoothing, kernel_slope, kernel_value
from porescale.common.core.errors import Fault, InputError

FALL = 7.0
"""2 · 2π W(0) h² of Wendland C2: what a zig-zag from particle to particle falls by at most, over χ and shear strain."""
DAMPED = 0.8
"""Longest step over h/(α c).  Damping takes λ dt of a zig-zag of velocity in a step, with the velocities before it, so
beyond 2 it swings ever wider.  Over all waves on a square lattice λ is at most 2.19 α c/h (Wendland C2, h = 1 to 2
spacings; the spline 1.97): 0.91 h/(α c).  What is left is for particles that crowd."""
PARTED = 0.25
"""Largest A γ' Δt of particles that part.  One between two others, δ nearer to one of them than a spacing, goes back by
4 A γ' Δt δ: where it was at most, not beyond."""
STREWN = 1.025
"""`stress.CROWD` over a lattice's up to which nothing swells: as much as particles strewn by a fifth of a spacing have,
1.022 in the mean, so that disorder alone lifts no ground."""
BEARING = 0.5
"""Mean stress, over what a row of particles weighs, from which on soil counts as bearing: less has the top row, and
soil that water lifts."""
RULES = ("sound", "acceleration", "other layers")


@functools.cache
def even_crowd(smoothing: Smoothing, spacing: float) -> float:
    """`stress.CROWD` of a square lattice of particles at ``spacing`` (m): spacing² Σ -(1/r) W' over 2π W(0).

    Equilateral triangles of as many particles an area have as much (0.6827, the square lattice 0.6830, at h = 1.375
    spacings, Wendland C2), so what is more is crowded, not ordered otherwise.
    """
    kind, h = smoothing.kind, smoothing.length
    reach = range(-math.ceil(smoothing.support / spacing), math.ceil(smoothing.support / spacing) + 1)
    slopes = [kernel_slope(kind, math.hypot(i, j) * spacing / h, h) for i in reach for j in reach if i or j]
    return -(spacing**2) * math.fsum(slopes) / (2.0 * math.pi * float(kernel_value(kind, 0.0, h)))


@dataclass(frozen=True)
class SoilLaw:
    """Numbers in SI.

    smoothing : kernel and h;  spacing : of the particles, m;  materials : by the numbers that particles carry;
    gravity : (x, y) m/s²;  damping : α, of the part of velocity differences that is not linear in place, or with
    ``printed_damping`` of all of it between particles that approach (eq. 36);  bounded : damping bears a share of the
    shear stress at most, and stress diffuses by plastic strain alone, see `momentum`;  corrected : gradients exact for
    linear fields;  diffusion : χ of stress and volume, per shear strain, see `momentum`;  sound_diffusion : the same
    per passage of sound through h, which never rests (for comparison);  spacing_recovery : A, how fast particles nearer
    than a spacing part, per shear strain, 0: soil does not swell either;  repulsion : A of `tension`, where soil bears
    tension;  drag : 1/s, of all motion until ``settle`` (s), so that a start finds its equilibrium;  printed_spin :
    turn stress as eq. 38 has it, the wrong way;  courant : the 0.25 of eq. 49;  averages : over neighbours, of what
    shears in a step, where soil softens, see `softening`;  level_from : time (s) from which on stress and
    volume diffuse;  side_friction : 2 tan δ/W of side walls, 1/m, see `side_walls`.
    """

    smoothing: Smoothing
    spacing: float
    materials: tuple[Material, ...]
    gravity: tuple[float, float]
    damping: float = 0.2
    printed_damping: bool = False
    bounded: bool = False
    corrected: bool = True
    diffusion: float = 100.0
    sound_diffusion: float = 0.0
    spacing_recovery: float = 4.0
    repulsion: float = 10.0
    drag: float = 0.0
    settle: float = 0.0
    printed_spin: bool = False
    courant: float = 0.25
    averages: int = 1
    level_from: float = 0.0
    side_friction: float = 0.0

    def __post_init__(self) -> None:
        """InputError when diffusion at the rate of sound takes more of a zig-zag in a step than there is."""
        most = 1.0 / (FALL * self.courant)
        if self.sound_diffusion > most:
            key = "soil.numerics.restless_diffusion"
            repair = "or lower numerics.courant"
            raise InputError(Fault(key, self.sound_diffusion, "swings ever wider", "", f"<= {most:.3g}", repair))

    @property
    def share(self) -> float:
        """Step that sound and damping allow, over h/c."""
        return min(self.courant, DAMPED / self.damping) if self.damping > 0.0 else self.courant

    @property
    def most(self) -> float:
        """Shear strain of one step that diffusion follows.

        A zig-zag from particle to particle falls by up to 2 · 2π W(0) h² χ = 7 χ times that (W(0) = 7/4πh² of Wendland
        C2, the spline has less), and would swing ever wider beyond 2: σ_zz does, which no strength bounds.  It may
        vanish in a step.  Of a particle's volume half at most is then exchanged, spacing² Σ -(1/r) W' being the
        integral 2π W(0): volumes stay between those around, so above zero, up to twice the lattice's particles in a
        place, and their noise decays up to four times.  A step may be `flow.LASTING` = 1.25 of that before it, so where
        the sum is more than `stress.CROWDED` = 2/1.25 of the integral, the bound is as much lower.  What diffuses by
        sound is part of it.
        """
        left = 1.0 - FALL * self.courant * self.sound_diffusion
        return max(0.0, left) / (FALL * self.diffusion) if self.diffusion > 0.0 else float("inf")

    def parted(self, step: float) -> float:
        """Rate of shear strain (1/s) up to which particles part in a ``step`` (s)."""
        taken = self.spacing_recovery * step
        return PARTED / taken if taken > 0.0 else float("inf")

    @property
    def bearing(self) -> float:
        """Mean stress (Pa) from which on soil counts as bearing: BEARING of what a row of particles weighs."""
        return BEARING * self.materials[0].density * math.hypot(*self.gravity) * self.spacing

    @property
    def even(self) -> float:
        """`stress.CROWD` beyond which sheared soil swells; infinite where particles do not part either."""
        return STREWN * even_crowd(self.smoothing, self.spacing) if self.spacing_recovery > 0.0 else math.inf

    @property
    def step_at_rest(self) -> float:
        """The step that sound of the stiffest material, at its reference stress, allows, s."""
        sound2 = max(material.column_modulus / material.density for material in self.materials)
        return min(self.limits(0.0, sound2**0.5 / self.smoothing.length, math.inf))

    def limits(self, acceleration: float, sound_rate: float, others: float) -> tuple[float, float, float]:
        """Steps allowed by sound, acceleration (m/s²) and other layers (s), s: eq. 49.

        0.25/max(c/h), 0.25 √(h/|a|);  ``sound_rate``: the largest c/h, 1/s.  The first is DAMPED/α max(c/h) where that
        is less: the third of eq. 49, for the damping.
        """
        h, infinite = self.smoothing.length, float("inf")
        return (
            self.share / sound_rate if sound_rate > 0.0 else infinite,
            self.courant * (h / acceleration) ** 0.5 if acceleration > 0.0 else infinite,
            others,
        )
