"""What a deck holds: in_gm.dat (grains) and in_bc.dat (the run), read and written.

in_gm.dat, one record a line (DEMseg tutorial I-2, I-7):
    mode mode2 mode3
    dt gx gy
    nmat
    rho kn ks cn cs mu                for each material; mu in degrees
    x1 x2 y1 y2 thick
mode 0, random discs:                 mode 1, bodies:
    r1 r2                                 ncir nseg1 nseg2
    material                              ic imat nelm           for each body; discs, then segments, then containers
    void ratio                            vx vy vw
                                          ielm rad / xc yc wc    for each disc of it
                                          ielm x1 y1 / x2 y2     or for each segment of it
in_bc.dat:
    jclid iloop nstep nprn1 nprn2
    npfd, and the numbers of as many bodies to record
    npbd, and for as many bodies to control: ic, then kind and value of x, y and rotation;
    kind 1: moved by the value in all over the nstep steps, kind 0: pushed with the value
mode 0 numbers its discs from 1, each seed by another order of sizes; npfd and npbd name them as they do bodies.
jclid 0: a new start;  1: goes on from in_cf.dat, see state.py;  3: bonded by in_cf0.dat, see tension.py.
"""

import math
from dataclasses import dataclass, field, replace
from pathlib import Path

from porescale.common.core.errors import Fault
from porescale.demseg.numbers import Reader, table

GM, BC, CF, CF0 = "in_gm.dat", "in_bc.dat", "in_cf.dat", "in_cf0.dat"
MOST_MATERIALS = 255
MOST_BODIES = 10_000_000
LARGEST = 1e100
"""Of sizes, densities, stiffnesses: their squares and cubes are numbers, too; 1/LARGEST is the smallest."""
NEW, GO_ON, BONDED = 0, 1, 3
PUSHED, MOVED = 0, 1
AXES = ("x", "y", "rotation")
Four = tuple[float, float, float, float]
Three = tuple[float, float, float]


@dataclass(frozen=True)
class Stuff:
    """A material: density, normal and tangential stiffness and dashpot, friction angle in degrees."""

    density: float
    kn: float
    ks: float
    cn: float
    cs: float
    angle: float


@dataclass(frozen=True)
class Body:
    """A rigid body: material (from 1), velocity (x, y, rotation) and its elements: discs (radius, x, y, angle) or
    segments (x1, y1, x2, y2); long: a container, nseg2."""

    material: int
    velocity: Three
    discs: tuple[Four, ...] = ()
    segments: tuple[Four, ...] = ()
    long: bool = False


@dataclass(frozen=True)
class Random:
    """Discs of mode 0: smallest and largest radius, material, void ratio."""

    smallest: float
    largest: float
    material: int
    void_ratio: float

    def count(self, domain: Four) -> int:
        """How many discs of radii uniform between the two fill a domain to the void ratio; one over MOST_BODIES stands
        for all that are more."""
        x1, x2, y1, y2 = domain
        mean = math.pi * (self.smallest**2 + self.smallest * self.largest + self.largest**2) / 3.0
        most = (MOST_BODIES + 1.0) * mean * (1.0 + self.void_ratio)
        room = (x2 - x1) * (y2 - y1)
        return MOST_BODIES + 1 if room >= most else round(room / (1.0 + self.void_ratio) / mean)


@dataclass(frozen=True)
class Control:
    """A controlled body (from 1): kinds and values of x, y, rotation."""

    body: int
    kinds: tuple[int, int, int]
    values: Three


