"""Soil with water in its pores: what is recorded of both layers together, and checks of their state."""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.assembly import Assembly
from continuum_sph.builders.parts.air import AIR as GAS
from continuum_sph.builders.parts.air import AirPart
from continuum_sph.builders.parts.faces import FacePart
from continuum_sph.builders.parts.held_soil import HeldSoilPart
from continuum_sph.builders.parts.instruments import (
    MeasuredWater,
    discharge,
    level_row,
    open_depth,
    probe_row,
)
from continuum_sph.builders.parts.phreatic import NAME, phreatic_row
from continuum_sph.builders.parts.pore_water import seepage_flow
from continuum_sph.builders.parts.reservoirs import ReservoirPart
from continuum_sph.builders.parts.sheet_pile import ExitGradientPart, given_heads, sheet_pile
from continuum_sph.builders.parts.soil import SoilPart
from continuum_sph.builders.parts.water import REPAIR, WaterPart
from continuum_sph.builders.sanity import Now, require_finite, require_step
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage import PoreFlow, Seepage
from continuum_sph.seepage.skeleton import Frame
from continuum_sph.seepage.step import Ground
from continuum_sph.soil import SoilFlow
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of

WATER, DRY, WET, AIR = range(4)
"""Values of "layer" in a snapshot's particles: water, soil whose pores are less than half full, other soil, air."""


class PoreWaterPart(WaterPart):
    """The water, as of a tank without soil; `MixturePart` shows it."""

    key = "water"

    def show(self, snapshot: Snapshot) -> None:
        """Show nothing: `MixturePart.show` writes the particles of both layers."""


class WetSoilPart(SoilPart):
    """The soil, as of a tank without water, whose columns begin with "soil: "; `MixturePart` shows it."""

    key = "soil"

    def row(self) -> dict[str, float]:
        """The columns of soil alone, with the prefix "soil: "."""
        return {f"soil: {name}": value for name, value in super().row().items()}

    def show(self, snapshot: Snapshot) -> None:
        """Show nothing: `MixturePart.show` writes the particles of both layers."""


