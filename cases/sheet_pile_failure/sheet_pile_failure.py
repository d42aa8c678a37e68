"""Failure of the ground behind a sheet pile: the head at which heave begins, and what follows."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from continuum_sph import Simulation
from continuum_sph.builders import SoilPart
from continuum_sph.validation.seepage import heave, setups
from porescale import GRAVITY
from porescale.common.pictures import write_film
from porescale.output import conclude, options, pixels

HERE = Path(__file__).resolve().parent
FREELY = 4.0  # of the rise that elasticity explains: the rest is flow of soil that yields
STAGES = {"before": 0.25, "onset": 1.0, "failure": 12.0}
"""Rise of the prism's surface over that at which heave begins."""
SHOWN = 0.5
COLOURS = {0.25: "#5b8fd0", 0.5: "#c8553d", 0.75: "#3f7f4f"}


def cases(rows: int) -> dict[float, heave.Heave]:
    """The grounds by s/T: the shorter the pile the finer."""
    given = heave.Heave(rows=rows, modulus=5e5, cover=0.17, permeability=3e-2, first=2.5, rate=0.5, settle=0.4)
    return {
        0.25: replace(given, share=0.25, rows=5 * rows // 3, reach=1.0, rate=0.8),
        0.5: given,
        0.75: replace(given, share=0.75, reach=1.25),
    }


def sight(where: tuple[Axes, Axes], model: Simulation, given: heave.Heave, title: str) -> None:
    """Soil by its displacement, with velocities;  excess pressure over water at rest at the level behind the pile."""
    soil, flow = model.flow.water.skeleton, model.flow.water
    layer, n = flow.layer, flow.layer.fluid
    there = layer.mass[:n] > 0.0
    water, pressure = layer.x[:n][there], layer.pressure[:n][there]
    moved = np.hypot(*(soil.x - model.part(SoilPart).first).T) / given.buried
    level = given.depth + round(given.cover * given.rows) * given.spacing
    excess = (pressure / (setups.WATER * GRAVITY) - (level - water[:, 1])) / (given.critical * given.buried)
    size = 3600.0 / given.rows**2
    left, right = where
    left.scatter(*water.T, s=0.3 * size, c="#a9c8ea", lw=0)
    colours = left.scatter(*soil.x.T, s=size, c=moved, cmap="Wistia", vmin=0.0, vmax=0.4, lw=0)
    left.figure.colorbar(colours, ax=left, label="displacement / s")
    fastest = max(float(np.hypot(*soil.v.T).max()), 1e-9)
    left.quiver(*soil.x.T, *(soil.v / fastest).T, scale=18.0, width=0.003)
    head = given.head(model.time)
    left.set_title(f"{title}: h = {head:.2f} i_c s, fastest soil {fastest * 100:.2g} cm/s", fontsize=9)
    shown = right.scatter(*water.T, s=1.6 * size, c=excess, cmap="viridis", vmin=0.0, vmax=head, lw=0)
    right.figure.colorbar(shown, ax=right, label="excess head / i_c s")
    middle = 0.5 * given.scene.tank.width
    for axes in where:
        axes.plot([middle, middle], [given.depth - given.buried, 3.0], color="#3b352b", linewidth=2.0)
        axes.set(aspect="equal", xlim=(middle - 1.2, middle + 1.2), ylim=(0.0, 1.7))
        axes.tick_params(labelsize=7)


def frames(given: heave.Heave, every: float = 0.04) -> Iterator[NDArray[np.uint8]]:
    """Pictures of the course until the ground has failed."""
    for _, _, rise, model in given.course(every):
        if rise > 1.5 * STAGES["failure"] * FREELY * given.elastic:
            return
        figure = Figure(figsize=(10.0, 3.6), layout="constrained")
        FigureCanvasAgg(figure)
        left, right = figure.subplots(1, 2)
        sight((left, right), model, given, f"t = {model.time:.2f} s")
        yield pixels(figure)


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(
        __doc__ or "", HERE, rows=(int, 12, "particles over the depth of the ground"),
        film=(bool, False, "film of the failure, s/T = 0.5"),
    )  # fmt: skip
    figure = Figure(figsize=(8.0, 11.0), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(4, 2)
    curve, numbers = figure.add_subplot(grid[3, :]), {}
    for share, case in cases(given.rows).items():
        rows, limit = [], FREELY * case.elastic
        stages = list(STAGES.items()) if share == SHOWN else []
        last = STAGES["failure"] if share == SHOWN else 2.0
        for time, head, rise, model in case.course():
            rows.append((time, head, rise))
            if stages and rise > stages[0][1] * limit:
                row = len(STAGES) - len(stages)
                pair = figure.add_subplot(grid[row, 0]), figure.add_subplot(grid[row, 1])
                sight(pair, model, case, stages.pop(0)[0])
            if rise > last * limit:
                break
        _, heads, rises = np.array(rows).T
        begun = np.flatnonzero(rises > limit)
        numbers[f"h/(i_c s) at the onset, s/T = {share:g}"] = float(heads[begun[0]]) if begun.size else float("nan")
        curve.plot(heads, rises / limit, color=COLOURS[share], label=f"s/T = {share:g}")
        curve.axvspan(*heave.BOUNDS[share], color=COLOURS[share], alpha=0.15, lw=0)
    curve.axhline(1.0, color="0.5", lw=0.8)
    curve.set(xlabel="h / (i_c s)", ylabel="rise over that at the onset", ylim=(0.0, 4.0), xlim=(2.5, 4.2))
    curve.legend(frameon=False)
    if given.film:
        given.out.mkdir(parents=True, exist_ok=True)
        print(f"film: {write_film(given.out / 'failure', frames(cases(given.rows)[0.5]), 20)}")
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
