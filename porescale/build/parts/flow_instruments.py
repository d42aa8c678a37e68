"""What probes, flux sections and load cells of a scene read: rows of probes.csv, flux.csv and loads.csv."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.build.parts.rectangles import rectangle_loads
from porescale.coupling.step import Coupled
from porescale.lbm.scales import Scales
from porescale.output.sample import Sampler, midpoints
from porescale.scene.measures.line import Flux
from porescale.scene.measures.loads import Loads
from porescale.scene.scene import Scene

Array = NDArray[Any]

Row = dict[str, float]


LAMBDA = "hydraulic radius ratio ()"
"""Column of lambda: every record of grains in fluid carries it."""


def total_pressure(scene: Scene, scales: Scales, excess: Array) -> Array:
    """Pressure (Pa) of a density excess (kg/m³), both (ny, nx): with the hydrostatic part that the lattice leaves out,
    zero in the upper left corner of the box."""
    ny, nx = excess.shape
    depth, across = (ny - 0.5 - np.arange(ny)) * scales.spacing, (np.arange(nx) + 0.5) * scales.spacing
    gx, gy = scene.gravity
    still = scales.density * (-gy * depth[:, None] + gx * across[None, :])
    return np.asarray(excess / scales.density * scales.pressure + still)


class Instruments:
    """The measuring sections of ``scene`` on a lattice of ``cells`` (nx, ny)."""

    def __init__(self, scene: Scene, scales: Scales, cells: tuple[int, int]) -> None:
        self.scene, self.scales = scene, scales
        grid = cells, scales.spacing, scene.domain.periodic
        self.probes = Sampler([(it.x, it.y) for it in scene.probe], *grid) if scene.probe else None
        self.fluxes = [_Section(it, scales.spacing, grid) for it in scene.flux]

    def tables(self, time: float, fields: tuple[Array, Array, Array, Array], coupled: Coupled | None) -> dict[str, Row]:
        """A row of every table that the scene asks for.  fields : density excess, velocity, solid fraction, SI."""
        first = {"time (s)": time}
        if self.scene.grains and self.scene.grains.hydraulic_radius_ratio:
            first[LAMBDA] = self.scene.grains.hydraulic_radius_ratio
        tables = {}
        if self.probes:
            tables["probes"] = first | self._probe_row(self.probes, fields)
        if self.fluxes:
            tables["flux"] = first | self._flux_row(fields)
        if self.scene.loads and coupled:
            tables["loads"] = first | load_row(self.scene, self.scene.loads, coupled)
            tables["loads"] |= rectangle_loads(self.scene.loads.rectangles, coupled)
        return tables

    def _probe_row(self, probes: Sampler, fields: tuple[Array, Array, Array, Array]) -> Row:
        excess, ux, uy, solid = fields
        p, u, v = probes.in_fluid(total_pressure(self.scene, self.scales, excess), solid), probes.of(ux), probes.of(uy)
        row = {}
        for k, section in enumerate(self.scene.probe):
            name = section.name or f"probe {k}"
            row[f"{name} pressure (Pa)"] = float(p[k])
            row[f"{name} velocity x (m/s)"] = float(u[k])
            row[f"{name} velocity y (m/s)"] = float(v[k])
        return row

    def _flux_row(self, fields: tuple[Array, Array, Array, Array]) -> Row:
        _, ux, uy, solid = fields
        row = {}
        for k, section in enumerate(self.fluxes):
            name = self.scene.flux[k].name or f"section {k}"
            row[f"{name} volume flux (m²/s)"] = section.integral(ux, uy)
            if self.scene.grains or self.scene.disc or self.scene.rectangle:
                row[f"{name} flux of solid (m²/s)"] = section.integral(ux * solid, uy * solid)
        return row


class _Section:
    """Integral of what crosses a straight section: the midpoint rule, a point a cell, exact for whole cells."""

    def __init__(self, section: Flux, spacing: float, grid: Any) -> None:
        (x0, y0), (x1, y1) = section.start, section.end
        self.length = math.hypot(x1 - x0, y1 - y0)
        self.normal = (y1 - y0) / self.length, (x0 - x1) / self.length
        self.at = Sampler(midpoints(section.start, section.end, max(1, round(self.length / spacing))), *grid)

    def integral(self, ux: Array, uy: Array) -> float:
        """Of a flow (ny, nx) through the section, m²/s."""
        across = self.normal[0] * self.at.of(ux) + self.normal[1] * self.at.of(uy)
        return float(across.mean()) * self.length


def load_row(scene: Scene, loads: Loads, coupled: Coupled) -> Row:
    """Force (N/m) and torque (N m/m) of the fluid on every chosen body, and coefficients where a reference is given.

    The load of the last step, that of the fluid inside taken back; buoyancy by gravity is not in it (the lattice
    solves for the reduced pressure).
    """
    grains = coupled.grains.discs.count - len(scene.disc)
    row: Row = {}
    bodies = [(f"disc {k}", grains + k) for k in loads.discs] + [(f"grain {k}", k) for k in loads.grains]
    length = math.hypot(*loads.direction)
    ex, ey = loads.direction[0] / length, loads.direction[1] / length
    for name, k in bodies:
        fx, fy = (float(value) for value in coupled.fluid_force[k])
        row[f"{name} force x (N/m)"] = fx
        row[f"{name} force y (N/m)"] = fy
        row[f"{name} torque (N m/m)"] = float(coupled.fluid_torque[k])
        if loads.speed and loads.length:
            unit = 0.5 * coupled.scales.density * loads.speed**2 * loads.length
            row[f"{name} drag coefficient ()"] = (fx * ex + fy * ey) / unit
            row[f"{name} lift coefficient ()"] = (fy * ex - fx * ey) / unit
    return row
