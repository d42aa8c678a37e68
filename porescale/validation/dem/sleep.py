"""Validations of sleep: what is left out is in balance, and heaps come to lie as they do without it."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.dem import sleep_trials as lab

VALIDATIONS = Validations()

NUDGES = 6
STUDENT = 4.4
"""Standard deviations: of six runs, one more lies within with 99 % (Student's t of 5 degrees, 4.03, times √(7/6))."""


@VALIDATIONS.row(
    "dem.sleepers_are_in_balance",
    source="sum of all contacts and the weight of every sleeper, from the list of contacts; 5 % of it are allowed",
    because="round-off: force and list are of the same positions and springs, summed in another order",
    tolerance=lab.SHARE * (1.0 + 1e-6),
)
def balance() -> Measured:
    """Largest force that a sleeper is out of balance by, over its weight: a heap struck by a disc that falls on it."""
    found = lab.struck()
    return Measured(0.0, found.imbalance, found.imbalance)


def off(share: float) -> Measured:
    """Distance in standard deviations of collapses that differ by a last digit of one disc's place."""
    runs = np.array([lab.collapsed(nudge=k * 1e-12) for k in range(NUDGES)])
    found, mean = lab.collapsed(share), runs.mean(axis=0)
    return Measured(mean.tolist(), found.tolist(), float(np.abs((found - mean) / runs.std(axis=0, ddof=1)).max()))


@VALIDATIONS.row(
    "dem.sleep_leaves_the_run_out",
    source="the same column without sleep, six times, one disc 0 to 5 pm out of place",
    because="what a last digit changes: 4.4 standard deviations hold 99 % (Student)",
    tolerance=STUDENT,
    slow=True,
)
def run_out() -> Measured:
    """Run-out and mean height, in radii, of a column of 54 discs that falls over, asleep where it has come to rest."""
    return off(lab.SHARE)
