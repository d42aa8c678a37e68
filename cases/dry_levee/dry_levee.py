"""A dry levee is wetted from one side: its wetting line at stages, how it sags, and how fast its foot advances."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from continuum_sph.seepage import Seepage
from continuum_sph.validation.seepage import dam, wetting
from porescale import Floats
from porescale.common.pictures import write_film
from porescale.output import conclude, options, pixels, stage

HERE = Path(__file__).resolve().parent
STAGES = (1.2, 2.4, 4.2, 6.0)  # s
EVERY = 0.06  # s, between frames
ABOUT = 0.6  # s, on either side of a time, over which a speed is measured


def sight(axes: Axes, given: wetting.Levee, both: Seepage, title: str) -> None:
    """Soil, water by its pressure, and the wetting line."""
    layer, ground = both.water.layer, given.ground
    n = layer.fluid
    there = layer.mass[:n] > 0.0
    axes.scatter(*ground.T, c="#dcc69a", s=9, lw=0)
    axes.scatter(*layer.x[:n][there].T, c=layer.pressure[:n][there], s=7, lw=0, vmin=0.0, vmax=9810.0 * given.level)
    x, heights = given.line(both)
    wet = heights > 0.0
    axes.plot(x[wet], heights[wet], "--", color="#c8553d", lw=1.5)
    axes.set(aspect="equal", xlim=(0, given.size[0]), ylim=(0, given.size[1]), xlabel="x, m", title=title)


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    asked = options(__doc__ or "", HERE, spacing=(float, 0.02, "of the particles, m"), film=(bool, False, "a film"))
    given = wetting.Levee(spacing=asked.spacing)
    both = given.build()
    figure = Figure(figsize=(11.0, 7.2), layout="constrained")
    FigureCanvasAgg(figure)
    places = figure.subplot_mosaic([[f"{when:g}", "way"] for when in STAGES], width_ratios=(2.2, 1.0))
    images, rows = [], []
    numbers: dict[str, float] = {}
    for count in range(1, round((STAGES[-1] + ABOUT) / EVERY) + 1):
        time = count * EVERY
        while both.time < time:
            both.advance()
        way, hang = wetting.sag(*given.line(both), given.level)
        rows.append((time, way))
        for when in STAGES:
            if abs(time - when) < 0.5 * EVERY:
                numbers[f"sag at {when:g} s"] = hang
                sight(places[f"{when:g}"], given, both, f"t = {when:g} s, sag {hang:+.3f}")
        if asked.film:
            frame, (inside,) = stage(1, 9.0, 2.8)
            sight(inside, given, both, f"t = {time:.2f} s")
            images.append(pixels(frame))
    times, ways = np.array(rows).T
    scale = (given.permeability * given.level / dam.POROSITY) ** 0.5
    for first, last in ((1.2, 2.4), (2.4, 6.0)):
        part = (times > first - 0.5 * EVERY) & (times < last + 0.5 * EVERY)
        pace = float(np.polyfit(np.sqrt(times[part]), ways[part], 1)[0]) / scale
        numbers[f"pace of the foot from {first:g} to {last:g} s"] = pace
    numbers["speed of the foot at 6 s over that at 1.2 s"] = speed(times, ways, 6.0) / speed(times, ways, 1.2)
    places["way"].plot(np.sqrt(times), ways, ".", label="measured")
    late = np.sqrt(times[times > 2.4])
    places["way"].plot(late, ways[-1] + wetting.BOUSSINESQ * scale * (late - late[-1]), label="Boussinesq's pace")
    places["way"].set(xlabel="√t, √s", ylabel="way of the foot, m")
    places["way"].legend(fontsize=8, frameon=False)
    if asked.film:
        asked.out.mkdir(parents=True, exist_ok=True)
        print(f"film: {write_film(asked.out / 'wetting', images, 15)}")
    for name, value in numbers.items():
        print(f"{name}: {value:.4g}")
    return conclude(HERE, numbers, figure, asked.out)


def speed(times: Floats, ways: Floats, about: float) -> float:
    """Mean speed (m/s) over ABOUT before and after a time."""
    part = np.abs(times - about) < ABOUT
    return float(np.polyfit(times[part], ways[part], 1)[0])


if __name__ == "__main__":
    raise SystemExit(main())
