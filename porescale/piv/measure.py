"""Displacements between two pictures, or from many pairs of one steady flow."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from porescale.ground.check import Fault, InputError
from porescale.piv.grid import Grid
from porescale.piv.outliers import THRESHOLD, filled, residual
from porescale.piv.passes import LEAST_WINDOW, Updated, bell, correlation_pass, paths, update_pass
from porescale.piv.prepare import Ready, ready
from porescale.piv.smooth import smoothed

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Settings:
    """How to measure.

    window : px, of the last pass, even;  overlap : of neighbouring windows, 0 to below 1;  search : px, largest
    displacement that the first pass looks for;  updates : Gauss-Newton updates after the last correlation;  width :
    half-width of their bell, over the window (10 px at least);  noise, slack : residuals from which a pixel counts for
    less, over the pictures' noise, and in px of displacement;  curved : paths bend as in a steady flow;  smooth : by
    cross-validation at the end;  least_correlation : below it, alone or in the median around, a vector is invalid.
    """

    window: int = 16
    overlap: float = 0.5
    search: int = 16
    updates: int = 3
    width: float = 0.35
    noise: float = 2.0
    slack: float = 0.2
    curved: bool = True
    smooth: bool = True
    least_correlation: float = 0.3

    def check(self, size: tuple[int, int]) -> None:
        """Raises InputError for what cannot be measured on pictures of ``size`` (rows, columns)."""
        faults = []
        if self.window < 4 or self.window % 2 or self.window > min(size):
            allowed = f"even, 4 to {min(size)}"
            faults.append(Fault("--window", self.window, "is not a window of these pictures", "px", allowed))
        if not 0 <= self.overlap < 1:
            faults.append(Fault("--overlap", self.overlap, "is out of range", allowed="0 to below 1"))
        if not 1 <= self.search <= 256:
            faults.append(Fault("--search", self.search, "is out of range", "px", "1 to 256"))
        if self.updates < 1:
            faults.append(Fault("updates", self.updates, "is out of range", allowed=">= 1"))
        if faults:
            raise InputError(faults)

    @property
    def step(self) -> int:
        """Pixels from one vector to the next."""
        return max(1, round(self.window * (1 - self.overlap)))


@dataclass(frozen=True)
class Vectors:
    """Displacements on a grid; arrays (ny, nx), pixels, y down.

    x (nx,), y (ny,) centres;  u, v : finite where not ``solid``;  valid : passed validation;  replaced : made of
    neighbours;  solid : in a solid;  correlation, peak_ratio;  uncertainty : standard deviation of a component, px.
    """

    x: Array
    y: Array
    u: Array
    v: Array
    valid: Flags
    replaced: Flags
    solid: Flags
    correlation: Array
    peak_ratio: Array
    uncertainty: Array


FIRST = 64
"""Window of the first pass, px, at least."""


def measure(
    first: NDArray[Any],
    second: NDArray[Any],
    solid: Flags | tuple[Flags, Flags] | None = None,
    settings: Settings | None = None,
) -> Vectors:
    """Displacements between two grey pictures (rows, columns).

    solid : True in solids, one mask for both pictures or one each.  InputError for pictures that cannot be measured.
    """
    settings = settings or Settings()
    masks = solid if isinstance(solid, tuple) else (solid, solid)
    refuse(first, second, masks, settings)
    reach = 2 * max(16, settings.window)
    pair = ready(first, masks[0], reach), ready(second, masks[1], reach)
    return measure_ready([pair], (first.shape[0], first.shape[1]), masks, settings)


def refuse(first: NDArray[Any], second: NDArray[Any], masks: Sequence[Flags | None], settings: Settings) -> None:
    """Raise InputError for sizes that differ, masks that do not fit or leave nothing, and pictures without contrast."""
    if first.shape != second.shape or first.ndim != 2:
        sizes = " and ".join("x".join(str(side) for side in it.shape[1::-1]) for it in (first, second))
        raise InputError(Fault("pictures", sizes, "are not of one size"))
    settings.check((first.shape[0], first.shape[1]))
    for picture, mask in zip((first, second), masks, strict=True):
        if mask is not None and mask.shape != picture.shape:
            sizes = " and ".join("x".join(str(side) for side in it.shape[::-1]) for it in (mask, picture))
            raise InputError(Fault("--mask", sizes, "the mask is not of the pictures' size"))
        if mask is not None and mask.all():
            raise InputError(Fault("--mask", None, "covers the whole picture", repair="solid is white, fluid black"))
        seen = picture if mask is None else picture[~mask]
        if float(seen.max()) - float(seen.min()) <= 0:
            raise InputError(Fault("pictures", None, f"no tracers: every pixel of the fluid is {seen.flat[0]}"))


def measure_ready(
    pairs: Iterable[tuple[Ready, Ready]], size: tuple[int, int], masks: Sequence[Flags | None], settings: Settings
) -> Vectors:
    """Displacements of prepared pairs of one steady flow, which are gone through once for every pass.

    size : rows, columns;  masks : solids, for the flag ``solid``.
    """
    grid, u, v = _coarse(pairs, size, settings)
    window = FIRST // 2
    while True:
        window = max(settings.window, min(window, min(size) // 2 * 2))
        new = Grid(size, window, settings.step if window == settings.window else window // 2)
        u, v = grid.at(new, u), grid.at(new, v)
        grid, fluid = new, _fluid(new, masks)
        along = paths(grid, u, v, curved=False)
        halved = window >= COARSE
        found = correlation_pass(pairs, grid, 2 * SEARCH if halved else SEARCH, along, halved=halved)
        good = fluid & (found.value > 0.5 * settings.least_correlation)
        lost = _outliers(u + found.u, v + found.v, found.u, found.v, good, THRESHOLD)
        u, v = filled(u + found.u, v + found.v, good & ~(lost & (found.ratio < CLEAR)))
        if window == settings.window:
            break
        window //= 2
    start_u, start_v = u, v
    reach = max(LEAST_REACH, settings.width * window)
    weights = bell(reach)
    cut = _cut(grid, fluid, masks, round(reach))
    for _ in range(settings.updates):
        along = paths(grid, u, v, curved=settings.curved)
        update = update_pass(pairs, grid, weights, settings.noise, settings.slack, along, cut)
        u, v, good = _updated(u, v, fluid, start_u, start_v, update, settings)
    if settings.smooth:
        u, v = smoothed(u, v, max(1.0, max(window, LEAST_WINDOW) / (2 * grid.step)))
    return _vectors(grid, u, v, good, fluid, update, found.ratio)


LEAST_REACH = 10.0
"""Half-width of a bell, px, at least: twenty tracers under it at the usual seeding."""
SEARCH = 3
"""Pixels, of the picture it looks at, that a pass after the first looks for beyond its prediction."""
COARSE = 32
"""Windows of this many px and more are correlated at half the resolution: a fraction of the work, and exact enough."""


def _coarse(
    pairs: Iterable[tuple[Ready, Ready]], size: tuple[int, int], settings: Settings
) -> tuple[Grid, Array, Array]:
    """The first pass, at half the resolution: whole-pixel displacements as far as ``search``."""
    window = min(max(FIRST, settings.window), min(size) // 2 * 2)
    grid = Grid(size, window, max(2, window // 4 * 2))
    found = correlation_pass(pairs, grid, settings.search, None, halved=True)
    good = found.value > 0.5 * settings.least_correlation
    good &= residual(found.u, found.v, good, 0.5) < 2 * THRESHOLD
    return grid, *filled(found.u, found.v, good)


def _fluid(grid: Grid, masks: Sequence[Flags | None]) -> Flags:
    """Whether the pixel of a vector is fluid, in both pictures."""
    found = np.ones(grid.shape, bool)
    for mask in masks:
        if mask is not None:
            found &= ~mask[np.ix_(grid.y.astype(int), grid.x.astype(int))]
    return found


def _cut(grid: Grid, fluid: Flags, masks: Sequence[Flags | None], reach: int) -> NDArray[np.int64]:
    """Row and column (n, 2) of the vectors of the fluid with a solid within ``reach`` px."""
    known = [mask.astype(np.uint8) for mask in masks if mask is not None]
    if not known:
        return np.empty((0, 2), np.int64)
    near = cv2.dilate(np.maximum.reduce(known), np.ones((2 * reach + 1,) * 2, np.uint8)) > 0
    return np.argwhere(near[np.ix_(grid.y.astype(int), grid.x.astype(int))] & fluid)


CLEAR = 1.2
"""Ratio of the first to the second peak from which a correlation is believed before neighbours are."""
REFINED = 2 * THRESHOLD
"""Bound of the median test on refined vectors: where the flow bends within a grid step good ones exceed the common
one.
"""


def _outliers(u: Array, v: Array, correction_u: Array, correction_v: Array, use: Flags, bound: float) -> Flags:
    """Vectors that are outliers in the total and in the correction: either alone condemns good ones in strong
    gradients.
    """
    total = residual(u, v, use) > bound
    return total & (residual(correction_u, correction_v, use) > bound) if total.any() else total


LARGEST = 1.0
"""Most that one update may move a vector, px: beyond it the linearisation means nothing."""


def _updated(
    u: Array, v: Array, fluid: Flags, start_u: Array, start_v: Array, update: Updated, settings: Settings
) -> tuple[Array, Array, Flags]:
    """Add an update, validate, replace."""
    length = np.hypot(update.u, update.v)
    good = fluid & np.isfinite(length) & _alike(update.correlation, fluid, settings.least_correlation)
    short = np.where(good, np.minimum(1.0, LARGEST / np.maximum(length, 1e-12)), 0.0)
    u, v = u + short * np.where(good, update.u, 0.0), v + short * np.where(good, update.v, 0.0)
    good &= ~_outliers(u, v, u - start_u, v - start_v, good, REFINED)
    u, v = filled(u, v, good)
    return u, v, good


def _alike(correlation: Array, fluid: Flags, least: float) -> Flags:
    """Whether pictures are alike at each vector and around it: few pixels may match by chance, not all around too."""
    own = np.where(fluid & np.isfinite(correlation), correlation, 0.0)
    around = np.where(fluid, own, np.median(own[fluid]) if fluid.any() else 0.0)
    return np.asarray((own > least) & (median_filter(around, 5, mode="nearest") > least), bool)


def _vectors(grid: Grid, u: Array, v: Array, good: Flags, fluid: Flags, update: Updated, ratio: Array) -> Vectors:
    """The outcome; solids carry zeros."""
    spread = np.sqrt(0.5 * (update.error_u**2 + update.error_v**2))
    known = good & np.isfinite(spread)
    return Vectors(
        grid.x,
        grid.y,
        np.where(fluid, u, 0.0),
        np.where(fluid, v, 0.0),
        known,
        fluid & ~known & known.any(),
        ~fluid,
        np.where(fluid, np.nan_to_num(update.correlation), 0.0),
        np.where(fluid, ratio, 0.0),
        np.where(known, spread, np.inf),
    )
