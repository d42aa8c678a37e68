"""A deck as a system of grains.

Choices where the DEMseg tutorial (Matsushima) gives nothing, or contradicts itself:
- Contacts hold until the overlap is gone (``release`` "overlap"), as its e = exp(-pi h/sqrt(1 - h^2)) has it.
- Walls of the domain are of the first material; unlike materials mix as in dem/contact/materials.py.
- Segments that make no polygon weigh ``rod`` times their length: 2 thick, and 0.1 where thick is 0.  The output listed
  in I-3 (thick 0, length 5, density 2.5, force 1e4: x = -2.99982 after 10 steps of 2e-5 and -2.99933 after 20) means a
  mass of 1.25, so a width of 0.1.
- Mode 0: as many discs as fill the domain to the void ratio when their radii are uniform between the two bounds (582 in
  I-7, as there), each radius from its own share of the range, evenly spread (packing.py) and without overlap (those of
  DEMseg overlap and fly apart).
- Rules "each" and "printed" count every segment for itself, also at the sides of the domain: a corner at which two
  segments end presses on a side twice (sides.py).
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.placement import place
from porescale.dem.bodies.frames import Frame, framed, from_ends
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.bonds import BondList
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.motion.control import Moved, Pushed
from porescale.dem.motion.drivers import Clump
from porescale.demseg.deck import MOVED, Body, Control, Deck, Random
from porescale.demseg.packing import even_start
from porescale.demseg.sides import at_sides

ROD = 0.1
FEW, TRIES = 100, 8
"""Discs of mode 0 that are so few may jam by chance, as one side holds only two or three: they are drawn again, at most
so often in all."""


@dataclass(frozen=True)
class Options:
    """Read by the program at run time, or left open: see module.  rule : of contacts with segments, segments.py.

    Raises InputError for a seed below 0, and a rod that is not finite or not above 0.
    """

    seed: int = 0
    release: str = "overlap"
    rule: str = "outline"
    rod: float | None = None

    def __post_init__(self) -> None:
        """Refuse numbers without sense, by the names that commands have for them."""
        if self.rod is not None and not 0.0 < self.rod < math.inf:
            raise InputError(Fault("--rod", self.rod, "is out of range", allowed="> 0"))
        if self.seed < 0:
            raise InputError(Fault("--seed", self.seed, "is out of range", allowed=">= 0"))


@dataclass
class Built:
    """The grains of a deck and where its bodies are among them.

    names : of each body, as grains name it;  first (b + 1,): rows of each body's points, discs or corners, among the
    discs;  heading (b,) rad: angle that a body had at the start, of its first disc or segment.
    """

    grains: Grains
    names: list[int | Clump]
    first: NDArray[np.int64]
    heading: Floats
    frames: list[Frame]


def with_bodies(deck: Deck, seed: int) -> Deck:
    """The deck with the discs that mode 0 makes, in place of what it holds of them."""
    if deck.random is None:
        return deck
    return replace(deck, bodies=random_discs(deck, deck.random, seed), random=None, lines=())


def random_discs(deck: Deck, random: Random, seed: int) -> tuple[Body, ...]:
    """Discs of mode 0, see module.  Raises InputError where they do not fit."""
    x1, x2, y1, y2 = deck.domain
    small, large, count = random.smallest, random.largest, random.count(deck.domain)
    lines = deck.lines[0] if deck.lines else ()
    if count < 1:
        raise _unfit(
            deck, lines[2:], "void ratio", random.void_ratio, "leaves no room for a disc", "give a smaller one"
        )
    rng = np.random.default_rng(seed)
    radius = small + (large - small) * (np.arange(count) + 0.5) / count
    widest, side = 2.0 * float(radius.max()), min(x2 - x1, y2 - y1)
    if widest > side:
        problem = f"makes a disc {widest:g} across in a domain of {side:g}"
        raise _unfit(deck, lines[:1], "r2", large, problem, "give smaller discs or a larger domain")
    for _ in range(TRIES if count <= FEW else 1):
        start, own = even_start(radius, (x2 - x1, y2 - y1), rng)
        try:
            where = place((x1, y1), (x2, y2), radii=own, start=start).position
        except InputError:
            continue
        rows = zip(own.tolist(), where.tolist(), strict=True)
        return tuple(Body(random.material, (0.0, 0.0, 0.0), discs=((r, x, y, 0.0),)) for r, (x, y) in rows)
    share = math.pi * float(radius @ radius) / ((x2 - x1) * (y2 - y1))
    problem = f"{count} discs would fill {share:.2f} of the domain, which is too dense for them to lie without overlap"
    repair = "give a larger void ratio, smaller discs, a larger domain or another --seed"
    raise _unfit(deck, lines[2:], "void ratio", random.void_ratio, problem, repair)


def _unfit(deck: Deck, line: tuple[int, ...], name: str, value: float, problem: str, repair: str) -> InputError:
    """What is said of discs of mode 0 that do not fit, by the ``line`` of what the deck has of them, where it has."""
    where = f"line {line[0]}, {name}" if line else name
    return InputError(Fault(where, value, problem, repair=repair, file=str(deck.file)))


def width_of(deck: Deck, options: Options) -> float:
    """Width of segments that weigh, see module."""
    return options.rod if options.rod is not None else 2.0 * deck.thick or ROD


def laws(deck: Deck, release: str) -> Linear | Materials:
    """The law of the deck's materials."""
    own = {
        str(k + 1): Linear(s.kn, s.cn, s.ks, s.cs, math.tan(math.radians(s.angle)), release)
        for k, s in enumerate(deck.stuff)
    }
    return Materials(own) if len(own) > 1 else own["1"]


