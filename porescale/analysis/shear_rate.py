"""How friction grows with the rate of shear: steady simple shear of a specimen at several inertial numbers, and a law.

    I = γ̇ d √(ρs/p),  γ̇ = |ε̇1 - ε̇2|,  p = (σ1 + σ2)/2,  sin φ = (σ1 - σ2)/(σ1 + σ2)

d : mean diameter of the grains, ρs : their density, 1 and 2 : principal values in the plane.  In simple shear at
constant volume γ̇ is the rate of shear dv_x/dy.  da Cruz et al. 2005 take γ̇ √(m/p) with m = π ρs d²/4: 0.886 I.

    sin φ(I) = s0 + Δ I/(I0 + I)        (Jop, Forterre & Pouliquen 2006, Nature 441, 727, there for tan φ of spheres)

A biaxial test cannot be driven so fast and be steady: its cell is as flat as three grains at a shear of 4 (400 discs).
Between walls, the acceleration ε̇² y of the grains also needs a pressure that differs by c ρs ε̇² L²/8 over half a
height, c the solid fraction: c (I L/d)²/32 of p, a tenth of it at I = 0.1 for L = 20 d.  Simple shear has no end and no
such acceleration: G² = 0 in dem/motion/affine_strain.py, so that its motion is Newton's.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from porescale.analysis.homogenise import FASTEST, packing_of, pressure_of
from porescale.analysis.material import Known
from porescale.builders.initial.contact_laws import MaterialPlan
from porescale.builders.scene import Scene
from porescale.common.core.statistics import independent, jackknife
from porescale.common.core.types import Floats

SHEAR = 10.0
"""Of a test."""
WARM = 2.0
"""Shear from where on a test is averaged: sin φ and porosity of three packings of 400 discs drift from the start to a
shear of 1, and then no longer beyond their scatter, at I = 0.01 to 0.3 (November 2026)."""
ROWS = 2000
"""Of the series of a test."""
SNAPSHOTS = 10
WIDE = 10.0
"""I0 is sought from the slowest rate over this to the fastest times this: beyond it the law is a step or a line."""
STEPS = 400
"""Values of I0 that are tried before the best is refined."""
STEEPEST = 1.4
"""Friction angle of the fastest flow (rad) that a continuum takes at most."""
AT_REST, FASTEST_ANGLE = "slow shear friction angle", "fastest shear friction angle"
GROWTH, HALFWAY = "growth of the sine with rate", "inertial number of half the growth"
LAW = {AT_REST: "rad", FASTEST_ANGLE: "rad", GROWTH: "", HALFWAY: ""}
"""Numbers of the law and their units: asin s0, asin(s0 + Δ), Δ, I0."""


class Steady(NamedTuple):
    """One test.  inertial : I;  sine : sin φ of the mean stress;  porosity;  independent : values of sin φ in it."""

    inertial: float
    sine: float
    porosity: float
    independent: float


def shear_rate(scene: Scene, inertial: float) -> float:
    """γ̇ (1/s) of an inertial number at the pressure of a scene's specimens."""
    packing = packing_of(scene)
    density = MaterialPlan.of(scene).density(packing.material)
    return inertial * math.sqrt(pressure_of(scene) / density) / packing.diameter


