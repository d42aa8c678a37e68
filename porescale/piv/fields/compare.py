"""Two fields compared: numbers over the common fluid region, and the vortices of both."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator

from porescale.common.core.errors import Fault, InputError, warn
from porescale.common.core.ranges import Range
from porescale.common.core.types import Floats
from porescale.piv import given
from porescale.piv.fields.field import Field
from porescale.piv.fields.surface import Difference, Surface, difference, of_field
from porescale.piv.fields.vortices import ALIKE, Vortex, matched, vortices

ALIGNED = 30.0
"""Degrees between two directions that count as one."""
SLOW = 0.05
"""Share of the rms speed below which a vector has no direction to compare."""
HALF = 0.5
"""Share of a field; less of it compared is warned of: its scale, place or region may be wrong."""


@dataclass(frozen=True)
class Comparison:
    """How ``other`` differs from ``reference``, on the reference's grid over the fluid of both.

    points : compared;  shared : what share of a field they are, of the one of which less is compared;
    speed : rms of the reference, its unit;  rms, largest : of the difference, over that speed;
    bias_u, bias_v : mean difference over it;  direction : mean cosine of the angle between the two, where neither is
    slow;  aligned : share of those that are within ALIGNED degrees;  correlation : of both components together;
    surface : of the piles, None where one has none;  surfaces : both;  reference_vortices, other_vortices, pairs : by
    falling strength, and matched;  difference_u, difference_v (ny, nx) : nan outside the common region.
    """

    points: int
    shared: float
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
    difference_u: Floats
    difference_v: Floats
    aligned: float
    surface: Difference | None
    surfaces: tuple[Surface, Surface] | None

    def __repr__(self) -> str:
        return (
            f"Comparison at {self.points} points: rms difference {self.rms:.4g}, largest {self.largest:.4g}, "
            f"of an rms speed of {self.speed:.4g}\nbias {self.bias_u:.4g}, {self.bias_v:.4g}, "
            f"correlation {self.correlation:.6g}; {len(self.pairs)} vortices matched"
        )

    def as_dict(self) -> dict[str, Any]:
        """JSON-able: the numbers, and each vortex with its partner."""
        names = (
            "points",
            "shared",
            "speed",
            "rms",
            "largest",
            "bias_u",
            "bias_v",
            "direction",
            "aligned",
            "correlation",
        )
        partners = {id(a): b for a, b in self.pairs}
        matched_others = {id(b) for _, b in self.pairs}
        rows = [_row(a, partners.get(id(a))) for a in self.reference_vortices]
        rows += [{"reference": None, "other": b.as_dict()} for b in self.other_vortices if id(b) not in matched_others]
        surface = None if self.surface is None else self.surface._asdict()
        return {**{name: getattr(self, name) for name in names}, "vortices": rows, "surface": surface}


def _row(reference: Vortex, other: Vortex | None) -> dict[str, Any]:
    """A vortex beside its partner, how far they are apart, and how much stronger the partner is."""
    if other is None:
        return {"reference": reference.as_dict(), "other": None}
    apart = float(np.hypot(reference.x - other.x, reference.y - other.y))
    ratio = other.circulation / reference.circulation
    return {"reference": reference.as_dict(), "other": other.as_dict(), "apart": apart, "ratio": ratio}


def compare(
    reference: Field,
    other: Field,
    within: float | None = None,
    factor: float = ALIKE,
    surfaces: tuple[Surface | None, Surface | None] = (None, None),
    error: float | None = None,
) -> Comparison:
    """Compare ``other`` with ``reference``.

    within, factor : distance (None: the larger radius) and factor in circulation up to which vortices of one sign
    match;  surfaces : of the piles; what a field has solid stands for one that is None;  error : standard deviation of
    a component of fields that state no uncertainty, whose vortices are not looked for without it, with a
    PorescaleWarning.  Another one where less than HALF of a field is compared.  InputError where the fields share no
    fluid, or one is in pixels and the other in metres.
    """
    repair = "give fields of piv.measure, or of field_of_run"
    for key, field in (("reference", reference), ("other", other)):
        if not isinstance(field, Field):
            raise InputError(Fault(key, str(field), f"is no field but {type(field).__name__}", repair=repair))
    near = [] if within is None else given.within("within", within, Range(gt=0))
    stated = [] if error is None else given.within("error", error, Range(gt=0))
    given.refuse(near, given.within("factor", factor, Range(gt=1)), stated)
    if reference.upwards != other.upwards:
        repair = "give both a scale, or none"
        raise InputError(Fault("fields", None, "one has y up (metres), the other y down (pixels)", repair=repair))
    u, v = _onto(other, other.u, reference), _onto(other, other.v, reference)
    common = _known(reference) & np.isfinite(u) & np.isfinite(v)
    if not common.any():
        raise InputError(Fault("fields", None, "share no point of the fluid", repair="check scale and region"))
    shared = min(float(common.sum()) / _known(reference).sum(), _inside(other, reference))
    if shared < HALF:
        warn(f"{100 * shared:.2g} % of a field is compared, the rest lies outside of the other: check scale and region")
    du, dv = np.where(common, u - reference.u, np.nan), np.where(common, v - reference.v, np.nan)
    speed = float(np.sqrt(np.mean(reference.u[common] ** 2 + reference.v[common] ** 2)))
    if speed == 0:
        raise InputError(Fault("reference", None, "is at rest everywhere: there is nothing to compare with"))
    size = np.hypot(du, dv)[common]
    first = np.concatenate([reference.u[common], reference.v[common]])
    second = np.concatenate([u[common], v[common]])
    own, theirs = vortices(reference, error=error), vortices(other, error=error)
    direction, aligned = _direction(reference, u, v, common, speed)
    tops = [known or of_field(field) for known, field in zip(surfaces, (reference, other), strict=True)]
    piles = None if tops[0] is None or tops[1] is None else (tops[0], tops[1])
    return Comparison(
        points=int(common.sum()),
        shared=shared,
        speed=speed,
        rms=float(np.sqrt(np.mean(size**2))) / speed,
        largest=float(size.max()) / speed,
        bias_u=float(np.mean(du[common])) / speed,
        bias_v=float(np.mean(dv[common])) / speed,
        direction=direction,
        correlation=_correlation(first, second),
        reference_vortices=own,
        other_vortices=theirs,
        pairs=matched(own, theirs, within, factor),
        difference_u=du,
        difference_v=dv,
        aligned=aligned,
        surface=None if piles is None else difference(*piles),
        surfaces=piles,
    )


def _known(field: Field) -> NDArray[np.bool_]:
    """Where a field has a velocity of the fluid, (ny, nx)."""
    return np.asarray(~field.solid & np.isfinite(field.u) & np.isfinite(field.v))


def _inside(field: Field, frame: Field) -> float:
    """Share of the points of ``field`` that lie between the outermost ones of ``frame``; 1 without any."""
    x = (field.x >= frame.x.min()) & (field.x <= frame.x.max())
    y = (field.y >= frame.y.min()) & (field.y <= frame.y.max())
    known = _known(field)
    return float(known[np.ix_(y, x)].sum() / known.sum()) if known.any() else 1.0


def _onto(field: Field, values: Floats, target: Field) -> Floats:
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


def _direction(reference: Field, u: Floats, v: Floats, common: NDArray[np.bool_], speed: float) -> tuple[float, float]:
    """Mean cosine between the fields where both are faster than SLOW, and the share of these that are aligned; nan if
    nowhere.
    """
    own, theirs = np.hypot(reference.u, reference.v), np.hypot(u, v)
    fast = common & (own > SLOW * speed) & (theirs > SLOW * speed)
    if not fast.any():
        return float("nan"), float("nan")
    cosine = (reference.u * u + reference.v * v)[fast] / (own * theirs)[fast]
    return float(np.mean(cosine)), float(np.mean(cosine > np.cos(np.radians(ALIGNED))))


def _correlation(first: Floats, second: Floats) -> float:
    """Sum of products over the root of the sums of squares: both fields as they are, means not taken off."""
    below = float(np.sqrt((first**2).sum() * (second**2).sum()))
    return float((first * second).sum()) / below if below > 0 else 0.0
