"""[homogenise]: the soil that the packing makes."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity

LEAST = 4
"""Rates through which a law of three numbers is laid."""


class Homogenise(Section):
    """How `porescale homogenise` measures the soil that the packing makes; runs of the scene do without it.

    pressure : left out, that of the packing, else what the weight of half its height makes.
    rates : left out, no test is sheared at other rates, and the material has no [rate].  Of γ̇ d √(ρs/p), while
    inertial_number is ε̇ √(m/p) of a test that is slow: 2.26 times that number in the terms of rates.
    """

    pressure: float | None = quantity("Pa", None, gt=0, le=1e12, help="mean stress at which the soil is measured")
    grains: int = pydantic.Field(800, ge=100, le=100_000, description="grains in a specimen")
    aspect_ratio: float = quantity("", 1.0, ge=0.25, le=4, help="height of a specimen over its width")
    packings: int = pydantic.Field(6, ge=2, le=1000, description="specimens, from the packing's seed on")
    strain: float = quantity("", 0.24, ge=0.03, le=1, help="logarithmic axial strain of a test")
    inertial_number: float = quantity("", 1e-3, ge=1e-6, le=1e-2, help="rate of a test, quasi-static to 1e-3")
    cells: int = pydantic.Field(12, ge=4, le=100, description="cells per hydraulic diameter of the flow")
    rates: tuple[float, ...] = quantity(
        "", (), ge=1e-3, le=1, help="inertial numbers at which friction is measured in shear"
    )
    ratio_error: float = quantity("", 0.01, ge=0, le=0.5, help="most that grains.hydraulic_radius_ratio may be off by")

    def _faults(self) -> list[Fault]:
        if self.rates and len({f"{rate:g}" for rate in self.rates}) < max(LEAST, len(self.rates)):
            problem, repair = f"are fewer than {LEAST} or not all different", "such as [0.01, 0.03, 0.1, 0.3]"
            return [Fault("rates", list(self.rates), problem, "", f"{LEAST} or more from 0.001 to 1", repair)]
        return []
