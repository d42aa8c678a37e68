"""What to try where too few vectors are valid: reasons that the pictures themselves show, with their numbers."""

from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Flags, Floats
from porescale.piv.estimate.measure import FIRST, Settings
from porescale.piv.fields.field import Field

FEW_VALID = 0.7
"""Share of the fluid's vectors that shall be valid."""
TILE = 128
"""px: side of the parts whose displacement is measured whatever was looked for."""
CLEAR_PEAK = 6.0
"""Deviations of a tile's correlation that its peak must exceed: of TILE^2 places the largest by chance is 4.0."""
TRACERS = 7.0
"""Tracers that a window needs (Keane & Adrian 1992, Appl. Sci. Res. 49, 191)."""
LOST = 0.5
"""Share of tracers without a partner from which synthetic pairs lose vectors (0.6: a fifth; 0.7: two thirds)."""
SPREAD = 0.1
"""Difference of displacements across a window, over its side, from which no shift of it fits (Keane & Adrian: 0.03 to
0.05 for one that is not deformed; ours is).
"""
FAINT = 0.1
"""Share of the contrast from which a spot is a tracer."""
CHANCE = 0.05
"""Share of vectors that are valid by chance: none of them tells a displacement."""
BARE = 0.25
"""Share of the mean seeding below which a window is bare."""


@dataclass(frozen=True)
class Pair:
    """A measured pair.  first, second (rows, columns) : grey, as measured;  solid (rows, columns) : in either;  field :
    on it, in its pixels, y down;  rejected (rows, columns) : where a person took vectors out.
    """

    first: NDArray[Any]
    second: NDArray[Any]
    solid: Flags
    field: Field
    rejected: Flags


