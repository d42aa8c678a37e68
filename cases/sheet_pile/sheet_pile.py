"""Seepage under a sheet pile before anything fails: discharge and exit gradient over the depth of the pile."""

from pathlib import Path

import numpy as np

from continuum_sph.validation.seepage import setups, sheet_pile
from porescale import GRAVITY
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
DEPTHS = (0.2, 0.35, 0.5, 0.75, 0.9)
SHOWN = 0.5


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, rows=(int, 20, "particles over the depth of the ground"))
    figure, (field, curve) = stage(2, 10.0, 3.6)
    numbers: dict[str, float] = {}
    for share in DEPTHS:
        pile = sheet_pile.SheetPile(share, given.rows)
        discharge, gradient, off, both = pile.run(100 * given.rows)
        numbers[f"q/(k h) over its exact value, s/T = {share:g}"] = discharge / pile.discharge
        numbers[f"i_E T/h over its exact value, s/T = {share:g}"] = gradient / pile.exit_gradient
        numbers[f"largest error of heads along the pile over h, s/T = {share:g}"] = off
        curve.plot(share, discharge, "o", color="#5b8fd0")
        curve.plot(share, gradient, "s", color="#c8553d")
        if share == SHOWN:
            x, q, _ = sheet_pile.flux(both)
            head = both.water.layer.pressure[: len(x)] / (setups.WATER * GRAVITY)
            middle = 0.5 * (x[:, 0].min() + x[:, 0].max())
            for side in (-1.0, 1.0):
                here = side * (x[:, 0] - middle) > 0.0
                field.tricontour(x[here, 0] - middle, x[here, 1], head[here], np.linspace(0.05, 0.95, 19),
                                 colors="#5b8fd0", linewidths=0.8)  # fmt: skip
            some = np.flatnonzero(np.arange(len(x)) % 5 == 0)
            field.quiver(x[some, 0] - middle, x[some, 1], q[some, 0], q[some, 1], color="#888888",
                         scale=0.02 * pile.permeability / 1e-3, width=0.002)  # fmt: skip
    field.plot([0.0, 0.0], [1.0 - SHOWN, 1.15], color="#3b352b", linewidth=2.5)
    field.plot([-1.05, 1.05], [1.0, 1.0], color="#8a6d3b", linewidth=1.0)
    field.set(xlim=(-1.05, 1.05), ylim=(0.0, 1.2), aspect="equal", xlabel="x / T", ylabel="y / T")
    shares = np.linspace(0.1, 0.9, 81)
    curve.plot(shares, [sheet_pile.SheetPile(float(s)).discharge for s in shares], color="#5b8fd0", label="q / (k h)")
    curve.plot(
        shares, [sheet_pile.SheetPile(float(s)).exit_gradient for s in shares], color="#c8553d", label="i_E T / h"
    )
    curve.set(xlabel="s / T", ylim=(0.0, 2.0))
    curve.legend(frameon=False)
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
