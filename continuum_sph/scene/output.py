"""The sections of how long a run lasts and of what is recorded."""

import pydantic

from porescale.common.schema.sections import Section, quantity


class TimeSection(Section):
    """How long a run lasts."""

    end: float = quantity("s", ge=1e-9, le=1e9, help="physical time to simulate")


class OutputSection(Section):
    """What is recorded when; recording never changes the physics."""

    snapshot_interval: float = quantity("s", ge=1e-9, le=1e9, help="time between snapshots (frames of the film)")
    series_interval: float = quantity("s", ge=1e-9, le=1e9, help="time between rows of series.csv")
    checkpoint_seconds: float = quantity("s", 30.0, ge=1e-3, le=1e9, help="wall-clock time between checkpoints")
    energy: bool = pydantic.Field(False, description="energy budget of the water, as columns of series.csv")
    report: bool = pydantic.Field(True, description="a page of the run at its end, for browsers: report.html")
