"""One soil at two scales: grains make a material file, and the continuum that reads it does what the grains do."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import continuum_sph as cs
import porescale as ps
from continuum_sph.builders import material_of
from continuum_sph.validation.seepage import permeameter
from continuum_sph.validation.soil import element as lab
from porescale import GRAVITY, Floats
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
STILL, TAPS = 0.05, (0.005, 0.015)
"""s from where on flux and pressure of a bed are averaged: flooded, it rebounds on its contacts for a while, with a
period of 11 ms; heights (m) between which the pressure is taken."""
EVERY = 0.0025  # s between looks at a bed
FLOWS = 2400  # steps after which the continuum's permeameter is steady
BINS = np.arange(0.0, 0.2, 0.004)  # m, of the surfaces
GRAINS, SOIL = "#8c1c2f", "#2a6f97"


@dataclass
class Fall:
    """A column that fell: times (t,) s, x (t,) m of its centre, top (b,) m of its surface in BINS at the end."""

    time: Floats
    centre: Floats
    top: Floats


def ground(settings: tuple[str, ...] = ()) -> cs.Scene:
    """The continuum's scene, which has taken over material.toml."""
    return cs.load(HERE / "ground.toml", settings=settings)


def bed(seed: int) -> float:
    """K (m²) of a bed of free grains that water is pressed through, from flux and taps, as in a laboratory."""
    scene = ps.load(HERE / "bed.toml", settings=[f"grains.packing.seed={seed}"])
    assert scene.fluid
    simulation = ps.build(scene)
    flux, drop = [], []
    each = round(EVERY / simulation.step_seconds)
    while simulation.time < scene.time.end - 0.5 * EVERY:
        simulation.advance(each)
        if simulation.time > STILL:
            flux.append(simulation.tables()["flux"]["outlet volume flux (m²/s)"] / scene.domain.width)
            drop.append(fall_of_pressure(simulation, scene.fluid.density))
    gradient = float(np.mean(drop)) / (TAPS[1] - TAPS[0])
    assert scene.fluid.viscosity
    return scene.fluid.density * scene.fluid.viscosity * float(np.mean(flux)) / gradient


def fall_of_pressure(simulation: ps.Simulation, density: float) -> float:
    """Pressure (Pa) that the flow loses between the taps: that of the water in the rows there, without its weight."""
    fields = simulation.snapshot().grids["fields"]
    found = []
    for y in TAPS:
        row = round(y / fields.spacing[1])
        rows = slice(row - 3, row + 3)
        free = 1.0 - fields.cells["solid_fraction"][rows]
        found.append(float((fields.cells["pressure"][rows] * free).sum() / free.sum()))
    return found[0] - found[1] - density * GRAVITY * (TAPS[1] - TAPS[0])


def darcy(porosity: float, k: float, gradient: float) -> float:
    """Flux q of the continuum's permeameter of that soil over k i."""
    column = permeameter.Permeameter(permeability=k, porosity=porosity, sound_speed=0.6 / k)
    both = column.build(gradient)
    for _ in range(FLOWS):
        both.advance()
    return permeameter.upward(both, 0.2 * column.height, 0.8 * column.height) / (k * gradient)


def grains_fall(seed: int) -> Fall:
    """The column of grains of column.toml."""
    simulation = ps.build(ps.load(HERE / "column.toml", settings=[f"grains.packing.seed={seed}"]))
    assert simulation.grains
    d, rows = simulation.grains.discs, []
    each = max(1, round(0.01 / simulation.step_seconds))
    while simulation.time < simulation.scene.time.end:
        rows.append((simulation.time, float(np.average(d.position[:, 0], weights=d.mass))))
        simulation.advance(each)
    time, centre = np.array(rows).T
    return Fall(time, centre, surface(d.position, d.radius))


def soil_falls(angle: float) -> Fall:
    """The column of soil of ground.toml with another angle of friction (rad)."""
    scene = ground((f"soil.friction_angle={angle!r}",))
    simulation, rows = cs.build(scene), []
    particles = simulation.flow.soil.x[: simulation.flow.soil.soil]
    while simulation.time < scene.time.end:
        rows.append((simulation.time, float(particles[:, 0].mean())))
        simulation.advance(50)
    time, centre = np.array(rows).T
    return Fall(time, centre, surface(particles, np.full(len(particles), 0.5 * scene.numerics.spacing)))


def surface(position: Floats, radius: Floats) -> Floats:
    """Height (m) of the highest body in each of BINS, (b,); 0 where there is none."""
    top = np.zeros(len(BINS))
    np.maximum.at(top, np.clip(np.digitize(position[:, 0], BINS) - 1, 0, len(BINS) - 1), position[:, 1] + radius)
    return top


