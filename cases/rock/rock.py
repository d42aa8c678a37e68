"""Rock of bonded discs, triangles and Voronoi cells is pulled and pressed: curves, strengths, emissions, cracks."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from porescale import Floats
from porescale.common.pictures import write_film
from porescale.dem.measures import stiffness, voigt
from porescale.dem.prepare import Curve, Kind, Rock, load
from porescale.output import (
    Shot,
    by_piece,
    conclude,
    draw_bodies,
    draw_cracks,
    frame,
    keep,
    options,
    pixels,
    shot,
    stage,
)
from porescale.validation.dem import rock as lab

HERE = Path(__file__).resolve().parent
MOMENTS = 200
PACKED = (0.0, 0.1, 0.2, 0.3, 0.5)
"""Friction while discs are packed, for the stiffness over the number of contacts."""
POLYGONS = 0.05
"""Rate (1/s) of polygons; a wave crosses the sample in 8 ms.  Strengths are 1 % from those at 0.02."""


@dataclass(frozen=True)
class Plan:
    """What is done with one sort of sample: kind, length over height, size over the tutorial's, strains it is pulled
    and pressed to, rate 1/s."""

    kind: Kind
    shape: float
    share: float
    strains: tuple[float, float]
    rate: float
    colour: str


PLANS = {
    "discs": Plan("discs", 1.0, 1.0, lab.LOADS["discs"], lab.RATE, "#2a6f97"),
    "triangles": Plan("triangles", 1.0, 0.5, lab.LOADS["triangles"], POLYGONS, "#b8702c"),
    "cells": Plan("cells", 1.0, 0.5, lab.LOADS["cells"], POLYGONS, "#3b7d4f"),
    "slender cells": Plan("cells", lab.SLENDER, 1.0, (0.004, -0.04), POLYGONS, "#8c1c2f"),
}


@dataclass
class Trial:
    """A sample, its curve, and what it looked like at every moment."""

    rock: Rock
    curve: Curve
    shots: list[Shot] = field(default_factory=list)

    @property
    def stress(self) -> Floats:
        """Over the naive strength, (m,), positive in the direction of the test."""
        return np.asarray(np.sign(self.curve.strain[-1]) * self.curve.stress / self.rock.naive_strength)

    @property
    def peak(self) -> int:
        """Moment of the largest stress."""
        return int(np.argmax(self.stress))

    @property
    def emissions(self) -> Floats:
        """Bonds that broke in each moment, (m,)."""
        return np.diff(self.curve.broken, prepend=0)


def trial(plan: Plan, pressed: bool, seed: int, count: int) -> Trial:
    """One sample pulled or pressed."""
    made = lab.sample(plan.kind, seed, round(plan.share * count), shape=plan.shape)
    strain, shots = plan.strains[pressed], [shot(made.grains)]
    curve = load(made, strain, abs(strain) / plan.rate, MOMENTS, look=lambda grains: shots.append(shot(grains)))
    return Trial(made, curve, shots)


Pair = tuple[Trial, Trial]


def pair(name: str, seed: int, count: int) -> Pair:
    """A sample pulled, and another of its kind pressed."""
    return trial(PLANS[name], False, seed, count), trial(PLANS[name], True, seed, count)


def said(name: str, tests: Sequence[Pair]) -> dict[str, float]:
    """Means over the packings, and their scatter."""
    tensile = np.array([pulled.stress.max() for pulled, _ in tests])
    compressive = np.array([pressed.stress.max() for _, pressed in tests])
    rigid = np.array([pulled.curve.stiffness() / lab.STIFFNESS for pulled, _ in tests])
    numbers = {
        f"{name}: stiffness": float(rigid.mean()),
        f"{name}: tensile strength": float(tensile.mean()),
        f"{name}: compressive strength": float(compressive.mean()),
        f"{name}: compressive over tensile": float(compressive.mean() / tensile.mean()),
    }
    if name == "discs":
        return numbers | {f"{name}: emissions where the pull falls most, over the mean": float(
            np.mean([falling(pulled) for pulled, _ in tests]))}  # fmt: skip
    deepest = max(float(pressed.curve.deepest[: pressed.peak + 1].max()) for _, pressed in tests)
    numbers[f"{name}: deepest overlap up to the peak"] = deepest
    if name == "slender cells":
        numbers[f"{name}: strain at the peak"] = float(np.mean([-it.curve.strain[it.peak] for _, it in tests]))
        numbers[f"{name}: left after the peak"] = float(np.mean([it.stress[-10:].mean() for _, it in tests]))
    return numbers


def falling(pulled: Trial) -> float:
    """Bonds broken in a moment of the tenth of all in which the stress falls most, over the mean of all moments."""
    drops = np.argsort(np.diff(pulled.stress, prepend=0.0))[: MOMENTS // 10]
    return float(pulled.emissions[drops].mean() / pulled.emissions.mean())


def contacts(packings: int, count: int) -> Floats:
    """(frictions, 3): contacts between discs per disc, stiffness of the springs, and Voigt's, over the contact's."""
    rows = []
    for friction in PACKED:
        found = []
        for seed in range(packings):
            made = lab.sample("discs", seed, count, friction)
            bonds, group = made.grains.bonds, made.grains.steering.clumps.group
            assert bonds is not None
            both = group[bonds.partners(made.grains.segments)] < 0
            found.append((2.0 * both.all(axis=1).sum() / count, stiffness(made), voigt(made)))
        rows.append(np.mean(found, axis=0) / (1.0, lab.STIFFNESS, lab.STIFFNESS))
    return np.array(rows)


def measure(
    packings: int = 12, polygons: int = 2, count: int = lab.COUNT, sorts: Sequence[str] = tuple(PLANS)
) -> tuple[dict[str, float], Figure, dict[str, list[Pair]]]:
    """Numbers, the picture of the curves, and the tests for more."""
    tests = {
        name: [pair(name, seed, count) for seed in range(packings if name == "discs" else polygons)] for name in sorts
    }
    springs = contacts(min(packings, 4), count)
    numbers = {"stiffness of the springs, packed without friction": float(springs[0, 1]),
               "stiffness of the springs, as packed here": float(springs[PACKED.index(lab.PREPARED), 1])}  # fmt: skip
    for name, found in tests.items():
        numbers |= said(name, found)
    return numbers, draw(tests, springs), tests


def draw(tests: dict[str, list[Pair]], springs: Floats) -> Figure:
    """Stress over strain pulled and pressed, emissions of a pulled sample of discs, stiffness over contacts."""
    figure, axes = stage(4, 13.0, 3.3)
    for name, found in tests.items():
        for k, it in enumerate(found):
            for ax, each in zip(axes, it, strict=False):
                ax.plot(100.0 * np.abs(each.curve.strain), each.stress, color=PLANS[name].colour, lw=0.7,
                        label=name if k == 0 else None)  # fmt: skip
    axes[0].set(xlabel="strain, %", ylabel="stress over the naive strength", title="pulled", xlim=(0.0, 0.6),
                ylim=(-0.2, 1.4))  # fmt: skip
    axes[1].set(xlabel="strain, %", title="pressed", yscale="log", ylim=(0.1, 50.0))
    for ax in axes[:2]:
        ax.legend(fontsize=7)
    if "discs" in tests:
        emissions(axes[2], tests["discs"][0][0])
    z, own, bound = springs.T
    axes[3].plot(z, bound, "s--", color="0.5", label="Voigt: one strain for all")
    axes[3].plot(z, own, "o-", color="#2a6f97", label="springs at rest")
    axes[3].axhline(0.5, color="k", ls=":", lw=1, label="tutorial")
    axes[3].set(xlabel="contacts of a disc", ylabel="stiffness over the contact's", ylim=(0, 0.9), title="packings")
    axes[3].legend(fontsize=7)
    return figure


def emissions(ax: Axes, pulled: Trial, until: int | None = None) -> None:
    """Stress and breaks of each moment of a test."""
    strain = 100.0 * np.abs(pulled.curve.strain)
    ax.bar(strain[:until], pulled.emissions[:until], width=strain[1] - strain[0], color="#b3122b")
    ax.set(xlabel="strain, %", ylabel="bonds broken in a moment", title="emissions", xlim=(0.0, strain[-1]),
           ylim=(0.0, 1.05 * pulled.emissions.max()))  # fmt: skip
    above = ax.twinx()
    above.plot(strain[:until], pulled.stress[:until], color="k", lw=0.8)
    above.set(yticks=[], ylim=(0.0, 1.15 * pulled.stress.max()))


def show(ax: Axes, made: Trial, moment: int) -> None:
    """A sample at a moment, its pieces coloured, with its cracks."""
    rock, at = made.rock, made.shots[moment]
    draw_bodies(ax, made.rock.grains, at, by_piece(rock.grains, at))
    draw_cracks(ax, rock.grains, at, (0.8 if made.rock.grains.segments is None else 0.5) * rock.diameter)
    margin = 0.12 * rock.height
    frame(ax, (-margin, rock.length + margin, -margin, rock.height + margin))


def cracks(tests: dict[str, list[Pair]]) -> Figure:
    """Samples broken by pulling, above, and by pressing."""
    figure = Figure(figsize=(3.2 * len(tests), 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    for row, axes in enumerate(figure.subplots(2, len(tests), squeeze=False)):
        for ax, (name, found) in zip(axes, tests.items(), strict=True):
            made = found[0][row]
            moment = later(made) if row else len(made.shots) - 1
            show(ax, made, moment)
            how = "pressed" if row else "pulled"
            ax.set_title(f"{name}, {how} to {100 * abs(made.curve.strain[moment - 1]):.1f} %", fontsize=9)
    return figure


def later(made: Trial) -> int:
    """Moment after the peak at which half of the stress is gone; the last if it never is."""
    gone = np.flatnonzero(made.stress[made.peak :] < 0.5 * made.stress.max())
    return made.peak + int(gone[0]) + 1 if len(gone) else len(made.shots) - 1


def film(made: Trial, stem: Path) -> Path:
    """The sample and its emissions, moment by moment."""

    def images() -> list[NDArray[np.uint8]]:
        """Every second shot: stress, cracks and emissions so far."""
        found = []
        for moment in range(1, len(made.shots), 2):
            figure, (left, right) = stage(2, 10.0, 4.0)
            show(left, made, moment)
            emissions(right, made, moment)
            found.append(pixels(figure))
        return found

    return write_film(stem, images(), 15)


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, packings=(int, 12, "packings of discs", 1), polygons=(int, 2, "packings of each polygon"),
        count=(int, lab.COUNT, "seeds of a sample, of half as many for square ones of polygons"),
    )  # fmt: skip
    numbers, figure, tests = measure(asked.packings, asked.polygons, asked.count)
    keep(cracks(tests), asked.out / "cracks.png")
    for name, k in (("discs", 0), ("slender cells", 1)):
        print(f"film: {film(tests[name][0][k], asked.out / ('pulled' if k == 0 else 'pressed'))}")
    raise SystemExit(conclude(HERE, numbers, figure, asked.out))
