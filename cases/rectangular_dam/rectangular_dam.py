"""A rectangular dam between two water levels: discharge and free surface over the exact ones; the dam being wetted."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from continuum_sph.seepage import Seepage
from continuum_sph.validation.seepage import dam as lab
from continuum_sph.validation.seepage import setups
from porescale import GRAVITY
from porescale.common.pictures import write_film
from porescale.output import conclude, options, pixels, stage

HERE = Path(__file__).resolve().parent
SPANS = {"L = H1": (3.5, 7.0), "L = 2 H1": (6.0, 12.0), "H2 = 0.3 H1": (3.5, 7.0)}
"""Between which times (s) each dam is taken for steady."""


def dams(rows: int) -> dict[str, lab.Dam]:
    """The dams by name."""
    given = lab.Dam(rows=rows)
    return dict(zip(SPANS, (given, replace(given, length=2.0), replace(given, downstream=0.3)), strict=True))


def sight(axes: Axes, given: lab.Dam, both: Seepage, title: str) -> None:
    """Heads of the water's particles over the soil; the measured surface and the exact one."""
    layer = both.water.layer
    n = layer.fluid
    there = layer.mass[:n] > 0.0
    x = layer.x[:n][there]
    head = x[:, 1] + layer.pressure[:n][there] / (setups.WATER * GRAVITY)
    axes.add_patch(Rectangle((given.basin, 0.0), given.length, 1.2 * given.upstream, color="#e9dcc0", lw=0))
    dots = 260.0 / given.rows / both.water.porosity[there]
    axes.scatter(*x.T, c=head, s=dots, vmin=0.0, vmax=given.upstream, cmap="viridis", lw=0)
    places = given.basin + np.array(lab.STATIONS) * given.length
    axes.plot(places, given.surface, "x", color="#c8553d", markersize=9, mew=2, label="exact")
    axes.plot(places, given.heights(both), "o", mfc="none", color="black", label="measured")
    axes.set(aspect="equal", xlim=(0, 2 * given.basin + given.length), ylim=(0, 1.2 * given.upstream), title=title)
    axes.set(xlabel="x / H1", ylabel="height / H1")


def wetting(given: lab.Dam, end: float, every: float) -> Iterator[NDArray[np.uint8]]:
    """Pictures of a dam that was dry, ``every`` (s) up to ``end`` (s)."""
    both = replace(given, full=False).build()
    for time in np.arange(0.0, end, every):
        while both.time < time:
            both.advance()
        figure, (axes,) = stage(1, 7.0, 3.6)
        sight(axes, given, both, f"t = {time:.2f} s")
        yield pixels(figure)


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, rows=(int, 20, "particles over H1"), film=(bool, False, "film of the wetting"))
    figure, axes = stage(4, 19.0, 3.8)
    numbers = {}
    for (name, dam), where, colour in zip(dams(given.rows).items(), axes, ("C0", "C1", "C2"), strict=False):
        both = dam.build()
        begin, end = SPANS[name]
        rows = dam.course(both, end, 0.05)
        into, out, heights = lab.steady(rows, begin)
        numbers[f"q over its exact value, {name}"] = 0.5 * (into + out) / dam.discharge
        for part, ratio in zip(lab.STATIONS, heights / dam.surface, strict=True):
            numbers[f"height at {part:g} L over its exact value, {name}"] = float(ratio)
        sight(where, dam, both, name)
        time = rows[:, 0]
        axes[3].plot(time, rows[:, 1] / dam.discharge, color=colour, label=f"in, {name}")
        axes[3].plot(time, rows[:, 2] / dam.discharge, color=colour, ls="--")
    axes[0].legend(fontsize=8, loc="upper right")
    axes[3].plot([0, 12], [0, 12], color="0.7", lw=1)
    axes[3].set(xlabel="t, s", ylabel="water let in, out (dashed) / q, s", title="booked")
    axes[3].legend(fontsize=7)
    if given.film:
        given.out.mkdir(parents=True, exist_ok=True)
        print(f"film: {write_film(given.out / 'wetting', wetting(lab.Dam(rows=given.rows), 6.0, 0.05), 20)}")
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
