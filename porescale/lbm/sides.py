"""The four sides of the box: half-way bounce-back, moving wall, free slip, periodic; all as pairs of slots.

In the in-place pattern only an odd step crosses cells, so sides act only around odd steps.  Each link that leaves the
box owns one slot in the halo and one inside.  Before the odd step the halo slot gets what must come back in; after it,
the halo slot holds what went out, and the inner slot of the same pair gets what that turns into.  So one list of
(halo, inner, added) serves every kind of side: bounce-back pairs a slot with its reversed link, free slip with the
mirrored one, periodic with the wrapped one, and a wall that moves along itself adds 6 w_i c_i . u_w (Ladd 1994).
A corner of two sides that both turn back reverses the link.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.ground.jit import kernel
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS, direction

Kind = Literal["wall", "slip", "periodic"]


@dataclass(frozen=True)
class Sides:
    """What each side is, and the speed (lattice units) of a wall along itself (+x or +y)."""

    left: Kind = "wall"
    right: Kind = "wall"
    bottom: Kind = "wall"
    top: Kind = "wall"
    left_speed: float = 0.0
    right_speed: float = 0.0
    bottom_speed: float = 0.0
    top_speed: float = 0.0

    def __post_init__(self) -> None:
        for low, high in (("left", "right"), ("bottom", "top")):
            if (getattr(self, low) == "periodic") != (getattr(self, high) == "periodic"):
                raise ValueError(f"{low} and {high} are periodic together or not at all")


@dataclass(frozen=True)
class SlotPairs:
    """Flat indices into populations: ``halo`` and ``inner`` slots (k,) and the value ``added`` on the way in."""

    halo: NDArray[np.int64]
    inner: NDArray[np.int64]
    added: NDArray[np.floating]


def slot_pairs(nx: int, ny: int, sides: Sides, dtype: DTypeLike) -> SlotPairs:
    """The pairs of every link that leaves a box of nx by ny cells (cells 1 to n, halo 0 and n + 1)."""
    halo, inner, added = [], [], []
    rim = [(x, y) for y in (1, ny) for x in range(1, nx + 1)] + [(x, y) for x in (1, nx) for y in range(2, ny)]
    if ny == 1:
        rim = rim[:nx]
    for x, y in dict.fromkeys(rim):
        for out in range(1, 9):
            to = (x + int(CX[out]), y + int(CY[out]))
            if 1 <= to[0] <= nx and 1 <= to[1] <= ny:
                continue
            halo.append(_flat(out, to, nx, ny))
            slot, at, plus = _partner(x, y, out, to, nx, ny, sides)
            inner.append(_flat(slot, at, nx, ny))
            added.append(plus)
    return SlotPairs(np.array(halo, np.int64), np.array(inner, np.int64), np.array(added, dtype))


def _flat(slot: int, at: tuple[int, int], nx: int, ny: int) -> int:
    return (slot * (ny + 2) + at[1]) * (nx + 2) + at[0]


def _partner(
    x: int, y: int, out: int, to: tuple[int, int], nx: int, ny: int, sides: Sides
) -> tuple[int, tuple[int, int], float]:
    """Inner slot, its cell and the added value for the link from cell (x, y) along ``out`` to halo cell ``to``."""
    column = sides.left if to[0] < 1 else sides.right if to[0] > nx else None
    row = sides.bottom if to[1] < 1 else sides.top if to[1] > ny else None
    wrapped = (
        (to[0] - 1) % nx + 1 if column == "periodic" else to[0],
        (to[1] - 1) % ny + 1 if row == "periodic" else to[1],
    )
    solid = [kind for kind in (column, row) if kind not in (None, "periodic")]
    if not solid:
        return out, wrapped, 0.0
    back = int(OPPOSITE[out])
    if solid == ["slip"]:
        if row == "slip":
            return direction(CX[out], -CY[out]), (wrapped[0], y), 0.0
        return direction(-CX[out], CY[out]), (x, wrapped[1]), 0.0
    speed_x = (sides.bottom_speed if to[1] < 1 else sides.top_speed) if row == "wall" else 0.0
    speed_y = (sides.left_speed if to[0] < 1 else sides.right_speed) if column == "wall" else 0.0
    return back, (x, y), float(6 * WEIGHTS[back] * (CX[back] * speed_x + CY[back] * speed_y))


@kernel
def fill_halo(flat, halo, inner, added):
    """Before an odd step: halo slots get what comes back in.  Overwrites flat populations at ``halo``."""
    for k in range(halo.shape[0]):
        flat[halo[k]] = flat[inner[k]] + added[k]


@kernel
def empty_halo(flat, halo, inner, added):
    """After an odd step: what went out becomes what comes in.  Overwrites flat populations at ``inner``."""
    for k in range(halo.shape[0]):
        flat[inner[k]] = flat[halo[k]] + added[k]
