"""What probes, flux sections and load cells of a scene read: rows of probes.csv, flux.csv and loads.csv."""

import math
from collections.abc import Sequence
from typing import Any

from porescale.builders.initial.frames import disc_count
from porescale.builders.parts.flow_fields import ratio_column, total_pressure
from porescale.builders.parts.fluid import FluidPart
from porescale.builders.stepper import Fields, Row
from porescale.builders.system import System
from porescale.common.core.types import AnyArray
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of
from porescale.coupling.step import Coupled
from porescale.output.lines import known_at_sides
from porescale.output.rectangle_mean import RectangleMean
from porescale.output.sample import Sampler, midpoints
from porescale.scene.measures.line import Flux
from porescale.scene.measures.loads import Loads


class FlowInstruments(Part):
    """The measuring sections of a scene with fluid."""

    def __init__(self, system: System) -> None:
        """``system`` : with fluid, and [[probe]], [[flux]] or [loads]."""
        scene, derived, fluid = system.scene, system.derived, system.part(FluidPart)
        assert derived.cells
        self.clock, self.fluid, self.gravity = system.clock, fluid, scene.gravity
        grid = derived.cells, fluid.scales.spacing, scene.domain.periodic
        names = names_of(scene.probe, "probe")
        points = [(name, it) for name, it in zip(names, scene.probe, strict=True) if it.corners is None]
        self.probes = Sampler([(it.x, it.y) for _, it in points], *grid) if points else None
        sides = {name: {"kind": it.kind, "speed": it.speed} for name, it in scene.domain.sides.items()}
        self.at_sides = known_at_sides(sides)
        self.probe_names = [name for name, _ in points]
        self.means = {
            name: RectangleMean(*it.corners, *grid[:2])
            for name, it in zip(names, scene.probe, strict=True) if it.corners
        }  # fmt: skip
        sections = names_of(scene.flux, "section")
        self.fluxes = [
            _Section(name, it, fluid.scales.spacing, grid) for name, it in zip(sections, scene.flux, strict=True)
        ]
        self.coupled = system.coupled
        self.loads = Loading(scene.loads, system.coupled, system.held) if scene.loads and system.coupled else None
        self.first = ratio_column(scene.grains)

    def tables(self) -> dict[str, Row]:
        """A row of every table that the scene has a section for."""
        first, fields, tables = {"time (s)": self.clock.time} | self.first, self.fluid.fields(), {}
        if self.probes or self.means:
            points = self._probe_row(self.probes, fields) if self.probes else {}
            tables["probes"] = first | points | self._mean_row(fields)
        if self.fluxes:
            tables["flux"] = first | self._flux_row(fields)
        if self.loads:
            tables["loads"] = first | self.loads.row()
        return tables

    def _probe_row(self, probes: Sampler, fields: Fields) -> Row:
        """Columns of probes.csv of probes that are points.

        NAME pressure (Pa) : with its hydrostatic part, which is zero in the upper left corner of the box; in fluid
        NAME velocity x (m/s) : at the point, to the right
        NAME velocity y (m/s) : at the point, up
        """
        excess, ux, uy, solid = fields
        p, u, v = (
            probes.in_fluid(total_pressure(self.gravity, self.fluid.scales, excess), solid),
            probes.to_sides(ux, self.at_sides[0], solid),
            probes.to_sides(uy, self.at_sides[1], solid),
        )
        row = {}
        for k, name in enumerate(self.probe_names):
            row[f"{name} pressure (Pa)"] = float(p[k])
            row[f"{name} velocity x (m/s)"] = float(u[k])
            row[f"{name} velocity y (m/s)"] = float(v[k])
        return row

    def _mean_row(self, fields: Fields) -> Row:
        """Means over the fluid in rectangles; the hydrostatic part is exact where they cut cells, too.

        NAME mean pressure (Pa) : over the fluid in the rectangle
        NAME mean velocity x (m/s) : over the fluid in the rectangle
        NAME mean velocity y (m/s) : over the fluid in the rectangle
        NAME fluid share () : share of the rectangle that is fluid
        """
        excess, ux, uy, solid = fields
        (gx, gy), s = self.gravity, self.fluid.scales
        top = excess.shape[0] * s.spacing
        row = {}
        for name, it in self.means.items():
            still = s.density * (gx * it.x[None, :] - gy * (top - it.y[:, None]))
            pressure = excess[it.where] / s.density * s.pressure + still
            share, p, u, v = it.of(solid, pressure, ux, uy)
            row[f"{name} mean pressure (Pa)"] = p
            row[f"{name} mean velocity x (m/s)"] = u
            row[f"{name} mean velocity y (m/s)"] = v
            row[f"{name} fluid share ()"] = share
        return row

    def _flux_row(self, fields: Fields) -> Row:
        """Fluxes of the volume at the density of rest: of mass, in a steady flow the same through every section.

        NAME volume flux (m²/s) : of the fluid through it, > 0 to the right on the way from its start to its end
        NAME flux of solid (m²/s) : of the grains through it, as the fluid sees them
        """
        excess, ux, uy, _ = fields
        relative = 1 + excess / self.fluid.scales.density
        flow, solid = (ux * relative, uy * relative), self.coupled.solid_flow() if self.coupled else None
        row = {}
        for section in self.fluxes:
            row[f"{section.name} volume flux (m²/s)"] = section.integral(*flow)
            if solid is not None:
                row[f"{section.name} flux of solid (m²/s)"] = section.integral(*solid)
        return row