def build(deck: Deck, options: Options) -> Built:
    """The grains of a deck with bodies, without bonds; an energy budget is kept.  Raises InputError as parts do."""
    round_ones = [body for body in deck.bodies if body.discs]
    rows = np.array([disc for body in round_ones for disc in body.discs]).reshape(-1, 4)
    sizes = [len(body.discs) for body in round_ones]
    each = np.repeat(np.arange(len(round_ones)), sizes)
    material = np.array([body.material - 1 for body in round_ones], np.int64)[each]
    density = np.array([stuff.density for stuff in deck.stuff])
    speed = np.array([body.velocity for body in round_ones]).reshape(-1, 3)[each]
    discs = make_discs(rows[:, 1:3], rows[:, 0], density[material], speed[:, :2], speed[:, 2], rows[:, 3])
    starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    bound = [np.arange(starts[k], starts[k + 1]) for k, size in enumerate(sizes) if size > 1]
    solid = [body for body in round_ones if len(body.discs) > 1]
    heavy = [deck.stuff[body.material - 1].density for body in solid]
    frames = [_frame(deck, k, options) for k, body in enumerate(deck.bodies) if body.segments]
    grains = _grains(deck, discs, material, bound, heavy, frames, options)
    if solid:
        table = grains.steering.clumps
        for k, body in enumerate(solid):
            table.velocity[k], table.spin[k] = body.velocity[:2], body.velocity[2]
        table.place(grains.discs)
    numbers = iter(range(len(solid) + len(frames)))
    names: list[int | Clump] = [
        int(starts[k]) if body.discs and len(body.discs) == 1 else Clump(next(numbers))
        for k, body in enumerate(deck.bodies)
    ]
    ends = np.cumsum([len(frame.corners) for frame in frames]).astype(np.int64) + starts[-1]
    heading = np.array([_heading(body) for body in deck.bodies])
    built = Built(grains, names, np.concatenate((starts, ends)), heading, frames)
    _steer(deck, built)
    return built


def _grains(
    deck: Deck,
    discs: Discs,
    material: NDArray[np.int64],
    bound: list[NDArray[np.int64]],
    heavy: list[float],
    frames: list[Frame],
    options: Options,
) -> Grains:
    x1, x2, y1, y2 = deck.domain
    law, box = laws(deck, options.release), Box((x1, y1), (x2, y2))
    if frames:
        own = [np.full(len(frame.corners), frame.material) for frame in frames]
        if options.rule != "outline":
            law, own = at_sides(law, frames)
        return framed(
            discs if discs.count else None, frames, law, box, clumps=bound, clump_density=heavy, rule=options.rule,
            material=material, corner_material=own, energy=True,
        )  # fmt: skip
    grains = Grains(discs, law, box, material=material, energy=True)
    if bound:
        grains.steering.bind(bound, heavy)
    return grains


