"""A deck run in memory: its energies, records and places over time, as numbers and in pictures."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection

from porescale.common.core.types import Floats
from porescale.demseg.build import Options
from porescale.demseg.deck import Deck, read_deck
from porescale.demseg.run import FORCES, DeckRun

LABELS = {"enrg": "potential", "enva": "kinetic", "enka": "elastic", "enca": "lost in dashpots",
          "enfr": "lost in friction", "err": "does not balance"}  # fmt: skip


@dataclass
class Trace:
    """A run: model at its end;  energy, record: columns of energy.dat and of the record, (rows,) each, every nprn2
    steps;  places: of all points (n, 2), every nprn1 steps."""

    model: DeckRun
    energy: dict[str, Floats] = field(default_factory=dict)
    record: dict[str, Floats] = field(default_factory=dict)
    places: list[Floats] = field(default_factory=list)


def trace(folder: Path, deck: Deck | None = None, options: Options | None = None) -> Trace:
    """The deck in ``folder``, or ``deck`` with what it needs from there, from its first to its last step."""
    given = read_deck(folder) if deck is None else deck
    model = DeckRun(given, options or Options(), folder)
    every = math.gcd(given.nprn1, given.nprn2)
    made, energy, record = Trace(model), [model.series()], [model.tables().get(FORCES, {})]
    made.places.append(model.grains.discs.position.copy())
    while model.step < given.nstep:
        model.advance(min(every, given.nstep - model.step))
        if model.step % given.nprn2 == 0:
            model.check()
            energy.append(model.series())
            record.append(model.tables().get(FORCES, {}))
        if model.step % given.nprn1 == 0:
            made.places.append(model.grains.discs.position.copy())
    made.energy = {name: np.array([row[name] for row in energy]) for name in energy[0]}
    made.record = {name: np.array([row[name] for row in record]) for name in record[0]}
    return made


def finer(deck: Deck, factor: int) -> Deck:
    """The same run with ``factor`` steps in place of one."""
    counts = {name: getattr(deck, name) * factor for name in ("nstep", "nprn1", "nprn2")}
    return replace(deck, dt=deck.dt / factor, **counts)


def unbalanced(made: Trace) -> float:
    """Largest err over what the potential energy falls by."""
    energy = made.energy
    return float(np.abs(energy["err"]).max() / np.ptp(energy["enrg"]))


def first_touch(made: Trace) -> float:
    """Time of the first row with a contact; infinite if there is none."""
    touching = np.flatnonzero(made.energy["enka"] > 0.0)
    return float(made.energy["time"][touching[0]]) if len(touching) else math.inf


def fallen(folder: Path, factor: int = 10) -> tuple[Trace, dict[str, float]]:
    """The deck in ``folder`` of something that falls and bounces, and what is measured of it: mass, inertia where it
    is a rigid body, first touch, and error of the energy budget, at the deck's step and at a ``factor``-th of it."""
    made, fine = trace(folder), trace(folder, finer(read_deck(folder), factor))
    grains = made.model.grains
    if grains.steering is None or not len(grains.steering.clumps.mass):
        numbers = {"mass": float(grains.discs.mass[0])}
    else:
        bodies = grains.steering.clumps
        numbers = {"mass": float(bodies.mass[0]), "inertia": float(bodies.inertia[0])}
    numbers |= {
        "first touch": first_touch(made),
        "err over the fall": unbalanced(made),
        "the same at a tenth of the step": unbalanced(fine),
    }
    return made, numbers


def draw_fall(shapes: Axes, energies: Axes, made: Trace, rows: Sequence[int]) -> None:
    """The bodies at four or so ``rows`` of the places, and the energies."""
    deck = made.model.deck
    for k, which in enumerate(rows):
        draw_shapes(shapes, made, which, f"C{k}")
    times = [f"{which * deck.nprn1 * deck.dt:.3g}" for which in rows]
    shapes.set(xlabel="x", ylabel="y", title=f"at {', '.join(times[:-1])} and {times[-1]}")
    draw_energies(energies, made)


def draw_shapes(axes: Axes, made: Trace, which: int, colour: str = "#8c1c2f", view: tuple[float, ...] = ()) -> None:
    """Discs and segments at row ``which`` of the places."""
    d, segments, at = made.model.grains.discs, made.model.grains.segments, made.places[which]
    size = 2.0 * d.radius
    outlines = EllipseCollection(
        size, size, np.zeros(len(size)), units="x", offsets=at, transOffset=axes.transData, facecolors="none",
        edgecolors=colour, linewidths=0.8,
    )  # fmt: skip
    axes.add_collection(outlines)
    for a, b in () if segments is None else segments.ends:
        axes.plot(at[[a, b], 0], at[[a, b], 1], color=colour, lw=1.4)
    x1, x2, y1, y2 = view or made.model.deck.domain
    axes.set(aspect="equal", xlim=(x1, x2), ylim=(y1, y2))


def draw_energies(axes: Axes, made: Trace) -> None:
    """Energies over time; those that stay zero are left out."""
    for name, label in LABELS.items():
        if np.any(made.energy[name]):
            axes.plot(made.energy["time"], made.energy[name], lw=0.9, label=label)
    axes.set(xlabel="time", ylabel="energy")
    axes.legend(fontsize=7)