class MixturePart(Part):
    """What water and soil of a ``flow`` have together."""

    def __init__(self, flow: Seepage, water: PoreWaterPart, soil: WetSoilPart | HeldSoilPart, *, air: bool) -> None:
        self.flow, self.water, self.soil, self.air = flow, water, soil, air

    def check(self) -> None:
        """Raise Unstable when the pores are out of bounds, or the next step exceeds the stable one."""
        both, flow, layer = self.flow, self.flow.water, self.flow.water.layer
        now = Now(both.step, both.time, REPAIR)
        recorded = {"porosity about": ("", flow.porosity), "room about": ("", flow.room),
                    "heat of drag": ("J/m", flow.heat), "seepage": ("m/s", flow.slip)}  # fmt: skip
        require_finite(recorded, now)
        wrong = np.flatnonzero((flow.porosity <= 0.0) | (flow.porosity > 1.0))
        if wrong.size:
            at = int(wrong[0])
            raise Unstable(f"particle {at}", "porosity about", float(flow.porosity[at]), "", *now)
        limits, rules = (flow.next_step, both.ground.next_step, both.bound), ("water", "soil", "sound of both")
        require_step(both.next_step, limits, rules, layer.x, layer.acceleration, layer.density, now)

    def row(self) -> dict[str, float]:
        """Seepage, and the work of drag.

        fastest seepage (m/s) : largest speed of the water against the soil, times porosity
        heat of drag (J/m) : what drag between water and soil has turned into heat, since the start
        """
        flow = self.flow.water
        slip, inside = np.hypot(flow.slip[:, 0], flow.slip[:, 1]), flow.porosity < 1.0
        return {
            "fastest seepage (m/s)": float((flow.porosity * slip)[inside].max(initial=0.0)),
            "heat of drag (J/m)": float(flow.heat.sum()),
        }

    def rows(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Numbers of the particles of the layer in the pores that are there now: of the water, and of the air."""
        layer = self.flow.water.layer
        there, gas = layer.mass[: layer.fluid] > 0.0, layer.material[: layer.fluid] == GAS
        return np.flatnonzero(there & ~gas), np.flatnonzero(there & gas)

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s of water, air and soil that are there now; copies."""
        layer, rows = self.flow.water.layer, np.concatenate(self.rows())
        x, v = self.soil.motion()
        return np.concatenate((layer.x[rows], x)), np.concatenate((layer.v[rows], v))

    def masses(self) -> Floats:
        """Masses of water, air and soil that are there now, (n,) kg/m; a copy."""
        return np.concatenate((self.flow.water.layer.mass[np.concatenate(self.rows())], self.soil.masses()))

    def _clouds(self) -> dict[str, Cloud]:
        """Water, air and soil as a cloud each, and all as one to look at."""
        flow = self.flow.water
        water, soil = self.water.cloud(), self.soil.cloud()
        water.data["porosity"] = flow.porosity.copy()
        water, air = (chosen(water, rows) for rows in self.rows())
        soil.data["saturation"] = flow.saturation()
        kind = np.where(soil.data["saturation"] < 0.5, DRY, WET)
        parts = (
            ("layer", np.full(len(water.position), WATER), np.full(len(air.position), AIR), kind),
            *((key, water.data[key], air.data[key], soil.data[key]) for key in ("velocity", "porosity")),
            ("pressure", water.data["pressure"], air.data["pressure"], flow.pore_pressure()),
        )
        data = {name: np.concatenate(values) for name, *values in parts}
        units = {"velocity": "m/s", "pressure": "Pa"}
        whole = Cloud(np.concatenate((water.position, air.position, soil.position)), data, units)
        weight = -self.flow.water.law.state.density * self.flow.water.law.gravity[1]
        if isinstance(self.soil, HeldSoilPart) and weight > 0.0 and not self.air:
            data["head"], units["head"] = data["pressure"] / weight + whole.position[:, 1], "m"
        return {"particles": whole, "water": water, "soil": soil} | ({"air": air} if self.air else {})

    def cloud(self) -> Cloud:
        """All particles that are there now: water, air, soil."""
        return self._clouds()["particles"]

    def show(self, snapshot: Snapshot) -> None:
        """Water, air and soil as a cloud each, and all as one to look at, soil over the others: layer, velocity,
        pressure (of soil that of the water about it, no number where there is none), porosity, and in ground that is
        held and without air the head of the water."""
        snapshot.clouds |= self._clouds()

    def state(self) -> dict[str, Any]:
        """State of the part: the next time step of both layers, s."""
        return {"next_step": self.flow.next_step}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the next time step from a state."""
        self.flow.next_step = float(state["next_step"])


class PoreInstruments(Part):
    """Water in pores, phreatic.csv, and probes.csv and levels.csv where a scene requests them: of the water, its
    surface in soil too, and its flow to the right through each strip."""

    def __init__(self, scene: Scene, flow: PoreFlow) -> None:
        self.probes, self.levels, self.flow, self.width = scene.probe, scene.level, flow, scene.inner[0]

    def row(self) -> dict[str, float]:
        """Mass of the water in pores.

        water in pores (kg/m) : mass of the water that lies in soil, about which there are more than half of its grains
        """
        flow, n = self.flow, self.flow.layer.fluid
        inside = self._in_soil() & (flow.layer.material[:n] == 0)
        return {"water in pores (kg/m)": float(flow.layer.mass[:n][inside].sum())}

    def _in_soil(self) -> NDArray[np.bool_]:
        """About which particles of the water (n,) there are more than half of the grains that ground has.

        The kernel that smears them is even: at the plane of a flat surface half of its weight lies in ground, with half
        of the grains; half a spacing higher it has a quarter, half a spacing lower three quarters.
        """
        return self.flow.porosity < 0.5 * (1.0 + self.flow.resistance.porosity)

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each table of the instruments.

        NAME discharge (m2/s) : flow of water to the right through the section of the level
        NAME open depth (m) : depth of the water in the strip of the level that lies in no soil, to half a spacing
        """
        flow, layer, law, n = self.flow, self.flow.layer, self.flow.law, self.flow.layer.fluid
        there = (layer.mass[:n] > 0.0) & (layer.material[:n] != GAS)
        volume = layer.mass[:n] / (flow.porosity * layer.density)
        cloud = MeasuredWater(
            layer.x[:n][there], volume[there], layer.pressure[:n][there], layer.v[:n][there], law.smoothing.length,
            law.spacing, self.width,
        )  # fmt: skip
        found: dict[str, dict[str, float]] = {}
        if self.probes:
            found["probes"] = probe_row(self.probes, cloud, flow.porosity[there])
        if self.levels:
            found["levels"] = level_row(self.levels, cloud)
        found[NAME] = phreatic_row(cloud, flow.skeleton.x)
        in_soil = self._in_soil()[there]
        for name, level in zip(names_of(self.levels, "level"), self.levels, strict=True):
            through = discharge(level, cloud, flow.porosity[there])
            found["levels"][f"{name} discharge (m2/s)"] = through
            found["levels"][f"{name} open depth (m)"] = open_depth(level, cloud, in_soil)
        return found


def wet_soil(scene: Scene, ground: Ground) -> WetSoilPart:
    """The soil that moves with its water."""
    assert isinstance(ground, SoilFlow)
    return WetSoilPart(scene, ground)


def chosen(cloud: Cloud, rows: NDArray[np.int64]) -> Cloud:
    """The points of a cloud by their numbers, ``rows`` (m,)."""
    return Cloud(cloud.position[rows], {key: values[rows] for key, values in cloud.data.items()}, cloud.units)


def assemble(scene: Scene) -> Assembly:
    """Soil with water in its pores, and all that a scene has besides."""
    both = seepage_flow(scene)
    water = PoreWaterPart(scene, both.water)
    soil = HeldSoilPart(scene, both.water) if isinstance(both.ground, Frame) else wet_soil(scene, both.ground)
    mixture = MixturePart(both, water, soil, air=scene.air is not None)
    parts: list[Part] = [water, soil, mixture]
    if both.supply:
        parts.append(ReservoirPart(both.supply, both, scene.tank.height))
    if scene.face:
        parts.append(FacePart(scene.face, both.water, scene.numerics.spacing, scene.water.density * scene.gravity))
    if scene.pile and scene.gravity > 0.0:
        spacing = scene.numerics.spacing
        pile = sheet_pile(scene.pile, spacing)
        given = partial(given_heads, scene.face, pile.x, scene.inner, spacing)
        lid = scene.inner[1] if scene.tank.lid else np.inf
        parts.append(ExitGradientPart(pile, both.water, scene.water.density * scene.gravity, given, lid))
    parts.append(PoreInstruments(scene, both.water))
    if scene.air:
        parts.append(AirPart(both.water))
    return Assembly(both, parts, mixture, REPAIR)
