"""What a rock bore: stress over strain, with the bonds that broke as acoustic emissions, from a run's rock.csv."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from porescale.common.core.atomic import whole

if TYPE_CHECKING:
    from porescale.common.record.open_run import Run

BINS = 60
"""Intervals of time in which breaks are counted, at the most."""


def write_rock_picture(run: Run, folder: Path) -> list[Path]:
    """Write rock.png, stress over strain and breaks over strain; [] where the run has no plates, or no row."""
    rock = run.table("rock")
    if not rock or len(rock["strain ()"]) < 2:
        return []
    path = folder / "rock.png"
    figure = drawn(rock["strain ()"], rock["stress (Pa)"], rock["broken bonds ()"], run.name)
    with whole(path) as beside:
        FigureCanvasAgg(figure).print_png(str(beside))
    return [path]


def drawn(strain: np.ndarray, stress: np.ndarray, broken: np.ndarray, title: str) -> Figure:
    """Stress (rows,) Pa over strain (rows,), and how many bonds broke from row to row, or in a BINS-th of them."""
    figure = Figure((7.0, 4.6), dpi=100, layout="constrained")
    axes = figure.add_subplot()
    factor, unit = (1e-3, "kPa") if np.abs(stress).max() < 1e6 else (1e-6, "MPa")
    axes.plot(100.0 * strain, factor * stress, color="#23303d", lw=1.2)
    axes.set(xlabel="strain (%), > 0 pulled", ylabel=f"stress ({unit}), > 0 tension")
    axes.set_title(title, loc="left", fontsize=10, parse_math=False)
    axes.axhline(0.0, color="#b5ab98", lw=0.6)
    rows = np.unique(np.linspace(0, len(strain) - 1, BINS + 1).round().astype(int))
    counts = axes.twinx()
    width = 100.0 * float(np.ptp(strain)) / len(rows)
    counts.bar(50.0 * (strain[rows[1:]] + strain[rows[:-1]]), np.diff(broken[rows]), width, color="#c0182b", alpha=0.45)
    counts.set_ylabel(f"bonds broken, {int(broken[-1])} in all", color="#c0182b")
    counts.set_ylim(0.0, 3.0 * max(1.0, float(np.diff(broken[rows]).max(initial=0.0))))
    return figure
