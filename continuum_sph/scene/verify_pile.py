"""Validation of the heave behind a sheet pile."""

from __future__ import annotations

import functools

from continuum_sph.scene.trials_pile import Heave
from porescale.workbench.validations import Measured, Validations

VALIDATIONS = Validations()

BOUNDS = {0.25: (2.85, 3.18), 0.5: (2.93, 3.34), 0.75: (3.18, 3.76)}
"""h/(i_c s) of Terzaghi's prism, s/2 wide and without friction, and of the exit gradient at the pile, by s/T."""
QUICK = Heave(rows=12, reach=1.0, cover=0.17, modulus=5e5, permeability=3e-2, first=2.7, rate=0.7, calm=0.4)


@functools.cache
def onset(given: Heave = QUICK) -> float:
    """h/(i_c s) at which heave begins."""
    return given.onset()


@VALIDATIONS.row(
    "continuum.heave_behind_pile",
    source="Terzaghi 1943: prism s/2 wide behind the pile; exit gradient by conformal mapping (Harr 1962); s/T = 0.5",
    because="heave begins between the two, whose distance is twice this; it has begun when the prism's surface has "
    "risen four times as much as soil without weight swells, i_c ρ g s²/2M",
    tolerance=0.5 * (BOUNDS[0.5][1] - BOUNDS[0.5][0]),
    slow=True,
)
def heave_row() -> Measured:
    """Head over i_c s at which the ground behind a pile to half its depth begins to rise, 12 particles over T."""
    low, high = BOUNDS[QUICK.share]
    found = onset()
    return Measured(0.5 * (low + high), found, abs(found - 0.5 * (low + high)))
