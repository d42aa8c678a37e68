"""Displacements between two pictures, or from many pairs of one steady flow."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import threads
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range
from porescale.common.core.types import Flags, Floats
from porescale.piv import given
from porescale.piv.estimate.fit import Equations, at_places, equations, solved, variances
from porescale.piv.estimate.grid import Grid, nearest
from porescale.piv.estimate.outliers import THRESHOLD, filled, residual
from porescale.piv.estimate.passes import correlation_pass, paths
from porescale.piv.estimate.rims import Rims, rims
from porescale.piv.estimate.smoothing import smoothed
from porescale.piv.images.prepare import Ready, ready

SMALLEST = 4
"""Side of windows, and of pictures, px, at least."""


@dataclass(frozen=True)
class Settings:
    """How to measure.

    window : px, of the last pass, even, 4 to the smaller side of the pictures;  overlap : of neighbouring windows, 0 to
    below 1;  search : px, largest displacement that the first pass looks for;  updates : Gauss-Newton updates after the
    last correlation, at most;  stiffness : weight of second derivatives in them, over that of the pictures, in knots'
    distances;  noise, slack : residuals from which a pixel counts for less, over the pictures' noise, and in px of
    displacement;  curved : paths bend as in a steady flow;  smooth : by cross-validation at the end;  no_slip : the
    flow stands still at the rims of solids that both pictures have at one place;  least_correlation : below it, alone
    or in the median around, a vector is invalid.
    """

    window: int = 16
    overlap: float = 0.5
    search: int = 16
    updates: int = 5
    stiffness: float = 0.001
    noise: float = 2.0
    slack: float = 0.2
    curved: bool = True
    smooth: bool = True
    no_slip: bool = False
    least_correlation: float = 0.3

    def check(self, size: tuple[int, int]) -> None:
        """Raises InputError for what cannot be measured on pictures of ``size`` (rows, columns)."""
        most = min(size)
        if most < SMALLEST:
            sides = " x ".join(map(str, size[::-1]))
            raise InputError(Fault("pictures", sides, "are too small", "px", f"{SMALLEST} a side and more"))
        faults = given.within("--window", self.window, Range("px", ge=SMALLEST, le=most, whole=True))
        if given.is_whole(self.window) and (faults or self.window % 2):
            allowed = f"even, {SMALLEST} to {most}"
            faults = [Fault("--window", self.window, "is not a window of these pictures", "px", allowed)]
        faults += given.within("--overlap", self.overlap, Range(ge=0, lt=1))
        faults += given.within("--search", self.search, Range("px", ge=1, le=256, whole=True))
        given.refuse(faults, given.within("updates", self.updates, Range(ge=1, whole=True)))

    @property
    def firm(self) -> float:
        """Stiffness of the fit: never less than ``stiffness`` has at FEW px between knots, whatever their distance."""
        return self.stiffness * max(1.0, (FEW / self.knots) ** 4)

    @property
    def knots(self) -> int:
        """Pixels between the knots of the splines: half a window, whatever the overlap."""
        return max(2, self.window // 2)

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

    x: Floats
    y: Floats
    u: Floats
    v: Floats
    valid: Flags
    replaced: Flags
    solid: Flags
    correlation: Floats
    peak_ratio: Floats
    uncertainty: Floats


FEW = 8
"""px between knots below which fewer than three tracers, at the usual seeding, determine a knot."""
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
    if len(masks) != 2:
        raise InputError(Fault("solid", f"{len(masks)} masks", "are not one for each of two pictures"))
    check_pictures(first, second, masks, settings)
    reach = 2 * max(16, settings.window)
    pair = ready(first, masks[0], reach), ready(second, masks[1], reach)
    return measure_ready([pair], (first.shape[0], first.shape[1]), masks, settings)


def check_pictures(
    first: NDArray[Any], second: NDArray[Any], masks: Sequence[Flags | None], settings: Settings
) -> None:
    """Raise InputError for what is no grey picture or mask, sizes that differ, masks that do not fit, and pictures that
    show nothing (``unseen``).
    """
    one_each = masks[:1] if masks[0] is masks[1] else masks
    pictures = given.grey("pictures", first, "first: "), given.grey("pictures", second, "second: ")
    given.refuse(*pictures, *(given.flags("--mask", it) for it in one_each))
    if first.shape != second.shape:
        sizes = " and ".join("x".join(str(side) for side in it.shape[1::-1]) for it in (first, second))
        raise InputError(Fault("pictures", sizes, "are not of one size"))
    settings.check((first.shape[0], first.shape[1]))
    for picture, mask in zip((first, second), masks, strict=True):
        if mask is not None and mask.shape != picture.shape:
            sizes = " and ".join("x".join(str(side) for side in it.shape[::-1]) for it in (mask, picture))
            raise InputError(Fault("--mask", sizes, "the bitmap is not of the pictures' size"))
    fault = unseen((first, second), masks)
    if fault is not None:
        raise InputError(fault)


SATURATED = 0.5
"""Share of the fluid's pixels at the top of their range from which a picture is overexposed."""


