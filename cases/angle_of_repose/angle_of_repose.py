"""582 discs lose one wall of their box and flow over a toe: the angle of the slope they leave, against friction."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from porescale import Floats
from porescale.common.neighbors import place
from porescale.dem import HIGH, Box, Grains, Linear, Plate, Rectangle, make_discs
from porescale.dem.measures import energy_budget
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
COUNT, SIDE, TOE, GRAVITY, DT = 582, 80.0, 4.0, 980.0, 5e-5  # discs, cm, cm, cm/s², s: the tutorial's
SETTLING, RUNNING = 12_000, 100_000  # steps
TUTORIAL = math.tan(math.radians(27.0))
FRICTIONS = (0.1, 0.2, 0.3, TUTORIAL, 0.8, 1.2, 2.0)
SCATTER = 1.9
"""Standard deviation of the angle over packings, degrees: that of the last recorded run."""
FOOT, HEAD = 0.15, 0.85
"""Heights between toe and crest, as shares, between which the slope counts: not the foot, nor the rounded crest."""


@dataclass
class Heap:
    """grains at the end; their energy budget, erg/cm; the book's step, s."""

    grains: Grains
    book: dict[str, float]


def heap(friction: float = TUTORIAL, seed: int = 1, dt: float = DT, book: bool = True, turning: bool = True) -> Heap:
    """The discs at rest after the wall is gone; turning: False holds their rotation once they have settled."""
    rng = np.random.default_rng(seed)
    radius = rng.uniform(1.0, 2.0, COUNT)
    radius *= math.sqrt(SIDE**2 / 1.5 / float(np.pi * np.sum(radius**2)))  # void ratio 0.5
    placed = place((0.0, 0.0), (SIDE, SIDE), radii=radius, seed=seed)
    discs = make_discs(placed.position, placed.radius, 2.5)
    law = Linear(1e8, 100.0, 0.25e8, 50.0, friction)
    box = Box((0.0, -100.0), (150.0, 200.0), top="open")
    gate = Plate(SIDE, -1.0, 200.0, name="gate")
    grains = Grains(discs, law, box, plates=[gate], energy=book)
    grains.set_rectangles([Rectangle((-10.0, -10.0), (SIDE, 0.0))])
    weights = np.column_stack((np.zeros(COUNT), -GRAVITY * discs.mass))
    grains.step(dt, weights, count=round(SETTLING * DT / dt))
    grains.plates[0, HIGH] = TOE
    if not turning:
        grains.hold(slice(None), x=False, y=False)
        discs.spin[:] = 0.0
    grains.step(dt, weights, count=round(RUNNING * DT / dt))
    return Heap(grains, energy_budget(grains, (0.0, -GRAVITY)) if book else {})


def outline(grains: Grains, points: int = 160) -> tuple[Floats, Floats]:
    """(x, height of the heap's surface there), cm, over its floor."""
    x = (np.arange(points) + 0.5) * SIDE / points
    d = grains.discs
    off = x[:, None] - d.position[None, :, 0]
    top = d.position[None, :, 1] + np.sqrt(np.maximum(d.radius**2 - off**2, 0.0))
    height = np.where(np.abs(off) < d.radius, top, 0.0).max(axis=1)
    return x, np.maximum(height, 0.0)


def angle(grains: Grains) -> float:
    """Slope of the surface, degrees: least squares through the outline between foot and crest."""
    x, height = outline(grains)
    share = (height - TOE) / (height.max() - TOE)
    first, last = int(np.argmax(share < HEAD)), len(x) - int(np.argmax(share[::-1] > FOOT))
    slope = np.polyfit(x[first:last], height[first:last], 1)[0]
    return -math.degrees(math.atan(float(slope)))


