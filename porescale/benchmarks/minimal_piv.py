"""The smallest statement of a correlation pass: one window of two pictures, every shift by its definition.

It is what the manual shows and what tests hold the fast kernels against.  Left out: the deformation of the pictures by
the estimate so far, and the fit of splines to all pixels that follows.
"""

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Reals

Mask = NDArray[np.floating]
Corner = tuple[int, int]


def correlation_at(
    pictures: tuple[Reals, Reals], masks: tuple[Mask, Mask], corner: Corner, size: int, shift: Corner
) -> float:
    """R of one window and one shift (rows, columns), px: A and B less their local means, zero in solids; masks 1 where
    fluid.  ``corner``: first pixel (row, column) of the window;  ``size``: its side, px."""
    one = tuple(slice(at, at + size) for at in corner)
    two = tuple(slice(at + by, at + by + size) for at, by in zip(corner, shift, strict=True))
    a, b = pictures[0][one], pictures[1][two]
    fluid_a, fluid_b = masks[0][one], masks[1][two]
    return float((a * b).sum() / np.sqrt((a**2 * fluid_b).sum() * (b**2 * fluid_a).sum()))


def peak_offset(low: float, middle: float, high: float) -> float:
    """Place of the peak of a Gaussian through three values a pixel apart, px from the middle one."""
    low, middle, high = np.log([low, middle, high])
    return float(0.5 * (low - high) / (low - 2.0 * middle + high))


def displacement(
    pictures: tuple[Reals, Reals], masks: tuple[Mask, Mask], corner: Corner, size: int, search: int
) -> tuple[float, float]:
    """Displacement (u, v), px to the right and down, of what one window shows: the peak of R over shifts of less than
    ``search`` px."""
    shifts = range(-search, search + 1)
    found = np.array([[correlation_at(pictures, masks, corner, size, (y, x)) for x in shifts] for y in shifts])
    row, column = (it + 1 for it in divmod(int(found[1:-1, 1:-1].argmax()), 2 * search - 1))
    across, down = found[row, column - 1 : column + 2], found[row - 1 : row + 2, column]
    return column - search + peak_offset(*across), row - search + peak_offset(*down)
