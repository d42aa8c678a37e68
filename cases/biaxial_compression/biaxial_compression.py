"""Dense and loose discs between servo walls are compressed: peak and critical friction angle, dilatancy, scatter."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from porescale import Floats, build, load
from porescale.dem import PX, PY, Grains, Table, make_discs
from porescale.dem.measures import CoarseGrained, Raster, contacts
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
SCENE = HERE / "specimen.toml"
STATES = {"dense": 0.0, "loose": 1.0}
"""Friction while the packing is made."""
STRAIN, CRITICAL = 0.24, 0.16  # of the test, and from where on states are averaged as critical
RAMP = 0.02  # s in which the top comes to its speed: some times what a wave takes through the specimen
ROWS, LOOKS = 480, 5  # rows of a record, and looks at the walls that are averaged in each
WINDOW = 0.01  # of strain, over which peak and dilatancy are taken
SOLID = 0.83  # fraction by which a number of discs is turned into a size of the box
SHOWN = (0.02, 0.06)  # strains between which the shear of the picture is taken


@dataclass
class Record:
    """strain: axial, logarithmic, of shortening;  volume: logarithmic strain, of dilation;  sine: of the mobilised
    friction angle;  side: stress on the side walls over that wanted; all (r,).  fraction: of solid, at the start.
    inertial: the largest inertial number.  grains at the end, chains (c, 2, 2) m and force (c,) N/m of contacts at the
    peak, shear (rows, columns) of the coarse-grained field and its extent, m."""

    strain: Floats
    volume: Floats
    sine: Floats
    side: Floats
    fraction: float
    inertial: float
    chains: Floats
    force: Floats
    shear: Floats
    extent: tuple[float, float, float, float]


def compress(state: str, seed: int = 1, friction: float = 0.5, discs: int = 0, *, strain: float = STRAIN) -> Record:
    """One test of the scene with ``friction`` of its discs; about ``discs`` of them, 0: as many as the scene has."""
    settings = [f"grains.packing.settling_friction={STATES[state]}", f"grains.packing.seed={seed}",
                f"contact.friction={friction}"]  # fmt: skip
    plain = load(SCENE, settings=settings)
    assert plain.grains
    assert plain.grains.packing
    assert isinstance(plain.domain.top.velocity, tuple)
    diameter, rate = plain.grains.packing.diameter, -plain.domain.top.velocity[1] / plain.domain.height
    if discs:
        wide = diameter * math.sqrt(0.5 * discs * math.pi / 4.0 / SOLID)
        settings += [f"domain.width={wide}", f"domain.height={2.0 * wide}", f"grains.packing.width={wide}",
                     f"grains.packing.height={2.0 * wide}"]  # fmt: skip
    simulation = build(load(SCENE, settings=settings))
    scene, grains, dt = simulation.scene, simulation.grains, simulation.step_seconds
    assert grains
    assert scene.domain.left.stress
    high, pressure = scene.domain.height, scene.domain.left.stress.mean
    speed = rate * high
    grains.steering.move_wall("top", y=Table([0.0, RAMP], [0.0, -speed]))
    area = float(grains.discs.area.sum())
    start = area / (high * scene.domain.width)
    lasts = high * (1.0 - math.exp(-strain)) / speed + 0.5 * RAMP
    each = max(1, round(lasts / dt / (ROWS * LOOKS)))
    rows: list[Floats] = []
    record: dict[str, Floats] = {}
    chains, force = np.zeros((0, 2, 2)), np.zeros(0)
    while not rows or rows[-1][0] < strain:
        found = []
        for _ in range(LOOKS):
            grains.step(dt, None, count=each)
            found.append(look(grains))
        w, h, along, side = np.mean(found, axis=0)
        rows.append(np.array([math.log(high / h), math.log(w * h / area * start), (along - side) / (along + side),
                              side / pressure]))  # fmt: skip
        if not len(force) and rows[-1][0] >= WINDOW:
            chains, force = branches(grains)
        for name, at in (("from", SHOWN[0]), ("to", SHOWN[1])):
            if rows[-1][0] >= at and name not in record:
                record[name] = grains.discs.position.copy()
    fastest = speed / float(np.exp(-rows[-1][0]) * high)
    strains, volume, sine, sides = np.array(rows).T
    end = grains.discs.position  # of a test that is shorter than what is shown: nothing to show
    shear, extent = sheared(grains, record.get("from", end), record.get("to", end))
    mass = plain.grains.density * math.pi / 4.0 * diameter**2
    return Record(strains, volume, sine, sides, start, fastest * math.sqrt(mass / pressure), chains, force,
                shear, extent)  # fmt: skip


def look(grains: Grains) -> tuple[float, float, float, float]:
    """Width and height (m) between the walls, axial and lateral stress on them (Pa), in the last step."""
    walls, force = dict(zip(grains.wall_names, grains.walls, strict=True)), grains.wall_force
    w = float(walls["right"][PX] - walls["left"][PX])
    h = float(walls["top"][PY] - walls["bottom"][PY])
    pushed = dict(zip(grains.wall_names, force, strict=True))
    along = 0.5 * float(pushed["top"][1] - pushed["bottom"][1]) / w
    return w, h, along, 0.5 * float(pushed["right"][0] - pushed["left"][0]) / h


def branches(grains: Grains) -> tuple[Floats, Floats]:
    """Ends (c, 2, 2) m of the lines between discs that touch, and their normal forces (c,) N/m."""
    found = contacts(grains)
    found = found.chosen(found.pairs)
    start = grains.discs.position[found.first]
    return np.stack((start, start + found.branch), axis=1), found.normal_force


def sheared(grains: Grains, start: Floats, end: Floats) -> tuple[Floats, tuple[float, float, float, float]]:
    """Largest shear strain (rows, columns) between two places of the discs, coarse-grained, and the extent, m."""
    low, high = start.min(axis=0), start.max(axis=0)
    size = 2.0 * float(grains.discs.radius.mean())
    d = make_discs(0.5 * (start + end), grains.discs.radius, 1.0, end - start)
    raster = Raster.over((float(low[0]), float(low[1])), (float(high[0]), float(high[1])), size, 2.0 * size)
    e = CoarseGrained(raster, d, contacts(grains)).strain_rate
    shear = np.hypot(e[..., 0, 0] - e[..., 1, 1], 2.0 * e[..., 0, 1])
    return np.asarray(shear), (float(low[0]), float(high[0]), float(low[1]), float(high[1]))


def dilatancy(test: Record) -> Floats:
    """d volume / d strain, (r,): slope of a straight line through the rows within WINDOW."""
    found = np.empty_like(test.strain)
    for k, at in enumerate(test.strain):
        near = np.abs(test.strain - at) < 0.5 * WINDOW
        found[k] = np.polyfit(test.strain[near], test.volume[near], 1)[0] if near.sum() > 2 else np.nan
    return found


def smooth(test: Record) -> Floats:
    """Mean of the sine within WINDOW of strain, (r,)."""
    return np.array([test.sine[np.abs(test.strain - at) < 0.5 * WINDOW].mean() for at in test.strain])


def said(test: Record) -> dict[str, float]:
    """Numbers of one test: angles in degrees."""
    late = test.strain > CRITICAL
    opening = dilatancy(test)[test.strain > WINDOW]  # before that contacts close, or the ramp is not over
    sine = opening / (2.0 + opening)
    return {
        "solid fraction at the start": test.fraction,
        "peak friction angle": math.degrees(math.asin(float(smooth(test).max()))),
        "largest dilatancy angle": math.degrees(math.asin(float(np.nanmax(sine)))),
        "critical friction angle": math.degrees(math.asin(float(test.sine[late].mean()))),
        "critical solid fraction": test.fraction * math.exp(-float(test.volume[late].mean())),
        "most that it contracts": -float(test.volume.min()),
    }


def measure(
    friction: float = 0.5, discs: int = 0, packings: int = 4, seed: int = 1
) -> tuple[dict[str, float], Figure]:  # fmt: skip
    """Means over packings, and the picture."""
    seeds = range(seed, seed + packings)
    tests = {state: [compress(state, it, friction, discs) for it in seeds] for state in STATES}
    return numbers_of(tests), draw(tests, friction)


def numbers_of(tests: dict[str, list[Record]]) -> dict[str, float]:
    """What expected.toml speaks of, from the tests of both states."""
    each = {state: [said(test) for test in found] for state, found in tests.items()}
    mean = {state: {name: float(np.mean([it[name] for it in found])) for name in found[0]}
            for state, found in each.items()}  # fmt: skip
    every = [test for found in tests.values() for test in found]
    numbers = {f"{state}: {name}": value for state, found in mean.items() for name, value in found.items()}
    for name in ("critical friction angle", "critical solid fraction"):
        numbers[f"{name}, dense less loose"] = mean["dense"][name] - mean["loose"][name]
    held = [float(np.abs(np.mean(test.side[test.strain > WINDOW]) - 1.0)) for test in every]
    dense = mean["dense"]
    more = dense["peak friction angle"] - dense["critical friction angle"]
    return numbers | {
        "peak over critical angle, of the dilatancy angle": more / dense["largest dilatancy angle"],
        "stress on the sides, largest mean error": max(held),
        "largest inertial number": max(test.inertial for test in every),
    }


def draw(tests: dict[str, list[Record]], friction: float) -> Figure:
    """Friction angle and volume over strain, stress-dilatancy, force chains at the peak, where the specimen shears."""
    figure, axes = stage(5, 12.6, 3.1)
    every = [test for found in tests.values() for test in found]
    colours = {"dense": "#8c1c2f", "loose": "#2a6f97"}
    for state, found in tests.items():
        for k, test in enumerate(found):
            how: dict[str, Any] = {"color": colours[state], "lw": 0.8, "label": state if k == 0 else None}
            axes[0].plot(test.strain, np.degrees(np.arcsin(smooth(test))), **how)
            axes[1].plot(test.strain, 100.0 * test.volume, **how)
            opening = dilatancy(test)[test.strain > WINDOW]
            sine = opening / (2.0 + opening)
            axes[2].plot(sine, smooth(test)[test.strain > WINDOW], ",", color=colours[state])
    critical = math.sin(math.radians(float(np.mean([said(test)["critical friction angle"] for test in every]))))
    x = np.linspace(-0.1, 0.3, 50)
    rowe = (1.0 + critical) / (1.0 - critical) * (1.0 + x) / (1.0 - x)
    axes[2].plot(x, (rowe - 1.0) / (rowe + 1.0), "k", lw=1.2, label="Rowe 1962")
    bolton = math.degrees(math.asin(critical)) + 0.8 * np.degrees(np.arcsin(x))
    axes[2].plot(x, np.sin(np.radians(bolton)), "k:", lw=1.2, label="Bolton 1986, φ = φc + 0.8 ψ")
    axes[0].set(
        xlabel="axial strain", ylabel="mobilised friction angle, degrees", ylim=(0, 30), title=f"μ = {friction:g}"
    )
    axes[1].set(xlabel="axial strain", ylabel="volume, %", title="dilatancy")
    axes[2].set(xlabel="sin ψ", ylabel="sin φ", xlim=(-0.1, 0.3), ylim=(0.1, 0.5), title="stress and dilatancy")
    for ax in axes[:3]:
        ax.legend(fontsize=7)
    first = tests["dense"][0]
    specimen(axes[3], first)
    image = axes[4].imshow(
        first.shear, origin="lower", extent=first.extent, interpolation="nearest", cmap="magma_r", vmin=0.0,
        vmax=float(np.nanpercentile(first.shear, 99)),
    )  # fmt: skip
    figure.colorbar(image, ax=axes[4], shrink=0.8)
    axes[4].set(xticks=[], yticks=[], title=f"shear from {SHOWN[0]:g} to {SHOWN[1]:g}")
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


def specimen(ax: Axes, test: Record) -> None:
    """Contacts that bear more than the mean, as lines as wide as their forces, at the peak."""
    strong = test.force > test.force.mean()
    width = 2.0 * np.minimum(test.force / np.percentile(test.force, 99), 1.5)
    ax.add_collection(LineCollection(list(test.chains[strong]), linewidths=width[strong], colors="#8c1c2f"))
    ax.set(aspect="equal", xticks=[], yticks=[], title="forces at the peak")
    ax.autoscale_view()


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, friction=(float, 0.5, "friction between discs"),
        discs=(int, 0, "discs in a specimen, 0: as the scene says"), packings=(int, 4, "packings of each state", 1),
        seed=(int, 1, "of the first packing"),
    )  # fmt: skip
    raise SystemExit(conclude(HERE, *measure(asked.friction, asked.discs, asked.packings, asked.seed), asked.out))
