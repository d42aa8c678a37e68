"""Sizes of discs: given numbers of given diameters, grading curves matched to within one disc, lognormal sizes.
Pure geometry.

Mass is area here: discs of one density.
"""

from collections.abc import Sequence

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats

Curve = Sequence[tuple[float, float]]
"""A grading curve: (diameter in m, percent finer by mass), both ascending, 0 to 100 %; straight over log diameter."""

Sizes = Sequence[tuple[float, float]]
"""Given sizes: (diameter in m, number of discs)."""

WIDEST = 20.0
"""Largest over smallest diameter: the step follows the smallest, so that wider mixtures cost too much."""
SMALLEST, LARGEST = 1e-9, 1e3
"""Diameters of a curve, m: beyond them a unit is wrong."""
MOST, MOST_GRADED = 10_000_000, 300_000
"""Discs whose sizes are drawn up, at once or one after the other along a curve: more are a wrong unit."""
TAIL = 2.5
"""Lognormal sizes end at so many standard deviations of the logarithm."""


def check_curve(curve: Curve, key: str = "grading") -> list[Fault]:
    """Faults of a grading curve; an empty list where it is valid."""
    form = "pairs (diameter, percent finer), both ascending"
    if len(curve) < 2:
        return [Fault(key, len(curve), "has too few points", "", ">= 2", form)]
    diameter, finer = np.array(curve, dtype=np.float64).T
    faults = []
    if not np.all(np.isfinite(diameter)) or diameter[0] <= 0.0 or np.any(np.diff(diameter) <= 0.0):
        faults.append(Fault(key, str(diameter.tolist()), "diameters must ascend", "m", "> 0", form))
    elif diameter[0] < SMALLEST or diameter[-1] > LARGEST:
        allowed, repair = f"{SMALLEST:g} to {LARGEST:g}", "give diameters in metres"
        faults.append(Fault(key, str(diameter.tolist()), "is out of range", "m", allowed, repair))
    elif diameter[-1] > WIDEST * diameter[0] * (1.0 + 1e-9):
        problem = f"spans diameters of 1 to {diameter[-1] / diameter[0]:.3g}"
        faults.append(Fault(key, None, problem, "", f"1 to {WIDEST:g}", "cut off the finest grains"))
    if finer[0] != 0.0 or finer[-1] != 100.0 or np.any(np.diff(finer) < 0.0):
        problem = "percent finer must ascend from 0 to 100"
        faults.append(Fault(key, str(finer.tolist()), problem, "%", "0 to 100", form))
    return faults


def check_sizes(sizes: Sizes, key: str = "sizes") -> list[Fault]:
    """Faults of given sizes; an empty list where they are valid."""
    form = "pairs (diameter, number of grains)"
    diameter, number = np.array(sizes, dtype=np.float64).reshape(-1, 2).T
    if not len(diameter):
        return [Fault(key, 0, "has no pair", "", ">= 1", form)]
    faults, least, largest = [], float(diameter.min()), float(diameter.max())
    if least < SMALLEST or largest > LARGEST:
        allowed, repair = f"{SMALLEST:g} to {LARGEST:g}", "give diameters in metres"
        faults.append(Fault(key, str(diameter.tolist()), "is out of range", "m", allowed, repair))
    elif largest > WIDEST * least * (1.0 + 1e-9):
        problem = f"spans diameters of 1 to {largest / least:.3g}"
        faults.append(Fault(key, None, problem, "", f"1 to {WIDEST:g}", "leave out the smallest grains"))
    if not (np.all(number >= 1.0) and np.all(number == np.floor(number)) and number.sum() <= MOST_GRADED):
        problem, allowed = "numbers of grains must be whole", f"1 to {MOST_GRADED} in all"
        faults.append(Fault(key, str(number.tolist()), problem, "", allowed, form))
    return faults


def given_radii(sizes: Sizes) -> Floats:
    """Radii (n,) m of so many discs of each diameter, in the order given.  Raises InputError for none."""
    faults = check_sizes(sizes)
    if faults:
        raise InputError(faults)
    diameter, number = np.array(sizes, dtype=np.float64).T
    return np.repeat(0.5 * diameter, number.astype(np.int64))


def graded_radii(curve: Curve, area: float) -> Floats:
    """Radii (n,) m, ascending, of discs of ``area`` (m²) together that follow a grading curve.

    Walking up the curve, each disc takes the size in the middle of the share of mass that is its own: wherever one
    looks, the mass finer differs from the curve's by at most half a disc of that size, and so does the whole area.
    Raises InputError for a curve that is none, or an area that no disc of the finest size fits.
    """
    faults = check_curve(curve)
    if faults:
        raise InputError(faults)
    diameter, finer = np.array(curve, dtype=np.float64).T
    share, logs = finer / 100.0, np.log(diameter)
    even = (np.arange(1000) + 0.5) / 1000
    check_count(float(4.0 / np.pi * area * np.exp(-2.0 * np.interp(even, share, logs)).mean()), "grading", MOST_GRADED)
    chosen: list[float] = []
    done = 0.0
    while done < 1.0:
        d = float(np.exp(np.interp(done, share, logs)))
        for _ in range(30):  # own share = pi d²/4 A, d at its middle: contracts as a disc is a small share
            half, before = np.pi * d * d / (8.0 * area), d
            d = float(np.exp(np.interp(min(done + half, 1.0), share, logs)))
            if d == before:
                break
        own = np.pi * d * d / (4.0 * area)
        if done + 0.5 * own > 1.0:
            break
        chosen.append(0.5 * d)
        done += own
    if not chosen:
        repair = "make the rectangle larger"
        raise InputError(Fault("grading", float(diameter[0]), "not one grain fits the area", "m", repair=repair))
    return np.array(chosen)


def check_count(count: float, key: str, most: int = MOST) -> None:
    """InputError, of ``key``, where so many discs are too many to draw up their sizes."""
    if not count <= most:
        repair = "make the rectangle smaller or the grains larger"
        raise InputError(Fault(key, None, f"makes about {count:.3g} grains", "", f"<= {most}", repair))


def lognormal_radii(count: int, diameter: float, spread: float) -> Floats:
    """Radii (count,) m, ascending, of lognormal diameters of mean ``diameter`` (m), ``spread`` that of their logarithm.

    Evenly spaced quantiles, cut off at 2.5 standard deviations and scaled to the mean.  Raises InputError when the
    largest is more than WIDEST times the smallest.
    """
    if not 0.0 <= spread <= np.log(WIDEST) / (2.0 * TAIL):
        allowed = f"0 to {np.log(WIDEST) / (2.0 * TAIL):.3g}"
        raise InputError(Fault("log_spread", spread, f"sizes would span more than 1 to {WIDEST:g}", "", allowed))
    from scipy.special import ndtr, ndtri  # takes longer to import than a scene takes to be checked

    low = float(ndtr(-TAIL))
    quantile = low + (1.0 - 2.0 * low) * (np.arange(count) + 0.5) / max(count, 1)
    relative = np.exp(spread * ndtri(quantile))
    return np.asarray(0.5 * diameter * relative / (relative.mean() if count else 1.0))
