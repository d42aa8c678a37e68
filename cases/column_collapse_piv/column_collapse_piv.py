"""The tank and the paper's own simulation, each filmed and measured: when the water moves, which vortices there are."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import numpy as np
from filmed import BOX, FLOWS, RATE, STIRS, TANK, Place, film, lattice, named, reaches, size_of, speed_beside
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import porescale as ps
from porescale.output import conclude, options
from porescale.piv.fields import Field, Vortex, compare, vortices

HERE = Path(__file__).resolve().parent
FASTER = 240.0
"""Frames a second of the films that small vortices need."""
FIVE = ("fluid.spacing=3e-4", "fluid.step=3.6e-5")
"""5 cells per grain of the box, where its draft has 4."""
FILMS: dict[str, tuple[str, tuple[str, ...], Place, tuple[float, float]]] = {
    "tank": ("column_collapse_tank", (), TANK, (0.6, 1.5)),
    "box": ("column_collapse", FIVE, BOX, (0.8, 1.5)),
    "box with a gate": ("column_collapse", ("gate.lift_speed=0.5", *FIVE), BOX, (0.8, 1.5)),
}
"""Case, settings, where to look, and the times at which vortices are looked for: while grains fall, and at rest."""
OFTEN = "output.snapshot_interval=0.00833333333333333"
"""Two snapshots a frame."""


@dataclass(frozen=True)
class Seen:
    """What one run shows.

    onset : by speed, m/s, when the water left of the column comes to it, s after the gate opens, in the film and in the
    lattice;  fields : by time, s, and frames a second, the measured one and the lattice's.
    """

    onset: dict[float, tuple[float, float]]
    fields: dict[tuple[float, float], tuple[Field, Field]]


def ran(case: str, settings: Sequence[str], folder: Path) -> Path:
    """The run of a case in ``folder``, made or finished if need be."""
    ps.run(ps.load(HERE.parent / case, settings=[OFTEN, *settings]), folder, resume=folder.is_dir(), progress=False)
    return folder


def look(folder: Path, place: Place, moments: Sequence[float]) -> Seen:
    """Film a run: from the gate's opening on until the water left of the column has set in, and at moments."""
    run = ps.open_run(folder)
    times, filmed = [], []
    for time, field in film(run, max(0.0, place.opens - 1.5 / RATE), place.opens + 0.5):
        times.append(time)
        filmed.append(speed_beside(field, place))
        if filmed[-1] > FLOWS:
            break
    own = [float(it) for it in run.times if it <= place.opens + 0.5]
    there = [speed_beside(lattice(folder, it), place) for it in own]
    fields = {}
    for moment in moments:
        for rate in (RATE, FASTER):
            time, field = next(film(run, moment - 0.5 / rate, moment + 0.51 / rate, rate))
            fields[moment, rate] = (field, lattice(folder, time, field))
    onset = {it: (reaches(it, times, filmed, place), reaches(it, own, there, place)) for it in (STIRS, FLOWS)}
    return Seen(onset, fields)


def numbers_of(name: str, seen: Seen, size: tuple[float, float]) -> dict[str, float]:
    """The numbers of expected.toml that a run gives."""
    numbers = {}
    for speed, (filmed, there) in seen.onset.items():
        numbers[f"{name}: {100 * speed:g} cm/s beside the column"] = filmed
        numbers[f"{name}: {100 * speed:g} cm/s, film less lattice"] = filmed - there
    for moment, rate in seen.fields:
        measured, exact = seen.fields[moment, rate]
        film_of = f"{name}, {moment:g} s, {rate:g} frames a second"
        own, theirs = named(measured, size), named(exact, size)
        low, there_low = own["lower left"], theirs["lower left"]
        numbers[f"{film_of}: rms difference"] = compare(exact, measured).rms
        numbers[f"{film_of}: lower left vortex"] = turn(low)
        numbers[f"{film_of}: upper middle vortex"] = turn(own["upper middle"])
        numbers[f"{film_of}: lower left vortex, how far off"] = (
            float(np.hypot(low.x - there_low.x, low.y - there_low.y)) if low and there_low else np.inf
        )
    return numbers