def measure(beds: int, columns: int) -> tuple[dict[str, float], Figure]:
    """Numbers of expected.toml, and the picture."""
    soil = ground().soil
    assert soil
    origin = soil.origin
    assert origin
    assert origin.intrinsic_permeability
    wanted, known = origin.intrinsic_permeability, origin.measured["permeability"][1]
    scene = ps.load(HERE / "bed.toml")
    assert scene.fluid
    assert scene.fluid.viscosity
    k = wanted * scene.fluid.density * GRAVITY / (scene.fluid.density * scene.fluid.viscosity)
    through = np.array([bed(seed) for seed in range(1, beds + 1)]) / wanted
    across = darcy(soil.porosity, k, 0.2)
    _, rows = lab.biaxial(material_of(soil), soil.reference, 0.05, 2000)
    strong = (rows[-1, 2] - rows[-1, 3]) / (rows[-1, 2] + rows[-1, 3])
    angle, error = origin.measured["critical_friction_angle"]
    fell = [grains_fall(seed) for seed in range(1, columns + 1)]
    flowed = [soil_falls(it) for it in (angle - error, angle, angle + error)]
    numbers = {
        "flow through grains over Darcy's": float(through.mean()),
        "flow through soil over Darcy's": across,
        "critical angle of an element over that of grains": math.asin(strong) / angle,
        "centre of fallen grains": float(np.mean([it.centre[-1] for it in fell])),
        "centre of fallen soil": float(flowed[1].centre[-1]),
        "centre of soil over that of grains at 0.15 s": float(
            np.interp(0.15, flowed[1].time, flowed[1].centre)
            / np.mean([np.interp(0.15, it.time, it.centre) for it in fell])
        ),
        "height of soil over that of grains at the wall": flowed[1].top[0] / float(np.mean([it.top[0] for it in fell])),
    }
    return numbers, draw(through, across, known / wanted, rows, (angle, error), fell, flowed)


def draw(
    through: Floats, across: float, known: float, rows: Floats, strength: tuple[float, float], fell: list[Fall],
    flowed: list[Fall],
) -> Figure:  # fmt: skip
    """Flow, strength, the way of both columns and what is left of them; bars and bands are standard errors."""
    figure, (flow, element, way, end) = stage(4, 13.0, 3.3)
    flow.axhspan(1.0 - known, 1.0 + known, color="#bbbbbb", lw=0, label="measured k ± its error")
    flow.plot(np.zeros(len(through)), through, ".", color=GRAINS)
    flow.errorbar(0.0, through.mean(), yerr=error_of(through), fmt="o", color=GRAINS, capsize=4, label="beds of grains")
    flow.plot(1.0, across, "s", color=SOIL, label="continuum")
    flow.set(xlim=(-0.7, 1.7), ylim=(0.85, 1.15), xticks=[], ylabel="q / (k i)", title="flow")
    mean, error = np.degrees(strength)
    element.axhspan(mean - error, mean + error, color=GRAINS, alpha=0.4, lw=0, label="grains, critical ± error")
    sine = (rows[:, 2] - rows[:, 3]) / (rows[:, 2] + rows[:, 3])
    element.plot(100.0 * rows[:, 0], np.degrees(np.arcsin(sine)), color=SOIL, label="element of the continuum")
    element.set(xlabel="axial strain, %", ylabel="mobilised friction angle, °", ylim=(0.0, 20.0), title="strength")
    for it in fell:
        way.plot(it.time, 100.0 * it.centre, color=GRAINS, lw=0.8, label="grains" if it is fell[0] else None)
        end.step(100.0 * BINS, 100.0 * it.top, where="post", color=GRAINS, lw=0.8)
    for it in flowed:
        way.plot(it.time, 100.0 * it.centre, color=SOIL, lw=0.8, label="continuum" if it is flowed[0] else None)
        end.step(100.0 * BINS, 100.0 * it.top, where="post", color=SOIL, lw=0.8)
    way.set(xlabel="time, s", ylabel="centre of the mass, cm", title="a column falls")
    end.set(xlabel="x, cm", ylabel="surface at the end, cm", title="what is left")
    panels: list[Axes] = [flow, element, way]
    for panel in panels:
        panel.legend(fontsize=7, frameon=False, loc="lower right" if panel is not flow else "upper right")
    return figure


def error_of(values: Floats) -> float:
    """Standard error of the mean of ``values`` (n,); 0 of a single one, which says nothing of it."""
    return float(np.std(values, ddof=1) / math.sqrt(len(values))) if len(values) > 1 else 0.0


if __name__ == "__main__":
    asked = options(
        __doc__ or "", HERE, beds=(int, 3, "beds that water is pressed through"),
        columns=(int, 3, "columns of grains that fall"),
    )  # fmt: skip
    raise SystemExit(conclude(HERE, *measure(asked.beds, asked.columns), asked.out))
