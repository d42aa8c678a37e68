"""The tutorial's decks of the angle of repose, one after the other: random discs, their settling, a wall taken away."""

import runpy
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.figure import Figure

from porescale.demseg import (
    MOVED,
    NEW,
    Body,
    Control,
    Deck,
    Trace,
    draw_energies,
    draw_shapes,
    read_deck,
    trace,
    unbalanced,
)
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
MORE, FLOWING = 10_000, 100_000  # steps
TOE = ((0.0, -0.1, 80.1, -0.1), (80.1, -0.1, 80.1, 4.0))
"""The body printed as No. 583."""


def settled(folder: Path) -> Deck:
    """What mode 0 made, 2000 steps on, and 10 000 more that go on from the files of the first run."""
    first = trace(HERE).model
    first.write_next(folder)
    for file in folder.iterdir():
        file.rename(folder / file.name.removeprefix("new_"))
    then = replace(read_deck(folder), nstep=MORE, nprn1=MORE, nprn2=MORE)
    second = trace(folder, then).model
    second.write_next(folder)
    (folder / "new_in_gm.dat").rename(folder / "in_gm.dat")
    return read_deck(folder)


def released() -> Trace:
    """The flow over the toe, after the right wall was moved away: the last decks of I-7."""
    with TemporaryDirectory() as folder:
        deck = settled(Path(folder))
        toe = Body(1, (0.0, 0.0, 0.0), segments=TOE, long=True)
        held = Control(len(deck.bodies) + 1, (MOVED, MOVED, MOVED), (0.0, 0.0, 0.0))
        last = replace(
            deck, domain=(0.0, 150.0, -100.0, 100.0), thick=0.1, bodies=(*deck.bodies, toe), jclid=NEW, iloop=12_000,
            nstep=FLOWING, nprn1=1000, nprn2=100, controls=(held,),
        )  # fmt: skip
        return trace(Path(folder), last)


def measure() -> tuple[dict[str, float], Figure]:
    """Discs, void ratio, angle of the slope that is left, energies."""
    made = released()
    angle = runpy.run_path(str(HERE.parent / "angle_of_repose" / "angle_of_repose.py"))["angle"]
    discs = [body.discs[0] for body in made.model.deck.bodies if body.discs]
    numbers = {
        "discs": float(len(discs)),
        "void ratio": 80.0**2 / float(np.pi * sum(radius**2 for radius, *_ in discs)) - 1.0,
        "angle": float(angle(made.model.grains)),
        "err over the fall": unbalanced(made),
    }
    figure, axes = stage(2, 8.0, 3.0)
    draw_shapes(axes[0], made, -1, "#6b4a1e", view=(0.0, 100.0, -12.0, 60.0))
    axes[0].set(title=f"after {FLOWING} steps: {numbers['angle']:.1f}°", xlabel="x", ylabel="y")
    draw_energies(axes[1], made)
    return numbers, figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))
