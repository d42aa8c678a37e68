"""[run]: on what a run steps; nothing of the physics."""

from typing import Literal

import pydantic

from porescale.common.schema.sections import Section


class Run(Section):
    """On what a run steps.  A run that is resumed may go on on another device."""

    device: Literal["cpu", "gpu"] = pydantic.Field("cpu", description="what steps the fluid")
