"""Circles read from files: a packing kept by an earlier run, a list, a picture."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import LARGEST, STILLS, reason, require_finite
from porescale.common.core.types import Floats
from porescale.common.neighbors.placement import part
from porescale.dem.prepare.compaction import read_circles, read_packing
from porescale.scene.circles import Circles


def grains_of(circles: Circles, folder: Path | None) -> list[dict[str, float | str]]:
    """The circles as entries of [[grains.grain]]; raises InputError with keys of [grains]."""
    path = (folder or Path()) / circles.file
    try:
        _require_readable(path)
        if path.suffix.lower() in STILLS:
            position, radius = _pictured(circles, path)
        elif path.suffix == ".h5":
            position, radius = read_packing(path)
            position = position + np.array([circles.left, circles.bottom])
        else:
            where = circles.left, circles.bottom
            position, radius = read_circles(path, circles.unit, circles.y, circles.image_height, where)
        if circles.part:
            position = part(position, radius)
    except InputError as error:
        raise InputError([replace(fault, key=f"circles.{fault.key}") for fault in error.faults]) from None
    return [
        {"x": x, "y": y, "diameter": 2.0 * r, "material": circles.material}
        for (x, y), r in zip(position.tolist(), radius.tolist(), strict=True)
    ]


def _require_readable(path: Path) -> None:
    """InputError for what cannot be read, or what reading would not end of."""
    try:
        require_finite(path, LARGEST)
    except (OSError, ValueError) as error:  # ValueError: a null in the name
        problem = f"cannot be read ({reason(error)})"
        raise InputError(Fault("file", str(path), problem, repair="check the name")) from None


def _pictured(circles: Circles, path: Path) -> tuple[Floats, Floats]:
    """Places (n, 2) m and radii (n,) m of the discs of a picture."""
    assert circles.pixel
    assert circles.smallest
    assert circles.largest
    from porescale.analysis.detect_circles import circles_in
    from porescale.piv.images.film import picture  # readers of pictures and films take a while to load

    seen = picture(path)
    sizes = circles.smallest / circles.pixel, circles.largest / circles.pixel
    at, radius = circles_in(seen.astype(np.float32), *sizes, light=circles.shade == "light")
    up = np.column_stack((at[:, 0], seen.shape[0] - at[:, 1]))
    return up * circles.pixel + np.array([circles.left, circles.bottom]), radius * circles.pixel