class _Section:
    """Integral of what crosses a straight section: the midpoint rule, a point a cell, exact for whole cells."""

    def __init__(self, name: str, section: Flux, spacing: float, grid: Any) -> None:
        self.name = name
        (x0, y0), (x1, y1) = section.start, section.end
        self.length = math.hypot(x1 - x0, y1 - y0)
        self.normal = (y1 - y0) / self.length, (x0 - x1) / self.length
        self.at = Sampler(midpoints(section.start, section.end, max(1, round(self.length / spacing))), *grid)

    def integral(self, ux: AnyArray, uy: AnyArray) -> float:
        """Volume flux of a flow (ny, nx) through the section, m²/s."""
        across = self.normal[0] * self.at.of(ux) + self.normal[1] * self.at.of(uy)
        return float(across.mean()) * self.length


class Loading:
    """Loads of the fluid on chosen bodies.  held : discs that are held, the last ones before corners of frames."""

    def __init__(self, loads: Loads, coupled: Coupled, held: int) -> None:
        self.loads, self.coupled, self.held = loads, coupled, held

    def row(self) -> Row:
        """Force (N/m) and torque (N m/m) of the fluid on every chosen body, and coefficients by a reference.

        The load of the last step, that of the fluid inside taken back, with the films of [lubrication], and what a body
        force, the pressure gradient that it stands for, does on the area of the body; buoyancy by gravity is not in it
        (the lattice solves for the reduced pressure).

        NAME force x (N/m) : of the fluid on the body, without buoyancy by gravity
        NAME force y (N/m) : of the fluid on the body, without buoyancy by gravity
        NAME torque (N m/m) : of the fluid about the body's centre
        NAME drag coefficient () : force along loads.direction over ½ ρ U² L
        NAME lift coefficient () : force across it, to its left, over the same
        ring force x (N/m) : of the fluid on the ring
        ring force y (N/m) : of the fluid on the ring
        ring torque (N m/m) : of the fluid on the ring, about its centre
        """
        loads, coupled = self.loads, self.coupled
        grains = disc_count(coupled.grains) - self.held
        row: Row = {}
        force = coupled.fluid_force + coupled.push
        if coupled.lubrication:
            force += coupled.lubrication.force
        bodies = [(f"disc {k}", grains + k) for k in loads.discs] + [(f"grain {k}", k) for k in loads.grains]
        length = math.hypot(*loads.direction)
        ex, ey = loads.direction[0] / length, loads.direction[1] / length
        for name, k in bodies:
            fx, fy = (float(value) for value in force[k])
            row[f"{name} force x (N/m)"] = fx
            row[f"{name} force y (N/m)"] = fy
            row[f"{name} torque (N m/m)"] = float(coupled.fluid_torque[k])
            if loads.speed and loads.length:
                unit = 0.5 * coupled.scales.density * loads.speed**2 * loads.length
                row[f"{name} drag coefficient ()"] = (fx * ex + fy * ey) / unit
                row[f"{name} lift coefficient ()"] = (fy * ex - fx * ey) / unit
        row |= rectangle_loads(loads.rectangles, coupled)
        if loads.ring:
            fx, fy, torque = (float(value) for value in coupled.ring_load[0])
            row |= {"ring force x (N/m)": fx, "ring force y (N/m)": fy, "ring torque (N m/m)": torque}
        return row


def rectangle_loads(numbers: Sequence[int], coupled: Coupled) -> Row:
    """Forces of the fluid and of the grains on rectangles by number, columns of loads.csv.

    rectangle K force AXIS (N/m) : of the fluid on the rectangle, in x and y
    rectangle K force of grains AXIS (N/m) : of the grains on it, in x and y
    """
    row: Row = {}
    for k in numbers:
        fluid, grains = coupled.rectangle_force[k], coupled.grains.rectangle_force[k]
        for a, axis in enumerate("xy"):
            row[f"rectangle {k} force {axis} (N/m)"] = float(fluid[a])
            row[f"rectangle {k} force of grains {axis} (N/m)"] = float(grains[a])
    return row
