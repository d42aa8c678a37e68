"""What is measured in a tank: probes.csv and levels.csv.

A probe takes the straight line through the particles about it (moving least squares with W as the weight), which is
exact for linear fields; beside fewer than three it takes their mean, and without any it has no value.

A level is where a column of water is half full: the highest y at which Σ V_i b_i w(y - y_i)/breadth over the particles
in a strip falls to one half, w the cubic spline on a line and b_i the share of a particle's width in the strip.  A drop
of one particle is no surface.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.instruments import LevelSection, ProbeSection
from continuum_sph.water.step import Flow
from porescale.common.core.types import Floats
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of

SUPPORT = 2.0  # of the kernels, in smoothing lengths
THIN = 1e-3  # of a mean square distance: particles on a line give no slope across it


@dataclass(frozen=True)
class MeasuredWater:
    """Water to be measured.  x (n, 2) m;  volume (n,) m², grains between it included;  pressure (n,) Pa;  v (n, 2) m/s;
    length : of smoothing, m;  spacing m;  width : of the tank, m."""

    x: Floats
    volume: Floats
    pressure: Floats
    v: Floats
    length: float
    spacing: float
    width: float


def interpolate(at: tuple[float, float], cloud: MeasuredWater) -> Floats:
    """Pressure (Pa) and velocity (m/s) at a point, (3,); no numbers where there is no water."""
    away = cloud.x - np.array(at)
    q = np.hypot(away[:, 0], away[:, 1]) / cloud.length
    near = q < SUPPORT
    if not near.any():
        return np.full(3, np.nan)
    rest = 1.0 - 0.5 * q[near]
    weight = cloud.volume[near] * rest**4 * (1.0 + 2.0 * q[near])
    values = np.column_stack((cloud.pressure[near], cloud.v[near]))
    columns = np.column_stack((np.ones(len(rest)), away[near] / cloud.length))
    moments = columns.T @ (weight[:, None] * columns)
    spread = moments[1:, 1:] / moments[0, 0] - np.outer(moments[0, 1:], moments[0, 1:]) / moments[0, 0] ** 2
    if len(rest) < 3 or np.linalg.eigvalsh(spread)[0] < THIN:
        mean: Floats = weight @ values / moments[0, 0]
        return mean
    line: Floats = np.linalg.solve(moments, columns.T @ (weight[:, None] * values))
    value: Floats = line[0]
    return value


def strip(level: LevelSection, cloud: MeasuredWater) -> tuple[Floats, float]:
    """Share (n,) of the width of each particle, a spacing, that lies in the strip of ``level``, and the strip's breadth
    within the tank, m.  A side of the tank cuts no particle."""
    half = 0.5 * (level.breadth if level.breadth is not None else 4.0 * cloud.spacing)
    left, right = max(0.0, level.x - half), min(cloud.width, level.x + half)
    begin, end = left if left > 0.0 else -np.inf, right if right < cloud.width else np.inf
    x, radius = cloud.x[:, 0], 0.5 * cloud.spacing
    inside = np.minimum(x + radius, end) - np.maximum(x - radius, begin)
    return np.clip(inside / cloud.spacing, 0.0, 1.0), right - left


def surface_height(level: LevelSection, cloud: MeasuredWater) -> float:
    """Height (m) of the free surface in the strip of ``level``; 0 where there is no water."""
    part, breadth = strip(level, cloud)
    inside = part > 0.0
    if not inside.any() or breadth <= 0.0:
        return 0.0
    y, share = cloud.x[inside, 1], (part * cloud.volume)[inside] / breadth
    h = cloud.length
    heights = np.arange(max(0.0, float(y.min())), float(y.max()) + SUPPORT * h + cloud.spacing, 0.1 * cloud.spacing)
    q = np.abs(heights[:, None] - y) / h
    kernel = (np.maximum(0.0, 2.0 - q) ** 3 - 4.0 * np.maximum(0.0, 1.0 - q) ** 3) / (6.0 * h)
    full = kernel @ share - 0.5
    over = np.flatnonzero(full > 0.0)
    if not over.size:
        return 0.0
    top = int(over[-1])
    return float(heights[top] + (heights[top + 1] - heights[top]) * full[top] / (full[top] - full[top + 1]))


def discharge(level: LevelSection, cloud: MeasuredWater, share: Floats) -> float:
    """Flow of water to the right (m²/s) through a section: Σ V_i b_i s_i u_i/breadth over the strip of ``level``;
    ``share`` (n,): s, of each particle's volume that is water."""
    part, breadth = strip(level, cloud)
    return float(part @ (cloud.volume * share * cloud.v[:, 0])) / breadth if breadth > 0.0 else 0.0


