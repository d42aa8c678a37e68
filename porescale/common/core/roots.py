"""The root of a function of one number, by Brent's method.

SciPy's `brentq`, step by step and bit by bit, for what a check of a scene needs: SciPy's takes longer to import than
all the rest of a check.  Source: Brent 1973, Algorithms for Minimization without Derivatives, chapter 4.
"""

import math
from collections.abc import Callable


def brent(function: Callable[[float], float], low: float, high: float, *, xtol: float, rtol: float) -> float:
    """Where ``function`` is zero between ``low`` and ``high``, at which its signs must differ.

    xtol, rtol : the root is within xtol + rtol |root|.
    """
    before, here = low, high
    f_before, f_here = function(before), function(here)
    if f_before == 0.0 or f_here == 0.0:
        return before if f_before == 0.0 else here
    assert (f_before < 0.0) != (f_here < 0.0), "no change of sign"
    opposite, f_opposite, last, step = 0.0, 0.0, 0.0, 0.0
    while True:
        if f_before != 0.0 and f_here != 0.0 and math.copysign(1.0, f_before) != math.copysign(1.0, f_here):
            opposite, f_opposite = before, f_before
            last = step = here - before
        if abs(f_opposite) < abs(f_here):
            before, here, opposite = here, opposite, here
            f_before, f_here, f_opposite = f_here, f_opposite, f_here
        within = (xtol + rtol * abs(here)) / 2.0
        half = (opposite - here) / 2.0
        if f_here == 0.0 or abs(half) < within:
            return here
        guess = math.inf
        if abs(last) > within and abs(f_here) < abs(f_before):
            if before == opposite:
                guess = -f_here * (here - before) / (f_here - f_before)
            else:
                slope = (f_before - f_here) / (before - here)
                other = (f_opposite - f_here) / (opposite - here)
                guess = -f_here * (f_opposite * other - f_before * slope) / (other * slope * (f_opposite - f_before))
        short = 2.0 * abs(guess) < min(abs(last), 3.0 * abs(half) - within)
        last, step = (step, guess) if short else (half, half)
        before, f_before = here, f_here
        here += step if abs(step) > within else math.copysign(within, half)
        f_here = function(here)