def _frame(deck: Deck, number: int, options: Options) -> Frame:
    body, width = deck.bodies[number], width_of(deck, options)
    try:
        return from_ends(
            np.array(body.segments).reshape(-1, 2, 2), deck.thick, deck.stuff[body.material - 1].density, width=width,
            velocity=body.velocity[:2], spin=body.velocity[2], long=body.long, material=body.material - 1,
        )  # fmt: skip
    except InputError as error:
        raise InputError([_of_body(deck, number, fault) for fault in error.faults]) from None


def _of_body(deck: Deck, number: int, fault: Fault) -> Fault:
    """A fault of a frame as one of its body, with the numbers of its segments from 1."""
    if isinstance(fault.value, tuple) and fault.value and isinstance(fault.value[0], int):
        one, other = (value + 1 for value in fault.value)
        return deck.fault(number, f"crosses itself: elements {one} and {other}", "give the outline in its order")
    return deck.fault(number, fault.problem, fault.repair)


def _heading(body: Body) -> float:
    """Angle of the first disc as given, or the direction of the first segment, rad."""
    if body.discs:
        return body.discs[0][3] if len(body.discs) > 1 else 0.0
    x1, y1, x2, y2 = body.segments[0]
    return math.atan2(y2 - y1, x2 - x1)


def _steer(deck: Deck, built: Built) -> None:
    """Controls and records of the deck."""
    if not deck.controls and not deck.recorded:
        return
    steering = built.grains.steering
    for control in deck.controls:
        steering.control(built.names[control.body - 1], *_prescribed(control, deck.nstep * deck.dt))
    steering.watch(*(built.names[body - 1] for body in deck.recorded))


def _prescribed(control: Control, seconds: float) -> list[Moved | Pushed | None]:
    """What is prescribed for each component; without a force it is free."""
    return [
        Moved(value / seconds) if kind == MOVED else Pushed(value) if value else None
        for kind, value in zip(control.kinds, control.values, strict=True)
    ]


def posture(built: Built, body: int) -> tuple[float, float, float]:
    """Place (x, y) and angle of a body (from 0) now."""
    name, grains = built.names[body], built.grains
    if isinstance(name, Clump):
        c = grains.steering.clumps
        x, y, angle = c.position[name.number, 0], c.position[name.number, 1], c.angle[name.number]
    else:
        x, y, angle = grains.discs.position[name, 0], grains.discs.position[name, 1], grains.discs.angle[name]
    return float(x), float(y), float(angle + built.heading[body])


def bodies_now(deck: Deck, built: Built) -> tuple[Body, ...]:
    """The deck's bodies where they are and as they move now."""
    d, found, numbers = built.grains.discs, [], iter(built.frames)
    for k, body in enumerate(deck.bodies):
        name, rows = built.names[k], range(int(built.first[k]), int(built.first[k + 1]))
        if isinstance(name, Clump):
            c = built.grains.steering.clumps
            moving = (*c.velocity[name.number].tolist(), float(c.spin[name.number]))
        else:
            moving = (*d.velocity[name].tolist(), float(d.spin[name]))
        if body.discs:
            own = tuple((float(d.radius[i]), *d.position[i].tolist(), float(d.angle[i])) for i in rows)
            found.append(replace(body, velocity=moving, discs=own))
        else:
            at = d.position[rows[0] : rows[-1] + 1].tolist()
            lines = tuple((*at[a], *at[b]) for a, b in next(numbers).ends)
            found.append(replace(body, velocity=moving, segments=lines))
    return tuple(found)


def bonded(built: Built, rows: list[tuple[int, int, int, float]]) -> None:
    """Bond the grains: rows of (point, point or segment, 1 where it is a segment, back tension)."""
    ends = np.array([row[:3] for row in rows], np.int64).reshape(-1, 3)
    built.grains.bonds = BondList(ends, np.array([row[3] for row in rows], float))
