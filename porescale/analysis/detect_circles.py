"""Circles in a laboratory's picture of discs: where they are and how large, to a fraction of a pixel.

1. Discs are parted from what lies between them by Otsu's threshold (1979, IEEE Trans. Syst. Man Cybern. 9, 62) of the
   picture less its slow changes of light.
2. Each peak of the distance to the background is a disc, as high as its radius: touching discs have a saddle between
   them.  Lower peaks within a disc that was taken are its own.
3. From there rays look for the steepest change of grey near the rim, found between pixels by a parabola; where a
   neighbour touches there is none, and the ray is left out.  The circle through what is left fits best in the sense of
   least squares (Kasa 1976, IEEE Trans. Instrum. Meas. 25, 8), with points far off it left out in turn.

Blur moves a steepest change inwards by its variance over twice the radius, nothing to the centre.
"""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats

Grey = NDArray[np.float32]
Mask = NDArray[np.bool_]

LIGHT = 4.0  # diameters of the largest disc over which light is taken to change slowly
PEAK = 0.75  # of its radius: how near the middle of a disc another peak is the same disc's
RAYS = 96
REACH = 0.35  # of the radius, on both sides of the rim, at least three pixels: where rays look
STEP = 0.25  # px along a ray
FAINT = 0.7  # of the median change of grey: less is no rim, or one that a neighbour's light shifts
DEEP = 0.3  # of the smaller radius: discs that lie further in each other are not both discs
FAR = 2.5  # times the median distance: points that are left out
FEWEST = 0.3  # share of rays that must end at a rim
WITHIN, WHOLE = 0.8, 0.97  # share of its radius within which this share of a disc is no background
ROUNDS = 6


def circles_in(picture: Grey, smallest: float, largest: float, *, light: bool = True) -> tuple[Floats, Floats]:
    """Centres (n, 2) and radii (n,) of discs in a picture (rows, columns), px; rows count from the top, the middle of
    the first pixel is at (0.5, 0.5).

    smallest, largest : diameters looked for, px;  light : discs are lighter than what is between them.
    Raises InputError where there is no disc.
    """
    grey = np.asarray(picture if light else -picture, np.float32)
    slow = cv2.GaussianBlur(grey, (0, 0), LIGHT * largest / 2.0, borderType=cv2.BORDER_REFLECT)
    even = cv2.GaussianBlur(grey - slow, (0, 0), 1.0)
    solid, peaks = _peaks(even, smallest / 2.0, largest / 2.0)
    fits = [_fitted(even, x, y, r) for x, y, r in peaks]
    found = [fit for fit in fits if fit is not None and _share_within(solid, *fit[:3]) > WHOLE]
    kept: list[tuple[float, float, float]] = []
    for x, y, r, _ in sorted(found, key=lambda it: -it[3] * it[2]):  # the most of a rim seen first
        into = [r + c - np.hypot(x - a, y - b) > DEEP * min(r, c) for a, b, c in kept]
        if smallest / 2.0 <= r <= largest / 2.0 and not any(into):
            kept.append((x, y, r))
    if not kept:
        allowed = f"diameters of {smallest:.3g} to {largest:.3g} pixels"
        raise InputError(Fault("file", None, "shows no disc", "", allowed, "check pixel, smallest, largest and shade"))
    kept.sort(key=lambda it: (it[1], it[0]))
    table = np.array(kept)
    return table[:, :2] + 0.5, table[:, 2]


