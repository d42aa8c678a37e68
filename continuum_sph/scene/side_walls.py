"""The section of side walls: a channel that brakes the soil in it."""

from typing import Any

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class SideWallsSection(Section):
    """Plates before and behind the plane, as of a channel in a laboratory, which rub on soil that slides along them:
    see `continuum_sph.soil.side_walls`.

    distance : from one to the other;  friction_angle : of soil on them, δ.  Glass beads on glass have about 10 to 12
    degrees (Jop, Forterre & Pouliquen 2005).  Left out there are none, and the soil is endless across the plane.
    """

    distance: float = quantity("m", ge=1e-6, le=1e5, help="distance between the two")
    friction_angle: float = quantity("rad", ge=0, le=1.4, help="angle of friction of soil on them")

    def faults(self, soil: Any) -> list[Fault]:
        """What is wrong with them in a ``soil``."""
        if not soil.held:
            return []
        repair = "take out [soil.side_walls]"
        return [Fault("soil.held", True, "leaves nothing that soil.side_walls could brake", repair=repair)]
