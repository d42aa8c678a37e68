"""Small experiments with segments, polygons and bonds that have exact answers, in SI."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.constants import GRAVITY
from porescale.dem.bodies.bonding import bond
from porescale.dem.bodies.frames import Frame, chain, framed, polygon
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_book
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.validation.dem.discs_trials import DENSITY, RADIUS, STIFFNESS, free, law_at

Array = NDArray[np.float64]

THICKNESS = 0.1 * RADIUS
OPEN = dict.fromkeys(("left", "right", "bottom", "top"), "open")
REST = Moved()


def regular(sides: int, at: tuple[float, float], turned: float = 0.0, size: float = RADIUS, **more: Any) -> Frame:
    """A regular polygon about ``at`` (m), ``size`` (m) from there to its corners, with THICKNESS."""
    angle = turned + 2.0 * math.pi * np.arange(sides) / sides
    corners = np.asarray(at) + size * np.column_stack((np.cos(angle), np.sin(angle)))
    return polygon(corners, THICKNESS, DENSITY, **more)


def rod(at: tuple[float, float], turned: float, length: float = 2.0 * RADIUS, **more: Any) -> Frame:
    """A single segment with THICKNESS about ``at`` (m)."""
    half = 0.5 * length * np.array([math.cos(turned), math.sin(turned)])
    return chain([np.asarray(at) - half, np.asarray(at) + half], THICKNESS, DENSITY, **more)


def hilly(crests: int = 4, slope: float = 0.3) -> Frame:
    """A container that rises and falls along x with ``slope`` (rad) by segments of 1.5 radii, edges up and down."""
    x = 1.5 * RADIUS * np.arange(-crests, crests + 1)
    return chain(np.column_stack((x, np.where(np.arange(len(x)) % 2, 0.0, -1.5 * RADIUS * math.tan(slope)))),
                 THICKNESS, DENSITY, long=True)  # fmt: skip


def hold(grains: Grains, *clumps: int) -> None:
    """Let these clumps stand still."""
    for clump in clumps:
        grains.steering.control(Clump(clump), REST, REST, REST)


def weights(discs: Discs, gravity: float = GRAVITY) -> Array:
    """Weight of every disc, (n, 2) N/m."""
    return np.outer(discs.mass, (0.0, -gravity))


def bouncing(what: str, steps_per_contact: float, rule: str = "outline", seconds: float = 0.5) -> Array:
    """Energy book of a ``what`` ("segment", "polygon" or "disc") that bounces on a container with edges up and down.

    It falls 3 radii, turning, off the middle, and meets edges and sides with its own; two walls keep it there.  Returns
    the residual at 100 moments over the most kinetic energy.
    """
    frames = [hilly()]
    at, velocity = (0.2 * RADIUS, 4.0 * RADIUS), (0.1, 0.0)
    discs = make_discs([at], RADIUS, DENSITY, [velocity]) if what == "disc" else None
    if what == "segment":
        frames.append(rod(at, 0.4, velocity=velocity, spin=20.0))
    elif what == "polygon":
        frames.append(regular(5, at, 0.1, velocity=velocity, spin=20.0))
    box = Box((-5.0 * RADIUS, -20.0 * RADIUS), (5.0 * RADIUS, 20.0 * RADIUS), top="open", bottom="open")
    grains = framed(discs, frames, Linear(STIFFNESS), box, rule=rule, energy=True)
    hold(grains, 0)
    return residuals(grains, seconds, steps_per_contact)


def residuals(grains: Grains, seconds: float, steps_per_contact: float, gravity: float = GRAVITY) -> Array:
    """|residual| at 100 moments of ``seconds`` under gravity over the most kinetic energy till then.

    Steps are in the contact of a rod as light as the lightest body that hits with its end, M/4.
    """
    clumps = grains.steering.clumps
    lightest = min([*clumps.mass[clumps.held[:, 0] == 0], *grains.discs.mass[clumps.group < 0]])
    lasts = grains.laws[0].shortest_contact(0.25 * float(lightest), RADIUS)
    dt, load, found, most = lasts / steps_per_contact, weights(grains.discs, gravity), [], 0.0
    for _ in range(100):
        grains.step(dt, load, count=int(0.01 * seconds / dt))
        book = energy_book(grains, (0.0, -gravity))
        most = max(most, *(book[f"kinetic energy of {kind} (J/m)"] for kind in ("translation", "rotation")))
        found.append(abs(book["residual (J/m)"]))
    return np.array(found) / most


def mixed_cloud(friction: float = 0.5, rule: str = "outline", seed: int = 3, pace: float = 0.3, **more: Any) -> Grains:
    """Polygons, rods, discs and clumps thrown at each other and spinning, in free space, 36 bodies in all.

    pace : over speeds of some metres per second, at which frames without friction go through each other.
    """
    rng = np.random.default_rng(seed)
    places = (np.stack(np.meshgrid(np.arange(6), np.arange(6)), axis=-1).reshape(-1, 2) - 2.5) * 2.6 * RADIUS
    order = rng.permutation(36)
    law = law_at(0.1, tangential_stiffness=0.25 * STIFFNESS, friction=friction, tangential_damping=50.0)
    if friction == 0.0:
        law = Linear(STIFFNESS)

    def thrown(at: Array) -> dict[str, Any]:
        """Velocity, m/s, and spin, rad/s, of a body at ``at``, m: towards the middle, and by dice."""
        speed = pace * (-40.0 * at + rng.normal(0.0, 1.0, 2))
        return {"velocity": (float(speed[0]), float(speed[1])), "spin": float(pace * rng.normal(0.0, 100.0))}

    frames = [
        rod(tuple(places[k]), float(rng.uniform(0.0, 3.0)), **thrown(places[k]))
        if number % 4 == 3
        else regular(3 + number % 4, tuple(places[k]), float(rng.uniform(0.0, 3.0)), **thrown(places[k]))
        for number, k in enumerate(order[:20])
    ]
    at = places[order[20:]]
    at = np.concatenate((at, np.add(at[:2], (0.8 * RADIUS, 0.0))))
    size = np.where(np.arange(len(at)) < 2, 0.6, rng.uniform(0.5, 1.0, len(at))) * RADIUS
    size[-2:] = 0.5 * RADIUS
    speed = pace * (-40.0 * at + rng.normal(0.0, 1.0, at.shape))
    discs = make_discs(at, size, DENSITY, speed, pace * rng.normal(0.0, 100.0, len(at)))
    box = Box((-1.0, -1.0), (1.0, 1.0), **OPEN)
    clumps = [[0, len(at) - 2], [1, len(at) - 1]]
    return framed(discs, frames, law, box, clumps=clumps, clump_density=DENSITY, rule=rule, **more)


def bond_strength(what: str, pressed: float = 1e-3, steps: int = 20_000) -> float:
    """Largest tension (N/m) of bonded bodies pulled apart slowly, over k d0.

    "discs": two of RADIUS;  "chain": 20 of them, with dashpots that end waves;  "squares": two with faces, which are
    bonded at two corners;  overlapping by ``pressed`` radii when they are bonded.
    """
    law, far = law_at(0.5) if what == "chain" else Linear(STIFFNESS), (2.0 - pressed) * RADIUS
    box = Box((-1.0, -1.0), (1.0, 1.0), **OPEN)
    links = 19 if what == "chain" else 1
    if what in ("discs", "chain"):
        at = np.column_stack((far * np.arange(links + 1), np.zeros(links + 1)))
        grains = Grains(make_discs(at, RADIUS, DENSITY), law, box)
        bodies: list[int | Clump] = [0, links]
    else:
        edge = np.array([(0.0, 0.0), (RADIUS, 0.0), (RADIUS, RADIUS), (0.0, RADIUS)])
        beside = np.add(edge, (RADIUS + 2.0 * THICKNESS - pressed * RADIUS, 0.0))
        grains = framed(None, [polygon(each, THICKNESS, DENSITY) for each in (edge, beside)], law, box)
        bodies = [Clump(0), Clump(1)]
    bond(grains)
    dt = grains.stable_step()
    grains.steering.control(bodies[0], REST, REST, REST)
    grains.steering.control(bodies[1], Moved(1.1 * links * pressed * RADIUS / (steps * dt)), REST, REST)
    grains.steering.watch(bodies[1])
    most = 0.0
    for _ in range(steps):
        grains.step(dt)
        most = max(most, -grains.steering.record()[0].contact[0])
    return most / (STIFFNESS * pressed * RADIUS)


def hanging_chain(count: int = 20, span: float = 0.7, relaxation: float = 1.0) -> Array:
    """Places (count, 2) m of the chain ``hung`` at rest."""
    return hung(count, span, relaxation).discs.position.copy()


def hung(
    count: int = 20, span: float = 0.7, relaxation: float = 1.0, pressed: float = 0.1, law: Linear | None = None
) -> Grains:
    """A chain of bonded discs without friction, its ends held ``span`` of its length apart, at rest under gravity.

    Laid out as an arc of a circle of discs that overlap by ``pressed`` radii; drag at ``relaxation`` of critical for
    its slowest swing.
    """
    apart = (2.0 - pressed) * RADIUS
    links = count - 1
    low, high = 1e-9, math.pi
    for _ in range(60):  # half angle of the arc whose chord is the span
        half = 0.5 * (low + high)
        if math.sin(half) / (links * math.sin(half / links)) > span:
            low = half
        else:
            high = half
    arc = -half + 2.0 * half * np.arange(count) / links
    ring = 0.5 * apart / math.sin(half / links)
    at = ring * np.column_stack((np.sin(arc), math.cos(half) - np.cos(arc)))
    grains = free(at, Linear(STIFFNESS) if law is None else law)
    bond(grains)
    grains.hold(np.array([0, links]))
    dt, load = grains.stable_step(), weights(grains.discs)
    slow = math.sqrt(GRAVITY / (links * apart))
    for _ in range(4):
        grains.step(dt, load, count=int(5.0 / (slow * dt)), drag=4.0 * relaxation * slow)
    return grains


def catenary(at: Array) -> Array:
    """Heights (n,) m over the lower end of the catenary through the ends of a chain of discs ``at`` (n, 2) m, with as
    much length as it has between them, at its places x.
    """
    span = float(at[-1, 0] - at[0, 0])
    length = float(np.hypot(*np.diff(at, axis=0).T).sum())
    low, high = 1e-6 * span, 1e3 * span
    for _ in range(200):
        size = math.sqrt(low * high)
        if 2.0 * size * math.sinh(min(0.5 * span / size, 300.0)) > length:
            low = size
        else:
            high = size
    middle = 0.5 * (at[0, 0] + at[-1, 0])
    return np.asarray(size * (np.cosh((at[:, 0] - middle) / size) - math.cosh(0.5 * span / size)))