@dataclass(frozen=True)
class Deck:
    """A deck; names as in the module's layout.  bodies: none in mode 0, where ``random`` states what to make.

    file : in_gm.dat with its folder;  lines : of each body the line that it begins on, from 1, then those of its
    elements, or of mode 0 those of its radii, material and void ratio;  none of bodies that stand in no file.
    """

    dt: float
    gravity: tuple[float, float]
    stuff: tuple[Stuff, ...]
    domain: Four  # x1 x2 y1 y2
    thick: float
    bodies: tuple[Body, ...]
    random: Random | None
    jclid: int
    iloop: int
    nstep: int
    nprn1: int
    nprn2: int
    recorded: tuple[int, ...] = ()
    controls: tuple[Control, ...] = ()
    file: Path = field(default=Path(GM), compare=False)
    lines: tuple[tuple[int, ...], ...] = field(default=(), compare=False)

    def fault(self, body: int, problem: str, repair: str = "", element: int | None = None) -> Fault:
        """A fault of a body, or of its ``element`` (both from 0), that names file and line, and numbers from 1."""
        key = f"body {body + 1}" + ("" if element is None else f", element {element + 1}")
        if self.lines:
            key = f"line {self.lines[body][0 if element is None else 1 + element]}, {key}"
        return Fault(key, None, problem, repair=repair, file=str(self.file))


def read_deck(folder: Path) -> Deck:
    """The deck in ``folder``; InputError naming file, line, field and what was expected, one line a fault."""
    deck = read_grains(folder)
    return _boundary(Reader(folder / BC), deck)


def read_grains(folder: Path) -> Deck:
    """What in_gm.dat in ``folder`` has of a deck, the rest as for one step; InputError as of read_deck."""
    return _grains(Reader(folder / GM))


def _grains(file: Reader) -> Deck:
    mode, mode2, mode3 = file.record(("mode", int), ("mode2", int), ("mode3", int))
    file.must(mode in (0, 1), "mode", mode, "0 (random discs) or 1 (bodies)")
    for name, value in (("mode2", mode2), ("mode3", mode3)):
        file.must(value == 0, name, value, "0, the default: the tutorial says what no other does")
    if mode not in (0, 1):
        file.done()  # what follows has a layout that is not known
    dt, gx, gy = file.record(("dt", float), ("gx", float), ("gy", float))
    file.must(dt > 0.0, "dt", dt, "> 0")
    (count,) = file.record(("nmat", int))
    file.must(1 <= count <= MOST_MATERIALS, "nmat", count, f"1 to {MOST_MATERIALS}")
    stuff = tuple(_stuff(file) for _ in range(min(int(count), MOST_MATERIALS)))
    x1, x2, y1, y2, thick = file.record(*((name, float) for name in ("x1", "x2", "y1", "y2", "thick")))
    file.must(x2 > x1, "x2", x2, f"> x1 = {x1:g}")
    file.must(y2 > y1, "y2", y2, f"> y1 = {y1:g}")
    file.must(thick >= 0.0, "thick", thick, ">= 0")
    if thick > 0.0:
        _sized(file, "thick", thick)
    random, bodies, lines = None, tuple[Body, ...](), tuple[tuple[int, ...], ...]()
    if mode == 0:
        random, own = _random(file, len(stuff), (x1, x2, y1, y2))
        lines = (own,)
    else:
        ncir, nseg1, nseg2 = file.record(("ncir", int), ("nseg1", int), ("nseg2", int))
        for name, value in (("ncir", ncir), ("nseg1", nseg1), ("nseg2", nseg2)):
            file.must(0 <= value <= MOST_BODIES, name, value, "0 or more")
        file.must(ncir + nseg1 + nseg2 > 0, "ncir nseg1 nseg2", 0, "at least one body")
        if min(ncir, nseg1, nseg2) < 0 or not 0 < ncir + nseg1 + nseg2 <= MOST_BODIES:
            file.done()
        first = (int(ncir), int(ncir + nseg1), int(ncir + nseg1 + nseg2))
        domain = (x1, x2, y1, y2)
        read = [_body(file, k + 1, k < first[0], k >= first[1], len(stuff), domain) for k in range(first[2])]
        bodies, lines = tuple(body for body, _ in read), tuple(places for _, places in read)
    file.done()
    return Deck(
        dt, (gx, gy), stuff, (x1, x2, y1, y2), thick, bodies, random, NEW, 0, 1, 1, 1, file=file.path, lines=lines
    )  # fmt: skip


