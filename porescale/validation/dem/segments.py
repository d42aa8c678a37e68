"""Segments, polygons and bonds: small experiments with exact answers, and energy that closes.  SI."""

import math
from typing import Any

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.bodies.bonding import bond
from porescale.dem.bodies.frames import Frame, chain, framed, from_ends, polygon
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_budget
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.validation.dem.momentum import momentum_drift
from porescale.validation.dem.setups import DENSITY, RADIUS, STIFFNESS, first_order, free, law_at

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
    """Hold the clumps of these numbers at rest."""
    for clump in clumps:
        grains.steering.control(Clump(clump), REST, REST, REST)


def weights(discs: Discs, gravity: float = GRAVITY) -> Floats:
    """Weight of every disc, (n, 2) N/m."""
    return np.outer(discs.mass, (0.0, -gravity))


def bouncing(what: str, steps_per_contact: float, rule: str = "outline", seconds: float = 0.5) -> Floats:
    """Energy budget of a ``what`` ("segment", "polygon" or "disc") that bounces on a container with edges up and down.

    It falls 3 radii, turning, off the middle, and hits edges and sides with its own; two walls keep it there.  Returns
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


def residuals(grains: Grains, seconds: float, steps_per_contact: float, gravity: float = GRAVITY) -> Floats:
    """|residual| at 100 moments of ``seconds`` under gravity over the most kinetic energy till then.

    Steps are in the contact of a rod as light as the lightest body that hits with its end, M/4.
    """
    clumps = grains.steering.clumps
    lightest = min([*clumps.mass[clumps.held[:, 0] == 0], *grains.discs.mass[clumps.group < 0]])
    lasts = grains.laws[0].shortest_contact(0.25 * float(lightest), RADIUS)
    dt, load, found, most = lasts / steps_per_contact, weights(grains.discs, gravity), [], 0.0
    for _ in range(100):
        grains.step(dt, load, count=int(0.01 * seconds / dt))
        budget = energy_budget(grains, (0.0, -gravity))
        most = max(most, *(budget[f"kinetic energy of {kind} (J/m)"] for kind in ("translation", "rotation")))
        found.append(abs(budget["residual (J/m)"]))
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

    def thrown(at: Floats) -> dict[str, Any]:
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


def hanging_chain(count: int = 20, span: float = 0.7, relaxation: float = 1.0) -> Floats:
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


def catenary(at: Floats) -> Floats:
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


VALIDATIONS = Validations()

ROOT_EPS = 1e-13
TUTORIAL = "Matsushima, DEMseg tutorial"
BODIES = ("segment", "polygon")


@VALIDATIONS.row(
    "dem.mass_of_frames",
    source="shoelace and parallel axes by hand; " + TUTORIAL + " I-2",
    because="a few tens of roundings of numbers of one size",
    tolerance=1e-14,
)
def masses() -> Measured:
    """Mass, centroid and inertia of a triangle given by segments, of an L of three squares and of two rods at right
    angles, over density and lengths.
    """
    triangle = from_ends([[(0, 0), (3, 0)], [(3, 0), (0, 6)], [(0, 6), (0, 0)]], 0.1, 2.0).mass_properties()
    bent = polygon([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 3.0).mass_properties()
    rods = chain([(2, 0), (0, 0), (0, 2)], 0.05, 5.0).mass_properties()
    # Right triangle: bh/2, thirds, bh(b^2 + h^2)/36.  Three unit squares about (5/6, 5/6): 3/6 + distances squared
    # 2/9 + 2 (1/9 + 4/9) - ... = (1/3)^2 2 + 2 ((2/3)^2 + (1/3)^2).  Rods 2 by 0.1 about (1/2, 1/2), 1/sqrt 2 away.
    exact = (
        18.0, 1.0, 2.0, 2.0 * 18.0 * 45.0 / 36.0,
        9.0, 5.0 / 6.0, 5.0 / 6.0, 3.0 * (3.0 / 6.0 + 2.0 / 9.0 + 2.0 * 5.0 / 9.0),
        2.0, 0.5, 0.5, 2.0 * ((4.0 + 0.01) / 12.0 + 0.5),
    )  # fmt: skip
    found = [value for body in (triangle, bent, rods) for value in (body.mass, *body.centroid, body.inertia)]
    return Measured.relative(exact, found)


@VALIDATIONS.row(
    "dem.energy_of_bouncing_segments",
    source="first law; " + TUTORIAL + " I-2: segment and polygon that bounce, without loss",
    because="required: below 1e-3 of the kinetic energy, here at 200 steps in a contact",
    tolerance=1e-3,
    slow=True,
)
def bouncing_row() -> Measured:
    """Largest unaccounted energy of a single segment and of a pentagon that bounce about a container with edges up and
    down, over the largest kinetic energy.
    """
    found = [float(bouncing(what, 200.0).max()) for what in BODIES]
    return Measured.absolute((0.0,) * len(found), found)


@VALIDATIONS.row(
    "dem.energy_of_bouncing_segments_closes_with_the_step",
    source="leap-frog is of second order, of first where contacts begin and end",
    because="first order, 0.2 below it for the phases at which some ten contacts begin",
    tolerance=0.2,
    slow=True,
)
def bouncing_order() -> Measured:
    """Order at which that falls from 50 to 400 steps in a contact."""
    return first_order(lambda what, steps: float(bouncing(what, steps).max()), BODIES, 50.0, 400.0)


@VALIDATIONS.row(
    "dem.energy_of_polygons_that_rub",
    source="first law: polygons, rods, discs and clumps that collide, rub and lose energy in dashpots",
    because="a dashpot is counted half a step too long at touch: 2 h w0 dt = 2 0.1 pi/200 of what it takes",
    tolerance=0.2 * math.pi / 200.0,
    slow=True,
)
def rubbing() -> Measured:
    """Largest unaccounted energy over the kinetic energy at the start, 36 bodies in free space."""
    return Measured.absolute(0.0, float(residuals(mixed_cloud(energy=True), 0.04, 200.0, gravity=0.0).max()))


@VALIDATIONS.row(
    "dem.momentum_of_segments",
    source="Newton's third law, forces of both bodies at one point",
    because="36 bodies, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=ROOT_EPS,
)
def momenta() -> Measured:
    """Polygons, rods, discs and clumps that collide and rub in free space: relative drift of both momenta."""
    return Measured.absolute((0.0, 0.0), momentum_drift(mixed_cloud(), 5000))


@VALIDATIONS.row(
    "dem.bond_strength",
    source=TUTORIAL + " II-3: F = k d0",
    because="the pull grows by 1.1/20 000 of the strength a step, the last of which is not seen: 5.5e-5",
    tolerance=6e-5,
)
def strength() -> Measured:
    """Largest tension of two bonded discs, of two squares bonded along a side at its two corners, and of a chain of 20
    discs, over k d0.
    """
    return Measured.relative((1.0, 2.0, 1.0), [bond_strength(what) for what in ("discs", "squares", "chain")])


@VALIDATIONS.row(
    "dem.hanging_chain",
    source="catenary; " + TUTORIAL + " II-3: bonded chain of 20 discs",
    because="straight links l have the slope of the curve at their middles: heights err by l^2/(24 a), a = 4.4 l its"
    " smallest radius, 1.6e-3 of the sag of 6 l; a quarter more, for x errs alike",
    tolerance=2e-3,
)
def hanging() -> Measured:
    """Largest distance in height of 20 discs from the catenary of their length and span, over its sag."""
    at = hanging_chain(20)
    curve = catenary(at)
    sag = -float(curve.min())
    return Measured(sag / RADIUS, -float(at[:, 1].min()) / RADIUS, float(np.abs(curve - at[:, 1]).max()) / sag)
