"""Small experiments with exact answers: Hertz, waves, rolling resistance, materials, energy book, threads; in SI."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.constants import GRAVITY
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Law, Materials
from porescale.dem.discs import make_discs
from porescale.dem.forces import threads as sweep
from porescale.dem.forces.walls import HIGH, Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_book
from porescale.validation.dem.discs_trials import DENSITY, MASS, RADIUS, STIFFNESS, grows, law_at

Array = NDArray[np.float64]

MODULUS = 1e9  # Pa
HERTZ = Hertz(MODULUS, 0.8 * MODULUS)
APART = 10.0 * RADIUS


def on_floor(law: Law | Materials, gaps: ArrayLike, **options: Any) -> Grains:
    """Discs far apart in a row, ``gaps`` (m) above a floor without sides."""
    gap = np.atleast_1d(np.asarray(gaps, float))
    places = np.column_stack((APART * np.arange(len(gap)), RADIUS + gap))
    box = Box((-1.0, 0.0), (APART * len(gap) + 1.0, 1.0), "open", "open", top="open")
    return Grains(make_discs(places, RADIUS, DENSITY), law, box, **options)


def hertz_bounce(law: Hertz, speed: float, steps_per_contact: float, phases: int = 20) -> Array:
    """Restitution (phases,) on a floor, touching at evenly spread moments of a contact step."""
    lasts = law.contact_time(MASS, RADIUS, speed)
    dt = lasts / steps_per_contact
    grains = on_floor(law, speed * dt * (np.arange(phases) + 0.5) / phases)
    grains.discs.velocity[:, 1] = -speed
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return grains.discs.velocity[:, 1] / speed


def hertz_bounce_of_pair(law: Hertz, ratio: float, speed: float, steps_per_contact: float) -> float:
    """Restitution of two discs of radius ratio ``ratio``, head on at an angle to the axes."""
    mass, radius = MASS * ratio**2 / (1.0 + ratio**2), RADIUS * ratio / (1.0 + ratio)
    dt = law.contact_time(mass, radius, speed) / steps_per_contact
    n = np.array([math.cos(0.3), math.sin(0.3)])
    box = Box((-1.0, -1.0), (1.0, 1.0), "open", "open", "open", "open")
    discs = make_discs(np.array([(0.0, 0.0), (1.0 + ratio) * RADIUS * n]), [RADIUS, ratio * RADIUS], DENSITY)
    discs.velocity[0] = speed * n
    grains = Grains(discs, law, box)
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return float((discs.velocity[1] - discs.velocity[0]) @ n) / speed


def hertz_impact(law: Hertz, speed: float, steps_per_contact: float = 1000.0) -> tuple[float, float]:
    """(deepest overlap, m; duration, s) of an impact on a floor, read to a step."""
    dt = law.contact_time(MASS, RADIUS, speed) / steps_per_contact
    grains = on_floor(law, 0.5 * speed * dt)
    grains.discs.velocity[:, 1] = -speed
    deepest, lasted = 0.0, 0
    for _ in range(int(1.5 * steps_per_contact)):
        grains.step(dt)
        overlap = RADIUS - float(grains.discs.position[0, 1])
        deepest = max(deepest, overlap)
        lasted += overlap > 0.0
    return deepest, lasted * dt


def hertz_critical_step(share: float, tolerance: float = 2e-3) -> float:
    """Measured stability limit (s) of a disc pressed on a floor to ``share`` of its radius, undamped, by bisection."""
    load = np.array([[0.0, -HERTZ.constant(RADIUS) * (share * RADIUS) ** 1.5]])
    unit = math.sqrt(MASS / (1.5 * HERTZ.constant(RADIUS) * math.sqrt(share * RADIUS)))
    low, high = 0.5 * unit, 3.0 * unit
    while high - low > tolerance * low:
        middle = 0.5 * (low + high)
        if grows(on_floor(HERTZ, -share * RADIUS), load, middle, 2000):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def grazing_gain(law: Hertz, angles: Array, speed: float = 1.0) -> Array:
    """Kinetic energy after over before, minus one, for impacts at ``angles`` (rad from the normal) on a floor.

    One run for each angle, as steps follow the contact's duration, which depends on the normal speed.
    """
    gains = []
    for angle in angles:
        down, along = speed * math.cos(angle), speed * math.sin(angle)
        dt = law.contact_time(MASS, RADIUS, down) / 1000.0
        grains = on_floor(law, 0.5 * dt * down)
        grains.discs.velocity[0] = along, -down
        grains.step(dt, count=1300)
        d = grains.discs
        gains.append((float(d.velocity[0] @ d.velocity[0]) + 0.5 * (RADIUS * float(d.spin[0])) ** 2) / speed**2 - 1.0)
    return np.array(gains)


def resisted_incline(slope: float, resistance: float, gravity: float = GRAVITY, wait: float = 0.05) -> float:
    """Acceleration (m/s^2) of a disc that resists rolling on an incline of ``slope`` (rad), from ``wait`` s on."""
    law = replace(
        law_at(0.2, tangential_stiffness=0.25 * STIFFNESS, friction=0.9), rolling_friction=resistance,
        rolling_stiffness=0.25 * STIFFNESS,
    )  # fmt: skip
    law = replace(law, tangential_damping=0.25 * law.damping, rolling_damping=0.25 * law.damping)
    weight = MASS * gravity * np.array([[math.sin(slope), -math.cos(slope)]])
    grains = on_floor(law, weight[0, 1] / STIFFNESS)
    dt = grains.stable_step(steps_per_contact=20.0)
    steps = int(wait / dt)
    grains.step(dt, weight, count=steps)
    first = float(grains.discs.velocity[0, 0])
    grains.step(dt, weight, count=4 * steps)
    return (float(grains.discs.velocity[0, 0]) - first) / (4 * steps * dt)


def resisted_acceleration(slope: float, resistance: float, gravity: float = GRAVITY) -> float:
    """What it must be, with the lever arm a = r - m g cos/k: m a' = m g sin - f, I w' = f a - mu_r r N, a' = a w'."""
    reach = 1.0 - MASS * gravity * math.cos(slope) / (STIFFNESS * RADIUS)  # a/r
    drive = gravity * (math.sin(slope) - resistance * math.cos(slope) / reach)
    return max(drive, 0.0) / (1.0 + 0.5 / reach**2)


def chain(count: int, law: Linear | None = None) -> Grains:
    """A ring of discs in a row, each pressed into its neighbours by 1 % of the radius."""
    apart = 2.0 * RADIUS - 0.01 * RADIUS
    places = np.column_stack((apart * (np.arange(count) + 0.5), np.zeros(count)))
    box = Box((0.0, -1.0), (count * apart, 1.0), "periodic", "periodic", "open", "open")
    return Grains(make_discs(places, RADIUS, DENSITY), Linear(STIFFNESS) if law is None else law, box)


def chain_frequency(mode: int, count: int = 32, steps: int = 2000) -> float:
    """Frequency over sqrt(k/m) of a standing wave with ``mode`` waves on the ring.

    Its amplitude obeys A(t - s) + A(t + s) = 2 cos(w s) A(t) at any phase; s is about a tenth of a period.
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


