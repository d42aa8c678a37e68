"""The section of rate: friction that grows with the rate of shear."""

from typing import Any

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class RateSection(Section):
    """Friction of grains that are sheared fast, of Jop, Forterre & Pouliquen 2006: see `continuum_sph.soil.material`.

    sin φ(I) = sin φ + (sin φ∞ - sin φ) I/(I0 + I), I = γ' d √(ρs/p), γ' the difference of the principal rates of strain
    in the plane, p the mean stress there, ρs the density of the grains.  friction_angle : φ∞;  inertial_number : I0;
    grain_diameter : d.  Glass beads have 32.8 degrees and 0.279, beyond 20.9 at rest.  A material file of
    `porescale homogenise` with rates has all three.
    """

    friction_angle: float = quantity("rad", ge=0, le=1.4, help="angle of friction of the fastest flow")
    inertial_number: float = quantity("", ge=1e-4, le=100, help="I at which half of the growth is there")
    grain_diameter: float = quantity("m", ge=1e-7, le=10, help="diameter of the grains")

    def faults(self, soil: Any) -> list[Fault]:
        """What is wrong with it in a ``soil``."""
        found = []
        slow = (soil.softening or soil).friction_angle
        if self.friction_angle < slow:
            found.append(Fault("soil.rate.friction_angle", self.friction_angle, "is less than that at rest", "rad",
                               f">= {slow:g}"))  # fmt: skip
        for key, there in (("elastic", soil.elastic), ("held", soil.held)):
            if there:
                found.append(Fault(f"soil.{key}", True, "leaves nothing that soil.rate could slow",
                                   repair="take out [soil.rate]"))  # fmt: skip
        return found
