"""One relaxation time for everything (Bhatnagar, Gross & Krook 1954; Qian, d'Humieres & Lallemand 1992).

The textbook's operator, kept for comparison: walls move with the viscosity (magic parameter (tau - 1/2)²), and it is
the first to become unstable as tau goes to 1/2.
"""

from typing import NamedTuple

import numpy as np

from porescale.lbm.collision.entry import Operator, Stability
from porescale.lbm.collision.law import (
    collide,
    collide_partial,
    half_force,
    half_of_force,
    molecular_rate,
    shear_rate,
)
from porescale.lbm.collision.smagorinsky import eddy_version
from porescale.lbm.collision.trt import relax_halves, relax_partial


class Bgk(NamedTuple):
    """rate : 1/tau;  fx, fy : body force density."""

    rate: np.floating
    fx: np.floating
    fy: np.floating


EddyBgk = eddy_version(Bgk)
half_force.of(Bgk, EddyBgk)(half_of_force)
shear_rate.of(Bgk)(molecular_rate)


@collide.of(Bgk, EddyBgk)
def _collide(f, m, rate, law):
    """BGK collision: both halves of the populations relax with the same rate."""
    return relax_halves(f, m, rate, rate, law)


@collide_partial.of(Bgk, EddyBgk)
def _collide_partial(f, m, rate, part, law):
    """Partial BGK collision: both halves of the populations relax with the same rate."""
    return relax_partial(f, m, rate, rate, part, law)


OPERATOR = Operator(
    name="bgk",
    purpose="one relaxation time: the textbook's, for comparison",
    law=Bgk,
    eddy_law=EddyBgk,
    third_order_rate=lambda law: float(law.rate),
    holds=Stability(100.0, 5100.0, 8.0, 8.0),
    order=3,
)
