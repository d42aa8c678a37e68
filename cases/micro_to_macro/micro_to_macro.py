"""One soil at two scales: grains make a material file, and the continuum that reads it does what the grains do."""

import math
import sys
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import numpy as np
from compared import HEAD, Compared, half, half_of, power
from consolidates import (
    ROWS,
    consolidated,
    consolidation,
    draw_layers,
    layer_numbers,
    squeezed,
    with_permeability,
)
from falls import Fall, grains_fall, soil_falls
from flows import Bed, bed, darcy
from layers import Layer
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from slides import RATED, Slopes, draw_slopes, ends_of, numbers_of_slopes, slopes

import continuum_sph as cs
import porescale as ps
from continuum_sph.builders import material_of
from continuum_sph.validation.soil import element as lab
from porescale import GRAVITY, Floats
from porescale.output import conclude, options

HERE = Path(__file__).resolve().parent
MIDDLE = 12  # rows of soil whose numbers are varied
FLOW_ROWS = (10, 20, 40)
GRADIENT = 0.2
SEEN: dict[str, tuple[str, Callable[[Fall], float]]] = {
    "front, 95 % of the mass behind it": ("m", Fall.front),
    "centre of mass at rest": ("m", lambda it: it.centre_at_rest),
    "height at the wall": ("m", lambda it: it.height),
    "time until the centre has gone 1 cm": ("s", Fall.when),
}
"""What is read of a column that fell: unit, and how."""
FLOW, AT_POROSITY = "q over k i", "q over k i, k at the porosity of the bed"
GRAINS, SOIL, FASTER = "#8c1c2f", "#2a6f97", "#e9a23b"


@dataclass
class Columns:
    """Columns that fell: of grains, one for each packing; of soil and of soil whose friction grows with the rate, one
    for each of ``rows``; of both, with each of its numbers at either end of its interval."""

    rows: Sequence[int]
    grains: list[Fall]
    soil: list[Fall]
    rated: list[Fall]
    ends: list[tuple[Fall, Fall]]
    rated_ends: list[tuple[Fall, Fall]]

    def compared(self, rated: bool = False) -> list[Compared]:
        """Every quantity of SEEN at both scales, or with friction of the soil that grows with the rate."""
        fell, ends = (self.rated, self.rated_ends) if rated else (self.soil, self.ends)
        made = []
        for name, (unit, of) in SEEN.items():
            grains = np.array([of(it) for it in self.grains])
            given = math.hypot(*(0.5 * (of(high) - of(low)) for low, high in ends))
            made.append(Compared(name, unit, grains, self.rows, np.array([of(it) for it in fell]), given))
        return made


def ground(settings: Sequence[str] = ()) -> cs.Scene:
    """The continuum's scene, which has taken over material.toml."""
    return cs.load(HERE / "ground.toml", settings=settings)


def known(name: str) -> tuple[float, float]:
    """A number of material.toml and half of its interval, of its packings alone: grains and soil have lattice and
    lambda in common."""
    soil = ground().soil
    assert soil
    assert soil.origin
    mean, error = soil.origin.measured[name]
    return mean, half_of(error, len(soil.origin.made["seeds"]))


def columns_fall(count: int, rows: Sequence[int], end: float) -> Columns:
    """``count`` columns of grains and those of soil, until ``end`` (s)."""
    stop = f"time.end={end!r}"

    def soil(row: int, *settings: str) -> Fall:
        """A column of ``row`` particles over its depth of 3 cm."""
        return soil_falls((f"numerics.spacing={0.03 / row!r}", stop, *settings))

    def ends(*settings: str) -> list[tuple[Fall, Fall]]:
        """Columns with each number at either end of its interval."""
        row = min(MIDDLE, rows[-1])
        return [(soil(row, *settings, low), soil(row, *settings, high)) for low, high in ends_of(settings)]

    return Columns(
        rows, [grains_fall(seed, (stop,)) for seed in range(1, count + 1)],
        [soil(row) for row in rows], [soil(row, *RATED) for row in rows], ends(), ends(*RATED),
    )  # fmt: skip


def flows(beds: Sequence[Bed]) -> list[Compared]:
    """Flow through beds of grains and through soil, over k i of the measured k, and of that at the beds' porosity."""
    scene, soil = ps.load(HERE / "bed.toml"), ground().soil
    assert scene.fluid
    assert scene.fluid.viscosity
    assert soil
    wanted, error = known("permeability")
    across = np.array(
        [darcy(soil.porosity, wanted * GRAVITY / scene.fluid.viscosity, GRADIENT, it) for it in FLOW_ROWS]
    )
    through = np.array([it.permeability for it in beds])
    n, k = specimens()
    there, off = power(n, k, np.array([it.porosity for it in beds]))
    plain = Compared(FLOW, "", through / k.mean(), FLOW_ROWS, across, error / wanted)
    return [plain, replace(plain, name=AT_POROSITY, grains=through / there, given=off)]