def turn(vortex: Vortex | None) -> float:
    """1 against the clock, -1 with it, 0 for none."""
    return 0.0 if vortex is None else float(np.sign(vortex.circulation))


def main() -> int:
    """Run, film, measure, compare, judge and draw."""
    given = options(__doc__ or "", HERE, runs=(Path, None, "folder of runs named tank, box and box_with_a_gate"))
    ps.set_threads(1)
    numbers: dict[str, float] = {}
    panels = []
    for name, (case, settings, place, moments) in FILMS.items():
        folder = ran(case, settings, (given.runs or given.out) / name.replace(" ", "_"))
        seen, size = look(folder, place, moments), size_of(folder)
        numbers |= numbers_of(name, seen, size)
        for speed, (filmed, there) in seen.onset.items():
            print(
                f"{name}: {speed:g} m/s left of the column {filmed:.3f} s after the gate opens; lattice {there:.3f} s"
            )
        for (moment, rate), (measured, exact) in seen.fields.items():
            print(f"{name}, {moment:g} s, {rate:g} frames a second: {told(measured)}")
            print(f"{name}, {moment:g} s, lattice: {told(exact)}", flush=True)
        panels.append((name, size, seen))
    return conclude(HERE, numbers, drawn(panels), given.out)


def told(field: Field) -> str:
    """The strongest vortices: place, cm, and circulation, cm²/s."""
    rows = (f"({100 * it.x:.1f}, {100 * it.y:.1f}) {1e4 * it.circulation:+.0f}" for it in vortices(field)[:6])
    return "; ".join(rows)


def drawn(panels: list[tuple[str, tuple[float, float], Seen]]) -> Figure:
    """Measured fields at 60 and 240 frames a second, the lattice's, and their vortices, at the last moment of each."""
    figure = Figure(figsize=(13.5, 3.9 * len(panels)), layout="constrained")
    rows = figure.subplots(len(panels), 3, squeeze=False)
    for axes, (name, size, seen) in zip(rows, panels, strict=True):
        end = max(moment for moment, _ in seen.fields)
        pictures = {
            f"{name}, {end:g} s, film of {RATE:g} frames a second": seen.fields[end, RATE][0],
            f"film of {FASTER:g} frames a second": seen.fields[end, FASTER][0],
            "the lattice's own velocity": seen.fields[end, FASTER][1],
        }
        fastest = float(np.nanquantile(np.hypot(seen.fields[end, FASTER][1].u, seen.fields[end, FASTER][1].v), 0.995))
        for one, (title, field) in zip(axes, pictures.items(), strict=True):
            arrows(one, field, size, fastest)
            one.set_title(title, fontsize=9)
    return figure


def arrows(axes: Axes, field: Field, size: tuple[float, float], fastest: float) -> None:
    """Speed, directions and vortices of a field: red against the clock, blue with it."""
    x, y = 100 * field.x, 100 * field.y
    speed = np.hypot(field.u, field.v)
    axes.pcolormesh(x, y, speed, cmap="Greys", vmin=0, vmax=fastest)
    every = (slice(None, None, 3), slice(None, None, 3))
    length = np.maximum(speed, 1e-4 * fastest) ** -0.5
    xx, yy = np.meshgrid(x, y)
    axes.quiver(xx[every], yy[every], (field.u * length)[every], (field.v * length)[every], scale=22 * fastest**0.5,
                width=0.002, color="0.35")  # fmt: skip
    for it in vortices(field)[:6]:
        colour = "#a50f15" if it.circulation > 0 else "#08519c"
        axes.plot(100 * it.x, 100 * it.y, "o", mfc="none", mec=colour, ms=10, mew=1.8)
        axes.annotate(f"{1e4 * it.circulation:+.0f}", (100 * it.x, 100 * it.y), (7, 5), textcoords="offset points",
                      fontsize=7, color=colour)  # fmt: skip
    axes.set(aspect="equal", xlim=(0, 100 * size[0]), ylim=(0, 100 * size[1]), xlabel="x, cm")


if __name__ == "__main__":
    raise SystemExit(main())