def kicked_chain(time: float, count: int = 96) -> tuple[float, Array]:
    """Some ``time`` in sqrt(m/k) after disc 0 got a kick: that time exactly, and velocities (count,) over the kick."""
    grains = chain(count)
    dt = 0.01
    steps = round(time / dt)
    kick = 1e-3 * RADIUS * math.sqrt(STIFFNESS / MASS)
    grains.discs.velocity[0, 0] = kick  # half a step before the first force, which is zero: even in time
    grains.step(dt * math.sqrt(MASS / STIFFNESS), count=steps)
    return (steps - 0.5) * dt, grains.discs.velocity[:, 0] / kick  # velocities are at half steps


def unlike_stack(gravity: float = GRAVITY) -> Array:
    """Overlaps over m g: floor of steel under a disc of rubber, under one of steel, (2,) m/N per metre, at rest."""
    steel, rubber = Linear(STIFFNESS), Linear(0.1 * STIFFNESS)
    laws = Materials({"steel": steel, "rubber": rubber}, walls="steel")
    discs = make_discs([(0.0, RADIUS), (0.0, 3.0 * RADIUS)], RADIUS, DENSITY)
    box = Box((-1.0, 0.0), (1.0, 1.0), "open", "open", top="open")
    grains = Grains(discs, laws, box, material=[1, 0])
    weights = np.tile([0.0, -MASS * gravity], (2, 1))
    slowest = 0.6 * math.sqrt(0.18 * STIFFNESS / MASS)
    grains.step(grains.stable_step(), weights, None, int(60.0 / (slowest * grains.stable_step())), 2.0 * slowest)
    y = discs.position[:, 1]
    return np.array([RADIUS - y[0], 2.0 * RADIUS - (y[1] - y[0])]) / (MASS * gravity)


