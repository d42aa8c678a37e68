"""Larger grains: nothing changes in an element test, all is stronger in a shear box that is few grains long."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from porescale import Floats
from porescale.dem import Box, Grains, Linear, Rectangle, make_discs
from porescale.dem.prepare import Compactor, kept
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
LENGTH, HEIGHT, PRESSURE, DENSITY, SPREAD = 0.2, 0.1, 1e4, 2500.0, 0.2  # m, m, Pa, kg/m³, -
STIFFNESS, RESTITUTION, FRICTION = 1e7, 0.3, 0.5  # N/m: a thousand times the pressure
SPEED, TRAVEL = 0.02, 0.02  # m/s, m of the upper half
ACROSS, SHORT = (10, 14, 20, 28), 15
"""Lengths of the box over the diameter of the grains; below the second a box counts as short, the last is long."""
LARGER, GRAINS, SHEAR, RATE = 8, 150, 0.2, 0.2  # times, discs, shear, 1/s: the element test
ROWS, LOOKS = 200, 5


@dataclass
class Shearing:
    """travel over the length of the box (r,);  ratio of shear to normal stress (r,);  risen: of the lid over the
    diameter (r,);  discs at the end, (n, 2) and (n,) m, the upper half's walls, m."""

    travel: Floats
    ratio: Floats
    risen: Floats
    position: Floats
    radius: Floats
    walls: Floats


def law(mass: float, friction: float) -> Linear:
    """Contacts of discs of mean ``mass`` (kg/m)."""
    return Linear.from_restitution(RESTITUTION, 0.5 * mass, STIFFNESS, 0.5 * STIFFNESS, 0.0, friction)


def pressed(
    diameter: float, size: tuple[float, float], seed: int, friction: float, periodic: bool
) -> tuple[Grains, Linear]:  # fmt: skip
    """A dense packing of discs in a rectangle of ``size`` (m) under PRESSURE, and its law."""
    count = round(0.83 * size[0] * size[1] / (math.pi / 4.0 * diameter**2))
    radius = 0.5 * diameter * (1.0 + SPREAD * (2.0 * (np.arange(count) + 0.5) / count - 1.0))
    contact = law(DENSITY * math.pi / 4.0 * diameter**2, friction)
    press = Compactor((0.0, 0.0), size, contact, (periodic, periodic), 0.0, DENSITY, seed)
    return kept(press, radius, PRESSURE).grains, contact


def box_shear(across: int, seed: int = 1, friction: float = FRICTION, *, travel: float = TRAVEL) -> Shearing:
    """Direct shear: the upper half of the box moves to the right, its lid bears PRESSURE."""
    diameter = LENGTH / across
    packing, contact = pressed(diameter, (LENGTH, HEIGHT), seed, friction, periodic=False)
    discs = make_discs(packing.discs.position, packing.discs.radius, DENSITY)
    grains = Grains(discs, contact, Box((-LENGTH, 0.0), (2.0 * LENGTH, HEIGHT), "open", "open"))
    ends, middle = ((-LENGTH, 0.0), (LENGTH, 2.0 * LENGTH)), 0.5 * HEIGHT
    lower = [Rectangle((a, -HEIGHT), (b, middle)) for a, b in ends]
    upper = [Rectangle((a, middle), (b, 3.0 * HEIGHT), (SPEED, 0.0)) for a, b in ends]
    grains.set_rectangles([*lower, *upper])
    lid = grains.wall_names.index("top")
    grains.steering.servo_wall("top", stress=PRESSURE, length=LENGTH, speed=0.5)
    dt = grains.stable_step()
    each = max(1, round(travel / SPEED / dt / (ROWS * LOOKS)))
    rows: list[tuple[float, ...]] = []
    while not rows or rows[-1][0] < travel:
        looks = []
        for _ in range(LOOKS):
            grains.step(dt, None, count=each)
            pushed = -float(grains.rectangle_force[2:, 0].sum() + grains.wall_force[lid, 0])
            looks.append((pushed, float(grains.wall_force[lid, 1]), float(grains.walls[lid, 1])))
        pushed, borne, high = np.mean(looks, axis=0)
        rows.append((SPEED * grains.time, float(pushed / borne), float(high)))
    gone, ratio, high = np.array(rows).T
    return Shearing(gone / LENGTH, ratio, (high - HEIGHT) / diameter, discs.position.copy(), discs.radius.copy(),
                    grains.rectangles.copy())  # fmt: skip


def element(times: float, seed: int = 1, friction: float = FRICTION) -> tuple[Floats, Floats, Floats]:
    """Simple shear of a periodic cell of GRAINS discs, all lengths ``times`` those of 1 cm: shear, ratio of shear to
    normal stress, solid fraction; the packing is that of 1 cm, enlarged."""
    side = 0.01 * math.sqrt(GRAINS * math.pi / 4.0 / 0.83)
    packing, contact = pressed(0.01, (side, side), seed, friction, periodic=True)
    d = packing.discs
    slower = Linear(contact.stiffness, times * contact.damping, contact.tangential_stiffness, 0.0, friction)
    box = Box((0.0, 0.0), (times * side, times * side), *("periodic",) * 4)
    grains = Grains(make_discs(times * d.position, times * d.radius, DENSITY), slower, box)
    rate = RATE / times
    grains.steering.strain_cell(xy=rate, pressure=(None, PRESSURE), limit=1.0 / times)
    dt = times * Grains(make_discs(d.position, d.radius, DENSITY), contact, packing.box).stable_step()
    each = max(1, round(SHEAR / rate / dt / (ROWS * LOOKS)))
    rows = []
    for _ in range(ROWS):
        looks = []
        for _ in range(LOOKS):
            grains.step(dt, None, count=each)
            (width, _), (_, height) = grains.steering.edges()
            _, xy, yy = grains.steering.cell_pressure()
            looks.append((rate * grains.time, -xy / yy, float(grains.discs.area.sum()) / (width * height)))
        rows.append(np.mean(looks, axis=0))
    shear, ratio, fraction = np.array(rows).T
    return shear, ratio, fraction


