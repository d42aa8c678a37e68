"""Water drawn into dry soil under a constant head: way of the wetting front over the root of time."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from continuum_sph.seepage import Seepage
from continuum_sph.validation.seepage import infiltration
from porescale.common.pictures import write_film
from porescale.output import conclude, options, pixels, stage

HERE = Path(__file__).resolve().parent
WATCHED = (0.3, 0.6, 0.9)  # s
COLOURS = ("#1b4965", "#5b8fd0", "#2a9d8f")


def sight(axes: Axes, given: infiltration.Imbibition, both: Seepage, title: str) -> None:
    """Particles of soil and of water, coloured by pressure, and the exact front."""
    layer = both.water.layer
    n = layer.fluid
    axes.plot(*both.ground.skeleton.x.T, ".", color="#d9bd82", markersize=3)  # type: ignore[attr-defined]
    axes.scatter(*layer.x[:n].T, c=layer.pressure[:n], s=9, cmap="viridis", lw=0, vmin=0.0, vmax=9810.0 * given.head)
    axes.axhline(given.height - given.front(both.time), color="#c8553d", lw=1.5)
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m", title=title)


def course(given: infiltration.Imbibition, end: float) -> Iterator[Seepage]:
    """The column at every hundredth of a second up to ``end``, s."""
    both = given.build()
    for time in np.arange(0.0, end + 1e-9, 0.01):
        while both.time < time:
            given.advance(both)
        yield both


def frames(given: infiltration.Imbibition, end: float) -> Iterator[NDArray[np.uint8]]:
    """Pictures of the particles at the times that the figure shows."""
    for both in course(given, end):
        figure, (axes,) = stage(1, 3.0, 6.0)
        sight(axes, given, both, f"t = {both.time:.2f} s")
        yield pixels(figure)


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(
        __doc__ or "", HERE, rows=(int, 30, "particles over the soil", 1), film=(bool, False, "write a film")
    )
    figure, axes = stage(2, 9.0, 4.6)
    trials = {
        "head 0.3 m": infiltration.Imbibition(rows=given.rows),
        "head 0.15 m": infiltration.Imbibition(rows=given.rows, head=0.15),
    }
    numbers = {}
    for (name, trial), colour in zip(trials.items(), COLOURS, strict=False):
        times, ways = [], []
        for both in course(trial, WATCHED[-1]):
            times.append(both.time)
            ways.append(trial.reached(both))
            for time in WATCHED:
                if abs(len(times) - 1 - 100 * time) < 0.5:
                    numbers[f"front over its exact way at {time:g} s, {name}"] = ways[-1] / trial.front(both.time)
        axes[0].plot(np.sqrt(times), ways, "o", color=colour, markersize=2.5, label=name)
        axes[0].plot(np.sqrt(times), [trial.front(time) for time in times], color=colour, lw=1)
        if name == "head 0.3 m":
            sight(axes[1], trial, both, f"head 0.3 m, t = {both.time:.2f} s")
    axes[0].set(xlabel="√t, √s", ylabel="front, m", title="dots measured, lines √(2 k h0 t/n)")
    axes[0].legend(fontsize=8, frameon=False)
    if given.film:
        given.out.mkdir(parents=True, exist_ok=True)
        images = frames(infiltration.Imbibition(rows=given.rows), WATCHED[-1])
        print(f"film: {write_film(given.out / 'front', images, 20)}")
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
