"""Smoothing kernels W(r, h) in two dimensions, support 2h, and their slopes, without branches.

Cubic spline: eq. 8 of Maeda & Sakai 2004.  Wendland C2: Wendland, Adv. Comput. Math. 4 (1995) 389, in the form of
Dehnen & Aly, MNRAS 425 (2012) 1068: no pairing instability at any number of neighbours.
"""

from dataclasses import dataclass

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import maximum
from porescale.common.core.ranges import Range, require_in_range

CUBIC, WENDLAND = 0, 1
NAMES = ("cubic", "wendland")
SUPPORT = 2.0  # smoothing lengths
RATIO = 1.375
"""Smoothing length over spacing where a scene names none: the least with which sums of W rise all the way when columns
of a square lattice slide past each other, so that water at rest stands (docs/theory/water.md, "Water at rest")."""


@inline
def kernel_kind(kind):
    """The kernel as a number: Wendland's where ``kind`` is None, which is then compiled in."""
    if kind is None:
        return WENDLAND
    return kind


@inline
def kernel_value(kind, q, h):
    """W, 1/m², at q = r/h;  h smoothing length, m;  kind CUBIC or WENDLAND.

    CUBIC: 15/(7 π h²) {(2-q)³/6 - 4(1-q)³/6}, brackets 0 where negative: eq. 8 in one line.
    WENDLAND: 7/(4 π h²) (1 - q/2)⁴ (1 + 2q).
    """
    if kind == CUBIC:
        outer = maximum(2.0 - q, 0.0)
        inner = maximum(1.0 - q, 0.0)
        return 5.0 / (14.0 * np.pi * h * h) * (outer * outer * outer - 4.0 * inner * inner * inner)
    rest = maximum(1.0 - 0.5 * q, 0.0)
    square = rest * rest
    return 1.75 / (np.pi * h * h) * square * square * (1.0 + 2.0 * q)


@inline
def value_scale(kind, h):
    """The part of `kernel_value` that depends on h alone, 1/m², for sums that it multiplies as a whole."""
    if kind == CUBIC:
        return 5.0 / (14.0 * np.pi * h * h)
    return 1.75 / (np.pi * h * h)


@inline
def value_shape(kind, q):
    """The part of `kernel_value` that depends on q alone."""
    if kind == CUBIC:
        outer = maximum(2.0 - q, 0.0)
        inner = maximum(1.0 - q, 0.0)
        return outer * outer * outer - 4.0 * inner * inner * inner
    rest = maximum(1.0 - 0.5 * q, 0.0)
    return rest * rest * rest * rest * (1.0 + 2.0 * q)


@inline
def slope_scale(kind, h):
    """The part of `kernel_slope` that depends on h alone, 1/m⁴."""
    if kind == CUBIC:
        return 15.0 / (14.0 * np.pi * h * h * h * h)
    return -8.75 / (np.pi * h * h * h * h)


@inline
def slope_shape(kind, q):
    """The part of `kernel_slope` that depends on q alone."""
    if kind == CUBIC:
        q = maximum(q, 1e-9)  # centres that coincide: the limit -2 is reached to 1e-9
        outer = maximum(2.0 - q, 0.0)
        inner = maximum(1.0 - q, 0.0)
        return (4.0 * inner * inner - outer * outer) / q
    rest = maximum(1.0 - 0.5 * q, 0.0)
    return rest * rest * rest


@inline
def kernel_slope(kind, q, h):
    """(1/r) dW/dr, 1/m⁴, at q = r/h: the gradient at i is this times (x_i - x_j).  Never positive.

    CUBIC: 15/(7 π h⁴) {-(2-q)²/2 + 2(1-q)²}/q, brackets 0 where negative.
    WENDLAND: -35/(4 π h⁴) (1 - q/2)³, without the division.
    """
    return slope_scale(kind, h) * slope_shape(kind, q)


@dataclass(frozen=True)
class Smoothing:
    """name : "cubic" or "wendland";  length : h, m, > 0.  Raises InputError for others."""

    name: str
    length: float

    def __post_init__(self) -> None:
        require_in_range("smoothing", vars(self), {"length": Range("m", gt=0)}, {"name": NAMES})

    @property
    def kind(self) -> int:
        """Number of the smoothing function in kernels."""
        return NAMES.index(self.name)

    @property
    def support(self) -> float:
        """Distance beyond which W vanishes, m."""
        return SUPPORT * self.length
