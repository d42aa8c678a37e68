"""Bodies whose motion is recorded: control.csv."""

from porescale.builders.initial.rock import has_plates
from porescale.builders.parts.flow_fields import ratio_column
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part


class ControlPart(Part):
    """recorded : names of the first bodies that are watched, the plates of a rock not counted."""

    def __init__(self, system: System) -> None:
        assert system.grains
        self.clock, self.grains, self.first = system.clock, system.grains, ratio_column(system.scene.grains)
        self.recorded = system.recorded[: -2 if has_plates(system.scene.rock) else None]

    def tables(self) -> dict[str, Row]:
        """control.csv: displacement since the start, forces of contacts and of the control.

        Forces are means over the last step of the model, and so 0 at the start, of bodies that overlap there, too.

        NAME displacement x (m) : since the start; likewise y
        NAME displacement rotation (rad) : since the start
        NAME contact force x (N/m) : of contacts on the body; likewise y
        NAME contact moment (N m/m) : of contacts about its centre or pivot
        NAME control force x (N/m) : what the control gives; likewise y
        NAME control moment (N m/m) : what the control gives
        """
        row: Row = {"time (s)": self.clock.time} | self.first
        for name, line in zip(self.recorded, self.grains.steering.record(), strict=False):
            for what, values, units in (
                ("displacement", line.displacement, ("m", "m", "rad")),
                ("contact", line.contact, ("N/m", "N/m", "N m/m")),
                ("control", line.supply, ("N/m", "N/m", "N m/m")),
            ):
                kinds = ("x", "y", "rotation") if what == "displacement" else ("force x", "force y", "moment")
                row |= {f"{name} {what} {kind} ({unit})": value
                        for kind, value, unit in zip(kinds, values, units, strict=True)}  # fmt: skip
        return {"control": row}
