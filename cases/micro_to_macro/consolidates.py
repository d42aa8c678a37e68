"""A bed under water that is given its weight at once, of grains and of the soil that they make: how soon its water
loses what it bears of that weight, and how soon it settles."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from compared import Compared, half
from layers import Layer, terzaghi
from matplotlib.axes import Axes

import continuum_sph as cs
import porescale as ps
from porescale import GRAVITY, Floats

HERE = Path(__file__).resolve().parent
REST, RAMP = 0.02, 0.01
"""s that a bed rests, and within which its weight is raised: two periods of its sound, so that it hardly swings."""
LONG = 0.3  # s that a bed is followed from the middle of the ramp on: T_v 1
LOOKS = 0.001  # s between looks
MIDDLE = (0.25, 0.75)  # of the height, between which the porosity is taken
ROWS = (10, 20, 40)  # of soil over the height
EXCESS, SETTLED = "T_v of half of the excess pressure at the floor", "T_v of half of the settlement"
OWN = "with K as the bed has it"
MODULUS = "M over that of material.toml"
SEEN = "K of beds that consolidate over that at their porosity"
GRAINS_EXCESS, GRAINS_SETTLED = "half of the excess, T_v of grains over soil", "half settled, T_v of grains over soil"
SOIL_EXCESS, SOIL_SETTLED = "half of the excess, T_v of soil", "half settled, T_v of soil"
STIFF = "M of beds that consolidate over that of specimens"
"""Rows of expected.toml."""


def squeezed(seed: int, settings: Sequence[str] = ()) -> Layer:
    """The bed of squeezed.toml with another packing and ``settings``, when a force on each grain raises gravity to that
    of the earth."""
    scene = ps.load(HERE / "squeezed.toml", settings=[f"grains.packing.seed={seed}", *settings])
    fluid, grains = scene.fluid, scene.grains
    assert fluid
    assert fluid.spacing
    assert fluid.step
    assert grains
    assert grains.hydraulic_radius_ratio
    simulation = ps.build(scene)
    area = math.pi * simulation.radii**2
    more = (grains.density - fluid.density) * area * (GRAVITY + scene.gravity[1])

    def weight(time: float, positions: Floats, velocities: Floats, out: Floats) -> None:
        """What submerged grains weigh more, raised as half a wave of a cosine."""
        share = min(max((time - REST) / RAMP, 0.0), 1.0)
        out[:, 1] -= 0.5 * (1.0 - math.cos(math.pi * share)) * more

    def look() -> tuple[float, Floats, Floats, Floats]:
        """Height (m) of the centre; of each row of cells pressure (Pa) in the pores and in all cells, and what discs
        fill."""
        cells = simulation.snapshot().grids["fields"].cells
        solid, pressure = cells["solid_fraction"].astype(float), cells["pressure"].astype(float)
        pores = (pressure * (1.0 - solid)).sum(axis=1) / (1.0 - solid).sum(axis=1)
        centre = float(np.average(simulation.positions[:, 1], weights=area))
        return centre, pores, pressure.mean(axis=1), solid.mean(axis=1)

    simulation.force(weight)
    simulation.advance(round(REST / simulation.step_seconds))
    centre, still, resting, solid = look()
    rows, last = [], solid
    while simulation.time < REST + 0.5 * RAMP + LONG:
        simulation.advance(round(LOOKS / simulation.step_seconds))
        there, pores, everywhere, last = look()
        rows.append((simulation.time - REST - 0.5 * RAMP, centre - there, pores - still, everywhere - resting))
    times, down, excess, everywhere = (np.array(it) for it in zip(*rows, strict=True))
    y = np.asarray((np.arange(len(still)) + 0.5) * fluid.spacing, dtype=np.float64)
    inside = (y > MIDDLE[0] * 2.0 * centre) & (y < MIDDLE[1] * 2.0 * centre)
    filled = 0.5 * float((solid + last)[inside].mean()) / grains.hydraulic_radius_ratio**2  # amid the settlement
    stored = float(everywhere[:, inside].sum() / excess[:, inside].sum())
    height = float(area.sum()) / (filled * scene.domain.width)  # of the same grains, if all lay as in the middle
    load, stiff = float(more.sum()) / scene.domain.width, fluid.density * (fluid.spacing / fluid.step) ** 2 / 3.0
    return Layer(height, 1.0 - filled, load, times, y, excess, down, stored / stiff, sudden=True)


def consolidated(rows: int, settings: Sequence[str] = ()) -> Layer:
    """The layer of squeezed_ground.toml of ``rows`` particles over its height, with ``settings``."""
    height = cs.load(HERE / "squeezed_ground.toml").tank.height
    settings = [f"numerics.spacing={height / rows!r}", *settings]
    simulation: Any = cs.build(cs.load(HERE / "squeezed_ground.toml", settings=settings))
    scene = simulation.scene
    soil, water, particles = scene.soil, scene.water, simulation.flow.ground.soil
    y = particles.x[: particles.soil, 1]
    centre, found = float(y.mean()), []
    heights = np.array([it.y for it in scene.probe])
    still = water.density * GRAVITY * (height - heights)
    while simulation.time < scene.time.end:
        simulation.advance(max(1, round(LOOKS / simulation.step_seconds)))
        row = simulation.tables()["probes"]
        pressure = np.array([row[f"{it.name} pressure (Pa)"] for it in scene.probe])
        found.append((simulation.time, centre - float(y.mean()), pressure - still))
    times, down, excess = (np.array(it) for it in zip(*found, strict=True))
    load = (soil.density - (1.0 - soil.porosity) * water.density) * GRAVITY * height
    return Layer(
        height, soil.porosity, load, times, heights, excess, down,
        soil.porosity / (water.density * water.sound_speed**2), mobility=soil.permeability / (water.density * GRAVITY),
    )  # fmt: skip


def with_permeability(beds: Sequence[Layer], k: Floats) -> list[Layer]:
    """The beds (n,), each with the mobility of water in pores of its K, ``k`` (n,) m²."""
    fluid = ps.load(HERE / "squeezed.toml").fluid
    assert fluid
    assert fluid.viscosity
    return [replace(it, mobility=float(at) / (fluid.density * fluid.viscosity)) for it, at in zip(beds, k, strict=True)]


def modulus_of(stiffness: float, poisson: float) -> float:
    """M (Pa) of what cannot widen, of E (Pa) and nu."""
    return stiffness * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))


def consolidation(
    beds: Sequence[Layer], soil: Sequence[Layer], k: float, e: tuple[float, float], nu: tuple[float, float]
) -> list[Compared]:
    """``beds`` (n,) beside ``soil`` of ROWS.  k : half of the interval of K, relative;  e, nu : E (Pa) and nu of the
    material file, and half of their intervals."""
    own = [replace(it, mobility=it.seen) for it in beds], [replace(it, mobility=it.seen) for it in soil]

    def compared(name: str, of: Callable[[Layer], float], layers: Any = (beds, soil), given: float = k) -> Compared:
        """A quantity of both; given : half of the interval that the material's own leaves, relative."""
        here, there = (np.array([of(it) for it in scale]) for scale in layers)
        return Compared(name, "", here, ROWS, there, given * float(there[-1]))

    m = modulus_of(e[0], nu[0])
    hard, soft = (ps.load(HERE / name).contact for name in ("bed.toml", "squeezed.toml"))
    assert hard
    assert hard.stiffness
    assert soft
    assert soft.stiffness
    softer = soft.stiffness / hard.stiffness
    off = math.hypot(e[1] / e[0], 0.5 * (modulus_of(e[0], nu[0] + nu[1]) - modulus_of(e[0], nu[0] - nu[1])) / m)
    return [
        compared(EXCESS, lambda it: it.half_left), compared(SETTLED, lambda it: it.half_settled),
        compared(f"{EXCESS}, {OWN}", lambda it: it.half_left, own, 0.0),
        compared(f"{SETTLED}, {OWN}", lambda it: it.half_settled, own, 0.0),
        compared(MODULUS, lambda it: it.modulus / (m * softer if it.sudden else m), given=off),
    ]  # fmt: skip