def specimens() -> tuple[Floats, Floats]:
    """Porosity, and the K (m²) that beds of free grains have at half the cells, of each packing that material.toml was
    measured of."""
    measured = tomllib.loads((HERE / "material.toml").read_text(encoding="utf-8"))["measured"]
    names = "porosity", "permeability", "excess_with_free_grains_at_half_the_cells"
    n, k, more = (np.array(measured[it]["values"]) for it in names)
    return n, k * (1.0 + more)


def strength() -> tuple[float, Floats]:
    """Critical angle of an element of the soil over that of the grains, and the rows of its test."""
    soil = ground().soil
    assert soil
    _, rows = lab.biaxial(material_of(soil), soil.reference, 0.05, 2000)
    strong = (rows[-1, 2] - rows[-1, 3]) / (rows[-1, 2] + rows[-1, 3])
    return math.asin(strong) / known("critical_friction_angle")[0], rows


def layers(count: int) -> tuple[list[Layer], list[Layer], list[Compared]]:
    """``count`` beds that consolidate, the soil of ROWS that does, and both beside each other; nothing of none."""
    if not count:
        return [], [], []
    beds = [squeezed(seed) for seed in range(1, count + 1)]
    k, off = power(*specimens(), np.array([it.porosity for it in beds]))
    beds, soil = with_permeability(beds, k), [consolidated(it) for it in ROWS]
    return beds, soil, consolidation(beds, soil, off, known("stiffness"), known("Poissons_ratio"))


def numbers_of(flow: Sequence[Compared], columns: Columns, angle: float) -> dict[str, float | None]:
    """The rows of expected.toml; None where no bed was asked for."""
    front, centre = columns.compared()[:2]
    rated = {it.name: float(it.soil[-1] / it.grains.mean()) for it in columns.compared(rated=True)}
    made: dict[str, float | None] = {
        "flow through grains over Darcy's": None, "flow through grains over Darcy's at their porosity": None,
        "flow through soil over Darcy's": None,
    }  # fmt: skip
    if flow:
        means = [float(it.grains.mean()) for it in flow]
        made = dict(zip(made, [*means, float(flow[0].soil[-1])], strict=True))
    masses = [float(np.mean([it.mass.sum() for it in fell])) for fell in (columns.grains, columns.soil)]
    return made | {
        "mass of the column of soil over that of grains": masses[1] / masses[0],
        "critical angle of an element over that of grains": angle,
        "front of fallen grains": float(front.grains.mean()), "front of fallen soil": float(front.soil[-1]),
        "centre of fallen grains": float(centre.grains.mean()), "centre of fallen soil": float(centre.soil[-1]),
    } | {
        f"{short} of soil that grows with the rate over that of grains": rated[name]
        for short, name in zip(("front", "centre", "height", "time"), SEEN, strict=True)
    }  # fmt: skip


def table(flow: Sequence[Compared], columns: Columns, slid: Slopes | None = None) -> list[str]:
    """What both scales have, and whether they agree, as lines of a table in Markdown."""
    rated = [replace(it, name=f"{it.name}, growing with the rate") for it in columns.compared(rated=True)]
    rows = [it.cells() for it in [*flow, *columns.compared(), *rated, *(slid.compared() if slid else [])]]
    return ["| " + " | ".join(it) + " |" for it in [HEAD, ["---"] * len(HEAD), *rows]]


