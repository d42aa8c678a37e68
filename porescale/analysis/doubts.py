"""What is to be doubted of a soil measured on packings: said with its numbers, and by the continuum that takes them."""

import math
from collections.abc import Mapping, Sequence

from porescale.analysis.material import EXPONENT, UNITS, Known, elastic, grows
from porescale.analysis.shear_rate import AT_REST, FASTEST_ANGLE, GROWTH, HALFWAY, handed_over, law, point
from porescale.common.core.statistics import LEAST

USUAL = 4
"""Packings below which an interval is wide: three have one of 2.5 standard errors of one packing, four of 1.6."""
DRIFT = math.radians(0.5)
"""Dilatancy angle below which volume counts as constant: 0.14 % over the last third
of a strain of 0.24."""
ORDERED = math.radians(1.5)
"""Half of the interval of a critical angle from where on friction coefficients may come in any order: angles of discs
hardly grow with friction above 0.3, and a tenth of 15 degrees is as much as a doubling changes there."""
INDEPENDENT = 5.0
"""Independent values found in the critical state below which a test is too short for a mean of its own: it then has two
or three, as few are found as twice as many."""
HALF = 0.5
"""Interval over mean above which a number that a continuum takes over is hardly known."""
MISFIT = 2.0
"""Intervals by which a law may miss a measured sine: with four packings one in 130 is that far off by chance."""
HANDED_OVER = ("peak friction angle", "critical friction angle", "stiffness", EXPONENT, "permeability")


def doubts(rows: Sequence[Mapping[str, float]], found: Mapping[str, Known]) -> list[str]:
    """One line each, of the numbers ``rows`` of all packings and of what is ``found`` of them."""
    made = []
    for name in UNITS:
        have = sum(math.isfinite(row.get(name, math.nan)) for row in rows)
        if name not in found and any(name in row for row in rows):
            made.append(f"{name} is absent: {len(rows) - have} of {len(rows)} packings do not show it")
    if len(rows) < USUAL:
        bar = "no interval" if len(rows) < LEAST else "a wide interval"
        made.append(f"{len(rows)} packings give {bar}: raise homogenise.packings to {USUAL} or more")
    if "stiffness" in found and not elastic(found):
        ratio = found["Poisson's ratio"].text()
        made.append(
            f"stiffness {found['stiffness'].text()} and Poisson's ratio {ratio} are not those "
            "of an elastic soil: contacts hardly hold the packing, and a continuum takes neither of them"
        )
    elif EXPONENT in found and not grows(found):
        text = found[EXPONENT].text()
        made.append(f"{EXPONENT} {text} is not between 0 and 1 beyond its bar: none is handed over; more packings")
    for name in HANDED_OVER:
        if name == EXPONENT and not grows(found):
            continue
        if name in found and found[name].interval > HALF * abs(found[name].mean):
            made.append(f"{name} {found[name].text()} is hardly known: more packings, or larger ones")
    return made + _critical(found)


def _critical(found: Mapping[str, Known]) -> list[str]:
    """Of the critical state."""
    drift, angle, alone = (
        found[name] for name in ("critical dilatancy angle", "critical friction angle", "independent critical values")
    )
    made = []
    wide = drift.interval if math.isfinite(drift.interval) else 4.0 * DRIFT
    if abs(drift.mean) > max(wide, DRIFT):
        made.append(
            f"volume still drifts, dilatancy angle {drift.text()}: raise homogenise.strain for a critical state"
        )
    elif wide > 4.0 * DRIFT:
        made.append(f"whether volume still drifts is open, dilatancy angle {drift.text()}: more packings")
    if alone.mean < INDEPENDENT:
        made.append(f"a critical state has {alone.mean:.2g} independent values at most: raise homogenise.strain")
    if not angle.interval < ORDERED:
        made.append(
            f"critical friction angle {angle.text()}: too wide to order friction coefficients above 0.3, known to "
            f"{math.degrees(ORDERED):.2g} degrees it would; `--until friction=5%` goes on"
        )
    return made


def rate_doubts(found: Mapping[str, Known], rates: Sequence[float], inertial: Sequence[float]) -> list[str]:
    """Of the growth of friction with rate, one line each.  rates : as asked;  inertial : I as they were, (m,)."""
    if HALFWAY not in found:
        cause = "friction grows along a line, at once or not at all"
        return [f"no law of rate is handed over: {cause}; faster homogenise.rates, or more packings"]
    made = []
    for name in (GROWTH, HALFWAY, FASTEST_ANGLE):
        it = found[name]
        if not it.mean > 0.0 or it.interval >= it.mean:
            made.append(f"{name} {it.text()} is not resolved: faster homogenise.rates, or more packings")
        elif it.interval > HALF * it.mean:
            made.append(f"{name} {it.text()} is hardly known: faster homogenise.rates, or more packings")
    if not handed_over(found):
        return [*made, "the law of rate is not handed over"]
    rest, slow = found[AT_REST], found["critical friction angle"]
    if abs(rest.mean - slow.mean) > math.hypot(rest.interval, slow.interval):
        beside = f"is not that of the slow tests, {slow.text()}"
        made.append(f"{AT_REST} {rest.text()} {beside}: the law of a continuum begins at the latter")
    for rate, number in zip(rates, inertial, strict=True):
        seen = found[point("sine", rate)]
        off = law(number, math.sin(rest.mean), found[GROWTH].mean, found[HALFWAY].mean) - seen.mean
        if abs(off) > MISFIT * seen.interval:
            made.append(f"at inertial number {rate:g} the law is {off:+.2g} off the measured sine {seen.text()}")
    return made
