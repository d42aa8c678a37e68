"""What is to be doubted of a run that has ended."""

from collections.abc import Mapping

import numpy as np

from porescale.common.core.types import AnyArray
from porescale.coupling.limits import DENSITY


def density_doubt(series: Mapping[str, AnyArray]) -> str:
    """A warning where the fluid's density went further from that at rest than `DENSITY`, from where on its equation of
    state misleads; "" where not, and without fluid.

    series : columns of series.csv.  What lasts less than its interval may lie between the rows.
    """
    lowest, highest = series.get("lowest relative density ()"), series.get("highest relative density ()")
    if lowest is None or highest is None or not len(lowest):
        return ""
    low, high = int(np.argmin(lowest)), int(np.argmax(highest))
    at, density = (low, lowest[low]) if 1.0 - lowest[low] > highest[high] - 1.0 else (high, highest[high])
    if abs(density - 1.0) <= DENSITY:
        return ""
    return (
        f"the density came to {density:.3g} of that at rest, at t = {series['time (s)'][at]:.3g} s: further than"
        f" {DENSITY:g} from it the equation of state misleads, so pressures and loads are not to be trusted; shorten"
        " fluid.step, and see what check warns of"
    )
