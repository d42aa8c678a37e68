"""The section of the tank that holds everything."""

from typing import Literal

import pydantic

from continuum_sph.scene.bounds import LARGEST, SMALLEST
from porescale.common.schema.sections import Section, quantity


class TankSection(Section):
    """A rectangular tank, lower left inner corner at the origin.

    "slip" walls carry pressure only, "stick" walls hold the water as well, or floor and lid alone do.  wall_particles:
    "pressure" take the pressure of the water before them (Adami, Hu & Adams 2012), "images" are those of
    Maeda & Sakai 2004 (eqs 50, 51).
    """

    width: float = quantity("m", ge=SMALLEST, le=LARGEST, help="inner width of the tank")
    height: float = quantity("m", ge=SMALLEST, le=LARGEST, help="inner height of the tank")
    walls: Literal["slip", "stick", "floor and lid stick"] = pydantic.Field(
        default="slip", description="whether walls let water slip"
    )
    wall_particles: Literal["pressure", "images"] = pydantic.Field(
        default="pressure", description="what gives walls their pressure"
    )
    lid: bool = pydantic.Field(True, description="close the tank, so that no splash is lost")
