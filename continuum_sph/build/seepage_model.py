"""Soil with water in it as `porescale.common.record` drives it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.build.air_build import AIR as GAS
from continuum_sph.build.air_build import air_rows
from continuum_sph.build.exit_gradient import NAME as EXIT
from continuum_sph.build.exit_gradient import exit_gradient
from continuum_sph.build.health import refuse_no_numbers, refuse_step, stepped
from continuum_sph.build.instruments import Cloud, discharge, tables
from continuum_sph.build.model import REPAIR, Simulation
from continuum_sph.build.phreatic import NAME, phreatic_row
from continuum_sph.build.seepage_build import seepage_of
from continuum_sph.build.soil_model import SoilSimulation
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage import Seepage
from continuum_sph.soil import SoilFlow
from porescale.common.core.errors import Unstable
from porescale.common.record.model import Cloud as Points
from porescale.common.record.model import Snapshot

WATER, DRY, WET, AIR = range(4)
"""Values of "layer" in a snapshot's particles: water, soil whose pores are less than half full, other soil, air."""

HIGHER = 0.1
"""Share of the tank's height by which the water of a reservoir may stand over it: splashes."""


def chosen(cloud: Points, rows: NDArray[np.bool_]) -> Points:
    """The points of a cloud in ``rows`` (n,)."""
    return Points(cloud.position[rows], {key: values[rows] for key, values in cloud.data.items()}, cloud.units)


