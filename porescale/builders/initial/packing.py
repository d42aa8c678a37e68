"""Radii of a packing, and packings that are pressed together."""

from dataclasses import replace

import numpy as np

from porescale.common.core.errors import InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.grading import graded_radii, lognormal_radii
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.prepare.compaction import Compactor, Compressed, kept
from porescale.scene.packing import Packing


def radii_of(packing: Packing) -> Floats | None:
    """Radii (n,) m of a packing with a grading, lognormal sizes or compression; None for the plain one, drawn later."""
    area = packing.packing_fraction * packing.width * packing.height
    if packing.grading:
        return graded_radii(packing.grading, area)
    if packing.log_spread is not None:
        per_grain = np.pi / 4.0 * packing.diameter**2
        relative = lognormal_radii(1000, 1.0, packing.log_spread)
        count = max(1, round(area / (per_grain * 4.0 * float(np.mean(relative**2)))))
        return lognormal_radii(count, packing.diameter, packing.log_spread)
    if packing.compress:
        spread = packing.size_spread
        count = max(1, round(area / (np.pi / 4.0 * packing.diameter**2 * (1.0 + spread**2 / 3.0))))
        even = (np.arange(count) + 0.5) / count
        return np.asarray(0.5 * packing.diameter * (1.0 + spread * (2.0 * even - 1.0)))
    return None


def compressed(packing: Packing, density: float, periodic: tuple[bool, bool], law: ContactLaw) -> Compressed:
    """The packing pressed to its pressure or fraction; density: of the grains, kg/m³;  periodic: the sides of its
    rectangle.  Keys of faults are those of the scene."""
    assert isinstance(law, Linear)  # check_compressed has made sure
    radius = radii_of(packing)
    assert radius is not None
    box = (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height)
    press = Compactor(*box, law, periodic, packing.settling_friction, density, packing.seed)
    try:
        return kept(press, radius, packing.pressure)
    except InputError as error:
        raise InputError([replace(fault, key=f"grains.packing.{fault.key}") for fault in error.faults]) from None
