"""A scene as `porescale.common.record` drives it: something that moves, and a list of parts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from continuum_sph.builders.assembly import Assembly
from continuum_sph.builders.parts import mixture, soil, suction, water
from continuum_sph.builders.parts.watched import WatchedPart
from continuum_sph.builders.sanity import Now, advance_one
from continuum_sph.scene.sections import Scene
from porescale.common.api.fields import Field, scalars
from porescale.common.api.hooks import ForceHook, Hook
from porescale.common.api.shown_simulation import ShownSimulation
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats
from porescale.common.record.model import Snapshot
from porescale.common.record.part import overrides, restore, restoring, row_of, state_of, tables_of
from porescale.common.schema.sections import scene_as_dict

if TYPE_CHECKING:
    from porescale.common.api.report import Report
    from porescale.common.pictures.initial import Initial
    from porescale.common.pictures.look import Look


def assemble(scene: Scene) -> Assembly:
    """Water in a tank, soil in it, soil with water in its pores, or soil with suction; what is watched of the soil."""
    if scene.soil is None:
        return water.assemble(scene)
    if scene.soil.suction is not None:
        made = suction.assemble(scene)
    else:
        made = soil.assemble(scene) if scene.dry else mixture.assemble(scene)
    if scene.soil.watch:
        ground = next(part for part in made.parts if isinstance(part, soil.SoilPart))
        made.parts.append(WatchedPart(scene, ground))
    return made


class Simulation(ShownSimulation):
    """Model of a scene; see `porescale.common.record.model.Model`.

    Particles, as in `positions`, are those that a snapshot shows: water or soil in the order in which they were placed;
    of water in soil first the water, then the air, then the soil.  Where reservoirs supply water their number changes.

    flow : what moves: `water.step.Flow` of water, `soil.SoilFlow` of soil, `seepage.Seepage` of both,
    `unsaturated.MoistSoil` of soil with suction;  parts : see
    `porescale.common.record.part.Part`;  shown : that of them whose particles are seen.
    """

    variable_step = True

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        made = assemble(scene)
        self.flow: Any = made.flow  # a `System`, of which callers know the kind by their scene
        self.parts, self.shown, self.repair = made.parts, made.shown, made.repair
        self._after()

    @property
    def step(self) -> int:
        """Number of steps done since time 0."""
        return int(self.flow.step)

    @property
    def time(self) -> float:
        """Time reached, in seconds."""
        return float(self.flow.time)

    @property
    def step_seconds(self) -> float:
        """Length of the next step, s."""
        return float(self.flow.next_step)

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s of the particles; views, or copies of water in soil."""
        return self.shown.motion()

    @property
    def radii(self) -> Floats:
        """Half the spacing of the particles, (n,) m."""
        return np.full(len(self.motion()[0]), 0.5 * self.scene.numerics.spacing)

    @property
    def masses(self) -> Floats:
        """Masses of the particles, (n,) kg per metre of depth, soil with suction and its water together; a copy."""
        return self.shown.masses().copy()

    def _sizes(self) -> str:
        return f"{len(self.motion()[0])} particles, {self.scene.numerics.spacing:.4g} m apart"

    def _report(self) -> Report:
        from continuum_sph.builders.report import report

        return report(self.scene)

    def _look(self) -> Look:
        from continuum_sph.builders.parts.phreatic import NAME, line_of
        from continuum_sph.look import look_of_scene

        table = self.tables().get(NAME)
        row = {name: np.array([value]) for name, value in (table or {}).items()}
        surface = line_of(row, self.scene.numerics.spacing) if table else None
        return look_of_scene(scene_as_dict(self.scene), self.name, surface)

    def _initial(self, snapshot: Snapshot) -> Initial:
        from continuum_sph.features import features_of, lens_of
        from continuum_sph.look import GROUND
        from porescale.common.pictures.initial import Initial

        look, cloud = self._look(), snapshot.clouds["particles"]
        kinds = dict(look.kinds)
        if not kinds:  # of one kind all: soil or water
            cloud.data["layer"] = np.zeros(len(cloud.position), np.int8)
            kinds, look = {0: GROUND[self.scene.soil is not None]}, replace(look, colour="layer")
        return Initial(
            replace(look, kinds=kinds, marks=None, lines=()), features_of(self.scene), lens_of(self.scene, snapshot)
        )

    def _fields(self) -> dict[str, Field]:
        cloud = self.shown.cloud()
        return scalars(cloud.data, cloud.units)

    def _with_field(self, snapshot: Snapshot, look: Look, name: str, field: Field) -> Look:
        cloud = snapshot.clouds["particles"]
        cloud.data[name], cloud.units[name] = field
        return replace(look, colour=name, kinds={})

    def _add_force(self, hook: ForceHook, instead_of: Hook | None) -> None:
        from continuum_sph.builders.parts.user_forces import UserForces

        part = next((it for it in self.parts if isinstance(it, UserForces)), None)
        if part is None:
            part = UserForces(self.flow, self.shown)
            self.parts.append(part)
        part.hooks = [*(it for it in part.hooks if it is not instead_of), hook]

    def _after(self) -> None:
        for part in self.parts:
            part.after()

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps; Unstable when a position is no number any more."""
        self._require_steps(steps)
        before = [part.before for part in self.parts if overrides(part, "before")]
        for _ in range(steps):
            for act in before:
                act()
            try:
                advance_one(self.flow.advance, Now(self.step, self.time, self.repair))
            except Unstable:
                self._check_forces()
                raise
            self._after()

    def series(self) -> dict[str, float]:
        """One row: the time, and the columns of all parts.

        time (s) : time of the row, since the start
        step (s) : length of the next step
        """
        return {"time (s)": self.time, "step (s)": self.step_seconds} | row_of(self.parts)

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each further table."""
        return {name: {"time (s)": self.time} | row for name, row in tables_of(self.parts).items()}

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return state_of(self.parts)

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a simulation of the same scene; InputError for another one's."""
        with restoring():
            restore(self.parts, state)
            self._after()
