"""Correlation passes over a pair, or over many pairs of one steady flow, on deformed pictures.

Both pictures are deformed by half the last estimate each (symmetric window deformation; Scarano 2002, Meas. Sci.
Technol. 13, R1), so that what is left to measure is small, and interpolation errs alike in both.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats, Singles
from porescale.piv.estimate.correlate import Layout, correlation, peaks
from porescale.piv.estimate.grid import Grid, spread
from porescale.piv.images.prepare import Ready

LEAST_WINDOW = 16
"""Windows, px of the picture they are cut from, are correlated no smaller: fewer tracers match by chance."""


@dataclass(frozen=True)
class Correlated:
    """What a correlation pass found on its grid, each (ny, nx): px, height of the peak, ratio to the second."""

    u: Floats
    v: Floats
    value: Floats
    ratio: Floats


class Paths(NamedTuple):
    """Positions of each pixel at mid time in the first and in the second picture: x, y float32, px.

    reach : no path goes further than this, px.
    """

    first: tuple[Singles, Singles]
    second: tuple[Singles, Singles]
    reach: float


def paths(grid: Grid, coefficients: NDArray[Any], *, curved: bool, every: int = 1, whole: bool = True) -> Paths:
    """Half a displacement back and half forward from every pixel, along a parabola where ``curved``.

    coefficients (2, m, n) : of the splines of u and v;  every : pixels to one of a coarser picture, in whose pixels
    places are given then;  whole : places rather than displacements.  In a steady flow the mid-point between X(-1/2)
    and X(+1/2) lies (d . grad) d/8 off the material's place at mid time.
    """
    half = 0.5 * np.asarray(coefficients, float)
    bend = np.zeros_like(half)
    if curved and min(grid.shape) > 3:
        u, v = (grid.values(2 * it) for it in half)
        for k, (along_x, along_y) in enumerate((grid.slopes(u), grid.slopes(v))):
            bend[k] = grid.coefficients((u * along_x + v * along_y) / 8)
    down, across = grid.axes(every)
    own = np.zeros_like(half)
    if whole:  # B-splines add up to the place itself
        own[0], own[1] = across.at + 0.5 - 0.5 * every, (down.at + 0.5 - 0.5 * every)[:, None]
    rows, columns = (side // every for side in grid.size)  # as the coarser picture: what is left over goes
    back, forward = (
        [spread(it / every, down, across)[:rows, :columns] for it in own + bend + sign * half] for sign in (-1, 1)
    )
    return Paths((back[0], back[1]), (forward[0], forward[1]), float(np.abs(half).max() + np.abs(bend).max()))


def correlation_pass(
    pairs: Iterable[tuple[Ready, Ready]], grid: Grid, search: int, along: Paths | None, *, halved: bool
) -> Correlated:
    """Correlate windows of all pairs, deformed along ``along``, over ``search`` px; peaks of the sum of correlations.

    halved : at half the resolution, which ``along`` is given at then.
    """
    ny, nx = grid.shape
    part = 2 if halved else 1
    step = max(1, grid.step // part)
    search = -(-search // part)
    blocks = max(1, round(max(LEAST_WINDOW, grid.window / part) / step))
    size = blocks * step  # the window, to a whole number of blocks
    pad = search + size
    layout = Layout((ny, nx), step, blocks, pad + grid.start // part - size // 2, search)
    total = np.zeros((ny, nx, 2 * search + 1, 2 * search + 1), np.float32)
    for pair in pairs:
        arrays = []
        for number, one in enumerate(pair):
            grey, mask = (one.half_contrast, one.half_fluid) if halved else (one.contrast, one.fluid)
            if along is not None:
                at = along.first if number == 0 else along.second
                mask = moved(mask, at, cv2.INTER_NEAREST) if one.solid else mask
                grey = moved(grey, at, cv2.INTER_CUBIC) * mask
            arrays.append((_padded(grey, pad), _padded(mask, pad)))
        (a, ma), (b, mb) = arrays
        # Once pictures are deformed well, shifts are small and solids cut the same off both windows, where both are
        # zero: their own energies are those of the fluid that both show, to a rim of a pixel or two.
        masks = (ma, mb) if halved and (pair[0].solid or pair[1].solid) else None
        square: Any = b * b
        energy = np.asarray(cv2.boxFilter(square, cv2.CV_32F, (size, size), anchor=(0, 0), normalize=False), np.float32)
        total += correlation(layout, a, b, masks, energy)
    found = Correlated(*(np.empty((ny, nx)) for _ in range(4)))
    peaks(total, found.u, found.v, found.value, found.ratio)
    return Correlated(part * found.u, part * found.v, found.value, found.ratio)


def places(way: tuple[Singles, Singles]) -> tuple[Singles, Singles]:
    """Source position of each pixel, px, for OpenCV."""
    rows, columns = way[0].shape
    x, y = np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32)[:, None]
    return np.asarray(way[0] + x, np.float32), np.asarray(way[1] + y, np.float32)


def seen(one: Ready, at: tuple[Singles, Singles], reach: float) -> Singles:
    """1 where the picture shows fluid at places, none further than ``reach`` px from its pixel, else 0."""
    if one.solid:
        return moved(one.fluid, at, cv2.INTER_NEAREST)
    rows, columns = at[0].shape
    rim = 1 + int(np.ceil(reach))  # only from here a path leaves the picture
    found = np.ones((rows, columns), np.float32)
    for part in (np.s_[:rim], np.s_[max(0, rows - rim) :], np.s_[:, :rim], np.s_[:, max(0, columns - rim) :]):
        x, y = at[0][part], at[1][part]
        found[part] = (x >= -0.5) & (x <= columns - 0.5) & (y >= -0.5) & (y <= rows - 0.5)
    return found


def moved(image: Singles, at: tuple[Singles, Singles], how: int) -> Singles:
    """``image`` at places, zero outside."""
    found: Any = cv2.remap(image, at[0], at[1], how, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
    return np.asarray(found, np.float32)


def _padded(image: Singles, pad: int) -> Singles:
    """``image`` with a border of zeros."""
    return np.asarray(cv2.copyMakeBorder(image, pad, pad, pad, pad, cv2.BORDER_CONSTANT, value=0))
