"""Small experiments with exact answers, in SI: what ``verify`` measures and tests vary.

Protocols: Chung & Ooi 2011 (Granular Matter 13, 643), here with the linear law.  All discs of one
experiment lie far apart and share a system, so that a sweep costs one run.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.constants import GRAVITY
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import angular_momentum, kinetic_energy, momentum
from porescale.dem.timestep import packing_limit

Array = NDArray[np.float64]

RADIUS = 0.01  # m
DENSITY = 2500.0  # kg/m^3
MASS = math.pi * RADIUS**2 * DENSITY  # kg/m
STIFFNESS = 1e7  # N/m
APART = 10.0 * RADIUS  # between discs that must not meet


def free(discs_at: Any, law: Linear, radius: ArrayLike = RADIUS, floor: bool = False) -> Grains:
    """Discs at rest in an open box, with a floor at y = 0 if wanted."""
    discs = make_discs(discs_at, radius, DENSITY)
    low, high = discs.position.min(axis=0) - 1.0, discs.position.max(axis=0) + 1.0
    box = Box(
        (float(low[0]), 0.0 if floor else float(low[1])),
        (float(high[0]), float(high[1])),
        left="open", right="open", top="open", bottom="solid" if floor else "open",
    )  # fmt: skip
    return Grains(discs, law, box)


def row_on_floor(count: int, gaps: ArrayLike, law: Linear) -> Grains:
    """``count`` discs side by side, ``gaps`` (m) above a floor (below zero: pressed into it)."""
    x = APART * np.arange(count)
    return free(np.column_stack((x, RADIUS + np.broadcast_to(np.asarray(gaps, float), (count,)))), law, floor=True)


def law_at(damping_ratio: float, release: str = "force", mass: float = MASS, **tangential: float) -> Linear:
    """A law of STIFFNESS with a ``damping_ratio`` at effective ``mass`` (kg/m)."""
    return Linear(STIFFNESS, 2.0 * damping_ratio * math.sqrt(STIFFNESS * mass), release=release, **tangential)


def bounce(law: Linear, steps_per_contact: float, phases: int = 20, speed: float = 1.0) -> Array:
    """Restitution of a disc on a wall, (phases,), touching at evenly spread moments of a contact step.

    The floor is met from above without gravity; dt is the contact time over ``steps_per_contact``.
    """
    lasts = law.contact_time(MASS)
    dt = lasts / steps_per_contact
    grains = row_on_floor(phases, speed * dt * (np.arange(phases) + 0.5) / phases, law)
    grains.discs.velocity[:, 1] = -speed
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return grains.discs.velocity[:, 1] / speed


def bounce_pair(law: Linear, ratio: float, steps_per_contact: float, speed: float = 1.0) -> float:
    """Restitution of two discs of radius ratio ``ratio``, head on at an angle to the axes."""
    mass = MASS * ratio**2 / (1.0 + ratio**2)
    dt = law.contact_time(mass) / steps_per_contact
    n = np.array([math.cos(0.3), math.sin(0.3)])
    grains = free([(0.0, 0.0), (1.0 + ratio) * RADIUS * n], law, [RADIUS, ratio * RADIUS])
    grains.discs.velocity[0] = speed * n
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return float((grains.discs.velocity[1] - grains.discs.velocity[0]) @ n) / speed


def impact(
    law: Linear, down: ArrayLike, along: ArrayLike, spin: ArrayLike, steps_per_contact: float = 1000.0
) -> tuple[Array, Array, Array]:
    """Discs hitting a floor with speeds ``down`` and ``along`` (n,) m/s and ``spin`` (n,) rad/s: the same
    after.

    Returns speed up, along and spin once all contacts have ended.
    """
    fall, slide, turn = np.broadcast_arrays(*(np.asarray(part, float) for part in (down, along, spin)))
    dt = law.contact_time(MASS) / steps_per_contact
    grains = row_on_floor(fall.size, 0.5 * fall * dt, law)
    discs = grains.discs
    # Discs of different speeds run for 1.3 contact times and must not meet.
    run = 1.3 * law.contact_time(MASS) * float(np.abs(slide).max(initial=0.0))
    discs.position[:, 0] = np.arange(fall.size) * (APART + 2.0 * run)
    discs.velocity[:, 0], discs.velocity[:, 1], discs.spin[:] = slide, -fall, turn
    grains.step(dt, count=int(1.3 * steps_per_contact) + 3)
    return discs.velocity[:, 1].copy(), discs.velocity[:, 0].copy(), discs.spin.copy()


def grazing_gain(law: Linear, angles: ArrayLike, against: str = "wall", speed: float = 1.0) -> Array:
    """Kinetic energy after over before, minus one, for impacts at ``angles`` (rad from the normal)."""
    angle = np.asarray(angles, float)
    if against == "wall":
        up, along, spin = impact(law, speed * np.cos(angle), speed * np.sin(angle), 0.0)
        return (up**2 + along**2 + 0.5 * (RADIUS * spin) ** 2) / speed**2 - 1.0
    mass, gain = 0.5 * MASS, []
    dt = law.contact_time(mass) / 1000.0
    for a in angle:
        grains = free([(0.0, 0.0), (2.0 * RADIUS + 0.5 * dt * math.cos(a) * speed, 0.0)], law)
        grains.discs.velocity[0] = speed * math.cos(a), speed * math.sin(a)
        before = kinetic_energy(grains.discs)
        grains.step(dt, count=1300)
        gain.append(kinetic_energy(grains.discs) / before - 1.0)
    return np.array(gain)


def slide_to_roll(friction: float, speed: float = 1.0, gravity: float = GRAVITY) -> tuple[float, float]:
    """A disc set sliding on a floor without spin: (time when it stops slipping, s; final speed, m/s)."""
    law = law_at(0.2, tangential_stiffness=0.25 * STIFFNESS, friction=friction)
    law = Linear(**{**vars(law), "tangential_damping": 0.25 * law.damping})
    grains = row_on_floor(1, -MASS * gravity / STIFFNESS, law)
    weight = np.array([[0.0, -MASS * gravity]])
    expected = speed / (3.0 * friction * gravity)
    dt = grains.stable_step(steps_per_contact=20.0)
    discs = grains.discs
    discs.velocity[0, 0] = speed
    slipping = 0.0
    steps = int(1.5 * expected / dt)
    for _ in range(steps):
        grains.step(dt, weight)
        if slipping == 0.0 and discs.velocity[0, 0] + discs.spin[0] * RADIUS <= 0.0:
            slipping = grains.time
    return slipping, float(discs.velocity[0, 0])


def incline(
    slope: float, friction: float, gravity: float = GRAVITY, wait: float = 0.02
) -> tuple[float, float]:  # fmt: skip
    """A disc released on an incline of ``slope`` (rad): (acceleration, m/s^2; angular acceleration, rad/s^2), from
    ``wait`` (s) on.
    """
    law = law_at(0.2, tangential_stiffness=0.25 * STIFFNESS, friction=friction)
    law = Linear(**{**vars(law), "tangential_damping": 0.25 * law.damping})
    weight = MASS * gravity * np.array([[math.sin(slope), -math.cos(slope)]])
    grains = row_on_floor(1, weight[0, 1] / STIFFNESS, law)
    dt = grains.stable_step(steps_per_contact=20.0)
    steps = int(wait / dt)
    grains.step(dt, weight, count=steps)
    first = float(grains.discs.velocity[0, 0]), float(grains.discs.spin[0])
    grains.step(dt, weight, count=4 * steps)
    span = 4 * steps * dt
    return (
        (float(grains.discs.velocity[0, 0]) - first[0]) / span,
        -(float(grains.discs.spin[0]) - first[1]) / span,
    )


def incline_exact(slope: float, friction: float, gravity: float = GRAVITY) -> tuple[float, float]:
    """The same for the lever arm b = r - m g cos/k: rolling  m a = m g sin - f,  I w' = f b,  a = b w', or f = mu N."""
    arm = RADIUS - MASS * gravity * math.cos(slope) / STIFFNESS
    along = gravity * math.sin(slope) / (1.0 + 0.5 * (RADIUS / arm) ** 2)
    rub = gravity * math.sin(slope) - along  # friction over mass that rolling takes
    if rub <= friction * gravity * math.cos(slope):
        return along, along / arm
    rub = friction * gravity * math.cos(slope)
    return gravity * math.sin(slope) - rub, 2.0 * rub * arm / RADIUS**2


def stack(count: int, gravity: float = GRAVITY, decays: float = 40.0) -> Array:
    """Overlaps (count,) m under each disc of a stack left to itself for ``decays`` of its slowest wave's
    decay times, from the top, over m g/k."""
    law = law_at(0.3)
    y = RADIUS * (2.0 * np.arange(count) + 1.0)
    grains = free(np.column_stack((np.zeros(count), y)), law, floor=True)
    weights = np.column_stack((np.zeros(count), np.full(count, -MASS * gravity)))
    # The slowest wave of the stack has w = sqrt(k/m) pi/(2 count + 1): drag at its critical damping.
    slowest = math.sqrt(STIFFNESS / MASS) * math.pi / (2.0 * count + 1.0)
    dt = grains.stable_step()
    grains.step(dt, weights, None, int(decays / (slowest * dt)), 2.0 * slowest)
    height = np.concatenate(([-RADIUS], grains.discs.position[:, 1]))
    return (2.0 * RADIUS - np.diff(height))[::-1] * STIFFNESS / (MASS * gravity)


def cloud(count: int = 60, seed: int = 1, friction: float = 0.5) -> Grains:
    """Discs of radii 1:2 thrown at each other and spinning, in an open box."""
    rng = np.random.default_rng(seed)
    side = math.ceil(math.sqrt(count))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
    law = law_at(0.1, tangential_stiffness=0.25 * STIFFNESS, friction=friction, tangential_damping=50.0)
    grains = free((grid - 0.5 * side) * 2.2 * RADIUS, law, RADIUS * rng.uniform(0.5, 1.0, count))
    discs = grains.discs
    discs.velocity[:] = -40.0 * discs.position + rng.normal(0.0, 1.0, (count, 2))
    discs.spin[:] = rng.normal(0.0, 100.0, count)
    return grains


def momentum_drift(grains: Grains, steps: int) -> tuple[float, float]:
    """Change of momentum and of angular momentum over ``steps``, relative to sum m |v| and sum m |x| |v|."""
    discs = grains.discs
    start, turn = momentum(discs), angular_momentum(discs)
    speed = np.hypot(*discs.velocity.T)
    scale = float(np.sum(discs.mass * speed))
    lever = float(np.sum(discs.mass * speed * np.hypot(*discs.position.T)))
    grains.step(grains.stable_step(), count=steps)
    return (
        float(np.hypot(*(momentum(discs) - start))) / scale,
        abs(angular_momentum(discs) - turn) / lever,
    )


def grows(grains: Grains, loads: Array, dt: float, steps: int) -> bool:
    """Whether a small disturbance of a loaded equilibrium grows tenfold within ``steps`` of ``dt``."""
    discs = grains.discs
    rest = discs.position.copy()
    rng = np.random.default_rng(0)
    discs.position += 1e-7 * RADIUS * rng.uniform(-1.0, 1.0, rest.shape)
    scale = 1e-7 * RADIUS
    grains.refresh()
    for _ in range(steps // 20):
        grains.step(dt, loads, count=20)
        off = float(np.abs(discs.position - rest).max())
        if not off < 10.0 * scale * 3.0:
            return True
    return False


def critical_step(damping_ratio: float, tolerance: float = 2e-3, steps: int = 2000) -> float:
    """Measured stability limit of a disc pressed on a floor, over sqrt(m/k), by bisection to
    ``tolerance``.
    """
    unit = math.sqrt(MASS / STIFFNESS)
    load = np.array([[0.0, -1e-3 * RADIUS * STIFFNESS]])
    low, high = 0.1, 3.0
    while high - low > tolerance * low:
        middle = 0.5 * (low + high)
        grains = row_on_floor(1, -1e-3 * RADIUS, law_at(damping_ratio))
        if grows(grains, load, middle * unit, steps):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def lattice_frequency(shear: float, waves: int = 48) -> float:
    """Largest m w^2/k_n of the infinite triangular lattice of equal discs with k_t = ``shear`` k_n, exact.

    Dynamical matrix of (u, r q): each contact, direction n, tangent t, phase p = exp(i q.n): normal part n.(1 - p)u,
    tangential part t.(1 - p)u + (1 + p) r q; mass 1 for u and 1/2 for r q.  Maximum over a grid of wave
    vectors that holds the corners and edge centres of the zone.
    """
    highest = 0.0
    scale = np.array([1.0, 1.0, math.sqrt(2.0)])
    ends = np.array([(1.0, 0.0), (0.5, math.sqrt(0.75))])
    back = 2.0 * math.pi * np.linalg.inv(ends).T
    for a in range(waves):
        for b in range(waves):
            q = back[0] * a / waves + back[1] * b / waves
            matrix = np.zeros((3, 3), complex)
            for angle in (0.0, math.pi / 3.0, 2.0 * math.pi / 3.0):
                n = np.array([math.cos(angle), math.sin(angle)])
                p = np.exp(1j * float(q @ n))
                normal = np.array([n[0] * (1 - p), n[1] * (1 - p), 0.0])
                tangent = np.array([-n[1] * (1 - p), n[0] * (1 - p), 1 + p])
                matrix += np.outer(normal.conj(), normal) + shear * np.outer(tangent.conj(), tangent)
            highest = max(highest, float(np.linalg.eigvalsh(scale[:, None] * matrix * scale)[-1]))
    return highest


def lattice_critical_step(shear: float, cells: int = 6, tolerance: float = 3e-3) -> float:
    """Measured stability limit of a periodic triangular lattice (cells x cells, even), over sqrt(m/k_n)."""
    unit = math.sqrt(MASS / STIFFNESS)
    law = Linear(STIFFNESS, 0.0, shear * STIFFNESS, friction=1e6)
    apart = 2.0 * RADIUS * (1.0 - 1e-4)
    rise = math.sqrt(0.75) * apart
    places = np.array([(apart * (i + 0.5 * (j % 2)), rise * j) for j in range(cells) for i in range(cells)])
    box = Box((0.0, 0.0), (cells * apart, cells * rise), "periodic", "periodic", "periodic", "periodic")
    loads = np.zeros((len(places), 2))
    low, high = 0.1, 3.0
    while high - low > tolerance * low:
        middle = 0.5 * (low + high)
        grains = Grains(make_discs(places, RADIUS, DENSITY), law, box, skin=0.05 * RADIUS)
        if grows(grains, loads, middle * unit, 2000):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def packing_step(shear: float) -> float:
    """The limit that stable_step is built on, undamped, over sqrt(m/k_n)."""
    law = Linear(STIFFNESS, 0.0, shear * STIFFNESS)
    return packing_limit(law, MASS) / math.sqrt(MASS / STIFFNESS)


def relative(measured: ArrayLike, reference: ArrayLike) -> float:
    """Largest |measured/reference - 1|."""
    return float(np.max(np.abs(np.asarray(measured) / np.asarray(reference) - 1.0)))
