"""Soil pushes a block off its base: which blocks it moves by itself, and at what push a heavy one slides."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from porescale import GRAVITY, Floats
from porescale.common.neighbors import place
from porescale.common.pictures import write_film
from porescale.dem import Box, Clump, Control, Grains, Linear, Moved, Table, chain, framed, make_discs, polygon
from porescale.output import LARGEST, PLATE, Shot, conclude, draw_bodies, frame, options, pixels, shot, stage
from porescale.validation.dem import segments

HERE = Path(__file__).resolve().parent
DIAMETER, DENSITY = 0.02, 2500.0  # m, mean, radii 3:5; kg/m³
FRICTION = math.tan(math.radians(27.0))  # of everything: the tutorial's, I-7
LAW = Linear.from_restitution(0.3, math.pi / 8.0 * DIAMETER**2 * DENSITY, 5e6, 1.25e6, 0.0, FRICTION)
LONG, HIGH, WIDE = 0.6, 0.4, 0.3  # m: length and height of the soil, width of the block
THICK = 0.005  # m, of all segments
CLEAR = 2.2 * THICK  # m between ends of segments that must not touch; too narrow for discs
PUSHER, GROUND, BASE, BLOCK = (Clump(k) for k in range(4))
YIELD, PUSH = 0.01, 0.02  # m/s: the block drawn away, the plate pushed in
LASTS = 4.0  # s of the push
RAMP = 0.05  # s in which a speed is come to
EACH = 0.01  # s between rows
SLID = 0.01  # m: how far a block has to go within a second to count as pushed off
WEIGHTS = (0.4, 0.6, 0.8, 1.0, 1.2, 1.6)
HEAVY = 2.0  # weight over half γh² of the block that the plate pushes off
BAND = (0.34, 0.57)
"""Active coefficient by Coulomb 1776: tan²(45° - φ/2) at φ = 16° (critical, cases/biaxial_compression) behind a smooth
back, and cos²φ/(1 + √(sin 2φ sin φ/cos φ))² at φ = 24° (dense, peak) behind one as rough."""
COLOUR = "#9fb4c7"


@dataclass
class Record:
    """Row by row: time s, way of plate and of block m, force (r, 2) N/m of the soil on the block and of the plate on
    the soil, of the block on its base, each (r,) or (r, 2); shots of some rows."""

    grains: Grains
    time: Floats
    pushed: Floats
    gone: Floats
    soil: Floats
    plate: Floats
    base: Floats
    shots: list[tuple[int, Shot]] = field(default_factory=list)


def laid(seed: int) -> Grains:
    """Loose discs between a plate and a block that is held upright and where it is, both on long segments.

    The block's density is that of the discs until another is given.
    """
    rng = np.random.default_rng(seed)
    area = LONG * HIGH * 0.8
    radius = rng.uniform(0.375, 0.625, round(area / (math.pi * DIAMETER**2 * (0.25 + 0.125**2 / 3.0)))) * DIAMETER
    room = (LONG - THICK, 1.35 * HIGH)
    at = place((THICK, THICK), (THICK + room[0], THICK + room[1]), radii=radius, seed=seed).position
    left = LONG + 2.0 * THICK  # inner line of the block: its outside is THICK to the left
    foot, tall = left - 0.1 * THICK, HIGH + 0.1
    parts = [
        chain([(0.0, CLEAR - THICK), (0.0, 2.0 * HIGH)], THICK, DENSITY, long=True),
        chain([(-LONG, -THICK), (foot - CLEAR, -THICK)], THICK, DENSITY, long=True),
        chain([(foot, -THICK), (left + 3.0 * WIDE, -THICK)], THICK, DENSITY, long=True),
        polygon([(left, THICK), (left + WIDE, THICK), (left + WIDE, tall), (left, tall)], THICK, DENSITY, long=True),
    ]
    box = Box((-1.0, -1.0), (3.0, 3.0), **segments.OPEN)
    grains = framed(make_discs(at, radius, DENSITY), parts, LAW, box)
    for body in (PUSHER, GROUND, BASE):
        grains.steering.control(body, segments.REST, segments.REST, segments.REST)
    grains.steering.control(BLOCK, segments.REST, None, segments.REST)
    return grains


@cache
def settled(seed: int) -> dict[str, Any]:
    """State of the site once its discs have come to rest."""
    grains = laid(seed)
    dt, load = grains.stable_step(), segments.weights(grains.discs)
    for drag in (0.0, 5.0):
        grains.step(dt, load, count=round(0.8 / dt), drag=drag)
    grains.reset_clock()
    return grains.state()


def site(seed: int) -> Grains:
    """Discs at rest behind the block."""
    grains = laid(seed)
    grains.restore(settled(seed))
    return grains


def weigh(grains: Grains, weight: float) -> None:
    """Give the block this weight (N/m), and let it come to rest on its base, held from going and turning."""
    c, members = grains.steering.clumps, grains.steering.clumps.discs_of(BLOCK.number)
    factor = weight / (float(c.mass[BLOCK.number]) * GRAVITY)
    c.mass[BLOCK.number] *= factor
    c.inertia[BLOCK.number] *= factor
    grains.discs.mass[members] *= factor
    grains.discs.inertia[members] *= factor
    dt, load = grains.stable_step(), segments.weights(grains.discs)
    grains.step(dt, load, count=round(0.2 / dt), drag=20.0)
    grains.reset_clock()


def run(grains: Grains, seconds: float, block: Sequence[Control | None], speed: float = 0.0, looks: int = 0) -> Record:
    """What happens while the block is controlled so and the plate comes to ``speed`` (m/s); looks : shots taken."""
    grains.steering.control(PUSHER, Moved(Table([0.0, RAMP], [0.0, speed])), segments.REST, segments.REST)
    grains.steering.control(BLOCK, *block)
    grains.steering.watch(PUSHER, BASE, BLOCK)
    dt, load = grains.stable_step(), segments.weights(grains.discs)
    count, rows, shots = round(EACH / dt), [], [(0, shot(grains))]
    total = round(seconds / EACH)
    for k in range(total):
        grains.step(dt, load, count=count)
        plate, base, moved = grains.steering.record()
        on_block = np.add(moved.contact[:2], base.contact[:2])  # less what the base does
        rows.append((grains.time, plate.displacement[0], moved.displacement[0], *on_block,
                     *np.negative(plate.contact[:2]), *base.contact[:2]))  # fmt: skip
        if looks and (k + 1) % max(total // looks, 1) == 0:
            shots.append((k, shot(grains)))
    grains.check()
    t, pushed, gone, sx, sy, px, py, bx, by = np.array(rows).T
    soil, push, under = (np.column_stack(each) for each in ((sx, sy), (px, py), (bx, by)))
    return Record(grains, t, pushed, gone, soil, push, under, shots)


def surface(grains: Grains) -> tuple[float, float]:
    """Height of the soil (m) and its weight over its area (N/m³)."""
    d = grains.discs
    free = grains.steering.clumps.group < 0
    top = d.position[free, 1] + d.radius[free]
    x = d.position[free, 0]
    strips = np.linspace(0.0, LONG, 16)
    height = float(np.mean([top[(x >= a) & (x < b)].max() for a, b in itertools.pairwise(strips)]))
    return height, float(d.mass[free].sum()) * GRAVITY / (LONG * height)


@dataclass
class Found:
    """half: soil's weight over area times half its height squared, N/m;  drawn: the block drawn away;  freed: weights
    over half and the record of each free block;  pushed: a heavy block and the plate."""

    half: float
    drawn: Record
    freed: list[tuple[float, Record]]
    pushed: Record
    heavy: float

    @property
    def active(self) -> tuple[float, float]:
        """Thrust, and drag down the back of the block, over half, once the block has gone 2 mm."""
        far = self.drawn.gone > 2e-3
        x, y = self.drawn.soil[far].mean(axis=0) / self.half
        return float(x), -float(y)

    @property
    def critical(self) -> float:
        """Weight over half that friction on the base needs to bear the active thrust: P = mu (W + V)."""
        thrust, drag = self.active
        return thrust / FRICTION - drag

    @property
    def threshold(self) -> float:
        """Weight over half of a free block that goes SLID, between those tried: way over weight as a power."""
        weight, way = np.array([(each, record.gone[-1]) for each, record in self.freed]).T
        return float(np.exp(np.interp(-math.log(SLID), -np.log(way), np.log(weight))))

    @property
    def sliding(self) -> NDArray[np.bool_]:
        """Rows in which the pushed block goes and no disc has come under it yet."""
        speed = np.gradient(self.pushed.gone, self.pushed.time)
        return np.asarray((speed > 0.2 * PUSH) & (self.pushed.gone > 1e-3) & (self.pushed.gone < SLID))


def find(seed: int = 1, weights_over_half: Sequence[float] = WEIGHTS, heavy: float = HEAVY, looks: int = 0) -> Found:
    """All tests on one site."""
    grains = site(seed)
    height, unit = surface(grains)
    half = 0.5 * unit * height**2
    away = Moved(Table([0.0, RAMP], [0.0, YIELD]))
    drawn = run(grains, 1.0, (away, None, segments.REST))
    freed = []
    for weight in weights_over_half:
        grains = site(seed)
        weigh(grains, weight * half)
        freed.append((weight, run(grains, 1.0, (None, None, None), looks=1)))
    grains = site(seed)
    weigh(grains, heavy * half)
    return Found(half, drawn, freed, run(grains, LASTS, (None, None, None), PUSH, looks), heavy)


def said(found: Found) -> dict[str, float]:
    """Numbers of one site."""
    half, pushed, slides = found.half, found.pushed, found.sliding
    return {
        "thrust at rest": float(found.drawn.soil[0, 0] / half),
        "active thrust": found.active[0],
        "free block that goes 10 mm: weight over the critical one": found.threshold / found.critical,
        "pushed block: thrust over μ N while it slides": float(
            pushed.soil[slides, 0].mean() / (-FRICTION * pushed.base[slides, 1].mean())
        ),
    }


def measure(packings: int = 4, seed: int = 1, looks: int = 0) -> tuple[dict[str, float], Figure, Found]:
    """Means over packings, the picture of the first, and its tests for more."""
    first = find(seed, looks=looks)
    each = [said(first), *(said(find(seed + k)) for k in range(1, packings))]
    return {name: float(np.mean([it[name] for it in each])) for name in each[0]}, draw(first), first


def draw(found: Found) -> Figure:
    """A light block gone, a heavy one pushed, thrust of the drawn one, ways of free ones, forces of the push."""
    figure, axes = stage(5, 16.0, 3.0)
    light, record = found.freed[0]
    sight(axes[0], record, len(record.shots) - 1)
    axes[0].set_title(f"weight {light:g}, free for {record.time[-1]:.0f} s", fontsize=9)
    p = found.pushed
    sight(axes[1], p, len(p.shots) - 1)
    axes[1].set_title(f"weight {found.heavy:g}, plate pushed {1e3 * p.pushed[-1]:.0f} mm", fontsize=9)
    axes[2].plot(1e3 * found.drawn.gone, found.drawn.soil[:, 0] / found.half, color="#8c1c2f", lw=1)
    axes[2].axhspan(*BAND, color="0.9")
    axes[2].set(xlabel="block drawn away, mm", ylabel="thrust over γh²/2", ylim=(0, 1), title="active thrust")
    for weight, record in found.freed:
        axes[3].plot(record.time, 1e3 * record.gone, lw=1, label=f"{weight:.1f}")
    axes[3].set(xlabel="time, s", ylabel="way, mm", ylim=(-2, 60), title=f"free blocks, critical {found.critical:.2f}")
    axes[3].legend(fontsize=7, title="weight", title_fontsize=7)
    way, clean = 1e3 * p.pushed, p.gone < SLID
    axes[4].plot(way, p.plate[:, 0] / found.half, lw=0.9, label="plate on soil")
    axes[4].plot(way, p.soil[:, 0] / found.half, lw=0.9, label="soil on block")
    axes[4].plot(way[clean], -FRICTION * p.base[clean, 1] / found.half, "k:", lw=1.2, label="μ N of the base")
    axes[4].plot(way, p.gone / 0.02, color="0.6", lw=1, label="way of block / 20 mm")
    axes[4].set(xlabel="way of the plate, mm", ylabel="force over γh²/2", title="pushed")
    axes[4].legend(fontsize=7)
    return figure


def sight(ax: Axes, record: Record, which: int) -> None:
    """Plate, soil, block and base at a shot; soil in bands by its place at the start."""
    grains, at = record.grains, record.shots[which][1]
    first = record.shots[0][1].position
    colours = [LARGEST if int(x / 0.05) % 2 else "#b9a77c" for x in first[:, 0].tolist()]
    block = grains.steering.clumps.discs_of(BLOCK.number)
    for k in block.tolist():
        colours[k] = COLOUR
    draw_bodies(ax, grains, at, colours)
    frame(ax, (-0.06, LONG + 1.9 * WIDE, -0.03, HIGH + 0.16))


def film(record: Record, half: float, stem: Path) -> Path:
    """The push, with the forces so far."""
    images = []
    way = 1e3 * record.pushed
    for which, (row, _) in enumerate(record.shots):
        figure, (left, right) = stage(2, 11.0, 3.6)
        sight(left, record, which)
        right.plot(way[: row + 1], record.soil[: row + 1, 0] / half, color="#8c1c2f", lw=1, label="soil on block")
        right.plot(way[: row + 1], record.plate[: row + 1, 0] / half, color=PLATE, lw=1, label="plate on soil")
        right.set(xlim=(0, way[-1]), ylim=(0, 1.1 * record.plate[:, 0].max() / half), xlabel="way of the plate, mm",
                  ylabel="force over γh²/2")  # fmt: skip
        right.legend(fontsize=7, loc="lower right")
        images.append(pixels(figure))
    return write_film(stem, images, 15)


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE, packings=(int, 4, "packings", 1), seed=(int, 1, "of the first"))
    numbers, figure, found = measure(asked.packings, asked.seed, looks=90)
    print(f"film: {film(found.pushed, found.half, asked.out / 'pushed')}")
    raise SystemExit(conclude(HERE, numbers, figure, asked.out))