def _stuff(file: Reader) -> Stuff:
    names = ("rho", "kn", "ks", "cn", "cs", "mu")
    values = file.record(*((name, float) for name in names))
    for name, value in zip(names, values, strict=True):
        if name in ("rho", "kn"):
            _sized(file, name, value)
        elif name == "mu":
            file.must(0.0 <= value < 90.0, name, value, "an angle of friction in degrees, 0 to 90")
        else:
            file.must(value >= 0.0, name, value, ">= 0")
    return Stuff(*values)


def _sized(file: Reader, name: str, value: float) -> None:
    """Note a fault of a size, density or stiffness that is not positive, or beyond what squares of it can be."""
    fine = 1.0 / LARGEST < value < LARGEST
    file.must(fine, name, value, f"{1.0 / LARGEST:.0e} to {LARGEST:.0e}" if value > 0.0 else "> 0")


def _random(file: Reader, stuff: int, domain: Four) -> tuple[Random, tuple[int, ...]]:
    """What to make in mode 0, and the lines of radii, material and void ratio."""
    r1, r2 = file.record(("r1", float), ("r2", float))
    lines = [file.begun]
    _sized(file, "r1", r1)
    file.must(r2 >= r1, "r2", r2, f">= r1 = {r1:g}")
    (material,) = file.record(("material", int))
    lines.append(file.begun)
    file.must(1 <= material <= stuff, "material", material, f"1 to {stuff}")
    (void,) = file.record(("void ratio", float))
    lines.append(file.begun)
    file.must(void > 0.0, "void ratio", void, "> 0")
    made = Random(r1, r2, int(material), void)
    if not file.faults:
        fits = made.count(domain) <= MOST_BODIES
        file.must(fits, "void ratio", void, f"a larger one, or larger discs: it makes more than {MOST_BODIES} of them")
    return made, tuple(lines)


def _body(
    file: Reader, number: int, of_discs: bool, long: bool, stuff: int, domain: Four
) -> tuple[Body, tuple[int, ...]]:
    """The next body, and the line that it begins on, then those of its elements."""
    ic, material, count = file.record(("ic", int), ("imat", int), ("nelm", int))
    lines = [file.begun]
    file.must(ic == number, "ic", ic, f"{number}: bodies are numbered from 1, discs before segments")
    file.must(1 <= material <= stuff, "imat", material, f"1 to {stuff}")
    file.must(count >= 1, "nelm", count, "1 or more")
    vx, vy, vw = file.record(("vx", float), ("vy", float), ("vw", float))
    names = ("rad", "xc", "yc", "wc") if of_discs else ("x1", "y1", "x2", "y2")
    elements = []
    for k in range(int(count)):
        ielm, a, b, c, d = file.record(("ielm", int), *((name, float) for name in names), rows=2)
        lines.append(file.begun)
        file.must(ielm == k + 1, "ielm", ielm, f"{k + 1}: elements of a body are numbered from 1")
        if of_discs:
            _sized(file, "rad", a)
            _inside(file, domain, {"xc": b, "yc": c})
        else:
            file.must((a, b) != (c, d), "x2", c, "an end other than the first")
        elements.append((a, b, c, d))
    own = tuple(elements)
    body = Body(int(material), (vx, vy, vw), own if of_discs else (), () if of_discs else own, long)
    return body, tuple(lines)


def _inside(file: Reader, domain: Four, centre: dict[str, float]) -> None:
    """Note a fault of each coordinate of a disc's centre that does not lie within the domain: all that is behind a side
    is solid, and a centre on it is pressed in by the whole radius."""
    for name, value in centre.items():
        low, high = domain[:2] if name[0] == "x" else domain[2:]
        why = f"between {low:g} and {high:g}, inside the domain: its sides would throw the disc"
        file.must(low < value < high or low >= high, name, value, why)


