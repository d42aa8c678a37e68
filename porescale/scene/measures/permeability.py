"""[permeability]: what the bed lets through."""

from typing import Literal

import pydantic

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH, PLACE


class Window(Section):
    """The rectangle of the bed that is measured."""

    left: float = quantity("m", **PLACE, help="left edge")
    bottom: float = quantity("m", **PLACE, help="lower edge")
    width: float = quantity("m", **LENGTH, help="width")
    height: float = quantity("m", **LENGTH, help="height")


class Permeability(Section):
    """The permeability of the bed as it stands in the first and the last snapshot: permeability.csv.

    The grains and held discs in the window stand still, a body force drives fluid through them, slowly enough for
    Stokes flow; operators and relaxation time are the run's, so that it is what this bed lets through in this run.
    """

    window: Window | None = None
    direction: Literal["x", "y"] = pydantic.Field("y", description="direction of the flow")
    wanted: float | None = quantity(
        "", None, gt=0, le=1e3, help="K/d² that the bed should have, d of the grains: check says at which lambda"
    )
    spacing: float | None = quantity(
        "m", None, **LENGTH, help="lattice spacing of the measurement (default: the run's)"
    )
