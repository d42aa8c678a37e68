"""A saturated levee under a sudden rise of the river: its slope goes, then its crest, then water runs over it."""

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
from continuum_sph.validation.seepage import levee as lab
from porescale.common.pictures import write_film
from porescale.output import conclude, draw, options, pixels

HERE = Path(__file__).resolve().parent
COLOURS = ("#c8553d", "#c99a2e", "#3f7f4f")


OVERFLOW = lab.Levee(
    land=5.0, river=3.0, plain=1.6, crest=0.3, rising=0.8, low=0.8, high=1.12, end=7.5
)  # fmt: skip
"""A levee flat enough to stand, and a river that rises over its crest."""
SLID = (
    (1, lab.FAR, "(a) the toe slides"), (3, lab.FAR, "(b) failure has reached the crest"),
    (4, lab.OVER, "(c) overtopping"), (4, 0.2, "(d) overflow"),
)  # fmt: skip
BROKEN = (
    (3, 0.1, "water on the crest"), (3, lab.FAR, "the crest goes"), (1, lab.FAR, "the slope goes"),
    (4, 0.2, "overflow"),
)  # fmt: skip
"""Stages to draw: column of the course, what it exceeds, and what that is."""


def sight(axes: Axes, model: Simulation, given: lab.Levee, title: str) -> None:
    """Soil by its displacement with velocities, over the water."""
    soil, layer = model.flow.water.skeleton, model.flow.water.layer
    water = layer.x[: layer.fluid][layer.mass[: layer.fluid] > 0.0]
    size = 2200.0 / given.rows**2
    axes.scatter(*water.T, s=0.5 * size, c="#7fb0e8", lw=0)
    moved = model.part(SoilPart).displacement() / given.height
    shown = axes.scatter(*soil.x.T, s=size, c=moved, cmap="Wistia", vmin=0.0, vmax=1.0, lw=0)
    axes.figure.colorbar(shown, ax=axes, label="moved / H")
    fast = np.hypot(*soil.v.T) > 0.02
    axes.quiver(*soil.x[fast].T, *soil.v[fast].T, scale=30.0, width=0.001)
    width = given.corners[3] + given.plain
    axes.set(aspect="equal", xlim=(0.0, width), ylim=(0.0, 1.2 * given.height), title=title)


def frames(given: lab.Levee, every: float = 0.05) -> Iterator[NDArray[np.uint8]]:
    """Pictures of the whole course."""
    for row, model in given.course(every):
        figure = Figure(figsize=(11.0, 2.4), layout="constrained")
        FigureCanvasAgg(figure)
        sight(figure.subplots(), model, given, f"{row[0]:.2f} s after the river began to rise")
        yield pixels(figure)


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(
        __doc__ or "", HERE, rows=(int, 16, "particles over the height"), stiffness=(float, 0.5e6, "E, Pa"),
        film=(bool, False, "film of it"), overflow=(bool, False, "another: the river over a levee that stands"),
    )  # fmt: skip
    levee = replace(OVERFLOW if given.overflow else lab.Levee(), rows=given.rows, stiffness=given.stiffness)
    figure = Figure(figsize=(9.0, 10.5), layout="constrained")
    FigureCanvasAgg(figure)
    *places, curve = figure.subplots(5, 1)
    stages = [*(BROKEN if given.overflow else SLID)]
    rows = []
    for row, model in levee.course():
        rows.append(row)
        if stages and row[stages[0][0]] > stages[0][1]:
            sight(places[len(places) - len(stages)], model, levee, f"{stages.pop(0)[2]}: {row[0]:.2f} s")
    table = np.array(rows)
    times = levee.times(table)
    for column, (name, colour) in enumerate(zip(lab.PARTS, COLOURS, strict=True), 1):
        curve.plot(table[:, 0], table[:, column] / levee.height, color=colour, label=f"{name} moved / H")
    curve.plot(table[:, 0], table[:, 4] / levee.height**2, color="#5b8fd0", label="river beyond the crest / H²")
    curve.axhline(lab.FAR, color="0.5", lw=0.8)
    curve.set(xlabel="s since the river began to rise", ylim=(0.0, 1.5))
    curve.legend(frameon=False)
    numbers = {
        "from toe to middle": times["middle"] - times["toe"],
        "from middle to crest": times["crest"] - times["middle"],
        "from crest to overtopping": times["overtopped"] - times["crest"],
        "toe": times["toe"],
    }
    if given.film:
        given.out.mkdir(parents=True, exist_ok=True)
        print(f"film: {write_film(given.out / 'levee', frames(levee), 20)}")
    if given.overflow:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(figure, given.out / "overflow.png")
        print(f"{times}\npicture: {given.out / 'overflow.png'}")
        return 0
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
