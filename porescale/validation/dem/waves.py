"""Waves on a ring of discs in contact: the dispersion of standing waves, and a kick that travels.  SI."""

import math

import numpy as np

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.validation.dem.setups import DENSITY, MASS, RADIUS, STIFFNESS

VALIDATIONS = Validations()


def chain(count: int, law: Linear | None = None) -> Grains:
    """A ring of discs in a row, each pressed into its neighbours by 1 % of the radius."""
    apart = 2.0 * RADIUS - 0.01 * RADIUS
    places = np.column_stack((apart * (np.arange(count) + 0.5), np.zeros(count)))
    box = Box((0.0, -1.0), (count * apart, 1.0), "periodic", "periodic", "open", "open")
    return Grains(make_discs(places, RADIUS, DENSITY), Linear(STIFFNESS) if law is None else law, box)


def chain_frequency(mode: int, count: int = 32, steps: int = 2000) -> float:
    """Frequency over sqrt(k/m) of a standing wave with ``mode`` waves on the ring.

    Its amplitude satisfies A(t - s) + A(t + s) = 2 cos(w s) A(t) at any phase; s is about a tenth of a period.
    """
    grains = chain(count)
    shape = np.cos(2.0 * math.pi * mode * np.arange(count) / count)
    rest = grains.discs.position[:, 0].copy()
    grains.discs.position[:, 0] += 1e-3 * RADIUS * shape
    grains.refresh()
    unit = math.sqrt(MASS / STIFFNESS)
    dt = 0.02 * unit
    guess = 2.0 * math.sin(math.pi * mode / count)
    every = max(1, int(0.6 / (guess * 0.02)))
    amplitude = []
    for _ in range(steps // every):
        grains.step(dt, count=every)
        amplitude.append(float((grains.discs.position[:, 0] - rest) @ shape))
    a = np.array(amplitude)
    cosine = float(((a[:-2] + a[2:]) @ a[1:-1]) / (2.0 * a[1:-1] @ a[1:-1]))
    return math.acos(cosine) / (every * 0.02)


@VALIDATIONS.row(
    "dem.dispersion_of_a_chain",
    source="w = 2 sqrt(k/m) sin(q a/2), Brillouin, Wave Propagation in Periodic Structures; tutorial I-4",
    because="leap-frog raises a frequency by (w dt)^2/24 = 7e-5 at w dt = 0.04; half as much again to read it",
    tolerance=1e-4,
)
def dispersion() -> Measured:
    """Frequencies (sqrt(k/m)) of standing waves on a ring of 32 discs, 1 to 16 waves."""
    modes = (1, 4, 8, 12, 16)
    exact = [2.0 * math.sin(math.pi * mode / 32) for mode in modes]
    return Measured.relative(exact, [chain_frequency(mode) for mode in modes])


def kicked_chain(time: float, count: int = 96) -> tuple[float, Floats]:
    """Some ``time`` in sqrt(m/k) after disc 0 got a kick: that time exactly, and velocities (count,) over the kick."""
    grains = chain(count)
    dt = 0.01
    steps = round(time / dt)
    kick = 1e-3 * RADIUS * math.sqrt(STIFFNESS / MASS)
    grains.discs.velocity[0, 0] = kick  # half a step before the first force, which is zero: even in time
    grains.step(dt * math.sqrt(MASS / STIFFNESS), count=steps)
    return (steps - 0.5) * dt, grains.discs.velocity[:, 0] / kick  # velocities are at half steps


@VALIDATIONS.row(
    "dem.kick_travels_along_a_chain",
    source="v_n(t) = v0 J_2|n|(2 sqrt(k/m) t), Schroedinger 1914; tutorial I-4",
    because="phase of leap-frog at t = 20: 2t (w dt)^2/24 = 40 (0.02)^2/24 = 7e-4 of a profile of height 0.3",
    tolerance=3e-4,
)
def kick() -> Measured:
    """Velocities of the ten discs behind the front and those ahead, 20 sqrt(m/k) after the kick."""
    from scipy.special import jv

    at, found = kicked_chain(20.0)
    n = np.arange(len(found))
    exact = jv(2 * np.minimum(n, len(n) - n), 2.0 * at)
    return Measured(exact[:24].tolist(), found[:24].tolist(), float(np.abs(found - exact).max()))
