"""Vortices of a field: where, which way, how strong, how large.

Gamma 1 at P is the mean of sin(PM, U_M) over the neighbours M: 1 at the centre of an axisymmetric vortex.  Gamma 2 is
the same less the neighbours' mean velocity, which it does not see; its size exceeds 2/pi where rotation outweighs
strain (Graftieaux, Michard & Grosjean 2001, Meas. Sci. Technol. 12, 1422).  Both are angles alone, so that noise in a
uniform flow has cores as large as those of vortices: a core counts where it turns faster than errors do.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import cv2
import numpy as np

from porescale.common.core.errors import warn
from porescale.common.core.types import Flags, Floats
from porescale.piv.fields.field import Field

CORE = 2 / np.pi
"""|Gamma 2| from which rotation outweighs strain."""
REACH = 3
"""Neighbours as far as this many grid steps."""
CENTRE = 0.8
"""|Gamma 2| that a core must reach: 1 in the middle of a vortex, 2/pi all over a layer of pure shear."""
WEAK = 0.02
"""Share of the strongest circulation below which a vortex is left out."""
EXCEEDS = 4.0
"""Uncertainties of a component by which a core's rim must turn, beyond what strain alone would make of it.  Errors of
all of a core together turn it by one at most; of a thousand places the largest of normal numbers is 3.2.
"""
ROUND_OFF = 16 * float(np.finfo(np.float32).eps)
"""Error of a component over the largest speed, at least, of exact fields too: files of runs hold single precision."""
LEAST = 5
"""Grid points of a core, at least: fewer may be an outlier with its neighbours."""


@dataclass(frozen=True)
class Vortex:
    """x, y : centre;  circulation : over the core, positive against the clock;  radius : of a disc of the core's area.

    In the field's units: px and px^2 a frame, or m and m^2/s.  gamma : largest |Gamma 1| in the core.
    """

    x: float
    y: float
    circulation: float
    radius: float
    gamma: float

    def as_dict(self) -> dict[str, Any]:
        """The vortex as a dictionary of values that JSON can hold."""
        return {**asdict(self), "sign": 1 if self.circulation > 0 else -1}


def gammas(field: Field, reach: int = REACH) -> tuple[Floats, Floats]:
    """Gamma 1 and Gamma 2 (ny, nx), positive against the clock, over neighbours within ``reach`` steps."""
    ny, nx = field.u.shape
    fluid = np.pad((~field.solid).astype(float), reach)
    u, v = (np.pad(np.where(field.solid, 0.0, it), reach) for it in (field.u, field.v))
    offsets = [(j, i) for j in range(-reach, reach + 1) for i in range(-reach, reach + 1)]
    offsets = [(j, i) for j, i in offsets if 0 < j * j + i * i <= reach * reach + 1]
    step_x = field.x[1] - field.x[0] if nx > 1 else 1.0
    step_y = field.y[1] - field.y[0] if ny > 1 else 1.0
    hand = 1.0 if field.upwards else -1.0  # with y down the cross product counts with the clock

    def around(it: Floats, j: int, i: int) -> Floats:
        """Values of the neighbours j rows and i columns away, of all points (ny, nx)."""
        return it[reach + j : reach + j + ny, reach + i : reach + i + nx]

    # Missing neighbours count as still: along a wall all the flow passes on one side, and nothing turns.
    count = np.maximum(sum(around(fluid, j, i) for j, i in offsets) + (~field.solid).astype(float), 1)
    mean_u, mean_v = (
        (sum(around(it, j, i) for j, i in offsets) + np.where(field.solid, 0.0, own)) / count
        for it, own in ((u, field.u), (v, field.v))
    )
    found = []
    for base_u, base_v in ((0.0, 0.0), (mean_u, mean_v)):
        total = np.zeros((ny, nx))
        for j, i in offsets:
            du, dv = around(u, j, i) - base_u, around(v, j, i) - base_v
            px, py = i * step_x, j * step_y
            size = np.hypot(px, py) * np.hypot(du, dv)
            sine = np.where(size > 0, (px * dv - py * du) / np.where(size > 0, size, 1.0), 0.0)
            total += sine * around(fluid, j, i)
        found.append(np.where(field.solid, 0.0, hand * total / len(offsets)))
    return found[0], found[1]


def vortices(field: Field, reach: int = REACH, error: float | None = None) -> list[Vortex]:
    """Vortices by falling strength: connected cores of |Gamma 2| > 2/pi, centred where |Gamma 1| is largest in them.

    Only such as exceed the vectors' uncertainty, EXCEEDS times, and ROUND_OFF (an exact field states zero).

    error : standard deviation of a component, as u, of a field that states no uncertainty (text of OpenPIV).  Without
    it nothing tells such a field's vortices from its errors, which smoothing makes alike over many grid steps: none are
    looked for, with a PorescaleWarning.
    """
    if min(field.u.shape) < 2 or field.solid.all():
        return []
    if np.isnan(field.uncertainty[~field.solid]).all():
        if error is None:
            warn(
                "a field states no uncertainty, without which errors pass for vortices: none are looked for in it; give"
                " the error of a component to look for them"
            )
            return []
        field = replace(field, uncertainty=np.where(field.valid, error, np.inf))
    one, two = gammas(field, reach)
    turning = np.nan_to_num(field.vorticity())
    area = abs((field.x[1] - field.x[0]) * (field.y[1] - field.y[0]))
    slopes = [np.gradient(it, along, axis=k) for it in (field.u, field.v) for k, along in ((1, field.x), (0, field.y))]
    found = []
    for sign in (1, -1):
        core = (sign * two > CORE) & ~field.solid
        number, labels = cv2.connectedComponents(core.astype(np.uint8), connectivity=4)
        for label in range(1, number):
            inside = np.asarray(labels == label)
            if inside.sum() < LEAST or (sign * two)[inside].max() < CENTRE:
                continue
            x, y = _centre(field, np.where(inside, sign * one, 0.0))
            strength = float(turning[inside].sum()) * area
            size = float(np.sqrt(inside.sum() * area / np.pi))
            if strength * sign > 0 and _excess(slopes, inside) * size > EXCEEDS * _error(field, inside):
                found.append(Vortex(x, y, strength, size, float((sign * one)[inside].max())))
    found.sort(key=lambda it: -abs(it.circulation))
    return [it for it in found if abs(it.circulation) >= WEAK * abs(found[0].circulation)]


def _excess(slopes: Sequence[Floats], inside: Flags) -> float:
    """Rate at which a core turns less that at which it is strained, of its mean velocity gradient: 0 in pure shear.

    slopes : du/dx, du/dy, dv/dx, dv/dy (ny, nx), nan beside solids.
    """
    if not np.isfinite(slopes[0][inside]).any():
        return 0.0
    ux, uy, vx, vy = (float(np.nanmean(it[inside])) for it in slopes)
    return abs(vx - uy) / 2 - float(np.hypot(ux - vy, uy + vx)) / 2


def _error(field: Field, inside: Flags) -> float:
    """Error of a component in a core: the rms of its valid vectors' uncertainty; infinite where most are replaced."""
    least = ROUND_OFF * float(np.nanmax(np.hypot(field.u, field.v)))
    known = field.uncertainty[inside & field.valid & np.isfinite(field.uncertainty)]
    return max(least, float(np.sqrt(np.mean(known**2)))) if 2 * known.size > inside.sum() else np.inf