def unseen(pictures: Sequence[NDArray[Any]], masks: Sequence[Flags | None]) -> Fault | None:
    """Why pictures show no flow: a mask over all, no contrast, overexposed; None where they may show one."""
    for picture, mask in zip(pictures, masks, strict=True):
        if mask is not None and mask.all():
            return Fault("--mask", None, "covers the whole picture", repair="solid is white, fluid black")
        seen = picture if mask is None else picture[~mask]
        if float(seen.max()) - float(seen.min()) <= 0:
            return Fault("pictures", None, f"no tracers: every pixel of the fluid is {seen.flat[0]}")
        if seen.dtype.kind == "u":
            share = float(np.mean(seen == np.iinfo(seen.dtype).max))
            if share > SATURATED:
                words = f"overexposed: {100 * share:.0f} % of the fluid's pixels are white"
                return Fault("pictures", None, words, repair="less light, or a shorter exposure")
    return None


def nothing(size: tuple[int, int], masks: Sequence[Flags | None], settings: Settings) -> Vectors:
    """Vectors of pictures that show no flow: none valid, none replaced."""
    grid = Grid(size, settings.window, settings.step)
    fluid, zero, none = _fluid(grid, masks), np.zeros(grid.shape), np.zeros(grid.shape, bool)
    return Vectors(grid.x, grid.y, zero, zero, none, none, ~fluid, zero, zero, zero + np.inf)


