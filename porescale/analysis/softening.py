"""How strength falls from peak to critical state in biaxial tests, as the law of a continuum has it.

    sin φ(γ) = sin φ_c + (sin φ_p - sin φ_c) e^(-γ/γs)

γ = ε1 - ε2, the difference of the principal strains in the plane.  γs is the area between the mean curve of all tests
and the critical state, from the peak on, over the height of the peak: exact for the law, and no fit that noise or the
first strains before the peak could lead astray.  The critical state is the mean of the last third, as in `biaxial`.

Grains of a cell as wide as a shear band, some ten diameters, have nowhere to shear but evenly; in a wider one what is
measured is the mean over band and rest, so that γs is too small there by the share that shears.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from porescale.analysis.biaxial import LATE, curves, tabled
from porescale.analysis.material import Known
from porescale.common.core.statistics import jackknife
from porescale.common.core.types import Floats

HEIGHT, STRAIN = "peak sine above the critical one", "shear strain of softening"
LAW = (HEIGHT, STRAIN)
"""Numbers of the law, without unit: sin φ_p - sin φ_c of the mean curve, γs."""


def known_softening(tests: Sequence[Mapping[str, Floats]]) -> dict[str, Known]:
    """The LAW through the mean of all ``tests``, columns of their series.csv, with intervals of the jackknife; empty
    where a mean of all or of all but one has no peak above its critical state."""
    every = [curves(series) for series in tests]
    at, sine = tabled(every, "sine", 0)
    shear = np.array([np.interp(at, it["strain"], it["strain"] + it["across"]) for it in every])
    late = at > LATE * min(float(it["strain"][-1]) for it in every)

    def of(packings: list[int]) -> Floats:
        """The numbers of LAW of some packings."""
        return fall(shear[packings].mean(axis=0), sine[packings].mean(axis=0), late)

    values = jackknife(of, len(tests))
    if not np.isfinite(values).all():
        return {}
    return {name: Known(tuple(values[:, k].tolist())) for k, name in enumerate(LAW)}


def fall(shear: Floats, sine: Floats, late: NDArray[np.bool_]) -> Floats:
    """The LAW (2,) of a curve ``sine`` (m,) over ``shear`` (m,) whose critical state are the ``late`` (m,) rows; nan
    where the peak is among these, or no higher than they are."""
    critical, peak = float(sine[late].mean()), int(sine.argmax())
    height = float(sine[peak]) - critical
    if late[peak] or not height > 0.0:
        return np.full(len(LAW), math.nan)
    falling = slice(peak, int(late.argmax()) + 1)
    return np.array([height, np.trapezoid(sine[falling] - critical, shear[falling]) / height])


def handed_over(found: Mapping[str, Known]) -> bool:
    """Whether a continuum can take the law over: peak and γs are above zero, by more than their bars where there are
    any."""
    return all(name in found and found[name].resolved for name in LAW)


def softening_table(found: Mapping[str, Known]) -> dict[str, float]:
    """[softening] of a material file."""
    return {"friction_angle": found["critical friction angle"].mean, "shear_strain": found[STRAIN].mean}
