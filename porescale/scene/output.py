"""[output]: what is recorded when."""

from typing import Literal

import pydantic

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import TIME

FieldName = Literal["vorticity", "stream_function"]


class Output(Section):
    """What is recorded when; recording never changes the physics."""

    snapshot_interval: float = quantity("s", **TIME, help="time between snapshots (frames of the film)")
    series_interval: float = quantity("s", **TIME, help="time between rows of series.csv")
    checkpoint_seconds: float = quantity("s", 30.0, gt=0, le=1e9, help="wall-clock time between checkpoints")
    fields: tuple[FieldName, ...] = pydantic.Field(
        (), description="fields of snapshots besides velocity and pressure, each with a picture"
    )
    contacts: bool = pydantic.Field(False, description="contacts of grains with their forces in snapshots")
    forces: bool = pydantic.Field(
        False, description="force and moment of grains on every wall, plate, rectangle and held disc: forces.csv"
    )
    energy: bool = pydantic.Field(False, description="energy budget of the grains, as columns of series.csv")
    report: bool = pydantic.Field(True, description="a page of the run at its end, for browsers: report.html")