def _boundary(file: Reader, deck: Deck) -> Deck:
    names = ("jclid", "iloop", "nstep", "nprn1", "nprn2")
    jclid, *counts = (int(value) for value in file.record(*((name, int) for name in names)))
    file.must(jclid in (NEW, GO_ON, BONDED), "jclid", jclid, "0 (new), 1 (goes on), 3 (bonds)")
    for name, value in zip(names[1:], counts, strict=True):
        file.must(value >= (name != "iloop"), name, value, "0 or more" if name == "iloop" else "1 or more")
    most = len(deck.bodies) if deck.random is None else deck.random.count(deck.domain)
    (npfd,) = file.record(("npfd", int))
    file.must(0 <= npfd <= most, "npfd", npfd, f"0 to {most}")
    watched = [f"recorded body {k + 1}" for k in range(int(npfd) if npfd <= most else 0)]
    recorded = [int(n) for n in file.record(*((name, int) for name in watched), rows=None)] if watched else []
    for name, n in zip(watched, recorded, strict=True):
        file.must(1 <= n <= most, name, n, f"1 to {most}")
    (npbd,) = file.record(("npbd", int))
    file.must(0 <= npbd <= most, "npbd", npbd, f"0 to {most}")
    controls = tuple(_control(file, most) for _ in range(min(int(npbd), most)))
    for k, control in enumerate(controls):
        file.must(control.body not in {other.body for other in controls[:k]}, "ic", control.body, "each body once")
    file.done()
    iloop, nstep, nprn1, nprn2 = counts
    return replace(
        deck, jclid=jclid, iloop=iloop, nstep=nstep, nprn1=nprn1, nprn2=nprn2, recorded=tuple(recorded),
        controls=controls,
    )  # fmt: skip


def _control(file: Reader, most: int) -> Control:
    fields = [field for axis in AXES for field in ((f"kind of {axis}", int), (f"value of {axis}", float))]
    body, *rest = file.record(("ic", int), *fields)
    file.must(1 <= body <= most, "ic", body, f"1 to {most}")
    kinds, values = tuple(int(kind) for kind in rest[::2]), tuple(rest[1::2])
    for axis, kind in zip(AXES, kinds, strict=True):
        file.must(kind in (PUSHED, MOVED), f"kind of {axis}", kind, "1 (moved) or 0 (pushed)")
    return Control(int(body), (kinds[0], kinds[1], kinds[2]), (values[0], values[1], values[2]))


def grains_text(deck: Deck) -> str:
    """in_gm.dat of a deck with bodies (mode 1)."""
    own = [(s.density, s.kn, s.ks, s.cn, s.cs, s.angle) for s in deck.stuff]
    kinds = [sum(bool(b.discs) for b in deck.bodies), sum(not b.discs and not b.long for b in deck.bodies)]
    kinds.append(len(deck.bodies) - sum(kinds))
    head = table([(1, 0, 0), (deck.dt, *deck.gravity), (len(own),), *own, (*deck.domain, deck.thick), kinds])
    rows: list[tuple[float | int, ...]] = []
    for number, body in enumerate(deck.bodies):
        elements, split = (body.discs, 1) if body.discs else (body.segments, 2)
        rows += [(number + 1, body.material, len(elements)), body.velocity]
        for k, element in enumerate(elements):
            rows += [(k + 1, *element[:split]), element[split:]]
    return head + table(rows)


def boundary_text(deck: Deck) -> str:
    """in_bc.dat of a deck."""
    controlled = [
        (c.body, *(part for pair in zip(c.kinds, c.values, strict=True) for part in pair)) for c in deck.controls
    ]  # fmt: skip
    head = (deck.jclid, deck.iloop, deck.nstep, deck.nprn1, deck.nprn2)
    return table([head, (len(deck.recorded),), *((n,) for n in deck.recorded), (len(controlled),), *controlled])