def _peaks(even: Any, least: float, most: float) -> tuple[Mask, list[tuple[float, float, float]]]:
    """What is no background (rows, columns), and peaks of the distance to it: (column, row, distance) px, from the
    highest on."""
    scaled = cv2.normalize(even, np.zeros_like(even), 0, 255, cv2.NORM_MINMAX).astype(np.uint8)
    _, solid = cv2.threshold(scaled, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    framed = cv2.copyMakeBorder(solid, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    distance = cv2.distanceTransform(framed, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    distance = cv2.GaussianBlur(distance, (0, 0), 0.8)
    around = cv2.dilate(distance, np.ones((3, 3), np.uint8))
    rows, columns = np.nonzero((distance >= around) & (distance > 0.6 * least))
    order = np.argsort(-distance[rows, columns], kind="stable")
    taken: list[tuple[float, float, float]] = []
    at, size = np.zeros((len(order), 2)), np.zeros(len(order))
    for k in order:
        x, y, r = float(columns[k]), float(rows[k]), float(distance[rows[k], columns[k]])
        n = len(taken)
        if not (np.hypot(x - at[:n, 0], y - at[:n, 1]) < PEAK * size[:n]).any():
            at[n], size[n] = (x, y), min(r, most)
            taken.append((x, y, min(r, most)))
    return solid > 0, taken


def _fitted(even: Any, x: float, y: float, r: float) -> tuple[float, float, float, float] | None:
    """The circle through the rim around (x, y) px with a radius of about r, and the share of it that was seen; None
    where there is no rim."""
    angle = 2.0 * np.pi * np.arange(RAYS) / RAYS
    ways = np.column_stack((np.cos(angle), np.sin(angle)))
    for _ in range(ROUNDS):
        reach = max(REACH * r, 3.0)
        out = np.arange(max(r - reach, 0.5), r + reach, STEP)
        at = np.array([x, y]) + out[None, :, None] * ways[:, None, :]
        across: Any = at[..., 0].astype(np.float32)
        down: Any = at[..., 1].astype(np.float32)
        profile = np.asarray(cv2.remap(even, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE))
        inside = ((at >= 0.0) & (at <= np.array(even.shape[::-1]) - 1.0)).all(axis=2)
        fall = np.where(inside[:, 1:-1], profile[:, :-2] - profile[:, 2:], 0.0)
        best = fall[:, 1:-1].argmax(axis=1) + 1
        ray = np.arange(RAYS)
        before, here, after = (fall[ray, best + k].astype(float) for k in (-1, 0, 1))
        bend = before - 2.0 * here + after
        shift = np.where(bend < 0.0, 0.5 * (before - after) / np.where(bend < 0.0, bend, 1.0), 0.0)
        rim = out[best + 1] + STEP * np.clip(shift, -1.0, 1.0)
        sharp = here > FAINT * np.median(here[here > 0.0]) if (here > 0.0).any() else np.zeros(RAYS, bool)
        points = np.array([x, y]) + rim[:, None] * ways
        for _ in range(3):
            if sharp.sum() < FEWEST * RAYS:
                return None
            cx, cy, radius = _circle(points[sharp])
            off = np.abs(np.hypot(points[:, 0] - cx, points[:, 1] - cy) - radius)
            sharp &= off <= max(FAR * float(np.median(off[sharp])), 0.25)
        moved = float(np.hypot(cx - x, cy - y)) + abs(radius - r)
        x, y, r = cx, cy, radius
        if not (0.0 <= x < even.shape[1] and 0.0 <= y < even.shape[0]) or not r > 1.0:
            return None
        if moved < 1e-3:
            break
    return x, y, r, float(sharp.mean())


def _share_within(solid: Mask, x: float, y: float, r: float) -> float:
    """Share of ``solid`` in the middle of a circle, px."""
    reach = WITHIN * r
    rows = np.arange(max(int(y - reach), 0), min(int(y + reach) + 2, solid.shape[0]))
    columns = np.arange(max(int(x - reach), 0), min(int(x + reach) + 2, solid.shape[1]))
    inside = (rows[:, None] - y) ** 2 + (columns - x) ** 2 <= reach * reach
    return float(solid[np.ix_(rows, columns)][inside].mean()) if inside.any() else 0.0


def _circle(points: Floats) -> tuple[float, float, float]:
    """Centre and radius of the circle through points (n, 2) by linear least squares: x² + y² = 2 a x + 2 b y + c."""
    middle = points.mean(axis=0)
    u = points - middle
    (a, b, c), *_ = np.linalg.lstsq(np.column_stack((2.0 * u, np.ones(len(u)))), np.sum(u**2, axis=1), rcond=None)
    return float(middle[0] + a), float(middle[1] + b), float(np.sqrt(max(c + a * a + b * b, 0.0)))