def _centre(field: Field, height: Floats) -> tuple[float, float]:
    """Where ``height`` peaks: its centroid over the points within a step of the largest, less the lowest of them."""
    row, column = np.unravel_index(int(np.argmax(height)), height.shape)
    rows = slice(max(0, int(row) - 1), int(row) + 2)
    columns = slice(max(0, int(column) - 1), int(column) + 2)
    part = height[rows, columns]
    weight = part - part.min() + 1e-12
    x, y = np.meshgrid(field.x[columns], field.y[rows])
    return float((weight * x).sum() / weight.sum()), float((weight * y).sum() / weight.sum())


ALIKE = 2.0
"""Factor between circulations up to which two vortices may be one: cores a step wider or narrower, which noise and
resolution do to them, change what is counted as theirs by less.
"""


def matched(
    reference: Sequence[Vortex], other: Sequence[Vortex], within: float | None = None, factor: float = ALIKE
) -> list[tuple[Vortex, Vortex]]:
    """Pairs of the same sign, near each other and about as strong, best first, no vortex twice.

    within : largest distance of a pair; None: the larger radius of the two;  factor : most between their circulations.
    The best has the least distance over the bound plus logarithm of the ratio over that of the factor.
    """
    candidates = []
    for i, a in enumerate(reference):
        for j, b in enumerate(other):
            if a.circulation * b.circulation <= 0:
                continue
            apart = float(np.hypot(a.x - b.x, a.y - b.y)) / (within or max(a.radius, b.radius))
            ratio = abs(float(np.log(b.circulation / a.circulation))) / float(np.log(factor))
            if apart <= 1 and ratio <= 1:
                candidates.append((apart + ratio, i, j))
    best: dict[int, int] = {}
    for _, i, j in sorted(candidates):
        if i not in best and j not in best.values():
            best[i] = j
    return [(reference[i], other[j]) for i, j in best.items()]
