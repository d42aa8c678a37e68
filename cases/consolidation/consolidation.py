"""A layer drained on both faces consolidates: isochrones over Terzaghi's, and what compressible water does to them."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from continuum_sph.validation.seepage import consolidation as lab
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
RATIOS = (1.0, 4.0, 20.0)
COURSE = (0.02, 0.05, 0.1, 0.15, 0.2)
COLOURS = ("#1b4965", "#5b8fd0", "#2a9d8f", "#e8a33d", "#c8553d")


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, rows=(int, 30, "particles over the height", 1))
    layer = lab.Consolidation(rows=given.rows, permeability=1e-3, ratio=100.0)
    figure, axes = stage(2, 9.0, 4.2)
    worst, middle = 0.0, []
    heights = np.linspace(0.0, layer.height, 101)
    for factor, colour, (reached, z, u) in zip(lab.FACTORS, COLOURS, lab.isochrones(layer, lab.FACTORS), strict=True):
        worst = max(worst, float(np.abs(u - layer.excess(z, reached)).max()))
        near = np.abs(z / layer.height - 0.5) < 0.6 / layer.rows
        middle.append(float(u[near].mean() * np.exp(np.pi**2 * (reached - factor))))
        axes[0].plot(layer.excess(heights, reached), heights, color=colour, label=f"T_v {factor:g}")
        axes[0].plot(u, z, ".", color=colour, markersize=3)
    axes[0].set(xlabel="excess pressure / u0", ylabel="height / H", xlim=(0, 1), ylim=(0, 1))
    axes[0].legend(fontsize=8, frameon=False)
    soft = {ratio: lab.consolidation(replace(layer, rows=20, ratio=ratio), COURSE)[0] for ratio in RATIOS}
    times = np.linspace(0.0, 0.21, 101)
    for ratio, colour in zip(RATIOS, COLOURS[1:], strict=False):
        exact = np.exp(-(np.pi**2) * times / (1.0 + 1.0 / ratio))
        axes[1].plot(times, exact, color=colour, label=f"K_w = {ratio:g} n M")
        axes[1].plot(COURSE, soft[ratio], "o", color=colour, markersize=4)
    axes[1].plot(times, np.exp(-(np.pi**2) * times), color="#888888", linestyle="--", label="Terzaghi")
    axes[1].set(xlabel="T_v", ylabel="pressure in the middle / u0", yscale="log", ylim=(0.1, 1.0))
    axes[1].legend(fontsize=8, frameon=False)
    numbers = {
        "largest error of the isochrones": worst,
        "modulus of the soil over M": lab.realised_modulus(layer) / layer.modulus,
    }
    numbers |= {f"middle at T_v = {factor:g}": value for factor, value in zip(lab.FACTORS, middle, strict=True)}
    numbers |= {f"middle at T_v = 0.1, K_w = {ratio:g} n M": soft[ratio][COURSE.index(0.1)] for ratio in RATIOS}
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