def advice(pair: Pair, settings: Settings) -> list[str]:
    """Reasons for invalid vectors with what to try, the strongest first; empty where the pictures show none."""
    field = pair.field
    if pair.solid.all() or field.solid.all():
        return []
    tiles = _moved(pair)
    moved = float(np.hypot(*tiles.T).max(initial=0.0))
    one, two = (spots(it, pair.solid) for it in (pair.first, pair.second))
    fluid = max(1, int((~pair.solid).sum()))
    seeded = float(one.sum()) / fluid
    bad = ~field.valid & ~field.solid
    near = seeding(one, field, settings)
    bare = bad & (near < BARE * seeded)
    found = []
    if moved > settings.search:
        found.append(
            f"displacements reach {moved:.0f} px, and --search {settings.search} looks no further: give --search"
            f" {2 ** int(np.ceil(np.log2(1.2 * moved)))}, or pictures {moved / settings.search:.1f} times closer in"
            " time"
        )
    elif moved > FIRST / 4:
        found.append(
            f"displacements reach {moved:.0f} px, over a quarter of the first window ({FIRST} px): take pictures"
            f" {4 * moved / FIRST:.1f} times closer in time"
        )
    if bare.sum() > 0.3 * bad.sum():
        found.append(
            f"{100 * bare.sum() / bad.sum():.0f} % of the invalid vectors lie where there are hardly any tracers: if"
            " these are solids give --mask (a bitmap, bright or dark) or --polygon, else seed there"
        )
    seeded = float(np.median(near[~field.solid & (near >= BARE * seeded)]))
    within = seeded * settings.window**2
    if within < TRACERS:
        side = 2 ** int(np.ceil(np.log2(np.sqrt(TRACERS / max(seeded, 1e-9)))))
        larger = f"give --window {side}, or " if side <= min(FIRST, min(pair.first.shape) // 2) else ""
        found.append(f"{within:.1f} tracers in a window of {settings.window} px, {TRACERS:g} needed: {larger}seed more")
    if field.valid.sum() < CHANCE * (~field.solid).sum():  # by the most common displacement, if there is one
        middle = np.median(tiles, 0) if len(tiles) else np.zeros(2)
        shifted = replace(
            field, u=np.full(field.u.shape, middle[0]), v=np.full(field.u.shape, middle[1]), valid=~field.solid
        )
        lost = _lost(one, two, shifted)
    else:
        lost = _lost(one, two, field)
    if lost > LOST:
        found.append(
            f"{100 * lost:.0f} % of the tracers are not met where the displacement takes them: take pictures closer in"
            " time, with a thicker light sheet and more light; and see that the two are of one film"
        )
    spread = _spread(field)
    if spread > SPREAD:
        found.append(
            f"displacements differ by {100 * spread:.0f} % of a window across it: take pictures"
            f" {spread / SPREAD:.1f} times closer in time"
        )
    return found


def _moved(pair: Pair) -> Floats:
    """Displacements (n, 2), px, up to half a tile, of the tiles whose correlation has one clear peak."""
    rows, columns = pair.first.shape
    side, found = min(TILE, rows, columns), []
    for top in range(0, rows - side + 1, side):
        for left in range(0, columns - side + 1, side):
            part = np.s_[top : top + side, left : left + side]
            free = ~pair.solid[part]
            if free.mean() < 0.5:
                continue
            one, two = (np.where(free, it[part] - it[part][free].mean(), 0.0) for it in (pair.first, pair.second))
            plane = np.fft.irfft2(np.conj(np.fft.rfft2(one)) * np.fft.rfft2(two), (side, side))
            down, across = divmod(int(plane.argmax()), side)
            if plane[down, across] - plane.mean() > CLEAR_PEAK * plane.std() > 0:
                found.append([it - side if it > side // 2 else it for it in (across, down)])
    return np.array(found, float).reshape(-1, 2)


def spots(picture: NDArray[Any], solid: Flags) -> Flags:
    """Places of tracers: peaks of 3 x 3 px that stand out of the dark around them by FAINT of the picture's contrast.

    Of dense seeding only those that do not touch are counted, half of 0.05 a pixel of 2.8 px.
    """
    grey = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), 0.7)
    low, high = np.percentile(grey[~solid], [5, 99.9])
    ground = cv2.erode(grey, np.ones((9, 9), np.uint8))
    peak = (grey >= cv2.dilate(grey, np.ones((3, 3), np.uint8))) & (grey - ground > max(FAINT * (high - low), 1e-6))
    return np.asarray(peak & ~solid, bool)


def seeding(spots: Flags, field: Field, settings: Settings) -> Floats:
    """Tracers a pixel around each vector (ny, nx), over two windows."""
    side = 2 * settings.window + 1
    near = cv2.blur(spots.astype(np.float32), (side, side), borderType=cv2.BORDER_REFLECT)
    columns, rows = (
        np.clip(it.astype(int), 0, size - 1) for it, size in ((field.x, near.shape[1]), (field.y, near.shape[0]))
    )
    return np.asarray(near[np.ix_(rows, columns)], float)


def _lost(one: Flags, two: Flags, field: Field) -> float:
    """Share of the tracers of the first picture that have none in the second within 1.5 px of where they should be.

    Only around valid vectors, by their displacement; less the share that has one there by chance.
    """
    rows, columns = one.shape
    y, x = np.nonzero(one)
    if not field.valid.any() or not len(x):
        return 0.0
    j, i = (np.abs(np.subtract.outer(at, grid)).argmin(1) for at, grid in ((y, field.y), (x, field.x)))
    to_x, to_y = np.rint(x + np.nan_to_num(field.u)[j, i]), np.rint(y + np.nan_to_num(field.v)[j, i])
    use = field.valid[j, i] & (to_x >= 0) & (to_y >= 0) & (to_x < columns) & (to_y < rows)
    near = cv2.dilate(two.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    if not use.any():
        return 0.0
    chance = float(near.mean())
    met = float(near[to_y[use].astype(int), to_x[use].astype(int)].mean())
    return 1 - max(0.0, met - chance) / max(1e-9, 1 - chance)


def _spread(field: Field) -> float:
    """Largest (95 %) slope of the displacement between valid neighbours, px a px."""
    slopes = [
        np.abs(np.diff(it, axis=k) / np.diff(at).reshape((-1, 1) if k == 0 else (1, -1)))[_both(field.valid, k)]
        for it in (field.u, field.v)
        for k, at in ((0, field.y), (1, field.x))
        if len(at) > 1
    ]
    every = np.concatenate(slopes) if slopes else np.zeros(0)
    return float(np.percentile(every, 95)) if every.size else 0.0


def _both(valid: Flags, axis: int) -> Flags:
    """Whether both of neighbours along an axis are valid."""
    one, other = (valid[1:], valid[:-1]) if axis == 0 else (valid[:, 1:], valid[:, :-1])
    return np.asarray(one & other, bool)
