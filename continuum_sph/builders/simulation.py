"""A scene as `porescale.common.record` drives it: something that moves, and a list of parts."""

from typing import Any, TypeVar

from continuum_sph.builders import mixture, soil, water
from continuum_sph.builders.assembly import Assembly
from continuum_sph.builders.sanity import Now, advance_one
from continuum_sph.scene.sections import Scene
from porescale.common.record.model import Snapshot
from porescale.common.record.part import Part, overrides, restore, row_of, state_of, tables_of

P = TypeVar("P", bound=Part)


def assemble(scene: Scene) -> Assembly:
    """Water in a tank, soil in it, or soil with water in its pores."""
    if scene.soil is None:
        return water.assemble(scene)
    return soil.assemble(scene) if scene.dry else mixture.assemble(scene)


class Simulation:
    """Model of a scene; see `porescale.common.record.model.Model`.

    flow : what moves: `water.step.Flow` of water, `soil.SoilFlow` of soil, `seepage.Seepage` of both;  parts : see
    `porescale.common.record.part.Part`.
    """

    variable_step = True

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        made = assemble(scene)
        self.flow, self.parts, self.repair = made.flow, made.parts, made.repair
        self._take_time()

    def _take_time(self) -> None:
        """Steps done, time reached (s) and length of the next step (s), for the run loop; parts follow."""
        self.step: int = self.flow.step
        self.time: float = self.flow.time
        self.step_seconds: float = self.flow.next_step
        for part in self.parts:
            part.after()

    def part(self, kind: type[P]) -> P:
        """The first part of a ``kind``; StopIteration where there is none."""
        return next(part for part in self.parts if isinstance(part, kind))

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps; Unstable when a position is no number any more."""
        before = [part.before for part in self.parts if overrides(part, "before")]
        for _ in range(steps):
            for act in before:
                act()
            advance_one(self.flow.advance, Now(self.step, self.time, self.repair))
            self._take_time()

    def check(self) -> None:
        """Raise Unstable when the state of a part is not finite or out of bounds."""
        for part in self.parts:
            part.check()

    def series(self) -> dict[str, float]:
        """One row: the time, and the columns of all parts."""
        return {"time (s)": self.time, "step (s)": self.step_seconds} | row_of(self.parts)

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each further table."""
        return {name: {"time (s)": self.time} | row for name, row in tables_of(self.parts).items()}

    def snapshot(self) -> Snapshot:
        """The particles now, as clouds."""
        snapshot = Snapshot(self.time, self.step)
        for part in self.parts:
            part.show(snapshot)
        return snapshot

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return state_of(self.parts)

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a simulation of the same scene."""
        restore(self.parts, state)
        self._take_time()
