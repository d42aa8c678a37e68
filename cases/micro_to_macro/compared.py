"""One quantity at both scales: what is known of each, and whether the difference lies within that."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from porescale import Floats

LEVEL = 0.95
HEAD = ["quantity", "grains", "continuum", "angle or K", "spacing", "difference", "bar", "inside"]


def half(values: Sequence[float] | Floats) -> float:
    """Half of Student's interval of the mean of ``values`` (n,) at LEVEL; nan of fewer than three."""
    if len(values) < 3:
        return math.nan
    return half_of(float(np.std(values, ddof=1)) / math.sqrt(len(values)), len(values))


def half_of(error: float, count: int) -> float:
    """The same of a standard error of the mean of ``count`` values."""
    return float(stats.t.ppf(0.5 + 0.5 * LEVEL, count - 1)) * error


def power(x: Floats, y: Floats, at: Floats) -> tuple[Floats, float]:
    """y where x is ``at`` (n,), of the straight line through ln y (m,) over x; and half of the interval at LEVEL of the
    mean of ln y there, which is that of y, relative."""
    line = stats.linregress(x, np.log(y))
    fitted = line.intercept + line.slope * x
    off = math.sqrt(float(np.sum((np.log(y) - fitted) ** 2)) / (len(x) - 2))
    far = (float(np.mean(at)) - x.mean()) ** 2 / float(np.sum((x - x.mean()) ** 2))
    error = off * math.sqrt(1.0 / len(x) + far)
    return np.exp(line.intercept + line.slope * at), float(stats.t.ppf(0.5 + 0.5 * LEVEL, len(x) - 2)) * error


@dataclass(frozen=True)
class Compared:
    """A quantity.  name, unit;  grains : (n,) one for each packing;  rows : (s,) particles over the depth of the soil,
    few to many;  soil : (s,) of them;  given : half of the interval that the material's own leaves to the soil."""

    name: str
    unit: str
    grains: Floats
    rows: Sequence[int]
    soil: Floats
    given: float = 0.0

    @property
    def spacing(self) -> float:
        """What the spacing still leaves to the finest soil, if its error is of first order: Richardson's."""
        if len(self.soil) < 2:
            return math.nan
        return abs(float(self.soil[-1] - self.soil[-2])) / (self.rows[-1] / self.rows[-2] - 1.0)

    @property
    def difference(self) -> float:
        """The finest soil less the mean of the packings."""
        return float(self.soil[-1] - np.mean(self.grains))

    @property
    def bar(self) -> float:
        """Half of the interval of the difference, of packings, material and spacing, which are independent."""
        return math.sqrt(half(self.grains) ** 2 + self.given**2 + self.spacing**2)

    @property
    def inside(self) -> bool:
        """Whether both scales agree as far as is known; False where a bar is none."""
        return abs(self.difference) <= self.bar

    def cells(self) -> list[str]:
        """A row of the table with HEAD."""
        size = abs(float(np.mean(self.grains)))
        digits = max(0, 3 - math.floor(math.log10(size))) if size > 0.0 else 3

        def text(value: float) -> str:
            """A number with the digits of this quantity."""
            return f"{value:.{digits}f}" if math.isfinite(value) else "–"

        return [
            f"{self.name}, {self.unit}".removesuffix(", "),
            f"{text(float(np.mean(self.grains)))} ± {text(half(self.grains))}",
            ", ".join(text(it) for it in self.soil),
            f"± {text(self.given)}", f"± {text(self.spacing)}", text(self.difference),
            f"± {text(self.bar)}", "yes" if self.inside else "no",
        ]  # fmt: skip
