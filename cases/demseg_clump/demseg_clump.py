"""A rigid body of two discs, from the tutorial's deck, falls and bounces."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from porescale.decks.deck import read_deck
from porescale.decks.trace import draw_energies, draw_shapes, finer, first_touch, trace, unbalanced
from porescale.scene.case import conclude, options, stage

HERE = Path(__file__).resolve().parent


def measure(factor: int = 10) -> tuple[dict[str, float], Figure]:
    """Mass and inertia, first touch, and what the energy book lacks, at the deck's step and at a ``factor`` of it."""
    made, fine = trace(HERE), trace(HERE, finer(read_deck(HERE), factor))
    table = made.model.grains.steering.clumps
    numbers = {"mass": float(table.mass[0]), "inertia": float(table.inertia[0])}
    numbers |= {
        "first touch": first_touch(made),
        "err over the fall": unbalanced(made),
        "the same at a tenth of the step": unbalanced(fine),
    }
    figure, axes = stage(2, 9.0, 3.2)
    for k, which in enumerate((0, 35, 80, 120)):
        draw_shapes(axes[0], made, which, f"C{k}")
    axes[0].set(xlabel="x", ylabel="y", title="at 0, 0.175, 0.4 and 0.6")
    draw_energies(axes[1], made)
    return numbers, figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))