def peak(it: Shearing) -> float:
    """Largest stress ratio, of a running mean over 1/200 of the length."""
    near = np.abs(it.travel[:, None] - it.travel[None, :]) < 0.0025
    return float(((near @ it.ratio) / near.sum(axis=1)).max())


def residual(it: Shearing) -> float:
    """Mean stress ratio over the second half of the travel."""
    return float(it.ratio[it.travel > 0.5 * it.travel[-1]].mean())


def measure(
    friction: float = FRICTION, packings: int = 6, seed: int = 1, across: tuple[int, ...] = ACROSS
) -> tuple[dict[str, float], Figure]:  # fmt: skip
    """Means over packings, and the picture."""
    small, large = element(1.0, seed, friction), element(float(LARGER), seed, friction)
    runs = {n: [box_shear(n, it, friction) for it in range(seed, seed + packings)] for n in across}
    numbers = {
        "largest difference of stress ratios, grains eight times as large": float(np.abs(small[1] - large[1]).max())
    }
    return numbers | strengths(runs), draw(small, large, runs)


def strengths(runs: dict[int, list[Shearing]]) -> dict[str, float]:
    """Stress ratios of the longest box, and how much more those have that are short."""
    peaks, rests = (
        {n: float(np.mean([of(it) for it in found])) for n, found in runs.items()} for of in (peak, residual)
    )
    long, short = max(runs), [n for n in runs if n < SHORT]
    return {
        "peak, long box": peaks[long],
        "residual, long box": rests[long],
        "peak, short boxes less long": float(np.mean([peaks[n] for n in short])) - peaks[long],
        "residual, short boxes less long": float(np.mean([rests[n] for n in short])) - rests[long],
    }


def draw(small: tuple[Floats, ...], large: tuple[Floats, ...], runs: dict[int, list[Shearing]]) -> Figure:
    """Element tests; box tests over travel; their peaks over the size of grains; a box at the end."""
    figure, axes = stage(4, 12.0, 3.0)
    axes[0].plot(small[0], small[1], color="#8c1c2f", lw=1.5, label="1 cm")
    axes[0].plot(large[0], large[1], "k:", lw=1.2, label=f"{LARGER} cm")
    few, many = min(runs), max(runs)
    for n, colour in ((few, "#2a6f97"), (many, "#8c1c2f")):
        for k, it in enumerate(runs[n]):
            label = f"{n} grains long" if k == 0 else None
            axes[1].plot(it.travel, it.ratio, color=colour, lw=0.6, label=label)
    for n, found in runs.items():
        axes[2].plot(np.full(len(found), 1.0 / n), [peak(it) for it in found], ".", color="0.6")
        axes[2].plot(1.0 / n, np.mean([peak(it) for it in found]), "o", color="#8c1c2f")
        axes[2].plot(1.0 / n, np.mean([residual(it) for it in found]), "s", color="#2a6f97")
    axes[2].plot([], [], "o", color="#8c1c2f", label="peak")
    axes[2].plot([], [], "s", color="#2a6f97", label="residual")
    final(axes[3], runs[few][0])
    axes[0].set(xlabel="shear", ylabel="stress ratio", ylim=(0, 0.7), title="element test, periodic cell")
    axes[1].set(xlabel="travel over length", ylabel="stress ratio", ylim=(0, 1.2), title="box shear")
    axes[2].set(xlabel="diameter over length", ylabel="stress ratio", ylim=(0, 1.2), title="box shear, means")
    for ax in axes[:3]:
        ax.legend(fontsize=7)
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


def final(ax: Axes, it: Shearing) -> None:
    """A box at the end of its travel."""
    size = 2.0 * it.radius
    ax.add_collection(
        EllipseCollection(size, size, np.zeros(len(size)), units="x", offsets=it.position, transOffset=ax.transData,
                          facecolors="#d9b36c", edgecolors="#6b4a1e", linewidths=0.4)
    )  # fmt: skip
    gone = float(it.travel[-1]) * LENGTH
    for x in (0.0, LENGTH):
        ax.plot([x, x], [0.0, 0.5 * HEIGHT], "k", lw=2)
        ax.plot([x + gone, x + gone], [0.5 * HEIGHT, 1.3 * HEIGHT], "k", lw=2)
    ax.plot([0.0, LENGTH], [0.0, 0.0], "k", lw=2)
    ax.set(aspect="equal", xlim=(-0.01, 0.24), ylim=(-0.01, 0.14), xticks=[], yticks=[], title="few grains, at the end")


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, friction=(float, FRICTION, "friction between discs and at walls"),
        packings=(int, 6, "packings for each size", 1), seed=(int, 1, "of the first packing"),
    )  # fmt: skip
    raise SystemExit(conclude(HERE, *measure(asked.friction, asked.packings, asked.seed), asked.out))