def sheared(scene: Scene, specimen: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a scene that shears the ``specimen`` (tables) of ``scene`` at the first of its rates, at constant
    stress across the shear and constant width; other rates are laid over it, see ``settings``."""
    rate = shear_rate(scene, _rates(scene)[0])
    end = SHEAR / rate
    return {
        **specimen,
        "title": str(specimen["title"]).replace("Biaxial test", "Simple shear"),
        "cell": {"rate_xy": rate, "stress_yy": pressure_of(scene), "fastest": FASTEST * rate},
        "time": {"end": end},
        "output": {"snapshot_interval": end / SNAPSHOTS, "series_interval": end / ROWS},
    }


def settings(scene: Scene, inertial: float) -> tuple[str, ...]:
    """What is laid over ``sheared`` for another inertial number."""
    rate = shear_rate(scene, inertial)
    end = SHEAR / rate
    return (
        f"cell.rate_xy={rate!r}", f"cell.fastest={FASTEST * rate!r}", f"time.end={end!r}",
        f"output.snapshot_interval={end / SNAPSHOTS!r}", f"output.series_interval={end / ROWS!r}",
    )  # fmt: skip


def _rates(scene: Scene) -> tuple[float, ...]:
    """The inertial numbers of a scene that has some."""
    assert scene.homogenise
    return scene.homogenise.rates


def steady(series: Mapping[str, Floats], diameter: float, density: float) -> Steady:
    """What the columns of series.csv of a test say, rows after a shear of WARM; diameter m, density of grains kg/m³.

    sin φ is that of the mean stress: the radius of a swinging one is too large on average.
    """
    shear, time = np.abs(series["strain xy ()"]), series["time (s)"]
    late = shear >= WARM
    xx, yy, xy = (series[name][late] for name in ("stress xx (Pa)", "stress yy (Pa)", "shear stress (Pa)"))
    mean = 0.5 * float(xx.mean() + yy.mean())
    rate = float(shear[late][-1] - shear[late][0]) / float(time[late][-1] - time[late][0])
    return Steady(
        rate * diameter * math.sqrt(density / mean),
        math.hypot(0.5 * float(xx.mean() - yy.mean()), float(xy.mean())) / mean,
        1.0 - float(series["solid fraction ()"][late].mean()),
        independent(2.0 * xy / (xx + yy)),
    )


def law(inertial: float, rest: float, growth: float, halfway: float) -> float:
    """sin φ at I;  rest : s0, growth : Δ, halfway : I0."""
    return rest + growth * inertial / (halfway + inertial)


def fit(inertial: Floats, sine: Floats) -> tuple[float, float, float]:
    """s0, Δ and I0 of least squares through ``sine`` at ``inertial``, both (m,), m >= 3, all rates alike: equal shears
    have about as many independent values at any rate.  nan where no I0 within WIDE is best: a line, or a step."""
    from scipy.optimize import minimize_scalar

    def at(logs: Floats) -> tuple[Floats, Floats, Floats]:
        """Sum of squares, s0 and Δ, each (k,), of the straight lines over I/(I0 + I) at the ln I0 of ``logs`` (k,)."""
        x = inertial / (np.exp(logs)[:, None] + inertial)
        middle = x.mean(axis=1)
        swing = x - middle[:, None]
        growth = np.sum(swing * sine, axis=1) / np.sum(swing**2, axis=1)
        rest = sine.mean() - growth * middle
        return np.sum((sine - rest[:, None] - growth[:, None] * x) ** 2, axis=1), rest, growth

    logs = np.linspace(math.log(inertial.min() / WIDE), math.log(inertial.max() * WIDE), STEPS)
    best = int(np.argmin(at(logs)[0]))
    if best in (0, STEPS - 1):
        return math.nan, math.nan, math.nan
    ends = (float(logs[best - 1]), float(logs[best + 1]))
    found = float(minimize_scalar(lambda log: float(at(np.array([log]))[0][0]), bounds=ends, method="bounded").x)
    _, rest, growth = at(np.array([found]))
    return float(rest[0]), float(growth[0]), math.exp(found)


def known_points(rates: Sequence[float], tests: Sequence[Sequence[Steady]]) -> dict[str, Known]:
    """sin φ and porosity at each of the ``rates`` (as they were asked), ``tests`` of each packing in their order."""
    found: dict[str, Known] = {}
    for name in ("sine", "porosity"):
        for k, rate in enumerate(rates):
            found[point(name, rate)] = Known(tuple(float(getattr(each[k], name)) for each in tests))
    return found


def point(name: str, rate: float) -> str:
    """Name of a measured number at one of the rates."""
    return f"{name} at inertial number {rate:g}"


def inertial_numbers(tests: Sequence[Sequence[Steady]]) -> Floats:
    """Means over packings of I as it was, (m,)."""
    return np.asarray(np.mean([[it.inertial for it in each] for each in tests], axis=0), float)


def known_law(tests: Sequence[Sequence[Steady]]) -> dict[str, Known]:
    """The LAW through the means of all packings, with intervals; empty where it has none, or no angle.

    values : of the jackknife, whose mean is the fit: one packing alone may have no I0.
    """
    inertial = np.array([[it.inertial for it in each] for each in tests])
    sine = np.array([[it.sine for it in each] for each in tests])

    def of(packings: list[int]) -> Floats:
        """The numbers of LAW of some packings."""
        rest, growth, halfway = fit(inertial[packings].mean(axis=0), sine[packings].mean(axis=0))
        if not (abs(rest) < 1.0 and abs(rest + growth) < 1.0):
            return np.full(len(LAW), math.nan)
        return np.array([math.asin(rest), math.asin(rest + growth), growth, halfway])

    values = jackknife(of, len(tests))
    if not np.isfinite(values).all():
        return {}
    return {name: Known(tuple(values[:, k].tolist()), unit) for k, (name, unit) in enumerate(LAW.items())}


def handed_over(found: Mapping[str, Known]) -> bool:
    """Whether a continuum can take the law over: friction grows, by more than its bars where there are any, to an angle
    between that of the slow tests and STEEPEST."""
    if HALFWAY not in found:
        return False
    slow, fastest = found["critical friction angle"].mean, found[FASTEST_ANGLE].mean
    return slow < fastest <= STEEPEST and all(found[name].resolved for name in (GROWTH, HALFWAY))


def rate_table(found: Mapping[str, Known], diameter: float) -> dict[str, float]:
    """[rate] of a material file;  diameter m."""
    return {
        "grain_diameter": diameter,
        "friction_angle": found[FASTEST_ANGLE].mean,
        "inertial_number": found[HALFWAY].mean,
    }
