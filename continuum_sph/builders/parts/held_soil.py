"""Ground that does not move, of a scene with `soil.held`: only its water is computed."""

import numpy as np

from continuum_sph.builders.parts.soil import soil_particles, soil_section
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage import PoreFlow
from continuum_sph.seepage.skeleton import Frame
from porescale.common.core.types import Floats
from porescale.common.record.model import Cloud
from porescale.common.record.part import Part


def held_ground(scene: Scene) -> Frame:
    """The soil of a scene, held where it is."""
    section, x = soil_section(scene), soil_particles(scene)[0]
    return Frame(x, scene.numerics.spacing**2, section.porosity, section.permeability_at(x))


class HeldSoilPart(Part):
    """Soil that is held: it has no stress, no displacement and no columns."""

    key = "soil"

    def __init__(self, scene: Scene, flow: PoreFlow) -> None:
        self.section, self.flow, self.skeleton = soil_section(scene), flow, flow.skeleton
        self.mass = self.section.density * scene.numerics.spacing**2  # kg/m, of a particle

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s, which are 0, of the soil; views."""
        return self.skeleton.x, self.skeleton.v

    def masses(self) -> Floats:
        """Masses of the soil, (n,) kg/m."""
        return np.full(self.skeleton.count, self.mass)

    def cloud(self) -> Cloud:
        """The soil: velocity, porosity, and the pressure of the water about it; its stress is not known."""
        n = self.skeleton.count
        data = {
            "velocity": np.zeros((n, 3)),
            "pore_pressure": self.flow.pore_pressure(),
            "porosity": np.full(n, self.section.porosity),
        }
        return Cloud(self.skeleton.x.copy(), data, {"velocity": "m/s", "pore_pressure": "Pa"})
