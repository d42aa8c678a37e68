"""One relaxation time for everything (Bhatnagar, Gross & Krook 1954; Qian, d'Humieres & Lallemand 1992).

The textbook's operator, kept for comparison: walls move with the viscosity (magic parameter (tau - 1/2)²), and it is
the first to become unstable as tau goes to 1/2.
"""

from typing import NamedTuple

import numpy as np

from porescale.lbm.collision.law import collide, collide_in_shares, half_force, half_of_force, shear_rate
from porescale.lbm.collision.smagorinsky import eddy_version
from porescale.lbm.collision.trt import relax_halves, relax_shares


class Bgk(NamedTuple):
    """rate : 1/tau;  fx, fy : body force density."""

    rate: np.floating
    fx: np.floating
    fy: np.floating


EddyBgk = eddy_version(Bgk)
half_force.of(Bgk, EddyBgk)(half_of_force)


@shear_rate.of(Bgk)
def _molecular(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, law):
    """Rate of the molecular viscosity, the same everywhere."""
    return law.rate


@collide.of(Bgk, EddyBgk)
def _collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law):
    """Both halves relax with the same rate."""
    return relax_halves(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, rate, law)


@collide_in_shares.of(Bgk, EddyBgk)
def _collide_in_shares(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, even, odd, kept, px, py, law,
):  # fmt: skip
    """Both halves at the same rate."""
    return relax_shares(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, rate, even, odd, kept, px, py, law
    )  # fmt: skip
