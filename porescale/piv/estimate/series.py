"""Fields from films: one for each pair of frames, or one from all pairs together."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Flags, Singles
from porescale.common.record.model import Grid
from porescale.piv.estimate.measure import Settings, Vectors, check_pictures, measure, measure_ready, nothing, unseen
from porescale.piv.images.film import Film, background
from porescale.piv.images.masks import masks
from porescale.piv.images.prepare import Ready, ready


@dataclass(frozen=True)
class Shots:
    """Pictures with what is done to them before they are measured.

    mask : None, a file, "bright" or "dark", or an array (rows, columns), True in solids;  polygons : "x,y x,y …";
    background : "none", "mean" or "least".
    """

    film: Film
    mask: str | Flags | None = None
    polygons: tuple[str, ...] = ()
    background: str = "none"

    def frames(self) -> Iterator[tuple[NDArray[Any], Flags | None]]:
        """Each frame less the background, and where it is solid."""
        still = self._still
        for frame, mask in zip(self.film, masks(self.mask, list(self.polygons), self.film), strict=False):
            yield (frame if still is None else frame.astype(np.float32) - still), mask

    @cached_property
    def _still(self) -> Singles | None:
        """The background of the film, computed once; None without one."""
        return background(self.film, self.background)

    def pairs(self) -> Iterator[tuple[tuple[NDArray[Any], Flags | None], tuple[NDArray[Any], Flags | None]]]:
        """Pairs of each frame with the next, with their masks."""
        return pairwise(self.frames())


def measured(shots: Shots, settings: Settings, warn: Callable[[str], object] | None = None) -> Iterator[Vectors]:
    """A field for each pair of frames, one pair in memory at a time.  InputError where a pair cannot be measured.

    warn : called for pairs that show nothing, whose vectors are all invalid then; without it they are an error too.
    """
    count = 0
    for (first, mask_a), (second, mask_b) in shots.pairs():
        count += 1
        settings.check((first.shape[0], first.shape[1]))
        fault = None if warn is None else unseen((first, second), (mask_a, mask_b))
        if warn is not None and fault is not None:
            number = shots.film.start + (count - 1) * shots.film.step
            warn(f"frames {number} and {number + shots.film.step}: {InputError(fault)}; none of their vectors is valid")
            yield nothing((first.shape[0], first.shape[1]), (mask_a, mask_b), settings)
            continue
        empty = np.zeros(first.shape, bool)
        solid = None if mask_a is None and mask_b is None else (_or(mask_a, empty), _or(mask_b, empty))
        yield measure(first, second, solid, settings)
    if not count:
        raise InputError(Fault("film", None, "fewer than two frames chosen", repair="widen --start, --end, --step"))


def averaged(shots: Shots, settings: Settings, passed: Callable[[], object] | None = None) -> Vectors:
    """One field from all pairs of a steady flow: their correlations and equations are summed, not their vectors.

    Gone through once for every pass, one pair in memory at a time; solid is what is solid in every frame.  passed :
    called for every pair in every pass.
    """
    pairs = _Prepared(shots, settings, passed or (lambda: None))
    size, solid = None, None
    for (first, mask_a), (second, mask_b) in shots.pairs():
        check_pictures(first, second, (mask_a, mask_b), settings)
        size = (first.shape[0], first.shape[1])
        both = _or(mask_a, np.zeros(size, bool)) & _or(mask_b, np.zeros(size, bool))
        solid = both if solid is None else solid & both
    if size is None:
        raise InputError(Fault("film", None, "fewer than two frames chosen", repair="widen --start, --end, --step"))
    return measure_ready(pairs, size, (solid,), settings)


@dataclass(frozen=True)
class _Prepared:
    """Prepared pairs, made anew each time they are gone through: memory does not grow with the film."""

    shots: Shots
    settings: Settings
    passed: Callable[[], object]

    def __iter__(self) -> Iterator[tuple[Ready, Ready]]:
        reach = 2 * max(16, self.settings.window)
        for pair in pairwise(ready(picture, mask, reach) for picture, mask in self.shots.frames()):
            self.passed()
            yield pair


def _or(mask: Flags | None, empty: Flags) -> Flags:
    return empty if mask is None else mask


def as_grid(field: Any) -> Grid:
    """A :class:`Field` as cells around its vectors, row 0 lowest, for VTKHDF; pixels keep y down as -y.

    Solids carry zeros and the flag.
    """
    x, y = field.x, field.y if field.upwards else -field.y
    order = slice(None) if len(y) < 2 or y[1] > y[0] else slice(None, None, -1)
    dx, dy = (abs(float(it[1] - it[0])) if len(it) > 1 else 1.0 for it in (x, y))
    sign = 1.0 if field.upwards else -1.0
    zero = np.zeros_like(field.u)
    velocity = np.stack([np.nan_to_num(field.u), sign * np.nan_to_num(field.v), zero], -1)[order]
    flags = {name: getattr(field, name)[order].astype(np.uint8) for name in ("valid", "replaced", "solid")}
    numbers = {
        "correlation": np.nan_to_num(field.correlation)[order],
        "uncertainty": np.where(np.isfinite(field.uncertainty), field.uncertainty, 0.0)[order],
        "vorticity": np.nan_to_num(field.vorticity())[order],
    }
    speed = "m/s" if field.upwards else "px"
    units = {"velocity": speed, "uncertainty": speed, "vorticity": "1/s" if field.upwards else "1"}
    return Grid(
        (float(x[0]) - dx / 2, float(y.min()) - dy / 2), (dx, dy), {"velocity": velocity, **numbers, **flags}, units
    )


def corner(film: Film) -> tuple[int, int]:
    """Column and row of the first pixel of the film's region."""
    return (film.region[0], film.region[1]) if film.region else (0, 0)


def whole_size(film: Film) -> tuple[int, int]:
    """Rows and columns of the whole picture, region or not."""
    for frame in replace(film, region=None):
        return int(frame.shape[0]), int(frame.shape[1])
    raise InputError(Fault("film", None, "no frames chosen", repair="widen --start, --end"))
