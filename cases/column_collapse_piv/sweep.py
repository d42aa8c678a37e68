"""Runs of the tank and of the box with one thing changed at a time: which vortices are there, and what makes them."""

import argparse
import csv
import io
import re
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import numpy as np
from filmed import lattice, size_of
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from variants import VARIANTS, Variant

import porescale as ps
from porescale.piv.fields import Vortex, vortices

CASES = Path(__file__).resolve().parents[1]
TIMES = (0.6, 1.0, 1.5)
"""s, at which vortices are looked for; beads are at rest from about 0.9 s on."""


def folder_of(variant: Variant, out: Path) -> Path:
    """The run folder of a variant."""
    return out / re.sub(r"[^a-z0-9.-]+", "_", variant.name.lower())


def run(variant: Variant, out: Path) -> None:
    """Run a variant, or go on with it; what is finished is left alone."""
    folder = folder_of(variant, out)
    ps.run(ps.load(CASES / variant.case, settings=variant.settings), folder, resume=folder.is_dir(), progress=False)


def seen(folder: Path, moment: float) -> dict[str, Vortex | None]:
    """Strongest vortices of the lattice's own velocity: in the lower half, and of each sign in the upper half.

    Left of three quarters of the width: above the column's own place others stand.
    """
    width, height = size_of(folder)
    found = [it for it in vortices(lattice(folder, moment)) if it.x < 0.75 * width]
    high = [it for it in found if it.y > height / 2]
    return {
        "low": next((it for it in found if it.y <= height / 2), None),
        "high +": next((it for it in high if it.circulation > 0), None),
        "high -": next((it for it in high if it.circulation < 0), None),
    }


def told(it: Vortex | None) -> str:
    """Place, cm, and circulation, cm²/s."""
    return "–" if it is None else f"({100 * it.x:.1f}, {100 * it.y:.1f}) {1e4 * it.circulation:+.0f}"


def finished(folder: Path) -> bool:
    """Whether a run is there up to the last of TIMES."""
    try:
        run = ps.open_run(folder)
    except (ps.InputError, OSError):
        return False
    return len(run) > 0 and run.times[-1] > TIMES[-1] - 0.02


def table(out: Path) -> Path:
    """Write vortices.csv of all runs that are finished: a row each, place and circulation at every time."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(
        ["run", "cells per bead", *(f"{half} at {t:g} s" for t in TIMES for half in ("low", "high +", "high -"))]
    )
    for variant in VARIANTS.values():
        folder = folder_of(variant, out)
        if not finished(folder):
            continue
        cells = [told(it) for moment in TIMES for it in seen(folder, moment).values()]
        rows.writerow([variant.name.rpartition(",")[0], variant.cells, *cells])
    (out / "vortices.csv").write_text(text.getvalue(), encoding="utf-8")
    return out / "vortices.csv"


PANELS = (
    "as it is, seed 1, 6 cells",
    "lid, seed 1, 6 cells",
    "gate vanishes, seed 1, 6 cells",
    "viscosity 1e-4, seed 1, 6 cells",
    "box, gate 0.5 m/s, 5 cells",
)
"""Runs of the picture, a row each."""


def panels(out: Path) -> Path | None:
    """Write vortices.png: speed, beads and vortices of some runs at every time; None if none of them is there."""
    rows = [(name, folder_of(VARIANTS[name], out)) for name in PANELS]
    rows = [(name, folder) for name, folder in rows if finished(folder)]
    if not rows:
        return None
    figure = Figure(figsize=(11.0, 2.9 * len(rows)), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, (name, folder) in zip(figure.subplots(len(rows), len(TIMES), squeeze=False), rows, strict=True):
        for one, moment in zip(axes, TIMES, strict=True):
            panel(one, folder, moment, f"{name.rpartition(',')[0]}, {moment:g} s")
    path = out / "vortices.png"
    figure.savefig(path, dpi=80)
    return path


def panel(axes: Axes, folder: Path, moment: float, title: str) -> None:
    """One run at one time: red turns against the clock, blue with it, the number is the circulation in cm²/s."""
    field, size = lattice(folder, moment), size_of(folder)
    speed = np.hypot(field.u, field.v)
    axes.pcolormesh(100 * field.x, 100 * field.y, 100 * speed, cmap="Greys", vmin=0, vmax=30, rasterized=True)
    grains = ps.open_run(folder).nearest(moment).clouds["grains"]
    discs = [Circle((100 * x, 100 * y), 100 * r) for (x, y), r in
             zip(grains.position[:, :2], grains.data["radius"], strict=True)]  # fmt: skip
    axes.add_collection(PatchCollection(discs, facecolor="#d9b77e", edgecolor="none"))
    found = vortices(field)
    for it in found[:8]:
        if abs(it.circulation) < 0.25 * abs(found[0].circulation):
            continue
        colour = "#a50f15" if it.circulation > 0 else "#08519c"
        axes.plot(100 * it.x, 100 * it.y, "o", mfc="none", mec=colour, ms=9, mew=1.6)
        axes.annotate(f"{1e4 * it.circulation:+.0f}", (100 * it.x, 100 * it.y), (6, 5), textcoords="offset points",
                      fontsize=7, color=colour)  # fmt: skip
    axes.set(aspect="equal", xlim=(0, 100 * size[0]), ylim=(0, 100 * size[1]))
    axes.set_title(title, fontsize=8)
    axes.tick_params(labelsize=6)


def main() -> int:
    """Run what is asked for and is not finished; then the table of all that is."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("only", nargs="*", help="variants whose name contains one of these (default: all)")
    parser.add_argument("--out", type=Path, default=Path("runs") / "column_collapse_piv", help="folder of the runs")
    parser.add_argument("--list", action="store_true", help="names, and nothing is run")
    given = parser.parse_args()
    for name, variant in VARIANTS.items():
        if given.only and not any(word in name for word in given.only):
            continue
        if given.list:
            print(name)
            continue
        start = time.perf_counter()
        run(variant, given.out)
        print(f"{name}: {time.perf_counter() - start:.0f} s", flush=True)
    if not given.list:
        print(table(given.out))
        print(panels(given.out))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
