"""Heaps that sleep under water: what a current and a grain that sinks do to them, and what sleep makes of a collapse.

In lattice units.  A contact step is a fluid step, so that the forces which judge a sleeper can be taken from outside.
"""

from dataclasses import dataclass

import numpy as np

from porescale.common.core.types import Reals
from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.step import Coupled
from porescale.dem.measures.contacts import contacts
from porescale.dem.resting.sleep import Sleep
from porescale.validation.coupling.setups import immersed

RADIUS, DENSITY = 3.7, 2.5
WEIGHT = (0.0, -2e-4)
"""Acceleration, cells per step²."""
SHARE = 0.05
AFTER = 300.0
"""Steps for which a disc rests before it sleeps: some twenty oscillations."""
RESTED = 6000
"""Steps until all sleep."""
LOOK = 20
"""Steps between checks for grains out of balance."""
CURRENT = 0.1
"""Speed of the water above the heap when it begins to flow, cells per step."""


def let_sleep(coupled: Coupled, share: float = SHARE, after: float | None = AFTER) -> Coupled:
    """The same whose discs may sleep; share of their weight less lift;  after : steps, see `Sleep`."""
    grains = coupled.grains
    grains.sleep = Sleep(grains, np.hypot(coupled.weight[:, 0], coupled.weight[:, 1]), share, after)
    return coupled


def bed(sinks: bool) -> Coupled:
    """Two rows of six discs that fill a channel's floor, periodic along it;  sinks : another begins to sink above."""
    pitch, rise = 2.0 * RADIUS + 0.6, RADIUS * 1.75
    lower = [((k + 0.5) * pitch, RADIUS + 0.05) for k in range(6)]
    upper = [((k + 1.0) * pitch, RADIUS + rise) for k in range(6)]
    place = [*lower, *upper, *([(3.1 * pitch, 9.0 * RADIUS)] if sinks else [])]
    coupled = immersed(
        (round(6 * pitch), 44), place, RADIUS, DENSITY, sides=("periodic", "wall"), acceleration=WEIGHT, ratio=0.8,
    )  # fmt: skip
    coupled.contact_steps = 1
    return coupled


@dataclass(frozen=True)
class Disturbed:
    """imbalance : largest force a sleeper was out of balance by, over its weight;  asleep : how many slept before, and
    the fewest after;  coupled."""

    imbalance: float
    asleep: tuple[int, int]
    coupled: Coupled


def disturbed(sinks: bool, share: float = SHARE, steps: int = 5000, deaf: bool = False) -> Disturbed:
    """A sleeping bed, which a grain falls upon, or a current that begins to flow, wakes.

    A grain is let go when the others sleep.  The force on a sleeper is the sum over the list of all contacts before a
    step, and the load of that step.  deaf : sleepers do not wake, for the sake of comparison.
    """
    coupled = let_sleep(bed(sinks), share)
    grains, weight = coupled.grains, np.hypot(coupled.weight[:, 0], coupled.weight[:, 1])
    last = grains.discs.count - 1
    if sinks:
        grains.hold(last)
    for _ in range(RESTED):
        coupled.advance()
    sleep = grains.sleep
    assert sleep
    before, fewest, worst = sleep.count, sleep.count, 0.0
    if deaf:
        sleep.allowed[sleep.asleep == 1] = np.inf
    if sinks:
        grains.hold(last, False, False, False)
    else:
        above = round(4.5 * RADIUS)
        assert coupled.fluid.step % 2 == 0  # slots are where they are named
        coupled.fluid.populations[1, above:-1, 1:-1] += 0.5 * CURRENT
        coupled.fluid.populations[3, above:-1, 1:-1] -= 0.5 * CURRENT
    for step in range(steps):
        watched = step % LOOK == 0
        if watched:
            force, _ = contacts(grains).resultants(grains.discs.count)
        coupled.advance()
        if watched:
            out = np.hypot(*(force + coupled.force).T) / weight
            worst = max(worst, float(out[sleep.asleep == 1].max(initial=0.0)))
            fewest = min(fewest, sleep.count)
    return Disturbed(worst, (before, fewest), coupled)


COLUMN = (4, 7)
SMALL = 2.5
"""Radius of the discs of the column, cells."""


def collapsed(share: float | None = None, nudge: float = 0.0, steps: int = 8000) -> Reals:
    """A column of 28 discs at a wall, let go under water: (run-out, mean height) of what lies in the end, in radii.

    share : of their weight by which sleepers may be out of balance; None: no grain sleeps.  nudge : cells, of one disc.
    """
    rng = np.random.default_rng(2)
    across, high = COLUMN
    x, y = np.meshgrid((np.arange(across) + 0.5), (np.arange(high) + 0.5))
    place = 2.0 * SMALL * np.column_stack((x.ravel(), y.ravel()))
    place[:, 0] += SMALL * rng.uniform(0.0, 0.4, len(place))
    place[0, 1] += nudge
    coupled = immersed(
        (80, 42), place, SMALL * rng.uniform(0.8, 1.0, len(place)), DENSITY, acceleration=WEIGHT, ratio=0.8
    )  # fmt: skip
    if share is not None:
        let_sleep(coupled, share)
    for _ in range(steps):
        coupled.advance()
    x, y = coupled.grains.discs.position.T / SMALL
    return np.array([np.quantile(x, 0.9), y.mean()])


VALIDATIONS = Validations()


@VALIDATIONS.row(
    "coupling.sleepers_under_water_are_in_balance",
    source="sum of all contacts, of the load of the water and the weight of every sleeper; 5 % of it are allowed",
    because="round-off: force and list are of the same positions and springs, summed in another order",
    tolerance=SHARE * (1.0 + 1e-6),
    slow=True,
)
def balance() -> Measured:
    """Largest force that a sleeper is out of balance by, over its weight: a current sets in; a grain sinks on them."""
    return Measured.absolute([0.0, 0.0], [disturbed(sinks).imbalance for sinks in (False, True)])


def off(share: float) -> Measured:
    """Run-out and mean height, in radii, of a column that collapses under water, with sleep and without."""
    return Measured.absolute(collapsed(), collapsed(share))


@VALIDATIONS.row(
    "coupling.sleep_leaves_a_collapse_under_water",
    source="the same column without sleep",
    because="a disc on another, 2 r between centres, is out of balance by a share of its weight at 2 share r from where"
    " it balances: each may stop so far off, 0.1 r",
    tolerance=2.0 * SHARE,
    slow=True,
)
def collapse() -> Measured:
    """Run-out and mean height, in radii, of 28 discs that fall over under water, asleep where they came to rest."""
    return off(SHARE)
