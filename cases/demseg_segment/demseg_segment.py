"""A line segment without thickness, from the tutorial's deck, falls and bounces."""

from pathlib import Path

from matplotlib.figure import Figure

from porescale.demseg import draw_fall, fallen
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent


def measure() -> tuple[dict[str, float], Figure]:
    """Mass and inertia, first touch, and what the energy budget lacks, at the deck's step and at a tenth of it."""
    made, numbers = fallen(HERE)
    figure, axes = stage(2, 9.0, 3.2)
    draw_fall(axes[0], axes[1], made, (0, 35, 80, 120))
    return numbers, figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))