def open_depth(level: LevelSection, cloud: MeasuredWater, in_soil: NDArray[np.bool_]) -> float:
    """Depth (m) of the water in the strip of ``level`` that is not ``in_soil`` (n,): its volume over the breadth."""
    part, breadth = strip(level, cloud)
    return float((part * cloud.volume)[~in_soil].sum()) / breadth if breadth > 0.0 else 0.0


def mean_row(name: str, probe: ProbeSection, cloud: MeasuredWater, water: Floats) -> dict[str, float]:
    """Columns of a probe that is a rectangle: means of pressure (Pa) and velocity (m/s) over the water of the particles
    in it, ``water`` (n,) m², and the share of the rectangle that is water.

    NAME mean pressure (Pa) : over the water in the rectangle
    NAME mean velocity x (m/s) : over the water in the rectangle
    NAME mean velocity y (m/s) : over the water in the rectangle
    NAME fluid share () : volume of the water over the area of the rectangle
    """
    assert probe.width is not None
    assert probe.height is not None
    off = np.abs(cloud.x - (probe.x, probe.y))
    inside = (off[:, 0] <= 0.5 * probe.width) & (off[:, 1] <= 0.5 * probe.height)
    own, total = water[inside], float(water[inside].sum())
    values = np.column_stack((cloud.pressure, cloud.v))[inside]
    p, u, v = (own @ values / total).tolist() if total > 0.0 else (float("nan"),) * 3
    return {
        f"{name} mean pressure (Pa)": p, f"{name} mean velocity x (m/s)": u, f"{name} mean velocity y (m/s)": v,
        f"{name} fluid share ()": total / (probe.width * probe.height),
    }  # fmt: skip


def probe_row(
    probes: tuple[ProbeSection, ...], cloud: MeasuredWater, share: Floats | float = 1.0
) -> dict[str, float]:  # fmt: skip
    """Columns of probes.csv: pressure (Pa) and velocity (m/s) at each probe, or their means over a rectangle.

    share (n,): of each particle's volume that is water.

    NAME pressure (Pa) : at the point, by the straight line through the particles about it
    NAME velocity x (m/s) : at the point
    NAME velocity y (m/s) : at the point
    """
    row: dict[str, float] = {}
    for name, probe in zip(names_of(probes, "probe"), probes, strict=True):
        if probe.width is not None:
            row |= mean_row(name, probe, cloud, cloud.volume * share)
            continue
        p, u, v = interpolate((probe.x, probe.y), cloud)
        row[f"{name} pressure (Pa)"] = float(p)
        row[f"{name} velocity x (m/s)"] = float(u)
        row[f"{name} velocity y (m/s)"] = float(v)
    return row


def level_row(levels: tuple[LevelSection, ...], cloud: MeasuredWater) -> dict[str, float]:
    """Columns of levels.csv: height of the water surface at each level, m.

    NAME (m) : height of the water's surface in the strip of the level; 0 where water fills no half of a row
    """
    return {f"{level.name or f'level {k}'} (m)": surface_height(level, cloud) for k, level in enumerate(levels)}


class WaterInstruments(Part):
    """probes.csv and levels.csv of water in a tank.

    width : of the tank, m.
    """

    def __init__(
        self, probes: tuple[ProbeSection, ...], levels: tuple[LevelSection, ...], flow: Flow, width: float
    ) -> None:
        self.probes, self.levels, self.flow, self.width = probes, levels, flow, width

    def measured(self) -> MeasuredWater:
        """Positions, volumes, pressures and velocities of the water particles at the present time."""
        layer, law = self.flow.layer, self.flow.law
        n = layer.fluid
        return MeasuredWater(
            layer.x[:n], layer.mass[:n] / layer.density, layer.pressure[:n], layer.v[:n], law.smoothing.length,
            law.spacing, self.width,
        )  # fmt: skip

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each table that the scene requests."""
        cloud, found = self.measured(), {}
        if self.probes:
            found["probes"] = probe_row(self.probes, cloud)
        if self.levels:
            found["levels"] = level_row(self.levels, cloud)
        return found
