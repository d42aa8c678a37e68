"""Water pressed through a bed, of grains and of the soil that they make."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import porescale as ps
from continuum_sph.validation.seepage import permeameter
from porescale import GRAVITY

HERE = Path(__file__).resolve().parent
STILL, TAPS = 0.05, (0.005, 0.015)
"""s from where on flux and pressure of a bed are averaged: flooded, it rebounds on its contacts for a while, with a
period of 11 ms; heights (m) between which the pressure is taken."""
EVERY = 0.0025  # s between looks at a bed
HALF = "draft"
"""Quality of bed.toml with half the cells per diameter that specimens are measured with: an eighth of the time."""
FLOWS = 120  # steps for each row of the continuum's permeameter after which it is steady


@dataclass(frozen=True)
class Bed:
    """A bed of free grains that water was pressed through.  permeability : K, m², from flux and taps, as in a
    laboratory;  porosity : between the taps."""

    permeability: float
    porosity: float


def bed(seed: int, end: float, quality: str = HALF) -> Bed:
    """The bed of bed.toml with another packing, from STILL to ``end`` (s)."""
    scene = ps.load(HERE / "bed.toml", quality=quality, settings=[f"grains.packing.seed={seed}", f"time.end={end!r}"])
    assert scene.fluid
    assert scene.fluid.viscosity
    assert scene.grains
    assert scene.grains.hydraulic_radius_ratio
    simulation = ps.build(scene)
    flux, drop, solid = [], [], 0.0
    each = round(EVERY / simulation.step_seconds)
    while simulation.time < scene.time.end - 0.5 * EVERY:
        simulation.advance(each)
        if simulation.time > STILL:
            flux.append(simulation.tables()["flux"]["outlet volume flux (m²/s)"] / scene.domain.width)
            lost, solid = between_taps(simulation, scene.fluid.density)
            drop.append(lost)
    gradient = float(np.mean(drop)) / (TAPS[1] - TAPS[0])
    k = scene.fluid.density * scene.fluid.viscosity * float(np.mean(flux)) / gradient
    return Bed(k, 1.0 - solid / scene.grains.hydraulic_radius_ratio**2)


def between_taps(simulation: ps.Simulation, density: float) -> tuple[float, float]:
    """Pressure (Pa) that the flow loses between the taps: that of the water in the rows there, without its weight; and
    the share of the volume between them that its discs fill in the fluid."""
    fields = simulation.snapshot().grids["fields"]
    rows = [round(y / fields.spacing[1]) for y in TAPS]
    found = []
    for row in rows:
        near = slice(row - 3, row + 3)
        free = 1.0 - fields.cells["solid_fraction"][near]
        found.append(float((fields.cells["pressure"][near] * free).sum() / free.sum()))
    lost = found[0] - found[1] - density * GRAVITY * (TAPS[1] - TAPS[0])
    return lost, float(fields.cells["solid_fraction"][slice(*rows)].mean())


def darcy(porosity: float, k: float, gradient: float, rows: int) -> float:
    """Flux q over k i of the continuum's permeameter of ``rows`` particles, of soil with k (m/s)."""
    column = permeameter.Permeameter(rows=rows, permeability=k, porosity=porosity, sound_speed=0.6 / k)
    both = column.build(gradient)
    for _ in range(FLOWS * rows):
        both.advance()
    return permeameter.upward(both, 0.2 * column.height, 0.8 * column.height) / (k * gradient)
