"""Seepage under a sheet pile before anything fails: discharge and exit gradient over the depth of the pile."""

from pathlib import Path

import numpy as np

from continuum_sph.validation.seepage import setups, sheet_pile
from porescale import GRAVITY
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
DEPTHS = (0.25, 0.5, 0.75)
SHOWN = 0.5


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, rows=(int, 32, "particles over the depth of the ground"))
    figure, (field, curve) = stage(2, 10.0, 3.6)
    numbers: dict[str, float] = {}
    for share in DEPTHS:
        pile = sheet_pile.SheetPile(share, given.rows)
        discharge, gradient, both = pile.run(100 * given.rows)
        numbers[f"q/(k h) over its exact value, s/T = {share:g}"] = discharge / pile.discharge
        numbers[f"i_E T/h over its exact value, s/T = {share:g}"] = gradient / pile.exit_gradient
        curve.plot(share, discharge, "o", color="#5b8fd0")
        curve.plot(share, gradient, "s", color="#c8553d")
        if share == SHOWN:
            x, q, _ = sheet_pile.flux(both)
            head = both.water.layer.pressure[: len(x)] / (setups.WATER * GRAVITY)
            # The other half is its mirror image, head for head below that of the middle.
            for side, level in ((1.0, head), (-1.0, 1.0 - head)):
                field.tricontour(side * x[:, 0], x[:, 1], level, np.linspace(0.05, 0.95, 19), colors="#5b8fd0",
                                 linewidths=0.8)  # fmt: skip
                some = np.flatnonzero((x[:, 0] < 1.2) & (np.arange(len(x)) % 7 == 0))
                field.quiver(side * x[some, 0], x[some, 1], q[some, 0], side * q[some, 1], color="#888888",
                             scale=0.02 * pile.permeability / 1e-3, width=0.002)  # fmt: skip
    field.plot([0.0, 0.0], [1.0 - SHOWN, 1.15], color="#3b352b", linewidth=2.5)
    field.plot([-1.2, 1.2], [1.0, 1.0], color="#8a6d3b", linewidth=1.0)
    field.set(xlim=(-1.2, 1.2), ylim=(0.0, 1.2), aspect="equal", xlabel="x / T", ylabel="y / T")
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
