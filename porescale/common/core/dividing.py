"""A spacing of which several lengths are whole multiples."""

from __future__ import annotations

import math
from collections.abc import Sequence

FACTOR = 2.0
"""Furthest that a spacing lies from the one that was given: beyond it a run costs too much, or resolves too little."""
MOST = 20_000
"""Spacings along a length up to which one is looked for: no more than a tenth of a second."""


def dividing(lengths: Sequence[float], spacing: float, slack: float) -> float | None:
    """The spacing nearest to ``spacing`` of which all ``lengths`` (> 0) are whole multiples, within FACTOR of it.

    slack : of a share of them that counts as whole, relative.  None where there is none, or a length has more than
    MOST.
    """
    first = lengths[0] / spacing
    if not first <= MOST:
        return None
    counts = range(max(1, math.ceil(first / FACTOR)), math.floor(FACTOR * first) + 1)
    for count in sorted(counts, key=lambda it: abs(math.log(it / first))):
        found = lengths[0] / count
        shares = [length / found for length in lengths]
        if all(it > 0.5 and abs(it - round(it)) <= slack * max(1.0, it) for it in shares):
            return found
    return None