def impact_residual(law: Linear, steps_per_contact: float, phases: int = 20) -> float:
    """Energy unaccounted for over energy turned over, mean size over touch phases of oblique, spinning impacts."""
    dt = law.contact_time(MASS) / steps_per_contact
    total = []
    for phase in (np.arange(phases) + 0.5) / phases:
        grains = on_floor(law, phase * dt, energy=True)
        d = grains.discs
        d.velocity[0], d.spin[0] = (0.6, -1.0), 0.3 / RADIUS
        grains.step(dt, count=int(1.4 * steps_per_contact) + 3)
        book = energy_book(grains)
        total.append(abs(book["residual (J/m)"]) / book["turned over (J/m)"])
    return float(np.mean(total))


def repose(settling: int = 12_000, running: int = 100_000, seed: int = 1) -> tuple[Grains, dict[str, float]]:
    """The tutorial's 582 discs (I-7, cgs: cm, g, s, erg/cm): settled in a box, which then opens down to a toe of 4 cm.

    Returns the grains at the end and their energy book.
    """
    rng = np.random.default_rng(seed)
    count, side = 582, 22
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(30)), axis=-1).reshape(-1, 2)[:count]
    discs = make_discs((grid + 0.5) * 80.0 / side + rng.uniform(-0.1, 0.1, grid.shape), rng.uniform(1, 1.7, count), 2.5)
    law = Linear(1e8, 100.0, 0.25e8, 50.0, math.tan(math.radians(27.0)))
    box = Box((0.0, 0.0), (400.0, 400.0), right="open", top="open")
    grains = Grains(discs, law, box, plates=[Plate(80.0, 0.0, 400.0, name="gate")], energy=True)
    weights = np.column_stack((np.zeros(count), -980.0 * discs.mass))
    grains.step(5e-5, weights, count=settling)
    grains.plates[0, HIGH] = 4.0
    grains.step(5e-5, weights, count=running)
    return grains, energy_book(grains, (0.0, -980.0))


def crowd(law: Law, energy: bool, seed: int = 2, shuffled: bool = True) -> Grains:
    """Just enough discs for threads, pressed together, moving, spinning and numbered at random."""
    rng = np.random.default_rng(seed)
    side = math.ceil(math.sqrt(sweep.SERIAL_BELOW + 1))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    if shuffled:
        grid = rng.permutation(grid)
    apart = 1.96 * RADIUS
    size = len(grid)
    discs = make_discs(
        (grid + 0.5) * apart, RADIUS * rng.uniform(0.9, 1.05, size), DENSITY, rng.normal(0.0, 0.5, (size, 2)),
        rng.normal(0.0, 20.0, size),
    )  # fmt: skip
    return Grains(discs, law, Box((0.0, 0.0), (side * apart, side * apart)), energy=energy)


def difference_of_sweeps(law: Law, steps: int = 60) -> int:
    """Numbers of the state that differ between the single loop and the sweep over blocks after ``steps``."""
    one, other = crowd(law, False), crowd(law, True)
    for grains in (one, other):
        grains.step(grains.stable_step(), count=steps)
    pairs = [
        (getattr(one.discs, name), getattr(other.discs, name)) for name in ("position", "velocity", "spin", "force")
    ]
    pairs += [(one.wall_force, other.wall_force), (one.wall_spring, other.wall_spring)]
    pairs += [(one.pairs.carried, other.pairs.carried)]
    return sum(int(np.count_nonzero(a != b)) for a, b in pairs)
