"""The same bits from one loop over pairs and from many threads."""

import math

import numpy as np

from porescale.common.compiled.jit import set_threads, threads
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces import threads as sweep
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.validation.dem.setups import DENSITY, RADIUS, STIFFNESS, TANGENTIAL

VALIDATIONS = Validations()


def dense_block(law: ContactLaw, energy: bool, seed: int = 2) -> Grains:
    """Just enough discs for threads, pressed together, moving, spinning and numbered at random."""
    rng = np.random.default_rng(seed)
    side = math.ceil(math.sqrt(sweep.SERIAL_BELOW + 1))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    grid = rng.permutation(grid)
    apart = 1.96 * RADIUS
    size = len(grid)
    discs = make_discs(
        (grid + 0.5) * apart, RADIUS * rng.uniform(0.9, 1.05, size), DENSITY, rng.normal(0.0, 0.5, (size, 2)),
        rng.normal(0.0, 20.0, size),
    )  # fmt: skip
    return Grains(discs, law, Box((0.0, 0.0), (side * apart, side * apart)), energy=energy)


def difference_of_sweeps(law: ContactLaw, steps: int = 60) -> int:
    """Numbers of the state that differ between the single loop, on one thread, and the sweep over blocks, on all, after
    ``steps``.
    """
    one, other, before = dense_block(law, False), dense_block(law, True), threads()
    for grains, count in ((one, 1), (other, None)):
        set_threads(count)
        grains.step(grains.stable_step(), count=steps)
    set_threads(before)
    pairs = [
        (getattr(one.discs, name), getattr(other.discs, name)) for name in ("position", "velocity", "spin", "force")
    ]
    pairs += [(one.wall_force, other.wall_force), (one.wall_spring, other.wall_spring)]
    pairs += [(one.pairs.carried, other.pairs.carried)]
    return sum(int(np.count_nonzero(a != b)) for a, b in pairs)


@VALIDATIONS.row(
    "dem.threads_give_the_same_bits",
    source="sums in one order whoever takes them, see sweep.py",
    because="bits",
    tolerance=0.0,
    slow=True,
)
def same_bits() -> Measured:
    """Numbers of a state of 2e4 discs, numbered at random, that differ between one loop and the sweep over blocks."""
    differ = difference_of_sweeps(Linear(STIFFNESS, 1e3, **TANGENTIAL, tangential_damping=300.0))
    return Measured.absolute(0.0, float(differ))
