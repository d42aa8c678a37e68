"""The section of the water."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pydantic

from continuum_sph.scene.bounds import LARGEST, SMALLEST
from porescale.common.core.types import Floats
from porescale.common.schema.sections import Section, quantity


def stacked_top(start: Floats, reaches: Sequence[tuple[Floats, Floats]], slack: float) -> Floats:
    """Heights (n,) m from ``start`` (n,) up over pieces that stand on it or on each other without a gap wider than
    ``slack`` (m);  reaches : lowest and highest points (n,) m of each, in any order, inf and -inf where it is not."""
    top = start
    while True:
        before = top
        for low, high in reaches:
            top = np.where(low <= top + slack, np.maximum(top, high), top)
        if np.array_equal(top, before):
            return top


class Column(Section):
    """A rectangle of water at the start."""

    left: float = quantity("m", 0.0, ge=0, le=LARGEST, help="left edge of the water")
    bottom: float = quantity("m", 0.0, ge=0, le=LARGEST, help="lower edge of the water")
    width: float = quantity("m", ge=SMALLEST, le=LARGEST, help="width of the water")
    height: float = quantity("m", ge=SMALLEST, le=LARGEST, help="height of the water")

    def reach(self, x: Floats) -> tuple[Floats, Floats]:
        """Heights (m) of its lower and upper edge over each ``x`` (n,) m; inf and -inf where it is not."""
        over = (x > self.left) & (x < self.left + self.width)
        return np.where(over, self.bottom, np.inf), np.where(over, self.bottom + self.height, -np.inf)


class WaterSection(Section):
    """A weakly compressible liquid.

    pressure : at the start, "hydrostatic", that of fluids just let go ("released"), or "none"
    (density ρ0 everywhere, in pores, too, as in Maeda & Sakai 2004);  push : "face" gives the particles of the right
    face, where it is in the open, √(2g(H-y)) to the right, H the surface of all water on it, as in their figs 6 and 7.
    """

    density: float = quantity("kg/m^3", 1000.0, ge=1e-2, le=1e5, help="density under the pressure of the air")
    viscosity: float = quantity("Pa s", 1.002e-3, ge=0, le=1e9, help="viscosity")
    sound_speed: float | None = quantity(
        "m/s", None, ge=1e-3, le=1e6,
        help="speed of sound; left out 10 sqrt(2 g H), and with soil that moves K_w of at least ten times its n M",
    )  # fmt: skip
    exponent: float = quantity("", 7.0, ge=1.5, le=20, help="exponent of the equation of state")
    pressure: Literal["hydrostatic", "released", "none"] = pydantic.Field(
        default="hydrostatic", description="pressure at the start"
    )
    push: Literal["none", "face"] = pydantic.Field(
        default="none", description="whether the right face starts with a speed"
    )
    column: tuple[Column, ...] = pydantic.Field(default=(), description="rectangles of water")

    def surface_over(self, points: Floats, start: Floats, slack: float) -> Floats:
        """Height (n,) m of the surface of the water that stands over ``points`` (n, 2) m without a gap wider than
        ``slack`` (m): from heights ``start`` (n,) m up."""
        return stacked_top(start, [column.reach(points[:, 0]) for column in self.column], slack)