class SeepageSimulation:
    """Model of a scene with soil and water; see `porescale.common.record.model.Model`."""

    variable_step = True

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.both: Seepage = seepage_of(scene)
        ground = self.both.ground
        assert isinstance(ground, SoilFlow)
        self.water = Simulation(scene, self.both.water)
        self.soil = SoilSimulation(scene, ground)
        self.water.leaps.strips = [(it.left, it.right) for it in scene.reservoir]
        self.refresh()

    def refresh(self) -> None:
        """Steps done, time reached (s) and length of the next step (s), for whoever drives."""
        self.step: int = self.both.water.step
        self.time: float = self.both.time
        self.step_seconds: float = self.both.next_step
        self.water.refresh()
        self.soil.refresh()

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps; Unstable when a position is no number any more."""
        for _ in range(steps):
            stepped(self.both.advance, self.step, self.time, REPAIR)
            self.soil.count()
            self.refresh()

    def check(self) -> None:
        """Raise Unstable when water, soil, the pores between them or a reservoir has left what makes sense."""
        self.water.check()
        self.soil.check()
        flow = self.both.water
        recorded = {"porosity about": ("", flow.porosity), "room about": ("", flow.room),
                    "heat of drag": ("J/m", flow.heat), "seepage": ("m/s", flow.slip)}  # fmt: skip
        refuse_no_numbers(recorded, self.step, self.time, REPAIR)
        wrong = np.flatnonzero((flow.porosity <= 0.0) | (flow.porosity > 1.0))
        if wrong.size:
            at = int(wrong[0])
            raise Unstable(
                f"particle {at}", "porosity about", float(flow.porosity[at]), "", self.step, self.time, REPAIR
            )
        ground, layer = self.both.ground, flow.layer
        limits, rules = (flow.next_step, ground.next_step, self.both.bound), ("water", "soil", "sound of both")
        refuse_step(
            self.both.next_step, limits, rules, layer.x, layer.acceleration, layer.density, self.step, self.time, REPAIR
        )
        for pool in self.both.supply.reservoirs if self.both.supply else ():
            if not pool.bottom - HIGHER <= pool.level <= self.scene.tank.height * (1.0 + HIGHER):
                raise Unstable(
                    f"reservoir {pool.name}", "level", pool.level, "m", self.step, self.time,
                    "its strip is too narrow, or water comes in faster than it leaves: widen it",
                )  # fmt: skip

    def series(self) -> dict[str, float]:
        """One row: that of the water, and of the soil what it does not share with it."""
        water, soil, flow = self.water.series(), self.soil.series(), self.both.water
        shared = {"time (s)", "step (s)"}
        row = {name: value for name, value in water.items() if not name.startswith("steps limited")}
        row |= {f"soil: {name}": value for name, value in soil.items() if name not in shared}
        slip, inside = np.hypot(flow.slip[:, 0], flow.slip[:, 1]), flow.porosity < 1.0
        row["fastest seepage (m/s)"] = float((flow.porosity * slip)[inside].max(initial=0.0))
        row["heat of drag (J/m)"] = float(flow.heat.sum())
        for pool in self.both.supply.reservoirs if self.both.supply else ():
            row[f"{pool.name} level (m)"] = pool.level
            row[f"{pool.name} let in (kg/m)"] = pool.let_in
            row[f"{pool.name} let out (kg/m)"] = pool.let_out
        if self.scene.pile and self.scene.gravity > 0.0:
            wall = self.scene.pile.wall(self.scene.numerics.spacing)
            row[EXIT] = exit_gradient(wall, flow, self.scene.water.density * self.scene.gravity)
        inside &= flow.layer.material[: flow.layer.fluid] == 0
        row["water in pores (kg/m)"] = float(flow.layer.mass[: flow.layer.fluid][inside].sum())
        return row | (air_rows(flow) if self.scene.air else {})

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of phreatic.csv, and of probes.csv and levels.csv where the scene asks for them: of the water, its
        surface in soil too, and its flow to the right through each strip."""
        scene, flow = self.scene, self.both.water
        layer, n = flow.layer, flow.layer.fluid
        there = (layer.mass[:n] > 0.0) & (layer.material[:n] != GAS)
        volume = layer.mass[:n] / (flow.porosity * layer.density)
        length, spacing = flow.law.smoothing.length, scene.numerics.spacing
        cloud = Cloud(
            layer.x[:n][there], volume[there], layer.pressure[:n][there], layer.v[:n][there], length, spacing,
            scene.inner[0],
        )  # fmt: skip
        found = tables(self.time, scene.probe, scene.level, cloud) | {NAME: phreatic_row(self.time, cloud)}
        for number, level in enumerate(scene.level):
            through = discharge(level, cloud, flow.porosity[there])
            found["levels"][f"{level.name or f'level {number}'} discharge (m2/s)"] = through
        return found

    def snapshot(self) -> Snapshot:
        """Water, air and soil as a cloud each, and all as one to look at, soil over the others: layer, velocity,
        pressure (of soil mean effective stress), porosity."""
        water = self.water.snapshot().clouds["particles"]
        soil = self.soil.snapshot().clouds["particles"]
        water.data["porosity"] = self.both.water.porosity.copy()
        layer = self.both.water.layer
        there, gas = layer.mass[: layer.fluid] > 0.0, layer.material[: layer.fluid] == GAS
        air, water = chosen(water, there & gas), chosen(water, there & ~gas)
        soil.data["saturation"] = self.both.water.saturation()
        kind = np.where(soil.data["saturation"] < 0.5, DRY, WET)
        parts = (
            ("layer", np.full(len(water.position), WATER), np.full(len(air.position), AIR), kind),
            *((key, water.data[key], air.data[key], soil.data[key]) for key in ("velocity", "porosity")),
            ("pressure", water.data["pressure"], air.data["pressure"], soil.data["mean_stress"]),
        )
        data = {name: np.concatenate(values) for name, *values in parts}
        units = {"velocity": "m/s", "pressure": "Pa"}
        whole = Points(np.concatenate((water.position, air.position, soil.position)), data, units)
        clouds = {"particles": whole, "water": water, "soil": soil} | ({"air": air} if self.scene.air else {})
        return Snapshot(self.time, self.step, clouds=clouds)

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        supply = self.both.supply
        booked = {"supply": supply.state()} if supply else {}
        return {
            "water": self.water.state(), "soil": self.soil.state(), "next_step": self.both.next_step, **booked
        }  # fmt: skip

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a model of the same scene."""
        self.soil.restore(state["soil"])
        self.water.restore(state["water"])
        self.both.next_step = float(state["next_step"])
        if self.both.supply:
            self.both.supply.restore(state["supply"])
        self.refresh()
