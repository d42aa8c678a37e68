"""What a mean of few values is worth: Student's and the bootstrap's interval, and how many of a correlated series are
independent."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from porescale.common.core.types import Floats

LEVEL = 0.95
"""Share of intervals that hold the true mean."""
LEAST = 3
"""Values without which there is no interval: that of two is 12.7 standard errors wide each way, and says nothing."""
EPS = float(np.finfo(float).eps)
"""Twice what an operation rounds by at most, as a share."""
RESAMPLES = 9999
"""Of a bootstrap: its ends scatter by about a hundredth of the interval."""
REACH = 5.0
"""Correlation times over which correlations are summed (Sokal 1997, Monte Carlo methods in statistical mechanics)."""


def equal(values: Sequence[float] | Floats) -> bool:
    """Whether ``values`` (n,), n >= 1, differ by rounding alone: by 4 eps of the largest.

    An operation rounds by at most eps/2 of its result: what four of them make of the same number lies within 2 eps of
    it, and two such lie within 4 eps of each other.
    """
    least, most = float(np.min(values)), float(np.max(values))
    return math.isfinite(most - least) and most - least <= 4.0 * EPS * max(abs(least), abs(most))


def deviation(values: Sequence[float] | Floats) -> float:
    """Standard deviation of a single one of ``values`` (n,), n - 1; 0 of equal ones, nan below two.

    The mean of equal values is itself rounded, and so none of them: three times 0.1 would have 1.7e-17.
    """
    if len(values) < 2:
        return math.nan
    return 0.0 if equal(values) else float(np.std(values, ddof=1))


def student(count: float) -> float:
    """Half of Student's interval in standard errors of a mean of ``count`` independent values."""
    from scipy.special import stdtrit

    return float(stdtrit(count - 1.0, 0.5 + 0.5 * LEVEL))


def half_width(values: Sequence[float] | Floats) -> float:
    """Half of Student's interval of the mean of independent ``values`` (n,), in their unit; nan below LEAST values."""
    count = len(values)
    if count < LEAST:
        return math.nan
    return student(count) * deviation(values) / math.sqrt(count)


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


def jackknife(of: Callable[[list[int]], Floats], count: int) -> Floats:
    """Values (count, m) whose mean is ``of`` all of ``count`` samples, m numbers that are no means of one each, and
    whose standard error is the jackknife's (Tukey 1958, Ann. Math. Stat. 29, 614).

    of : the numbers (m,) of the samples of some places.  About what it gives of all: n of all less n - 1 of all but
    one, less their mean.  nan where one of these is; of one sample, its own numbers.
    """
    whole = list(range(count))
    every = of(whole)
    if count < 2:
        return every[None, :]
    without = np.array([of([j for j in whole if j != k]) for k in whole])
    found: Floats = every - (count - 1) * (without - without.mean(axis=0))
    return found


def needed(values: Sequence[float], width: float) -> float:
    """How many values of this deviation have an interval of ``width`` on each side; inf beyond a million."""
    counts, half = _intervals()
    short = half * deviation(values) > width * np.sqrt(counts)
    return math.inf if short.all() else int(counts[int(np.argmin(short))])


@cache
def _intervals() -> tuple[Floats, Floats]:
    """Counts (k,) 2 % apart, from LEAST to a million, and `student` of each."""
    counts = [LEAST]
    while (more := max(counts[-1] + 1, round(1.02 * counts[-1]))) <= 1e6:
        counts.append(more)
    return np.array(counts, float), np.array([student(count) for count in counts])


@lru_cache(maxsize=4096)
def bootstrap(values: tuple[float, ...], resamples: int = RESAMPLES) -> tuple[float, float]:
    """Ends of the bootstrap's interval of the mean of independent ``values``, in their unit; nan below LEAST values.

    Bias-corrected and accelerated (Efron 1987, J. Am. Stat. Assoc. 82, 171), by a fixed generator from the values in
    ascending order: the same ends for the same values, in whatever order they came.  It assumes no distribution, and is
    too narrow where values are few: of 5, 10, 20 normal ones it holds the mean in 85, 90, 93 of 100 cases.
    """
    if len(values) < LEAST:
        return math.nan, math.nan
    drawn = np.sort(np.asarray(values, float))
    if equal(drawn):
        return float(drawn[0]), float(drawn[0])
    from scipy import stats

    found = stats.bootstrap(
        (drawn,), np.mean, n_resamples=resamples, confidence_level=LEVEL, method="BCa", rng=np.random.default_rng(0)
    ).confidence_interval
    return float(found.low), float(found.high)


@dataclass(frozen=True)
class Sample:
    """Independent values of one quantity, such as those of several packings.  values : one for each, in its unit."""

    values: tuple[float, ...]

    @property
    def mean(self) -> float:
        """Mean of the values, of equal ones the smallest; nan where there are none."""
        if not self.values:
            return math.nan
        return float(min(self.values) if equal(self.values) else np.mean(self.values))

    @property
    def deviation(self) -> float:
        """Standard deviation of a single value (n - 1); nan below two."""
        return deviation(self.values)

    @property
    def error(self) -> float:
        """Standard error of the mean; nan below two values."""
        return self.deviation / math.sqrt(len(self.values)) if self.values else math.nan

    @property
    def half(self) -> float:
        """Half of Student's interval of the mean at LEVEL; nan below LEAST values."""
        return half_width(self.values)
