"""A bonded chain of 20 discs stays where it is, and breaks when it is pulled, by the tutorial's in_cf0.dat."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from porescale.demseg import NEW, DeckRun, Options, Trace, draw_shapes, read_deck, tensions, trace
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
PULLED = "body 20: "


def wandering(made: Trace) -> float:
    """Largest way of a disc from its first place."""
    return float(np.abs(np.array(made.places) - made.places[0]).max())


def measure() -> tuple[dict[str, float], Figure]:
    """Tensions of the first step, how far bonded and free chains move, pull and elongation at which one breaks."""
    deck = read_deck(HERE)
    first = DeckRun(replace(deck, jclid=NEW, dt=1e-9, nstep=1), Options(), HERE)
    first.advance(1)
    backs = np.array([row[3] for row in tensions(first.built)])
    still, loose = trace(HERE), trace(HERE, replace(deck, jclid=NEW, nstep=300))
    pulled = trace(HERE / "pulled")
    force, place = -pulled.record[PULLED + "force x"], pulled.record[PULLED + "place x"]
    strongest = int(np.argmax(force))
    bonds = pulled.model.grains.bonds
    assert bonds is not None
    numbers = {
        "tensions of the first step": float(backs.mean()),
        "their spread": float(np.ptp(backs)),
        "bonded: way of the furthest disc": wandering(still),
        "not bonded: way of the furthest disc": wandering(loose),
        "pull that breaks it": float(force[strongest]),
        "elongation at which it breaks": float(place[strongest] - place[0]),
    }
    figure, axes = stage(2, 10.0, 3.0)
    for k, which in enumerate((0, len(pulled.places) - 1)):
        draw_shapes(axes[0], pulled, which, f"C{k}", view=(48.0, 98.0, 40.0, 60.0))
    axes[0].set(xlabel="x", ylabel="y", title=f"pulled: {19 - bonds.count} of 19 bonds broken")
    axes[1].plot(place - place[0], force, lw=0.8)
    axes[1].axhline(2e7, color="k", ls=":", lw=1)
    axes[1].set(xlabel="elongation", ylabel="pull", title="k δ0 dotted")
    return numbers, figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))
