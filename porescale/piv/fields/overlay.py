"""A film of the measured pictures with their arrows on them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.pictures.film import write_film
from porescale.piv.fields.field import Field
from porescale.piv.fields.of_run import fields_of_film
from porescale.piv.images.film import Film

COLOURS = {"valid": (255, 213, 74), "replaced": (217, 95, 2)}
"""RGB colours of the arrows, by kind of vector."""
APART = 16
"""Pixels between arrows, at least."""
RATE = 10
"""Frames a second."""
SHIFT = 4
"""OpenCV coordinates in sixteenths of a pixel."""


def overlay_film(folder: Path, film: Film, span: tuple[float, ...]) -> Path:
    """Write overlay.mp4 into ``folder``, whose piv.vtkhdf has a field for each pair of ``film``; gives its path.

    span : left, right, bottom, top of the pictures in the fields' units.  Arrows have one
    length a speed, the first field's fastest (98 %) somewhat longer than two arrows are apart.
    """

    def painted() -> Iterator[NDArray[Any]]:
        """Pictures with the arrows of their fields."""
        fast = 0.0
        for image, field in zip(film, fields_of_film(folder), strict=False):
            if fast <= 0:
                speed = np.hypot(field.u, field.v)[field.valid]
                fast = float(np.percentile(speed, 98)) if speed.size else 0.0
            yield painting(image, field, span, fast)

    return write_film(folder / "overlay", painted(), RATE)


def painting(image: NDArray[Any], field: Field, span: tuple[float, ...], fast: float) -> NDArray[np.uint8]:
    """A picture (rows, columns) with arrows, RGB with even sides."""
    left, right, bottom, top = span
    rows, columns = image.shape
    high = float(np.percentile(image, 99.5)) or 1.0
    grey = np.clip(image * (200.0 / high), 0, 255).astype(np.uint8)
    drawn = np.repeat(grey[..., None], 3, 2)
    step = abs(field.x[1] - field.x[0]) * columns / abs(right - left) if len(field.x) > 1 else APART
    thin = max(1, int(np.ceil(APART / step)))
    longest = 1.4 * thin * step / fast if fast > 0 else 0.0
    sign = (1 if right > left else -1, -1 if field.upwards else 1)
    x = (field.x - left) / (right - left) * columns - 0.5
    y = (field.y - top) / (bottom - top) * rows - 0.5
    for name, colour in COLOURS.items():
        flags = getattr(field, name)
        for j in range(thin // 2, len(y), thin):
            for i in range(thin // 2, len(x), thin):
                if flags[j, i]:
                    tip = (x[i] + sign[0] * longest * field.u[j, i], y[j] + sign[1] * longest * field.v[j, i])
                    ends = [tuple(round(16 * float(value)) for value in end) for end in ((x[i], y[j]), tip)]
                    _arrow(drawn, ends[0], ends[1], colour)
    return np.ascontiguousarray(drawn[: rows // 2 * 2, : columns // 2 * 2])


def _arrow(image: NDArray[np.uint8], start: Any, tip: Any, colour: tuple[int, int, int]) -> None:
    """A line with a head, ends in sixteenths of a pixel."""
    cv2.line(image, start, tip, colour, 1, cv2.LINE_AA, SHIFT)
    along = np.array(tip, float) - np.array(start, float)
    across = np.array([-along[1], along[0]])
    for side in (0.15, -0.15):
        barb = np.rint(np.array(tip) - 0.3 * along + side * across).astype(int).tolist()
        cv2.line(image, tip, barb, colour, 1, cv2.LINE_AA, SHIFT)
