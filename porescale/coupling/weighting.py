"""Weight B of a partially saturated cell from its solid area fraction e (Noble & Torczynski 1998).

B1 = e.   B2 = e k / ((1 - e) + k),  k = tau - 1/2,  which makes the position of a wall independent of tau to first
order.  wall = 4 k e/(4 k e + 3 (1 - e)²) goes with the solid operator of exact_wall.py.  tau is the molecular
relaxation time: with an eddy viscosity the geometry must not breathe with the flow.
Grains that share a cell: B of min(1, sum of e), split in proportion to e; summing B(e) would make contacts porous.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.common.compiled.jit import by_law, kernel
from porescale.coupling.coverage.soft_rim import SLIP_FACTOR
from porescale.lbm.collision.law import numbers


class B1(NamedTuple):
    """k : tau - 1/2, not used."""

    k: np.floating


class B2(NamedTuple):
    """k : tau - 1/2."""

    k: np.floating


class WallWeight(NamedTuple):
    """k : tau - 1/2."""

    k: np.floating


class SoftWallWeight(NamedTuple):
    """k : tau - 1/2;  slip_factor : of theta times slip in it (rim.py)."""

    k: np.floating
    slip_factor: np.floating


@by_law
def weight(solid, theta, slip_x, slip_y, law):
    """B of a cell with summed solid fraction ``solid`` >= 0, in which fluid slips past solid at (slip_x, slip_y).

    theta: softness of the rim (rim.py).
    """


@weight.of(B1)
def _solid_fraction(solid, theta, slip_x, slip_y, law):
    """The solid fraction itself."""
    return min(numbers(solid).one, solid)


@weight.of(B2)
def _viscous(solid, theta, slip_x, slip_y, law):
    """Noble & Torczynski's weight."""
    one = numbers(solid).one
    e = min(one, solid)
    return e * law.k / ((one - e) + law.k)


@weight.of(WallWeight)
def _wall(solid, theta, slip_x, slip_y, law):
    """That of exact_wall.py."""
    c = numbers(solid)
    e = min(c.one, solid)
    t = c.one - e
    n = law.k * e
    return n / (n + c.c34 * t * t)


@weight.of(SoftWallWeight)
def _soft_wall(solid, theta, slip_x, slip_y, law):
    """The same with the slip in k."""
    c = numbers(solid)
    e = min(c.one, solid)
    t = c.one - e
    n = (law.k + law.slip_factor * theta * np.sqrt(slip_x * slip_x + slip_y * slip_y)) * e
    return n / (n + c.c34 * t * t)


@kernel
def _weights(solid, zero, law, out):
    """B of cells (ny, nx) without slip into ``out``."""
    for y in range(solid.shape[0]):
        for x in range(solid.shape[1]):
            out[y, x] = weight(solid[y, x], zero, zero, zero, law)


def weights_of(solid: NDArray[np.floating], law: Any) -> NDArray[np.floating]:
    """B of cells with summed solid fractions (ny, nx) without slip, in the precision of ``solid``."""
    out = np.empty_like(solid)
    _weights(solid, solid.dtype.type(0), law, out)
    return out


WEIGHTINGS = {
    "wall": "goes with the solid operator exact-wall",
    "B2": "depends on the viscosity so that walls stay where they are",
    "B1": "the solid fraction: walls move with the viscosity",
}
"""Name of each weight and what it is good for."""


def fitting_weight(solid_operator: str, weighting: str | None) -> str:
    """The weight that a solid operator is used with where none is named; ValueError if the one named does not fit."""
    own = solid_operator == "exact-wall"
    if weighting is not None and own != (weighting == "wall"):
        fits = "'wall'" if own else "'B2' or 'B1'"
        raise ValueError(f"weight {weighting!r} does not go with the solid operator {solid_operator!r}: take {fits}")
    return weighting or ("wall" if own else "B2")


def choose_weight(name: str, relaxation_time: float, dtype: DTypeLike, *, soft: bool = False) -> Any:
    """The law of a weight by name;  soft: of bodies with soft rims.  ValueError if there is none of that name."""
    laws: dict[str, Any] = {"wall": WallWeight, "B1": B1, "B2": B2}
    if name not in laws:
        raise ValueError(f"unknown weight {name!r}: choose from {', '.join(WEIGHTINGS)}")
    real: Any = np.dtype(dtype).type
    if soft and name == "wall":
        return SoftWallWeight(real(relaxation_time - 0.5), real(SLIP_FACTOR))
    return laws[name](real(relaxation_time - 0.5))