def measure_ready(
    pairs: Iterable[tuple[Ready, Ready]], size: tuple[int, int], masks: Sequence[Flags | None], settings: Settings
) -> Vectors:
    """Displacements of prepared pairs of one steady flow, which are gone through once for every pass.

    size : rows, columns;  masks : solids, for the flag ``solid``.
    """
    if cv2.getNumThreads() != threads():
        cv2.setNumThreads(threads())  # OpenCV takes no more than the kernels do
    grid, u, v = _coarse(pairs, size, settings)
    last, known = settings.window, any(mask is not None for mask in masks)
    for window in _windows(settings.window, min(size)):
        new = Grid(size, window, settings.knots if window == last else window // 2)
        u, v = grid.at(new, u), grid.at(new, v)
        grid, fluid = new, _fluid(new, masks)
        halved = window >= (COARSE if known else FINE)
        along = paths(grid, grid.both(u, v), curved=False, every=2 if halved else 1)
        found = correlation_pass(pairs, grid, 2 * SEARCH if halved else SEARCH, along, halved=halved)
        good = fluid & (found.value > 0.5 * settings.least_correlation)
        lost = _outliers(u + found.u, v + found.v, found.u, found.v, good, THRESHOLD)
        u, v = filled(u + found.u, v + found.v, good & ~(lost & (found.ratio < CLEAR)))
    still = rims(grid, masks) if settings.no_slip else None
    fitted = _fitted(pairs, grid, grid.both(u, v), fluid, settings, still)
    return _vectors(fitted, Grid(size, window, settings.step), masks, found.ratio, settings)


class Fitted(NamedTuple):
    """A fitted field.  grid : of its knots;  c (2, m, n) : coefficients of u and v;  lost (ny, nx) : knots of the fluid
    that failed validation;  known : the part of the last update that the pictures determine.
    """

    grid: Grid
    c: NDArray[np.float32]
    lost: Flags
    known: Equations


def _fitted(
    pairs: Iterable[tuple[Ready, Ready]],
    grid: Grid,
    c: NDArray[np.float32],
    fluid: Flags,
    settings: Settings,
    still: Rims | None,
) -> Fitted:
    """Updates of all of the field at once, each validated and repaired."""
    start_u, start_v = (grid.values(it) for it in c)
    settled = False
    for number in range(settings.updates):
        last = number == settings.updates - 1 or (number >= len(EASED) - 1 and settled)
        along = paths(grid, c, curved=settings.curved, whole=not last)
        slack = settings.slack * (1.0 if last else EASED[min(number, len(EASED) - 1)])
        known = equations(pairs, along, settings.noise, slack, exact=last)
        update = np.clip(solved(grid, c, known, settings.firm, still), -LARGEST, LARGEST)
        c = c + update
        far = float(np.percentile(np.abs([grid.values(it) for it in update])[:, fluid], SHARE)) if fluid.any() else 0.0
        u, v = (grid.values(it) for it in c)
        match = at_places(known.correlation, grid.x, grid.y)
        good = fluid & _alike(match, fluid, settings.least_correlation)
        settled = not good.any() or far < SETTLED * math.sqrt(max(0.0, 1 - float(np.median(match[good]))))
        if (match[good] < DOUBT).any():
            good &= (match >= DOUBT) | ~_outliers(u, v, u - start_u, v - start_v, good, REFINED)
        if not good[fluid].all():
            whole_u, whole_v = filled(u, v, good)
            c = c + grid.both(np.where(fluid, whole_u - u, 0.0), np.where(fluid, whole_v - v, 0.0))
        if last:
            break
    return Fitted(grid, c, fluid & ~good, known)


SEARCH = 3
"""Pixels, of the picture it looks at, that a pass after the first looks for beyond its prediction."""
COARSE, FINE = 32, 16
"""Windows of this many px and more are correlated at half the resolution, a fraction of the work, and exact enough for
fits to begin with: with solids, whose rims half the resolution blurs, and without.
"""


def _windows(last: int, side: int) -> list[int]:
    """Sides of the windows of the passes after the first, px: halved to the last, wide last ones twice."""
    found = [min(FIRST // 2, side // 2 * 2)]
    while found[-1] > last:
        found.append(max(last, found[-1] // 2))
    found = [max(last, it) for it in found]
    return [*found, last] if last >= COARSE else found


def _coarse(
    pairs: Iterable[tuple[Ready, Ready]], size: tuple[int, int], settings: Settings
) -> tuple[Grid, Floats, Floats]:
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


SAMPLER = 0.001
"""px: rms of what the interpolator misplaces where the fraction of a pixel varies; three to four times that (rows of
sub-pixel bias) where it is one and the same everywhere.
"""
CLEAR = 1.2
"""Ratio of the first to the second peak from which a correlation is believed before neighbours are."""
REFINED = 2 * THRESHOLD
"""Bound of the median test on refined vectors: where the flow bends within a grid step good ones exceed the common
one.
"""


def _outliers(u: Floats, v: Floats, correction_u: Floats, correction_v: Floats, use: Flags, bound: float) -> Flags:
    """Vectors that are outliers in the total and in the correction: either alone condemns good ones in strong
    gradients.
    """
    total = residual(u, v, use) > bound
    return total & (residual(correction_u, correction_v, use) > bound) if total.any() else total


LARGEST = 2.0
"""Most that one update may move a coefficient, px: beyond it the linearisation means nothing."""
EASED = (5.0, 2.0, 1.0)
"""Factors of the slack in the first updates: first guesses are further off."""
SETTLED, SHARE = 0.3, 99.0
"""An update that moves so many per cent of the vectors by less than SETTLED sqrt(1 - correlation) px is followed by the
last: each leaves a quarter of the one before, and the better pictures match the more of it can be had.
"""
DOUBT = 0.6
"""Correlation from which a fitted vector is believed whatever its neighbours are."""


def _alike(correlation: Floats, fluid: Flags, least: float) -> Flags:
    """Whether pictures are alike at each vector and around it: few pixels may match by chance, not all around too."""
    own = np.where(fluid & np.isfinite(correlation), correlation, 0.0)
    around = np.where(fluid, own, np.median(own[fluid]) if fluid.any() else 0.0)
    return np.asarray((own > least) & (cv2.medianBlur(around.astype(np.float32), 5) > least), bool)


def _vectors(fitted: Fitted, grid: Grid, masks: Sequence[Flags | None], ratio: Floats, settings: Settings) -> Vectors:
    """The outcome on the chosen grid; solids carry zeros."""
    knots, known = fitted.grid, fitted.known
    u, v = (knots.values(it) for it in fitted.c)
    alike = max(1.0, FEW / knots.step)
    smooth = smoothed(u, v, knots.step, settings.firm, alike, choose=settings.smooth)
    fluid = _fluid(grid, masks)
    near = np.ix_(*(nearest(own, other) for own, other in ((knots.y, grid.y), (knots.x, grid.x))))
    match = at_places(known.correlation, grid.x, grid.y)
    good = fluid & ~fitted.lost[near] & (match > settings.least_correlation)
    u, v = (knots.through(grid, it) for it in (smooth.u, smooth.v))
    noise = smooth.noise * at_places(variances(known, smooth.freedom), grid.x, grid.y)
    bias = 0.5 * (smooth.bias_u**2 + smooth.bias_v**2)
    spread = np.sqrt(noise + bias[near] + SAMPLER**2)
    valid = good & np.isfinite(spread)
    return Vectors(
        grid.x,
        grid.y,
        np.where(fluid, u, 0.0),
        np.where(fluid, v, 0.0),
        valid,
        fluid & ~valid & valid.any(),
        ~fluid,
        np.where(fluid, match, 0.0),
        np.where(fluid, ratio[near], 0.0),
        np.where(valid, spread, np.inf),
    )
