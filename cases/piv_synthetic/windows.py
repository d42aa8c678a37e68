"""What windows, overlaps and updates cost and buy: errors of whole fields over core-seconds of a pair.

    python cases/piv_synthetic/windows.py --out runs/piv_windows

Writes front.json, trade.csv, trade.md and trade.png, as `study trade` does for scenes.  A field is compared with the
exact displacement every PLACE pixels, with straight lines between its vectors: a coarse grid is off between them.
"""

import time
from pathlib import Path

import numpy as np
from scipy.interpolate import LinearNDInterpolator, RegularGridInterpolator

from porescale import Floats, set_threads
from porescale.output import Tried, options, trade
from porescale.piv.estimate import Settings, Vectors, measure
from porescale.piv.images import Pair, pair
from porescale.validation.piv import pairs as lab

HERE = Path(__file__).resolve().parent
FLOWS = ("lamb_oseen", "taylor_green_128", "taylor_green_64", "discs")
PLACE = 4  # px
MARGIN = 48  # px: the widest window that is tried, so that all have vectors around every place
TRIED: dict[str, dict[str, dict[str, float]]] = {
    "window": {f"{it} px": {"window": it} for it in (8, 12, 16, 24, 32, 48)},
    "overlap": {"none": {"overlap": 0.0}, "0.75": {"overlap": 0.75}},
    "window and overlap": {
        "32 px, 0.75": {"window": 32, "overlap": 0.75},
        "48 px, 0.75": {"window": 48, "overlap": 0.75},
    },
    "updates": {"1": {"updates": 1}, "2": {"updates": 2}},
    "smoothing": {"none": {"smooth": False}},
}
"""Points by knob and label: what differs from the defaults."""


def between(found: Vectors, x: Floats, y: Floats) -> Floats:
    """Displacements (n, 2) at places (n,) in the fluid, linear between vectors of the fluid."""
    both, places = np.stack([found.u, found.v], axis=-1), np.column_stack([y, x])
    if not found.solid.any():
        return np.asarray(RegularGridInterpolator((found.y, found.x), both)(places))
    down, across = np.meshgrid(found.y, found.x, indexing="ij")
    has = ~found.solid
    return np.asarray(LinearNDInterpolator(np.column_stack([down[has], across[has]]), both[has])(places))


def error(made: Pair, settings: Settings) -> tuple[float, float]:
    """Rms error of a field over the rms displacement, at places in the fluid, and the processor's seconds."""
    start = time.process_time()
    found = measure(made.first, made.second, made.solid if made.solid.any() else None, settings)
    spent = time.process_time() - start
    down, across = (np.arange(MARGIN, side - MARGIN, PLACE, dtype=float) for side in made.first.shape)
    x, y = np.meshgrid(across, down)
    fluid = made.flow.discs.distance(x, y) > 0
    exact = np.stack(made.flow.displacement(x[fluid], y[fluid]), axis=-1)
    off = between(found, x[fluid], y[fluid]) - exact
    return float(np.sqrt(np.sum(off**2) / np.sum(exact**2))), spent


def main() -> None:
    """Measure every point on the same pairs, and write the files."""
    given = options(__doc__ or "", HERE, seeds=(int, 2, "pairs of every flow", 1))
    set_threads(1)
    made = [{name: pair(*lab.TABLE[name], seed) for name in FLOWS} for seed in range(given.seeds)]
    for name in FLOWS:
        error(made[0][name], Settings())  # kernels are compiled before anything is timed
    tried = []
    for knob, points in TRIED.items():
        for label, changed in points.items():
            settings = Settings(**changed)  # type: ignore[arg-type]
            rows = [{name: error(each[name], settings) for name in FLOWS} for each in made]
            errors = [{name: row[name][0] for name in FLOWS} for row in rows]
            spent = sum(row[name][1] for row in rows for name in FLOWS)
            words = tuple(f"{key}={value}" for key, value in changed.items())
            tried.append(Tried(knob, label, words, errors, spent, len(made) * len(FLOWS)))
            print(f"{knob} {label}: {spent / tried[-1].count:.3f} s, {errors[0]}", flush=True)
    trade(given.out, f"python cases/{HERE.name}/{Path(__file__).name}", tried)
    print(f"{given.out / 'front.json'}, trade.csv, .md, .png")


if __name__ == "__main__":
    main()
