"""Vectors that a person took out of a field, by the page of `--review` or in any program that paints."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Flags
from porescale.piv.estimate.measure import Vectors
from porescale.piv.estimate.outliers import filled
from porescale.piv.images.film import Film
from porescale.piv.images.masks import SEGMENTS, masks


def rejections(source: str | Flags | None, film: Film) -> Iterator[Flags | None]:
    """What to reject in every frame: True where the bitmap is white (masks.masks), None without one.

    InputError, under "--reject", for what is no bitmap of the pictures' size.
    """
    if isinstance(source, str) and source in SEGMENTS:
        raise InputError(Fault("--reject", source, "is no bitmap", repair="give one saved by the page of --review"))
    try:
        yield from masks(source, [], film)
    except InputError as error:
        named = [replace(it, key="--reject" if it.key == "--mask" else it.key) for it in error.faults]
        raise InputError(named) from None


def without(vectors: Vectors, reject: Flags | None) -> Vectors:
    """The vectors less those whose pixel is rejected: invalid, replaced by planes through the valid ones around.

    All others are as they were.
    """
    gone = picked(vectors.x, vectors.y, reject) & vectors.valid
    if not gone.any():
        return vectors
    valid = vectors.valid & ~gone
    u, v = filled(vectors.u, vectors.v, valid)
    return replace(
        vectors,
        u=np.where(gone, u, vectors.u),
        v=np.where(gone, v, vectors.v),
        valid=valid,
        replaced=(vectors.replaced | gone) & valid.any(),
        uncertainty=np.where(gone, np.inf, vectors.uncertainty),
    )


def picked(x: np.ndarray, y: np.ndarray, reject: Flags | None) -> Flags:
    """Whether the pixel of each place of a grid (ny, nx) is rejected."""
    if reject is None:
        return np.zeros((len(y), len(x)), bool)
    return np.asarray(reject[np.ix_(y.astype(int), x.astype(int))], bool)
