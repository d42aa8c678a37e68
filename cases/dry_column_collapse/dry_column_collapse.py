"""Columns of dry discs collapse to both sides on a plane: run-out over the aspect ratio, against others' and films."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from porescale import GRAVITY, Floats
from porescale.common.neighbors import place
from porescale.dem import Box, Grains, Linear, Plate, make_discs
from porescale.dem.measures import centre_of_mass
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
DIAMETER, SPREAD, DENSITY = 5e-3, 0.2, 2500.0  # m, half width of the sizes over their mean, kg/m³
FRICTION, RESTITUTION = 0.5, 0.5
HARDNESS = 3000.0  # stiffness over the column's weight on its base, ρ g H
ASPECTS = (0.5, 0.8, 1.2, 1.7, 2.5, 4.0, 6.0, 10.0)
TALL = 2.0
NEAR = 0.05  # gap over mean diameter up to which discs belong together


@dataclass
class Collapse:
    """aspect: height over half width of the column at rest;  run_out: how far its edges went, over the half width;
    half: half width, m;  before, after (n, 2) m;  radius (n,) m;  main (n,) bool: the connected mass."""

    aspect: float
    run_out: float
    half: float
    before: Floats
    after: Floats
    radius: Floats
    main: NDArray[np.bool_]


def collapse(
    aspect: float, discs: int = 1000, seed: int = 1, friction: float = FRICTION, base: float | None = None,
    restitution: float = RESTITUTION,
) -> Collapse:  # fmt: skip
    """A column of about ``aspect``, settled between plates without friction that vanish; ``base``: friction of the
    plane, default that between discs."""
    rng = np.random.default_rng(seed)
    radius = 0.5 * DIAMETER * rng.uniform(1.0 - SPREAD, 1.0 + SPREAD, discs)
    half = math.sqrt(float(np.pi * np.sum(radius**2)) / 0.82 / (2.0 * aspect))
    high = aspect * half
    placed = place((-half, 0.0), (half, high * 0.82 / 0.7), radii=radius, seed=seed)
    stiffness = HARDNESS * DENSITY * GRAVITY * high
    mass = DENSITY * math.pi / 4.0 * DIAMETER**2
    law = Linear.from_restitution(restitution, 0.5 * mass, stiffness, 0.5 * stiffness, 0.0, friction)
    reach = half * (1.0 + 6.0 * max(aspect, 1.0)) + 50.0 * DIAMETER
    box = Box((-reach, 0.0), (reach, 2.0 * high + 10.0 * DIAMETER), "open", "open", top="open")
    gates = [Plate(x, 0.0, 2.0 * high, friction=0.0, name=name) for x, name in ((-half, "left"), (half, "right"))]
    d = make_discs(placed.position, placed.radius, DENSITY)
    grains = Grains(d, law, box, wall_law=law.with_friction(friction if base is None else base), plates=gates)
    weights = np.column_stack((np.zeros(discs), -GRAVITY * d.mass))
    dt = grains.stable_step(steps_per_contact=15.0)
    falls, rolls = math.sqrt(high / GRAVITY), math.sqrt(DIAMETER / GRAVITY)
    grains.step(dt, weights, None, round(5.0 * falls / dt), 1.0 / falls)
    d.velocity[:] = 0.0
    d.spin[:] = 0.0
    before, settled = d.position.copy(), 2.0 * float(centre_of_mass(d)[1])
    for gate in gates:
        grains.remove_plate(gate.name)
    grains.step(dt, weights, count=round((6.0 * falls + 20.0 * rolls) / dt))
    main = together(d.position, d.radius)
    x, r = d.position[main, 0], d.radius[main]
    edge = 0.5 * float((x + r).max() - (x - r).min())
    return Collapse(settled / half, edge / half - 1.0, half, before, d.position.copy(), d.radius.copy(), main)


def together(position: Floats, radius: Floats) -> NDArray[np.bool_]:
    """The largest mass of discs that touch, but for gaps of NEAR mean diameters, (n,) bool; the rest are stragglers."""
    gap = NEAR * DIAMETER
    i, j = cKDTree(position).query_pairs(2.0 * float(radius.max()) + gap, output_type="ndarray").T
    near = np.hypot(*(position[i] - position[j]).T) < radius[i] + radius[j] + gap
    i, j = i[near], j[near]
    _, label = connected_components(coo_array((np.ones(len(i)), (i, j)), shape=(len(radius), len(radius))), False)
    return np.asarray(label == np.bincount(label).argmax())


def fitted(runs: list[Collapse]) -> dict[str, float]:
    """Coefficients of c a for squat columns and of c a^0.7 for tall ones, least squares of the logarithm, and the
    exponent that tall ones would choose."""
    aspect = np.array([run.aspect for run in runs])
    out = np.array([run.run_out for run in runs])
    tall = aspect >= TALL
    return {
        "squat: run-out over a": float(np.exp(np.mean(np.log(out[~tall] / aspect[~tall])))),
        "tall: run-out over a^0.7": float(np.exp(np.mean(np.log(out[tall] / aspect[tall] ** 0.7)))),
        "tall: exponent": float(np.polyfit(np.log(aspect[tall]), np.log(out[tall]), 1)[0]),
    }


def measure(discs: int = 1000, packings: int = 1, friction: float = FRICTION) -> tuple[dict[str, float], Figure]:
    """Fitted coefficients, and the picture."""
    runs = [collapse(aspect, discs, seed, friction) for aspect in ASPECTS for seed in range(1, packings + 1)]
    return fitted(runs), draw(runs, discs, packings)


def draw(runs: list[Collapse], discs: int, packings: int) -> Figure:
    """Run-out over aspect ratio with the references; one squat and one tall column before and after."""
    figure, axes = stage(2, 10.5, 4.2)
    a, b = np.array([0.4, TALL]), np.array([TALL, 12.0])
    for x, low, high, power in ((a, 1.2, 1.8, 1.0), (b, 1.9, 2.3, 2.0 / 3.0)):
        label = "experiments: Lube et al., Lajeunesse et al. 2005" if x is a else None
        axes[0].fill_between(x, low * x**power, high * x**power, color="#2a6f97", alpha=0.3, lw=0, label=label)
    for x, c, power in ((a, 2.5, 1.0), (b, 3.25, 0.7)):
        label = "Staron & Hinch 2005 ± 15 %" if x is a else None
        axes[0].plot(x, c * x**power, "k", lw=1, label=label)
        axes[0].fill_between(x, 0.85 * c * x**power, 1.15 * c * x**power, color="0.85", lw=0, zorder=0)
    aspect, out = [run.aspect for run in runs], [run.run_out for run in runs]
    axes[0].loglog(
        aspect,
        out,
        "o",
        color="#8c1c2f",
        ms=5,
        label=f"measured: {discs} discs, {packings} packing{'s' * (packings > 1)}",
    )
    axes[0].set(xlabel="aspect ratio a = H₀/R₀", ylabel="run-out (R∞ − R₀)/R₀", title="run-out", xlim=(0.4, 12))
    axes[0].legend(fontsize=7)
    ground, widest = 0.0, 0.0
    for aspect_shown in (1.2, 4.0):
        run = min(runs, key=lambda it, a=aspect_shown: abs(it.aspect - a))  # type: ignore[misc]
        edge = 1e3 * float(np.abs(run.after[run.main, 0]).max()) + 20.0
        widest = max(widest, edge)
        ground -= 1.1e3 * float(run.before[:, 1].max())
        deposit(axes[1], run, ground, edge)
    axes[1].set(aspect="equal", xlabel="x, mm", yticks=[], title="before (grey) and after; red: stragglers",
                xlim=(-widest, widest), ylim=(ground - 20.0, 10.0))  # fmt: skip
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


def deposit(ax: Axes, run: Collapse, ground: float, edge: float) -> None:
    """Discs of one run, mm, on a line at ``ground`` out to ``edge``."""
    size = 2e3 * run.radius
    kinds = (
        (run.before, np.full(len(size), True), "#d8d8d8"), (run.after, run.main, "#d9b36c"),
        (run.after, ~run.main, "#8c1c2f"),
    )  # fmt: skip
    for at, which, colour in kinds:
        ax.add_collection(
            EllipseCollection(size[which], size[which], np.zeros(which.sum()), units="x",
                              offsets=1e3 * at[which] + (0.0, ground), transOffset=ax.transData, facecolors=colour,
                              edgecolors="none")
        )  # fmt: skip
    ax.plot([-edge, edge], [ground, ground], "k", lw=1)
    ax.text(25.0 - edge, ground + 40.0, f"a = {run.aspect:.2g}", fontsize=8)


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, discs=(int, 1000, "discs in a column"), packings=(int, 1, "packings for each ratio", 1),
        friction=(float, FRICTION, "friction between discs and of the plane"),
    )  # fmt: skip
    raise SystemExit(conclude(HERE, *measure(asked.discs, asked.packings, asked.friction), asked.out))
