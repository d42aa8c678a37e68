"""Two fields compared: numbers over the common fluid region, and the vortices of both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator

from porescale.ground.check import Fault, InputError
from porescale.piv.field import Field
from porescale.piv.vortices import Vortex, matched, vortices

Array = NDArray[np.float64]

SLOW = 0.05
"""Share of the rms speed below which a vector has no direction to compare."""


@dataclass(frozen=True)
class Comparison:
    """How ``other`` differs from ``reference``, on the reference's grid over the fluid of both.

    points : compared;  speed : rms of the reference, its unit;  rms, largest : of the difference, over that speed;
    bias_u, bias_v : mean difference over it;  direction : mean cosine of the angle between the two, where neither is
    slow; correlation : of both components together;  reference_vortices, other_vortices, pairs : by falling strength,
    and matched;  difference_u, difference_v (ny, nx) : nan outside the common region.
    """

    points: int
    speed: float
    rms: float
    largest: float
    bias_u: float
    bias_v: float
    direction: float
    correlation: float
    reference_vortices: list[Vortex]
    other_vortices: list[Vortex]
    pairs: list[tuple[Vortex, Vortex]]
    difference_u: Array
    difference_v: Array

    def as_dict(self) -> dict[str, Any]:
        """JSON-able: the numbers, and each vortex with its partner."""
        names = ("points", "speed", "rms", "largest", "bias_u", "bias_v", "direction", "correlation")
        partners = {id(a): b for a, b in self.pairs}
        taken = {id(b) for _, b in self.pairs}
        rows = [
            {"reference": a.as_dict(), "other": partners[id(a)].as_dict() if id(a) in partners else None}
            for a in self.reference_vortices
        ]
        rows += [{"reference": None, "other": b.as_dict()} for b in self.other_vortices if id(b) not in taken]
        return {**{name: getattr(self, name) for name in names}, "vortices": rows}


def compare(reference: Field, other: Field, within: float | None = None) -> Comparison:
    """Compare ``other`` with ``reference``; vortices within the distance ``within`` (None: the larger radius) match.

    InputError where the fields share no fluid, or one is in pixels and the other in metres.
    """
    if reference.upwards != other.upwards:
        repair = "give both a scale, or none"
        raise InputError(Fault("fields", None, "one has y up (metres), the other y down (pixels)", repair=repair))
    u, v = _onto(other, other.u, reference), _onto(other, other.v, reference)
    common = ~reference.solid & np.isfinite(u) & np.isfinite(v) & np.isfinite(reference.u) & np.isfinite(reference.v)
    if not common.any():
        raise InputError(Fault("fields", None, "share no point of the fluid", repair="check scale and region"))
    du, dv = np.where(common, u - reference.u, np.nan), np.where(common, v - reference.v, np.nan)
    speed = float(np.sqrt(np.mean(reference.u[common] ** 2 + reference.v[common] ** 2)))
    if speed == 0:
        raise InputError(Fault("reference", None, "is at rest everywhere: there is nothing to compare with"))
    size = np.hypot(du, dv)[common]
    first = np.concatenate([reference.u[common], reference.v[common]])
    second = np.concatenate([u[common], v[common]])
    own, theirs = vortices(reference), vortices(other)
    return Comparison(
        points=int(common.sum()),
        speed=speed,
        rms=float(np.sqrt(np.mean(size**2))) / speed,
        largest=float(size.max()) / speed,
        bias_u=float(np.mean(du[common])) / speed,
        bias_v=float(np.mean(dv[common])) / speed,
        direction=_direction(reference, u, v, common, speed),
        correlation=_correlation(first, second),
        reference_vortices=own,
        other_vortices=theirs,
        pairs=matched(own, theirs, within),
        difference_u=du,
        difference_v=dv,
    )


def _onto(field: Field, values: Array, target: Field) -> Array:
    """Values at the target's points; nan outside and beside solids.  Cubic where there is no solid, else linear."""
    if np.array_equal(field.x, target.x) and np.array_equal(field.y, target.y):
        return values
    rows = slice(None) if len(field.y) < 2 or field.y[1] > field.y[0] else slice(None, None, -1)
    smooth = bool(np.isfinite(values).all()) and min(values.shape) > 3
    known = RegularGridInterpolator(
        (field.y[rows], field.x),
        values[rows],
        method="cubic" if smooth else "linear",
        bounds_error=False,
        fill_value=np.nan,
    )
    y, x = np.meshgrid(target.y, target.x, indexing="ij")
    return np.asarray(known((y, x)))


def _direction(reference: Field, u: Array, v: Array, common: NDArray[np.bool_], speed: float) -> float:
    """Mean cosine between the fields where both are faster than SLOW; nan if nowhere."""
    own, theirs = np.hypot(reference.u, reference.v), np.hypot(u, v)
    fast = common & (own > SLOW * speed) & (theirs > SLOW * speed)
    if not fast.any():
        return float("nan")
    cosine = (reference.u * u + reference.v * v)[fast] / (own * theirs)[fast]
    return float(np.mean(cosine))


def _correlation(first: Array, second: Array) -> float:
    """Sum of products over the root of the sums of squares: both fields as they are, means not taken off."""
    below = float(np.sqrt((first**2).sum() * (second**2).sum()))
    return float((first * second).sum()) / below if below > 0 else 0.0