def draw(flow: Sequence[Compared], columns: Columns, rows: Floats, slid: Slopes | None = None) -> Figure:
    """Flow, strength, quantities of the columns over the spacing, and their way; friction of slopes, and a place for
    layers; bars are intervals at 95 %."""
    figure = Figure(figsize=(10.5, 8.5), layout="constrained")
    *panels, below, last = figure.subplots(3, 3).flat
    draw_slopes(below, slid, (GRAINS, SOIL, FASTER))
    last.axis("off")
    for at, it in enumerate(flow):
        scale(panels[0], it, at, SOIL, "continuum" if not at else None)
    panels[0].set(xticks=[0, 1], xlim=(-0.6, 1.8), title="q / (k i)")
    panels[0].set_xticklabels(["measured k", "k at the\nbed's porosity"], fontsize=7)
    mean, error = np.degrees(known("critical_friction_angle"))
    panels[1].axhspan(mean - error, mean + error, color=GRAINS, alpha=0.4, lw=0, label="grains, critical, 95 %")
    sine = (rows[:, 2] - rows[:, 3]) / (rows[:, 2] + rows[:, 3])
    panels[1].plot(100.0 * rows[:, 0], np.degrees(np.arcsin(sine)), color=SOIL, label="element of the continuum")
    panels[1].set(xlabel="axial strain, %", ylim=(0.0, 20.0), title="mobilised angle, °")
    for panel, usual, rated in zip(panels[2:6], columns.compared(), columns.compared(rated=True), strict=True):
        own = 100.0 if usual.unit == "m" else 1.0
        mean, error = own * float(usual.grains.mean()), own * half(usual.grains)
        panel.axhspan(mean - error, mean + error, color=GRAINS, alpha=0.3, lw=0, label="grains, mean, 95 %")
        panel.plot(np.zeros(len(usual.grains)), own * usual.grains, ".", color=GRAINS, ms=4, label="one packing")
        spacing = 30.0 / np.array(usual.rows)
        panel.errorbar(spacing, own * usual.soil, own * usual.given, fmt="s-", color=SOIL, ms=4, capsize=3,
                       label="continuum")  # fmt: skip
        panel.errorbar(spacing, own * rated.soil, own * rated.given, fmt="d--", color=FASTER, ms=4, capsize=3,
                       label="growing with the rate")  # fmt: skip
        panel.set(xlim=(-0.3, None), xlabel="spacing, mm", title=f"{usual.name.split(',')[0].split(' until')[0]}")
        panel.set_ylabel("cm" if usual.unit == "m" else usual.unit)
    for fell, colour, label in ((columns.grains, GRAINS, "grains"), (columns.soil, SOIL, "continuum"),
                                (columns.rated, FASTER, "growing with the rate")):  # fmt: skip
        for one in fell:
            panels[6].plot(one.times, 100.0 * one.centre, color=colour, lw=0.7, label=label if one is fell[0] else None)
    panels[6].set(xlabel="time, s", title="centre of mass, cm")
    for panel in panels:
        panel.title.set_fontsize(9)
        panel.tick_params(labelsize=7)
        if panel in panels[1:3] or panel is panels[6] or (flow and panel is panels[0]):
            panel.legend(fontsize=6, frameon=False)
    return figure


def scale(panel: Axes, it: Compared, at: float, colour: str, label: str | None) -> None:
    """Packings, their mean with its interval, and the soil, at ``at`` of a panel."""
    panel.plot(np.full(len(it.grains), at), it.grains, ".", color=GRAINS, ms=4)
    panel.errorbar(at + 0.12, float(it.grains.mean()), half(it.grains), fmt="o", color=GRAINS, capsize=4,
                   label="beds of grains" if label else None)  # fmt: skip
    panel.errorbar(at + 0.3, float(it.soil[-1]), it.given, fmt="s", color=colour, capsize=4, label=label)


def measure(
    beds: int, columns: int, rows: Sequence[int], end: float, flooded: float = 0.073, slid: int = 0, squeezes: int = 0
) -> tuple[dict[str, float | None], Figure, list[str]]:
    """Numbers of expected.toml, the picture, and the table.  rows : of soil particles over the depth of a column;
    end : of its fall, s;  flooded : until when water is pressed through beds, s: two periods of their rebound;
    slid, squeezes : layers of grains on a slope, and beds that consolidate, none if 0."""
    flow = flows([bed(seed, flooded) for seed in range(1, beds + 1)]) if beds else []
    fell = columns_fall(columns, rows, end)
    angle, test = strength()
    sliding = slopes(slid) if slid else None
    loaded, soil, settled = layers(squeezes)
    numbers = numbers_of(flow, fell, angle) | numbers_of_slopes(sliding) | layer_numbers(loaded, settled)
    figure = draw(flow, fell, test, sliding)
    if settled:
        draw_layers(figure.axes[-1], loaded, soil[-1], settled, (GRAINS, SOIL))
    return numbers, figure, table([*flow, *settled], fell, sliding)


def numbered(text: str) -> list[int]:
    """Rows of soil, few to many, of a text such as 6,9,12; ValueError where it is none."""
    rows = [int(it) for it in text.split(",")]
    if min(rows) < 1 or sorted(set(rows)) != rows:
        raise ValueError
    return rows


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, beds=(int, 8, "beds that water is pressed through, none if 0", 0),
        columns=(int, 8, "columns of grains that fall", 2), end=(float, 0.6, "s that columns fall", 0.01),
        slopes=(int, 8, "layers of grains that slide under water, none if 0", 0),
        squeezed=(int, 8, "beds that consolidate, none if 0", 0),
        rows=(numbered, "6,9,12", "rows of soil over the depth of a column, few to many"),
    )  # fmt: skip
    numbers, figure, lines = measure(
        asked.beds, asked.columns, asked.rows, asked.end, slid=asked.slopes, squeezes=asked.squeezed
    )
    print("\n".join(lines))
    asked.out.mkdir(parents=True, exist_ok=True)
    (asked.out / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    raise SystemExit(conclude(HERE, numbers, figure, asked.out))
