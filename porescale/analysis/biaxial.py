"""What a biaxial test of a cell shows of its soil: strength and dilatancy.

Axial strain a = -ε_yy and volume strain v = ε_xx + ε_yy, logarithmic, dilation positive; stresses are compression.

    sin φ = (σ_yy - σ_xx)/(σ_yy + σ_xx)      mobilised friction angle, means over 1 % of strain
    sin ψ = D/(2 + D),  D = dv/da            dilatancy angle, by straight lines over 1 %

Peak: where the mean over all tests is largest, what each test has there; the largest of each test alone would be the
largest of its swings, which loose soil has, too.  Critical: the mean of the last third of a test, its dilatancy by one
straight line: zero where volume no longer drifts.  How many independent values that mean has follows from their
correlation over strain.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.statistics import independent
from porescale.common.core.types import Floats

WINDOW = 0.01
"""Of axial strain, over which peak and dilatancy are taken."""
LATE = 2.0 / 3.0
"""Share of the strain from where on a test is in its critical state."""
LEAST, SHORTEST = 40, 2.5 * WINDOW
"""Rows, and strain, below which a series holds no test: one of the least homogenise.strain, 3 of these windows, ends a
step short of it."""


def running(strain: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Mean and slope of ``values`` (r,) over ``strain`` (r,), ascending, within half a WINDOW of each row, both (r,);
    nan where the window reaches beyond the test."""
    half = 0.5 * WINDOW
    low = np.searchsorted(strain, strain - half)
    high = np.searchsorted(strain, strain + half, side="right")
    inside = (strain - half >= strain[0] - 1e-12) & (strain + half <= strain[-1] + 1e-12)
    mean, slope = np.full_like(strain, np.nan), np.full_like(strain, np.nan)
    for k in np.flatnonzero(inside):
        x, y = strain[low[k] : high[k]], values[low[k] : high[k]]
        mean[k] = y.mean()
        slope[k] = float(np.sum((x - x.mean()) * y) / np.sum((x - x.mean()) ** 2))
    return mean, slope


def curves(series: Mapping[str, Floats]) -> dict[str, Floats]:
    """Axial strain, volume strain, sine of the mobilised angle, strain across, solid fraction, of every row of a test
    but the first, which comes before its first step."""
    across, axial = series["strain xx ()"][1:], -series["strain yy ()"][1:]
    side, along = series["stress xx (Pa)"][1:], series["stress yy (Pa)"][1:]
    return {
        "strain": axial, "volume": across - axial, "sine": (along - side) / (along + side),
        "across": across, "fraction": series["solid fraction ()"][1:],
    }  # fmt: skip


def numbers(tests: Sequence[Mapping[str, Floats]]) -> list[dict[str, float]]:
    """The numbers of each of several tests of one soil, angles in rad, from the columns of their series.csv.

    Raises InputError for a test without strength: one that ended before it began to shear.
    """
    every = [curves(series) for series in tests]
    if any(len(it["strain"]) < LEAST or not it["strain"][-1] > SHORTEST for it in every):
        raise InputError(Fault("series.csv", None, "holds no test", repair="remove that run folder"))
    sines, openings = peaks(every)
    return [
        {
            "porosity": 1.0 - float(series["solid fraction ()"][0]),
            "peak friction angle": math.asin(sine),
            "peak dilatancy angle": math.asin(opening / (2.0 + opening)),
            **_alone(it),
        }
        for series, it, sine, opening in zip(tests, every, sines.tolist(), openings.tolist(), strict=True)
    ]


def peaks(every: Sequence[Mapping[str, Floats]]) -> tuple[Floats, Floats]:
    """Sine of the friction angle and dilatancy dv/da of each test, (n,), where their means over tests are largest."""
    found = []
    for name, which in (("sine", 0), ("volume", 1)):
        table = tabled(every, name, which)[1]
        found.append(table[:, int(table.mean(axis=0).argmax())])
    return found[0], found[1]


def tabled(every: Sequence[Mapping[str, Floats]], name: str, which: int) -> tuple[Floats, Floats]:
    """Axial strains (m,) that all tests reach, and there of each the ``which`` of `running` of a column, (n, m)."""
    end = min(float(it["strain"][-1]) for it in every)
    at = np.arange(WINDOW, end - 0.5 * WINDOW, 0.1 * WINDOW)  # before WINDOW contacts close, or a test begins
    rows = []
    for it in every:
        values = running(it["strain"], it[name])[which]
        sound = np.isfinite(values)
        rows.append(np.interp(at, it["strain"][sound], values[sound]))
    return at, np.array(rows)


def _alone(it: Mapping[str, Floats]) -> dict[str, float]:
    """Numbers of one test that need no other."""
    late = it["strain"] > LATE * it["strain"][-1]
    a, sine = it["strain"][late], it["sine"][late]
    opening = max(float(np.polyfit(a, it["volume"][late], 1)[0]), -0.99)
    return {
        "critical friction angle": math.asin(float(sine.mean())),
        "critical dilatancy angle": math.asin(opening / (2.0 + opening)),
        "independent critical values": independent(np.interp(np.linspace(a[0], a[-1], len(a)), a, sine)),
        "critical porosity": 1.0 - float(it["fraction"][late].mean()),
        "porosity after the test": 1.0 - float(it["fraction"][-1]),
    }
