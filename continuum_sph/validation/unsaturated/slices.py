"""Factor of safety of a slope on circles by slices: Bishop's simplified method, Geotechnique 5 (1955) 7.

    F = R Σ {c' b + (N_v - u b) tan φ'}/m_α / M,   m_α = cos α (1 + tan α tan φ'/F)

over slices of a breadth b whose base dips by α into the slope; R radius, N_v what stands on the base: the slice and the
open water on it; u pore pressure at the base, under suction χ p of Bishop's effective stress; M the moment about the
centre of all that drives: weights, and the pressure of open water on the ground, which acts across its surface.
Forces between slices are level.  Open water is at rest; soil weighs what it does with the water of its pores.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations

SLICES = 60
ENOUGH = 1e-10  # of F, by which the last iteration changes it
MOST = 200  # iterations
LEAST_PART = 0.2  # m_α of a slice: below it the base is so steep at the toe that the method has no answer


def at_rest(x: Floats, y: Floats) -> Floats:
    """No pore pressure, Pa, at (x, y) (k,) m."""
    return np.zeros_like(x)


@dataclass(frozen=True)
class Slope:
    """surface (k, 2) m : corners of the ground from left to right;  weight : γ of soil and its water, N/m³;
    cohesion : c', Pa;  friction : φ', rad;  pore : u (Pa) at (x, y) m;  water : level (m) of open water at x, or None;
    specific : ρ_w g, N/m³."""

    surface: Floats
    weight: float
    cohesion: float
    friction: float
    pore: Callable[[Floats, Floats], Floats] = at_rest
    water: Callable[[Floats], Floats] | None = None
    specific: float = 9806.65

    def top(self, x: Floats) -> Floats:
        """Height (m) of the ground at ``x`` (k,) m."""
        found: Floats = np.interp(x, self.surface[:, 0], self.surface[:, 1])
        return found


@dataclass(frozen=True)
class Circle:
    """Centre (x, y) and radius, m;  right : whether the soil above it slides to the right."""

    x: float
    y: float
    radius: float
    right: bool = True

    def base(self, x: Floats) -> Floats:
        """Its lower half at ``x`` (k,) m."""
        found: Floats = self.y - np.sqrt(np.maximum(0.0, self.radius**2 - (x - self.x) ** 2))
        return found

    def ends(self, slope: Slope) -> tuple[float, float] | None:
        """Where it goes into the ground and out of it (x, m), of the widest piece that it cuts; None without one."""
        low = max(self.x - self.radius, float(slope.surface[0, 0]))
        high = min(self.x + self.radius, float(slope.surface[-1, 0]))
        x = np.linspace(low, high, 2001)
        below = np.concatenate(([False], slope.top(x) > self.base(x), [False]))
        edges = np.flatnonzero(below[1:] != below[:-1])
        if not edges.size:
            return None
        pieces = edges.reshape(-1, 2)
        first, last = pieces[(pieces[:, 1] - pieces[:, 0]).argmax()]
        return (float(x[first]), float(x[last - 1])) if last - first > 2 else None


def factor(slope: Slope, circle: Circle, slices: int = SLICES) -> float:
    """F of a ``circle``; nan where it cuts no soil, or where bases are too steep, inf where nothing drives."""
    ends = circle.ends(slope)
    if ends is None:
        return math.nan
    edges = np.linspace(*ends, slices + 1)
    x, breadth = 0.5 * (edges[1:] + edges[:-1]), edges[1] - edges[0]
    ground, base, side = slope.top(x), circle.base(x), 1.0 if circle.right else -1.0
    sine = side * (circle.x - x) / circle.radius
    cosine = np.sqrt(1.0 - sine**2)
    soil = slope.weight * breadth * (ground - base)
    standing, moment = soil, circle.radius * float((soil * sine).sum())
    if slope.water is not None:
        pressure = slope.specific * np.maximum(0.0, slope.water(x) - ground)
        rise = (slope.top(edges[1:]) - slope.top(edges[:-1])) / breadth
        # (p dy/dx, -p) per breadth, across the surface, times (y_c - y, x - x_c), the velocity of a turn
        down = side * (circle.x - x) * pressure * breadth
        across = side * (circle.y - ground) * pressure * rise * breadth
        moment += float((down + across).sum())
        standing = soil + pressure * breadth
    if moment <= 0.0:
        return math.inf
    held = slope.cohesion * breadth + (standing - slope.pore(x, base) * breadth) * math.tan(slope.friction)
    found = 1.0
    for _ in range(MOST):
        part = cosine + sine * math.tan(slope.friction) / found
        if part.min() < LEAST_PART:
            return math.nan
        new = circle.radius * float((held / part).sum()) / moment
        if new <= 0.0:
            return 0.0
        if abs(new - found) < ENOUGH * found:
            return new
        found = new
    return math.nan


def least(
    slope: Slope, centres: Sequence[tuple[float, float]], depths: Sequence[float], *, right: bool = True,
    shallow: float = 0.0,
) -> tuple[float, Circle]:  # fmt: skip
    """(least F, its circle) of those about ``centres`` (x, y) m that reach down to ``depths`` (y, m).

    shallow : m, circles that nowhere cut deeper than this are left out.  ValueError where none has a factor.
    """
    best: tuple[float, Circle] | None = None
    for x, y in centres:
        for deep in depths:
            if deep >= y:
                continue
            circle = Circle(x, y, y - deep, right)
            ends = circle.ends(slope)
            if ends is None:
                continue
            at = np.linspace(*ends, SLICES)
            if float((slope.top(at) - circle.base(at)).max()) < shallow:
                continue
            found = factor(slope, circle)
            if math.isfinite(found) and (best is None or found < best[0]):
                best = found, circle
    if best is None:
        raise ValueError("no circle cuts the slope")
    return best


VALIDATIONS = Validations()
PUBLISHED = {0.0: 2.080, 0.25: 1.766}
"""Pore pressure over γ times the depth, and F: cases 1 and 3 of Fredlund & Krahn 1977, a slope 2 : 1 of 40 ft, c' 600
lb/ft², φ' 20°, γ 120 lb/ft³, a circle about (120, 90) of 80 ft, with the crest's edge at (60, 60)."""


@VALIDATIONS.row(
    "continuum.bishop_simplified",
    source="Fredlund & Krahn, Can. Geotech. J. 14 (1977) 429, cases 1 and 3, Bishop's simplified method",
    because="half a per cent: theirs are of slices by hand; other programs give 2.078 and 1.761, 0.1 and 0.3 % less",
    tolerance=0.005,
)
def published_row() -> Measured:
    """Factor of safety of a simple slope, dry and with a pore pressure of a quarter of the weight above."""
    ground = np.array([[0.0, 60.0], [60.0, 60.0], [140.0, 20.0], [250.0, 20.0]])
    found = []
    for share in PUBLISHED:

        def pore(x: Floats, y: Floats, share: float = share) -> Floats:
            """u (lb/ft²) at (x, y) ft."""
            return np.asarray(share * 120.0 * (np.interp(x, ground[:, 0], ground[:, 1]) - y))

        found.append(factor(Slope(ground, 120.0, 600.0, math.radians(20.0), pore), Circle(120.0, 90.0, 80.0), 400))
    return Measured.relative(list(PUBLISHED.values()), found)
