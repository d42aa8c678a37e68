"""The section of softening: strength that falls as soil is sheared."""

from typing import Any

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class SofteningSection(Section):
    """Strength of dense or cemented soil, that of [soil] before it shears: see `continuum_sph.soil.material`.

    sin φ, c cos φ and sin ψ go to those of large strains as exp(-γ/γs) with the plastic shear strain γ, the difference
    of the principal plastic strains in the plane; sin ψ to 0.  friction_angle : left after large strains;  cohesion :
    left then;  shear_strain : γs, measured in soil that shears evenly, or in a band;  band_width : of the shear bands
    of the soil, some ten grain diameters: γs times it is the slip by which a band softens, whatever the spacing.  A
    material file of `porescale homogenise` has angle and strain, and its peak strength is that of [soil].
    """

    friction_angle: float = quantity("rad", ge=0, le=1.4, help="angle of friction after large strains")
    cohesion: float = quantity("Pa", 0.0, ge=0, le=1e9, help="cohesion after large strains")
    shear_strain: float = quantity(
        "", ge=1e-4, le=100, help="plastic shear strain at which 1/e of the difference is left"
    )
    band_width: float = quantity("m", ge=1e-6, le=100, help="width of the soil's shear bands, some ten grains")

    def faults(self, soil: Any) -> list[Fault]:
        """What is wrong with it in a ``soil``."""
        found = []
        for key, unit in (("friction_angle", "rad"), ("cohesion", "Pa")):
            left, first = getattr(self, key), getattr(soil, key)
            if left > first:
                found.append(Fault(f"soil.softening.{key}", left, "is more than before", unit, f"<= {first:g}"))
        if self.friction_angle == soil.friction_angle and self.cohesion == soil.cohesion and not soil.dilatancy_angle:
            repair = 'soil.strength = "peak" takes that of a material file'
            problem = "is that before: nothing softens"
            found.append(Fault("soil.softening.friction_angle", self.friction_angle, problem, "rad", repair=repair))
        for key, there in (("elastic", soil.elastic), ("held", soil.held)):
            if there:
                found.append(Fault(f"soil.{key}", True, "leaves nothing that soil.softening could weaken",
                                   repair="take out [soil.softening]"))  # fmt: skip
        return found
