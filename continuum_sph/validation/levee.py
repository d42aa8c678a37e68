"""Validation of the levee: what its stiffness does to when its parts go."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np

from continuum_sph.validation.levee_trials import PARTS, Levee
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

QUICK = Levee(rows=8, end=1.4)
STIFFER = 4.0
"""Times as stiff as the other."""


@functools.cache
def gone(given: Levee = QUICK) -> tuple[float, ...]:
    """When (s) toe, middle and crest have moved."""
    times = given.times(np.array([row for row, _ in given.course()]))
    return tuple(times[name] for name in PARTS)


@VALIDATIONS.row(
    "continuum.levee_stiffness",
    source="Maeda & Sakai 2004, fig. 15: E is a numerical choice, and the course of the failure does not hang on it",
    because="between 0.5 and 2 MPa: soil strains by γ'H²/M before it yields, 0.014 or 0.004 of H, at 0.7 m/s a "
    "difference of 0.015 s; what was braked until the river rose starts with 0.09 or 0.05 m/s, 0.02 m in 0.5 s, "
    "0.03 s; displacements are read every 0.02 s and lines drawn between: 0.05 s",
    tolerance=0.05,
    slow=True,
)
def stiffness_row() -> Measured:
    """When toe, middle and crest of levees of E 0.5 and 2 MPa go, s, the largest difference; 8 particles over H."""
    soft, stiff = gone(), gone(replace(QUICK, stiffness=STIFFER * QUICK.stiffness))
    return Measured(list(soft), list(stiff), max(abs(one - other) for one, other in zip(soft, stiff, strict=True)))