def layer_numbers(beds: Sequence[Layer], compared: Sequence[Compared]) -> dict[str, float | None]:
    """The rows of expected.toml that are of consolidation, of ``beds`` and of what `consolidation` compares of them;
    None where no bed was asked for."""
    made: dict[str, float | None] = dict.fromkeys(
        (SEEN, GRAINS_EXCESS, GRAINS_SETTLED, SOIL_EXCESS, SOIL_SETTLED, STIFF)
    )
    if beds:
        excess, settled, modulus = compared[2:]
        over = [float(it.grains.mean() / it.soil[-1]) for it in (excess, settled)]
        k = float(np.mean([it.seen / it.mobility for it in beds]))
        soil = [float(it.soil[-1]) for it in compared[:2]]
        made = dict(zip(made, [k, *over, *soil, float(modulus.grains.mean())], strict=True))
    return made


def draw_layers(
    panel: Axes, beds: Sequence[Layer], soil: Layer, compared: Sequence[Compared], colours: tuple[str, str]
) -> None:
    """What is left of the excess pressure at the floor and of the settlement over T_v, of grains and soil in their
    ``colours``, and exact; the half times of grains with their intervals, filled with K as the beds have it."""
    for at, (it, colour) in enumerate([*((bed, colours[0]) for bed in beds), (soil, colours[1])]):
        factor = it.factor(it.times)
        label = "beds of grains" if at == 0 else "continuum" if it is soil else None
        width = 1.4 if it is soil else 0.4
        panel.plot(factor, it.left, color=colour, lw=width, label=label)
        panel.plot(factor, it.to_come, "--", color=colour, lw=width)
    for quantity in compared[:4]:
        fill = colours[0] if OWN in quantity.name else "w"
        panel.errorbar(float(quantity.grains.mean()), 0.5, xerr=half(quantity.grains), fmt="o", ms=4, mfc=fill,
                       color=colours[0], capsize=3, zorder=3)  # fmt: skip
    exact = np.linspace(1e-3, 0.6, 200)
    left, to_come = terzaghi(exact, np.zeros(1))
    panel.plot(exact, left[:, 0], "k:", lw=1.0, label="Terzaghi")
    panel.plot(exact, to_come, "k:", lw=1.0)
    panel.axis("on")
    panel.legend(fontsize=6, frameon=False)
    panel.tick_params(labelsize=7)
    panel.set(xlim=(0.0, 0.6), ylim=(0.0, 1.0), xlabel="T_v")
    panel.set_title("excess left, settlement (dashed)", fontsize=9)
