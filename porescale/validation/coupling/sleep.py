"""Validations of sleep under water: sleepers are in balance with the water too, and a collapse ends as without it."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.coupling import sleep_trials as lab

VALIDATIONS = Validations()


@VALIDATIONS.row(
    "coupling.sleepers_under_water_are_in_balance",
    source="sum of all contacts, of the load of the water and the weight of every sleeper; 5 % of it are allowed",
    because="round-off: force and list are of the same positions and springs, summed in another order",
    tolerance=lab.SHARE * (1.0 + 1e-6),
    slow=True,
)
def balance() -> Measured:
    """Largest force that a sleeper is out of balance by, over its weight: a current sets in; a grain sinks on them."""
    found = [lab.disturbed(sinks).imbalance for sinks in (False, True)]
    return Measured([0.0, 0.0], found, max(found))


def off(share: float) -> Measured:
    """Run-out and mean height, in radii, of a column that collapses under water, with sleep and without."""
    reference, found = lab.collapsed(), lab.collapsed(share)
    return Measured(reference.tolist(), found.tolist(), float(np.abs(found - reference).max()))


@VALIDATIONS.row(
    "coupling.sleep_leaves_a_collapse_under_water",
    source="the same column without sleep",
    because="a disc on another, 2 r between centres, is out of balance by a share of its weight at 2 share r from where"
    " it balances: each may stop so far off, 0.1 r",
    tolerance=2.0 * lab.SHARE,
    slow=True,
)
def collapse() -> Measured:
    """Run-out and mean height, in radii, of 28 discs that fall over under water, asleep where they came to rest."""
    return off(lab.SHARE)