def measure(packings: int = 4, frictions: tuple[float, ...] = FRICTIONS) -> tuple[dict[str, float | None], Figure]:
    """Angles over friction with their scatter, that of discs that cannot turn, the energy residual, and the picture."""
    first, finer = heap(), heap(dt=0.5 * DT)
    seeds = range(1, packings + 1)
    found = {mu: np.array([angle(heap(mu, seed, book=False).grains) for seed in seeds]) for mu in frictions}
    stiff = np.array([angle(heap(TUTORIAL, seed, book=False, turning=False).grains) for seed in seeds])
    numbers: dict[str, float | None] = {
        "residual over energy turned over": share(first),
        "the same with half the step": share(finer),
        "order of the residual": math.log2(share(first) / share(finer)),
        "angle": float(found[TUTORIAL].mean()),
        "angle at four times the friction, more": float(found[frictions[-1]].mean() - found[TUTORIAL].mean()),
        "angle at a fifth of the friction, less": float(found[TUTORIAL].mean() - found[frictions[0]].mean()),
        "scatter of the angle over packings": scatter(found),
        "angle of discs that cannot turn, more": float(stiff.mean() - found[TUTORIAL].mean()),
    }
    return numbers, draw(first, found, stiff)


def scatter(found: dict[float, Floats]) -> float | None:
    """Mean over frictions of the standard deviation of the angle over packings, degrees; None of one packing."""
    if len(found[TUTORIAL]) > 1:
        return float(np.mean([angles.std(ddof=1) for angles in found.values()]))
    print(f"one packing has no scatter: its angles are worth ± {SCATTER:g}°, the deviation of one over packings")
    return None


def deviation(angles: Floats) -> float:
    """Of angles over packings, degrees; see scatter."""
    return float(angles.std(ddof=1)) if len(angles) > 1 else SCATTER


def share(made: Heap) -> float:
    """Size of the residual over the energy turned over."""
    return abs(made.book["residual (J/m)"]) / made.book["turned over (J/m)"]


def draw(made: Heap, found: dict[float, Floats], stiff: Floats) -> Figure:
    """The heap with its fitted slope; angle against friction."""
    figure, axes = stage(2, 10.0, 3.8)
    d = made.grains.discs
    size = 2.0 * d.radius
    axes[0].add_collection(
        EllipseCollection(size, size, np.zeros(COUNT), units="x", offsets=d.position,
                          transOffset=axes[0].transData, facecolors="#d9b36c", edgecolors="#6b4a1e", linewidths=0.3)
    )  # fmt: skip
    axes[0].plot([0.0, SIDE, SIDE], [0.0, 0.0, TOE], "k", lw=2)
    x, height = outline(made.grains)
    axes[0].plot(x, height, color="#8c1c2f", lw=1)
    slope = angle(made.grains)
    axes[0].set(aspect="equal", xlim=(0, 100), ylim=(-12, 70), xlabel="x, cm", ylabel="y, cm",
                title=f"582 discs, μ = tan 27°: {slope:.1f}°")  # fmt: skip
    friction = np.array(list(found))
    for k, angles in enumerate(np.array(list(found.values())).T):
        axes[1].plot(friction, angles, ".", color="0.6", label="each packing" if k == 0 else None)
    mean = [float(values.mean()) for values in found.values()]
    axes[1].plot(friction, mean, "o-", color="#8c1c2f", label="mean")
    axes[1].errorbar([TUTORIAL], [stiff.mean()], [deviation(stiff)], fmt="s", color="#2a6f97", label="cannot turn")
    fine = np.linspace(0.0, float(friction.max()), 100)
    axes[1].plot(fine, np.degrees(np.arctan(fine)), "k:", lw=1, label="arctan μ")
    axes[1].set(
        xlabel="friction μ between discs", ylabel="angle, degrees", ylim=(0, 60), title="discs roll: it saturates"
    )
    axes[1].legend(fontsize=7)
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE, packings=(int, 4, "packings for each friction", 1))
    raise SystemExit(conclude(HERE, *measure(asked.packings), asked.out))
