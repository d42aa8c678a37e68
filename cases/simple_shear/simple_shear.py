"""Dense and loose discs in a periodic cell are sheared under a constant normal stress, to the same critical state."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from porescale import Floats, build, load
from porescale.dem import Grains
from porescale.dem.measures import contacts
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
SCENE = HERE / "cell.toml"
STATES = {"dense": 0.0, "loose": 1.0}
"""Friction while the packing is made."""
SHEAR, CRITICAL = 1.5, 0.75  # of the test, and from where on states are averaged as critical
ROWS, LOOKS = 750, 10  # rows of a record, and looks at the cell that are averaged in each
WINDOW = 0.02  # of shear, over which peak and dilatancy are taken
SHOWN = (0.1, 0.12)  # shears between which the picture shows displacements; contacts at the second
SOLID = 0.81  # fraction by which a number of discs is turned into a size of the cell


@dataclass
class Record:
    """shear;  ratio: shear over normal stress;  fraction of solid;  across: normal stress over that wanted;  along:
    stress along the shear over that across it;  sine: of the mobilised friction angle;  all (r,).  inertial: number.
    chains (c, 2, 2) m, force (c,) N/m: contacts;  at, went (n, 2) m: places in the cell, and how far the discs went
    beside the mean shear."""

    shear: Floats
    ratio: Floats
    fraction: Floats
    across: Floats
    along: Floats
    sine: Floats
    inertial: float
    chains: Floats
    force: Floats
    at: Floats
    went: Floats


def sheared(state: str, seed: int = 1, friction: float = 0.5, discs: int = 0, *, shear: float = SHEAR) -> Record:
    """One test of the scene with ``friction`` of its discs; about ``discs`` of them, 0: as many as the scene has."""
    settings = [f"grains.packing.settling_friction={STATES[state]}", f"grains.packing.seed={seed}",
                f"contact.friction={friction}"]  # fmt: skip
    plain = load(SCENE, settings=settings)
    assert plain.grains
    assert plain.grains.packing
    diameter = plain.grains.packing.diameter
    if discs:
        side = diameter * math.sqrt(discs * math.pi / 4.0 / SOLID)
        settings += [f"{key}={side}" for key in ("domain.width", "domain.height", "grains.packing.width",
                                                 "grains.packing.height")]  # fmt: skip
    simulation = build(load(SCENE, settings=settings))
    scene, grains, dt = simulation.scene, simulation.grains, simulation.step_seconds
    assert grains
    assert scene.cell
    assert scene.cell.rate_xy
    assert scene.cell.stress_yy
    rate, pressure = scene.cell.rate_xy.mean, scene.cell.stress_yy.mean
    area = float(grains.discs.area.sum())
    each = max(1, round(shear / rate / dt / (ROWS * LOOKS)))
    rows: list[Floats] = []
    before: tuple[Floats, Floats] | None = None
    chains, force, at, went = np.zeros((0, 2, 2)), np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2))
    while grains.time * rate < shear:
        found = []
        for _ in range(LOOKS):
            grains.step(dt, None, count=each)
            (width, _), (_, height) = grains.steering.edges()
            xx, xy, yy = grains.steering.cell_pressure()
            found.append((area / (width * height), xx, -xy, yy))
        fraction, along, turning, across = np.mean(found, axis=0)
        sine = math.hypot(0.5 * (along - across), turning) / (0.5 * (along + across))
        rows.append(np.array([grains.time * rate, turning / across, fraction, across / pressure, along / across, sine]))
        if before is None and rows[-1][0] >= SHOWN[0]:
            before = grains.discs.position.copy(), frame(grains)
        elif before is not None and not len(at) and rows[-1][0] >= SHOWN[1]:
            chains, force, at = branches(grains)
            went = grains.discs.position - before[0] @ (frame(grains) @ np.linalg.inv(before[1])).T
    inertial = rate * math.sqrt(plain.grains.density * math.pi / 4.0 * diameter**2 / pressure)
    gone, ratio, solid, normal, beside, angle = np.array(rows).T
    return Record(gone, ratio, solid, normal, beside, angle, inertial, chains, force, at, went)


def frame(grains: Grains) -> Floats:
    """The cell's edges as columns, (2, 2) m."""
    return np.array(grains.steering.edges()).T


def branches(grains: Grains) -> tuple[Floats, Floats, Floats]:
    """Ends (c, 2, 2) m of the lines between discs that touch, their normal forces (c,) N/m, and the places (n, 2) m of
    the discs: all within the cell, but for lines that leave it."""
    edges, found = frame(grains), contacts(grains)
    share = grains.discs.position @ np.linalg.inv(edges).T
    at = (share - np.floor(share)) @ edges.T
    start = at[found.first]
    return np.stack((start, start + found.branch), axis=1), found.normal_force, at


def running(it: Record, values: Floats) -> Floats:
    """Mean of ``values`` (r,) within WINDOW of shear."""
    return np.array([values[np.abs(it.shear - at) < 0.5 * WINDOW].mean() for at in it.shear])


def dilatancy(it: Record) -> Floats:
    """d ln V/d shear, (r,): slope of a straight line through the rows within WINDOW."""
    found = np.empty_like(it.shear)
    for k, at in enumerate(it.shear):
        near = np.abs(it.shear - at) < 0.5 * WINDOW
        found[k] = np.polyfit(it.shear[near], -np.log(it.fraction[near]), 1)[0] if near.sum() > 2 else np.nan
    return found


