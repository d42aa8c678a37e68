"""The picture of `porescale homogenise`: the tests of all packings, and every number with its error bar."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from porescale.analysis.biaxial import running
from porescale.analysis.material import EXPONENT, Known
from porescale.analysis.shear_rate import AT_REST, GROWTH, HALFWAY, inertial_numbers, law, point
from porescale.analysis.softening import STRAIN
from porescale.cli.homogenise_rates import Rates
from porescale.common.core.types import Floats
from porescale.common.evidence.files import new_figure, png

EVERY = 5
"""Rows between points of a curve."""
BARS = ("peak friction angle", "peak dilatancy angle", "critical friction angle", "porosity", "stiffness",
        "Poisson's ratio", EXPONENT, "permeability")  # fmt: skip


def picture(tests: Sequence[Mapping[str, Floats]], found: Mapping[str, Known], rates: Rates) -> bytes:
    """Friction angle and volume over strain of every packing, numbers over their means, and, where ``rates`` were
    asked for, sin φ over the inertial number with the law, as a PNG."""
    more = (1.0,) if rates.asked else ()
    figure = new_figure(12.0 + 3.6 * len(more), 3.6)
    left, middle, right, *last = figure.subplots(1, 3 + len(more), width_ratios=(1.0, 1.0, 1.2, *more))
    for axes in last:
        _rates(axes, found, rates)
    for test in tests:
        angle = np.degrees(np.arcsin(running(test["strain"], test["sine"])[0]))
        left.plot(test["strain"][::EVERY], angle[::EVERY], color="#2a6f97", lw=0.7)
        middle.plot(test["strain"][::EVERY], 100.0 * test["volume"][::EVERY], color="#2a6f97", lw=0.7)
    for name, colour in (("peak friction angle", "#8c1c2f"), ("critical friction angle", "#3b4552")):
        mean, wide = np.degrees(found[name].mean), np.nan_to_num(np.degrees(found[name].interval))
        left.axhline(mean, color=colour, lw=1.0, label=f"{name} {found[name].text()}")
        left.axhspan(mean - wide, mean + wide, color=colour, alpha=0.35, lw=0)
    if STRAIN in found:
        left.plot([], [], " ", label=f"{STRAIN} {found[STRAIN].text()}")
    left.set(xlabel="axial strain", ylabel="mobilised friction angle, degrees", ylim=(0.0, None))
    left.legend(fontsize=7, frameon=False, loc="lower right")
    middle.set(xlabel="axial strain", ylabel="volume, %")
    names = [name for name in BARS if name in found and found[name].mean != 0.0]
    for place, name in enumerate(names):
        it = found[name]
        right.plot(np.array(it.values) / it.mean, np.full(len(it.values), place), ".", color="#9fb8c8", ms=5)
        if np.isfinite(it.interval):
            right.errorbar(1.0, place, xerr=it.interval / abs(it.mean), fmt="o", color="#8c1c2f", ms=4, capsize=4)
    right.set_yticks(range(len(names)), [f"{name}\n{found[name].text()}" for name in names], fontsize=7)
    right.invert_yaxis()
    right.set_xlabel("of the mean; dots: packings,\nbars: intervals at 95 %")
    return png(figure, 100)


def _rates(axes: Axes, found: Mapping[str, Known], rates: Rates) -> None:
    """Sines of all packings over their inertial numbers, means with bars, and the law."""
    for each in rates.tests:
        axes.plot([it.inertial for it in each], [it.sine for it in each], ".", color="#9fb8c8", ms=5)
    inertial = inertial_numbers(rates.tests)
    seen = [found[point("sine", rate)] for rate in rates.asked]
    bars = np.nan_to_num([it.interval for it in seen])
    axes.errorbar(inertial, [it.mean for it in seen], yerr=bars, fmt="o", color="#8c1c2f", ms=4, capsize=4)
    if HALFWAY in found:
        across = np.geomspace(0.3 * inertial.min(), 2.0 * inertial.max(), 100)
        rest, growth, halfway = math.sin(found[AT_REST].mean), found[GROWTH].mean, found[HALFWAY].mean
        label = f"{rest:.3f} + {growth:.3f} I/({halfway:.3f} + I)"
        axes.plot(
            across, [law(it, rest, growth, halfway) for it in across.tolist()], color="#3b4552", lw=1.0, label=label
        )
        axes.legend(fontsize=7, frameon=False, loc="upper left")
    slow = found["critical friction angle"]
    axes.axhline(math.sin(slow.mean), color="#2a6f97", lw=0.7, ls=":")
    axes.set(xscale="log", xlabel="inertial number; dotted: slow tests", ylabel="sine of the friction angle")
