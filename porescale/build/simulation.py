"""A simulation: the parts that a scene asked for, driven through time.  Implements the model that ``runs`` drives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.build.derive import Derived
from porescale.build.initial.control import control_row
from porescale.build.initial.fluid_options import weight_of
from porescale.build.initial.frames import Placed, disc_count, free_rows
from porescale.build.parts import flow_fields
from porescale.build.parts.bonds import Binder
from porescale.build.parts.cell import Strained
from porescale.build.parts.flow_instruments import LAMBDA, Instruments, total_pressure
from porescale.build.parts.grain_instruments import GrainInstruments
from porescale.build.parts.rectangles import Movers
from porescale.build.parts.rock import RockWatch
from porescale.build.parts.series import Watch, energy_row
from porescale.build.parts.sleep import sleep_row
from porescale.common.core.errors import Unstable
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.coupling.divergence_check import DivergenceCheck
from porescale.coupling.step import Coupled
from porescale.dem.grains import Grains
from porescale.lbm.boundary.thin_plate import Plate
from porescale.lbm.fluid import Fluid
from porescale.output.frame_clouds import BONDS, FRAMES, frame_cloud
from porescale.scene.scene import Scene

Array = NDArray[Any]


class Gatekeeper:
    """Opens the gate, for fluid and grains alike, at its time: at once, or upward with a speed."""

    def __init__(
        self, opens_at: float, lift_speed: float | None, plate: Plate | None, grains: Grains | None, name: str
    ) -> None:
        self.opens_at, self.lift_speed = opens_at, lift_speed
        self.plate, self.grains, self.name = plate, grains, name
        self.open = False

    def advance(self, time: float, fluid: Fluid | None, spacing: float, step: float) -> None:
        """What the gate does in the step that begins at ``time`` (s)."""
        if not self.open and time >= self.opens_at - 0.5 * step:
            self.open = True
            if self.lift_speed is None:
                if fluid and self.plate in fluid.plates:
                    fluid.plates.remove(self.plate)
                if self.grains:
                    self.grains.remove_plate(self.name)
            else:
                if self.plate:
                    self.plate.speed = self.lift_speed * step / spacing
                if self.grains:
                    self.grains.move_plate(self.name, self.lift_speed)
        if self.plate:
            self.plate.lower_edge += self.plate.speed


class Simulation:
    """A scene in motion.

    step : model steps done (fluid steps, or contact steps without fluid);  step_seconds : s;  time : s.
    fluid, grains, coupled, gate : None where the scene has no such part.
    """

    def __init__(
        self,
        scene: Scene,
        derived: Derived,
        *,
        fluid: Fluid | None,
        grains: Grains | None,
        coupled: Coupled | None,
        weight: Array | None,
        gate: Gatekeeper | None,
        movers: Movers | None = None,
        frames: Sequence[Placed] = (),
        recorded: Sequence[str] = (),
    ) -> None:
        """``frames``: the scene's, those of the grains;  recorded : names of the bodies that are watched."""
        self.scene, self.derived = scene, derived
        self.frames, self._recorded = list(frames), list(recorded)
        self.fluid, self.grains, self.coupled, self.gate = fluid, grains, coupled, gate
        self.weight, self.movers = weight, movers
        self.step = 0
        self.time = 0.0
        self.step_seconds = derived.model_step
        self._mass = fluid.mass_excess() if fluid else 0.0
        free = grains is not None and free_rows(grains, frames, len(scene.disc)).size > 0
        self._watch = Watch(scene, grains, frames) if grains and scene.grains and free else None
        self._grain_instruments = GrainInstruments(scene, grains, frames) if grains and scene.grains else None
        self._binder = Binder(scene, grains, self.frames) if grains and (scene.bonds or scene.rock) else None
        if self._binder:
            self._binder.advance(0.0, self.step_seconds)
        plates = scene.rock is not None and scene.rock.plates != "none"
        self._rock = RockWatch(scene, grains, len(recorded) - 2) if grains and plates else None
        self._strained = Strained(grains) if grains and scene.cell else None
        self._instruments = (
            Instruments(scene, derived.scales, derived.cells) if derived.scales and derived.cells else None
        )

        self._sense: DivergenceCheck | None = None
        if fluid and derived.scales and scene.fluid:
            laws = scene.fluid
            self._sense = DivergenceCheck(
                fluid, derived.scales, coupled, operator=laws.operator, eddies=bool(laws.smagorinsky),
                solid_operator=laws.solid_operator, weighting=weight_of(laws),
            )  # fmt: skip

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps; raises Unstable when a grain is nowhere."""
        try:
            self._advance(steps)
        except Unstable as error:
            if self._sense:  # where both are beyond sense the lattice is named: it throws the grains, not they it
                self._sense.check(self.step, self.time)
            raise self._in_steps(error) from None

    def _in_steps(self, error: Unstable) -> Unstable:
        """``error`` of the grains, which count contact steps, in steps and time of the model."""
        e = error
        return Unstable(e.where, e.quantity, e.value, e.unit, self.step, self.time, e.cause)

    def _alone(self) -> Grains | None:
        """The grains, where nothing is done between their steps and no load is a mean over a call: all go in one."""
        grains, others = self.grains, (self.fluid, self.movers, self._binder, self._strained)
        gate = self.gate is not None and not (self.gate.open and self.gate.lift_speed is None)
        if grains is None or gate or any(others) or grains.sleep or grains.steered or len(grains.held):
            return None
        return grains

    def _advance(self, steps: int) -> None:
        scales, grains = self.derived.scales, self._alone()
        if grains:
            before = grains.steps - self.step
            try:
                grains.step(self.step_seconds, self.weight, count=steps)
            finally:
                self.step = grains.steps - before
                self.time = self.step * self.step_seconds
            return
        for _ in range(steps):
            if self.gate:
                self.gate.advance(self.time, self.fluid, scales.spacing if scales else 1.0, self.step_seconds)
            if self.movers:
                self.movers.advance(self.step, self.step_seconds, self.coupled)
            if self.coupled:
                self.coupled.advance()
            elif self.fluid:
                self.fluid.advance()
            elif self.grains:
                if self._binder:
                    self._binder.advance(self.time, self.step_seconds)
                self.grains.step(self.step_seconds, self.weight)
                if self._strained:
                    self._strained.advance(self.step_seconds)
            self.step += 1
            self.time = self.step * self.step_seconds
            if self.movers:
                self.movers.place(self.step, self.step_seconds)

    def fields(self) -> tuple[Array, Array, Array, Array]:
        """Density excess (kg/m³), velocity (m/s, two arrays) and solid fraction of every cell, each (ny, nx)."""
        assert self.fluid
        assert self.derived.scales
        if self.coupled:
            return self.coupled.fields()
        s = self.derived.scales
        rho, ux, uy = self.fluid.fields()
        return (rho - 1) * s.density, ux * s.velocity, uy * s.velocity, np.zeros_like(rho)

    def check(self) -> None:
        """Raise Unstable, naming cell or grain, quantity and step, when the state is beyond sense."""
        fault = None
        if self.grains:
            try:
                self.grains.check()
            except Unstable as error:
                fault = self._in_steps(error)
        if self._sense:
            self._sense.check(self.step, self.time)
        if fault:
            raise fault

    def series(self) -> dict[str, float]:
        """One row: time, and what the parts present have to say."""
        row = {"time (s)": self.time}
        if self.grains and self._watch:
            row |= self._watch.row(self.grains) | sleep_row(self.grains)
        if self.fluid:
            excess, ux, uy, solid = self.fields()
            row |= flow_fields.fluid_row(excess, ux, uy, solid, self.derived.scales)
            cells = self.fluid.nx * self.fluid.ny
            if self.scene.grains and self.scene.grains.hydraulic_radius_ratio:
                row[LAMBDA] = self.scene.grains.hydraulic_radius_ratio
            row["fluid mass change ()"] = (self.fluid.mass_excess() - self._mass) / cells
            if self.movers and self.coupled:
                row |= self.movers.row(self.coupled)
        if self._strained:
            row |= self._strained.row()
        if self._binder:
            row |= self._binder.row()
        if self.grains and self.scene.output.energy:
            row |= energy_row(self.grains, self.scene.gravity)
        return row

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each further series: what probes, flux sections and load cells read; {} where there are none."""
        scene = self.scene
        tables = self._grain_instruments.tables(self.time) if self._grain_instruments else {}
        if self._instruments and (scene.probe or scene.flux or scene.loads):
            tables |= self._instruments.tables(self.time, self.fields(), self.coupled)
        controlled = self._recorded[: -2 if self._rock else None]
        if self.grains and controlled:
            tables["control"] = {"time (s)": self.time} | control_row(self.grains, controlled)
        if self._rock and self._binder:
            tables["rock"] = {"time (s)": self.time} | self._rock.row(self._binder.row()["broken bonds ()"])
        return tables

    def snapshot(self) -> Snapshot:
        """Fluid as cells, grains as points."""
        snapshot = Snapshot(self.time, self.step)
        if self.fluid and self.derived.scales:
            snapshot.grids["fields"] = self._grid()
        if self.grains and self.grains.discs.count:
            if disc_count(self.grains):
                snapshot.clouds["grains"] = self._cloud(self.grains)
            if self.frames:
                snapshot.clouds[FRAMES] = frame_cloud(self.grains, self.frames)
            if self._binder:
                snapshot.clouds[BONDS] = self._binder.cloud()
            if self._grain_instruments:
                self._grain_instruments.add_to(snapshot)
        return snapshot

    def _cloud(self, grains: Grains) -> Cloud:
        """The discs."""
        own = slice(disc_count(grains))
        d, flat = grains.discs, np.zeros((disc_count(grains), 3))
        position, velocity = self._strained.seen() if self._strained else (d.position, d.velocity)
        flat[:, :2], position = velocity[own], position[own]
        data = {"radius": d.radius[own], "angle": d.angle[own], "velocity": flat, "spin": d.spin[own]}
        units = {"radius": "m", "angle": "rad", "velocity": "m/s", "spin": "rad/s"}
        if self.coupled:
            data["hydraulic_radius"], units["hydraulic_radius"] = self.coupled.hydraulic_radius[own], "m"
        period = np.array([0.0, 0.0] if self._strained else grains.box.period)
        inside = np.where(period > 0, np.mod(position, np.where(period > 0, period, 1.0)), position)
        return Cloud(inside, data, units)

    def _grid(self) -> Grid:
        s = self.derived.scales
        assert s
        assert self.fluid
        excess, ux, uy, solid = self.fields()
        velocity = np.zeros((*ux.shape, 3), np.float32)
        velocity[..., 0], velocity[..., 1] = ux, uy
        cells: dict[str, Array] = {
            "velocity": velocity, "pressure": total_pressure(self.scene, s, excess).astype(np.float32),
        }  # fmt: skip
        if self.grains:
            cells["solid_fraction"] = solid.astype(np.float32)
        cells |= flow_fields.derived_fields(self.scene.output.fields, self.fluid, ux, uy, s)
        units = {"velocity": "m/s", "pressure": "Pa", **flow_fields.UNITS}
        units = {name: unit for name, unit in units.items() if name in cells}
        return Grid((0.0, 0.0), (s.spacing, s.spacing), cells, units)

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit."""
        state: dict[str, Any] = {"step": self.step, "mass": self._mass}
        if self.coupled:
            state["coupled"] = self.coupled.state()
        elif self.fluid:
            state["fluid"] = self.fluid.state()
        elif self.grains:
            state["grains"] = self.grains.state()
        if self._watch:
            state["watch"] = self._watch.state()
        if self.gate:
            state["gate_open"] = self.gate.open
        if self.movers:
            state["made_good"] = self.movers.made_good
        if self._strained:
            state["shear"] = self._strained.shear
        if self._binder:
            state["bonds_made"] = self._binder.made
        return state

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state of a simulation built from the same scene."""
        self.step, self._mass = int(state["step"]), float(state["mass"])
        self.time = self.step * self.step_seconds
        if self.movers:
            self.movers.made_good = float(state["made_good"])
        if self.gate and bool(state["gate_open"]):
            self.gate.open = True
            if self.gate.lift_speed is None and self.fluid:
                self.fluid.plates.clear()
        if self.coupled:
            self.coupled.restore(state["coupled"])
        elif self.fluid:
            self.fluid.restore(state["fluid"])
        elif self.grains:
            self.grains.restore(state["grains"])
        if self.movers:
            self.movers.place(self.step, self.step_seconds)
        if self._watch:
            self._watch.restore(state["watch"])
        if self._strained:
            self._strained.shear = float(state["shear"])
        if self._binder:
            self._binder.made = int(state["bonds_made"])
