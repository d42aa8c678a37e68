"""What a mean of few values is worth: Student's interval, and how many of a correlated series are independent."""

import math
from collections.abc import Sequence

import numpy as np

from porescale.common.core.types import Floats

LEVEL = 0.95
"""Share of intervals that hold the true mean."""
LEAST = 3
"""Values without which there is no interval: that of two is 12.7 standard errors wide each way, and says nothing."""
REACH = 5.0
"""Correlation times over which correlations are summed (Sokal 1997, Monte Carlo methods in statistical mechanics)."""


def student(count: float, level: float = LEVEL) -> float:
    """Half of Student's interval in standard errors of a mean of ``count`` independent values."""
    from scipy.special import stdtrit

    return float(stdtrit(count - 1.0, 0.5 + 0.5 * level))


def half_width(values: Sequence[float] | Floats, level: float = LEVEL) -> float:
    """Half of Student's interval of the mean of independent ``values`` (n,), in their unit; nan below LEAST values."""
    count = len(values)
    if count < LEAST:
        return math.nan
    return student(count, level) * float(np.std(values, ddof=1)) / math.sqrt(count)


def independent(values: Floats) -> float:
    """How many independent values tell as much of the mean as the evenly spaced series ``values`` (n,), n >= 2.

    n over 1 + 2 Σ ρ_k = 2 τ, correlations summed to the first k of REACH times τ, 1 to n.  Too many where they are few:
    with its mean a series loses its slowest swings, so that 5 are found as 7 to 18 and 10 as 11 to 26 (of first order,
    in two series of three).
    """
    count = len(values)
    swing = values - values.mean()
    power = np.abs(np.fft.rfft(swing, 2 * count)) ** 2  # padded: no correlation around the end
    correlation = np.fft.irfft(power)[:count]
    if not correlation[0] > 0.0:
        return float(count)
    times = 2.0 * np.cumsum(correlation / correlation[0]) - 1.0
    enough = np.arange(count) >= 0.5 * REACH * times
    time = float(times[int(np.argmax(enough))]) if enough.any() else float(count)
    return count / min(max(time, 1.0), float(count))


def needed(values: Sequence[float], width: float) -> float:
    """How many values of this deviation have an interval of ``width`` on each side; inf beyond a million."""
    deviation, count = float(np.std(values, ddof=1)), LEAST
    while student(count) * deviation > width * math.sqrt(count):
        count = max(count + 1, round(1.02 * count))
        if count > 1e6:
            return math.inf
    return count
