"""A simulation: the parts that a scene has sections for, driven through time.  A `Model` of `common.record`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from porescale.builders.initial.frames import disc_count
from porescale.builders.stepper import Fields, Stepper
from porescale.builders.system import System
from porescale.common.api.fields import Field, scalars
from porescale.common.api.hooks import ForceHook, Hook
from porescale.common.api.shown_simulation import ShownSimulation
from porescale.common.api.simulation import absent
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats
from porescale.common.record.model import Snapshot
from porescale.common.record.part import acts_between, overrides, restore, restoring, row_of, state_of, tables_of
from porescale.common.schema.sections import scene_as_dict

if TYPE_CHECKING:
    from porescale.common.api.report import Report
    from porescale.common.pictures.initial import Initial
    from porescale.common.pictures.look import Look


class Simulation(ShownSimulation):
    """A scene in motion.

    Grains, as in `positions`, are all discs in the order of the scene: the packing, grains and members of clumps placed
    by hand, discs that are held; not the bodies of segments.

    step : model steps done (fluid steps, or contact steps without fluid);  step_seconds : s;  time : s.
    parts : the stepper first;  scene, derived : what it was built from.
    fluid, grains, coupled, weight (n, 2) N/m of dry grains : None where the scene has no such thing;  frames : bodies
    of segments.
    """

    def __init__(self, system: System, stepper: Stepper) -> None:
        """``system`` : with its parts in the order of their columns, tables, arrays and state;  ``stepper`` : of it."""
        self.scene, self.derived, self.clock = system.scene, system.derived, system.clock
        self.fluid, self.grains, self.coupled = system.fluid, system.grains, system.coupled
        self.weight, self.frames = system.weight, system.frames
        self.stepper, self.parts = stepper, system.parts
        self._held = system.held
        self._before = [part.before for part in self.parts if overrides(part, "before")]
        self._after = [part.after for part in self.parts if overrides(part, "after")]
        self._between = [part for part in self.parts if acts_between(part)]

    @property
    def step(self) -> int:
        """Number of steps done since time 0."""
        return self.clock.step

    @property
    def time(self) -> float:
        """Time reached, in seconds."""
        return self.clock.time

    @property
    def step_seconds(self) -> float:
        """Length of a step, s."""
        return self.clock.seconds

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s of the discs; views.  In a strained cell, as they are shown.

        Velocities are those between the last step and the next, half a step away.
        """
        from porescale.builders.parts.clouds import GrainCloud

        cloud = self._part_or_none(GrainCloud)
        if cloud is None:
            raise absent("positions", *self._instead_of_grains())
        position, velocity = cloud.motion()
        return position[: cloud.count], velocity[: cloud.count]

    def _instead_of_grains(self) -> tuple[str, str]:
        """What a scene without grains has, in words, and where its places are had."""
        if self.frames:
            count = len(self.frames)
            there = f"grains, but {count} {'body' if count == 1 else 'bodies'} of segments"
            return there, 'read self.snapshot().clouds["frames"].position, the corners, (n, 2) m'
        return "grains", "add [grains], or read self.fields()" if self.fluid else "add [grains]"

    @property
    def radii(self) -> Floats:
        """Radii of the grains, (n,) m; a copy."""
        return self._of_discs("radius")

    @property
    def masses(self) -> Floats:
        """Masses of the grains, (n,) kg per metre of depth; a copy.  Members of a clump have their shares."""
        return self._of_discs("mass")

    @property
    def angles(self) -> Floats:
        """How far the grains have turned, (n,) rad; a copy."""
        return self._of_discs("angle")

    @property
    def spins(self) -> Floats:
        """Speeds at which the grains turn, (n,) rad/s; a copy."""
        return self._of_discs("spin")

    def _of_discs(self, name: str) -> Floats:
        """A copy of an array of the discs."""
        count = len(self.motion()[0])
        assert self.grains
        values: Floats = getattr(self.grains.discs, name)[:count].copy()
        return values

    def _sizes(self) -> str:
        words = []
        if self.fluid:
            assert self.derived.scales
            words.append(f"{self.fluid.nx} x {self.fluid.ny} cells of {self.derived.scales.spacing:.4g} m")
        if self.grains:
            count = disc_count(self.grains)
            words += [f"{count} grain{'s' * (count > 1)}"] if count else []
            words += [f"{len(self.frames)} bodies of segments"] if self.frames else []
        return ", ".join(words)

    def _report(self) -> Report:
        from porescale.builders.report import report

        return report(self.scene)

    def _look(self) -> Look:
        from porescale.output.show import look_of_scene

        return look_of_scene(scene_as_dict(self.scene), self.name)

    def _initial(self, snapshot: Snapshot) -> Initial:
        from porescale.common.pictures.initial import Initial
        from porescale.output.features import features_of, lens_of

        spacing = self.derived.scales.spacing if self.derived.scales else None
        look = replace(self._look(), colour="", lines=())
        return Initial(look, features_of(self.scene), lens_of(self.scene, snapshot, spacing))

    def _fields(self) -> dict[str, Field]:
        if self.fluid:
            from porescale.builders.parts.flow_fields import all_fields

            assert self.derived.scales
            return all_fields(self.scene.gravity, self.derived.scales, self.fluid, *self.fields())
        snapshot = self.snapshot()
        cloud = snapshot.clouds.get("grains")
        if cloud is None:
            raise absent("field", "fluid and no grains", "snapshot() has its bodies of segments")
        return scalars(cloud.data, cloud.units)

    def _with_field(self, snapshot: Snapshot, look: Look, name: str, field: Field) -> Look:
        if self.fluid:
            grid = snapshot.grids["fields"]
            grid.cells[name], grid.units[name] = field
            return replace(look, field=name, label="")
        cloud = snapshot.clouds["grains"]
        cloud.data[name], cloud.units[name] = field
        return replace(look, colour=name)

    def _add_force(self, hook: ForceHook, instead_of: Hook | None) -> None:
        from porescale.builders.parts.clouds import GrainCloud
        from porescale.builders.parts.user_forces import UserForces

        part = self._part_or_none(UserForces)
        if part is None:
            cloud = self._part_or_none(GrainCloud)
            if cloud is None:
                raise absent(f"force {hook.name}", "discs that it could act on", "add [grains], [[disc]] or [[clump]]")
            part = UserForces(self.stepper, self.coupled, cloud, self._held)
            self.parts.append(part)
            self._before.append(part.before)
            self._between.append(part)
        part.hooks = [*(it for it in part.hooks if it is not instead_of), hook]

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps; raises Unstable when a grain is nowhere."""
        self._require_steps(steps)
        try:
            self._advance(steps)
            if self.fluid:
                self.fluid.wait()  # so that a device's time, and its errors, are those of the steps
        except Unstable as error:
            self._check_forces()
            raise self.stepper.explained(error) from None

    def _advance(self, steps: int) -> None:
        clock, advance, before, after = self.clock, self.stepper.advance, self._before, self._after
        end = clock.step + steps
        while clock.step < end:
            if self.stepper.takes_many:
                alone = min([part.acts_from for part in self._between], default=end)
                if alone >= clock.step + 1:
                    self.stepper.advance_many(int(min(alone, end)) - clock.step)
                    continue
            for act in before:
                act()
            advance()
            clock.put(clock.step + 1)
            for act in after:
                act()

    def fields(self) -> Fields:
        """Density excess (kg/m³), velocity (m/s, two arrays) and solid fraction of every cell, each (ny, nx)."""
        return self.stepper.fields()

    def series(self) -> dict[str, float]:
        """One row: time, and the columns of every part.

        time (s) : time of the row, since the start
        """
        return {"time (s)": self.time} | row_of(self.parts)

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each further series: what probes, flux sections and load cells read; {} where there are none."""
        return tables_of(self.parts)

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit."""
        return {"step": self.step} | state_of(self.parts)

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state of a simulation built from the same scene.

        In the reverse order of the parts: what stands in the fluid is put in place before the fluid is restored.
        InputError for another one's.
        """
        with restoring():
            self.clock.put(int(state["step"]))
            restore(self.parts, state)