def said(it: Record) -> dict[str, float]:
    """Numbers of one test."""
    late = it.shear > CRITICAL
    return {
        "solid fraction at the start": float(it.fraction[0]),
        "largest stress ratio": float(running(it, it.ratio)[it.shear < 0.3].max()),
        "largest dilatancy": float(np.nanmax(dilatancy(it)[(it.shear > WINDOW) & (it.shear < 0.3)])),
        "critical stress ratio": float(it.ratio[late].mean()),
        "critical solid fraction": float(it.fraction[late].mean()),
        "critical friction angle": math.degrees(math.asin(float(it.sine[late].mean()))),
    }


def measure(
    friction: float = 0.5, discs: int = 0, packings: int = 2, seed: int = 1
) -> tuple[dict[str, float], Figure]:  # fmt: skip
    """Means over packings, and the picture."""
    seeds = range(seed, seed + packings)
    tests = {state: [sheared(state, it, friction, discs) for it in seeds] for state in STATES}
    return numbers_of(tests), draw(tests, friction)


def numbers_of(tests: dict[str, list[Record]]) -> dict[str, float]:
    """What expected.toml speaks of, from the tests of both states."""
    mean: dict[str, dict[str, float]] = {}
    for state, found in tests.items():
        each = [said(it) for it in found]
        mean[state] = {name: float(np.mean([row[name] for row in each])) for name in each[0]}
    numbers = {f"{state}: {name}": value for state, found in mean.items() for name, value in found.items()}
    for name in ("critical stress ratio", "critical solid fraction"):
        numbers[f"{name}, dense less loose"] = mean["dense"][name] - mean["loose"][name]
    dense = mean["dense"]
    every = [it for found in tests.values() for it in found]
    return numbers | {
        "peak over critical ratio, of the dilatancy": (dense["largest stress ratio"] - dense["critical stress ratio"])
        / dense["largest dilatancy"],
        "normal stress, largest mean error": max(abs(float(it.across.mean()) - 1.0) for it in every),
        "inertial number": max(it.inertial for it in every),
    }


def draw(tests: dict[str, list[Record]], friction: float) -> Figure:
    """Stress ratio and solid fraction over shear, stress and dilatancy; contacts and displacements of a cell."""
    figure, axes = stage(5, 12.5, 2.8)
    colours = {"dense": "#8c1c2f", "loose": "#2a6f97"}
    for state, found in tests.items():
        for k, it in enumerate(found):
            label = state if k == 0 else None
            axes[0].plot(it.shear[::3], running(it, it.ratio)[::3], color=colours[state], lw=0.8, label=label)
            axes[1].plot(it.shear[::3], it.fraction[::3], color=colours[state], lw=0.8, label=label)
            early = (it.shear > WINDOW) & (it.shear < 0.3)
            axes[2].plot(dilatancy(it)[early], running(it, it.ratio)[early], ",", color=colours[state])
    critical = float(np.mean([said(it)["critical stress ratio"] for found in tests.values() for it in found]))
    axes[0].axhline(0.25, color="k", lw=1, ls=":", label="da Cruz et al. 2005, μ = 0.4")
    axes[1].axhline(0.81, color="k", lw=1, ls=":")
    x = np.linspace(-0.2, 0.4, 2)
    axes[2].plot(x, critical + x, "k", lw=1.2, label="Taylor 1948: critical + dilatancy")
    axes[0].set(xlabel="shear", ylabel="stress ratio", ylim=(0, 0.55), title=f"μ = {friction:g}")
    axes[1].set(xlabel="shear", ylabel="solid fraction", title="dilatancy")
    axes[2].set(xlabel="d ln V/d shear", ylabel="stress ratio", xlim=(-0.2, 0.4), ylim=(0.1, 0.55),
                title="stress and dilatancy")  # fmt: skip
    axes[0].legend(fontsize=7)
    axes[2].legend(fontsize=7, loc="lower right")
    first = tests["dense"][0]
    chains(axes[3], first)
    axes[4].quiver(*first.at.T, *first.went.T, angles="xy", color="#2a6f97", width=0.003, antialiased=False)
    axes[4].set(aspect="equal", xticks=[], yticks=[],
                title="beside the mean shear")  # fmt: skip
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


def chains(ax: Axes, it: Record) -> None:
    """Contacts that bear more than the mean, as lines as wide as their forces."""
    strong = it.force > it.force.mean()
    width = 2.5 * np.minimum(it.force / np.percentile(it.force, 99), 1.5)
    ax.add_collection(LineCollection(list(it.chains[strong]), linewidths=width[strong], colors="#8c1c2f"))
    ax.autoscale_view()
    ax.set(aspect="equal", xticks=[], yticks=[], title=f"forces at shear {SHOWN[1]:g}")


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, friction=(float, 0.5, "friction between discs"),
        discs=(int, 0, "discs in a cell, 0: as the scene says"), packings=(int, 2, "packings of each state", 1),
        seed=(int, 1, "of the first packing"),
    )  # fmt: skip
    raise SystemExit(conclude(HERE, *measure(asked.friction, asked.discs, asked.packings, asked.seed), asked.out))
