"""The four sides of the box: what each is, and which slots a link that leaves the box owns.

In the in-place pattern only an odd step crosses cells, so sides act only around odd steps.  Each link that leaves the
box owns one slot in the halo and one inside.  Before the odd step the halo slot gets what must come back in; after it,
the halo slot holds what went out, and the inner slot of the same pair gets what that turns into.  So one list of
(halo, inner, added) serves every kind of side but pressure (open_links.py): bounce-back pairs a slot with its reversed
link, free slip with the mirrored one, periodic with the wrapped one; what moves at a wall or comes through a velocity
side adds 6 w_i c_i . u (Ladd 1994).

A link through a corner of two sides belongs to the kind that comes first in: velocity, wall, pressure, slip, periodic.
Two velocities, and two densities, are averaged.  A wall's motion along itself ends where it meets another wall or free
slip: the corner link adds nothing.  A lid drags 6 w u = u/6 less fluid past each section than its cells' velocities
say; leaving its motion out of both corner links makes good for that, as a source in one corner and a sink in the other.
With it in, a cavity's flow is u/6 short, a first-order error (measured: extrema at Re 100, 32 cells, 7 instead of 1 %).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS, direction

Kind = Literal["wall", "slip", "periodic", "velocity", "pressure"]
Velocity = tuple[float, float] | NDArray[np.floating]
NAMES = ("left", "right", "bottom", "top")


@dataclass(frozen=True)
class Sides:
    """What each side is, and its numbers in lattice units.

    wall      half-way bounce-back; ``speed`` along itself (+x or +y)
    slip      free slip: a flat surface of water, a line of symmetry
    periodic  joined to the other side
    velocity  the fluid comes in or goes out with ``velocity``, (ux, uy) or one for each cell, (n, 2); half-way
              bounce-back at the density 1 of rest, so that the mass that passes is the sum of the velocities, exactly,
              and two sides of equal velocity balance.  A wall that pushes (a piston of small stroke) is the same.
    pressure  the fluid passes at ``density``, 1 + 3 p; its velocity is that of the cells inside (open_links.py)
    """

    left: Kind = "wall"
    right: Kind = "wall"
    bottom: Kind = "wall"
    top: Kind = "wall"
    left_speed: float = 0.0
    right_speed: float = 0.0
    bottom_speed: float = 0.0
    top_speed: float = 0.0
    left_velocity: Velocity = (0.0, 0.0)
    right_velocity: Velocity = (0.0, 0.0)
    bottom_velocity: Velocity = (0.0, 0.0)
    top_velocity: Velocity = (0.0, 0.0)
    left_density: float = 1.0
    right_density: float = 1.0
    bottom_density: float = 1.0
    top_density: float = 1.0

    def __post_init__(self) -> None:
        for low, high in (("left", "right"), ("bottom", "top")):
            if (getattr(self, low) == "periodic") != (getattr(self, high) == "periodic"):
                raise ValueError(f"{low} and {high} are periodic together or not at all")

    def kind(self, side: str) -> Kind:
        """What the side called left, right, bottom or top is."""
        kind: Kind = getattr(self, side)
        return kind

    def speed(self, side: str) -> float:
        """Speed of a side along itself; 0 unless it is a wall."""
        return float(getattr(self, f"{side}_speed")) if self.kind(side) == "wall" else 0.0


class Link(NamedTuple):
    """A link from cell (x, y) along direction ``out`` to the halo cell ``to``; ``across``: the side left or right that
    it crosses, ``along``: bottom or top, "" if none.  Cells count from 1."""

    x: int
    y: int
    out: int
    to: tuple[int, int]
    across: str
    along: str

    @property
    def sides(self) -> tuple[str, ...]:
        """The one or two sides it crosses."""
        return tuple(side for side in (self.across, self.along) if side)


@dataclass(frozen=True)
class Bounds:
    """The box of nx by ny cells and its sides: which links leave it, and where."""

    nx: int
    ny: int
    sides: Sides

    def links(self) -> Iterator[Link]:
        """Every link that leaves the box, cell by cell."""
        rim = [(x, y) for y in (1, self.ny) for x in range(1, self.nx + 1)]
        rim += [(x, y) for x in (1, self.nx) for y in range(2, self.ny)]
        for x, y in dict.fromkeys(rim):
            for out in range(1, 9):
                to = (x + int(CX[out]), y + int(CY[out]))
                across = "left" if to[0] < 1 else "right" if to[0] > self.nx else ""
                along = "bottom" if to[1] < 1 else "top" if to[1] > self.ny else ""
                if across or along:
                    yield Link(x, y, out, to, across, along)

    def owners(self, link: Link) -> tuple[str, ...]:
        """The side or sides that a link belongs to: those of the kind that comes first, see above."""
        for kind in ("velocity", "wall", "pressure", "slip"):
            found = tuple(side for side in link.sides if self.sides.kind(side) == kind)
            if found:
                return found
        return link.sides

    def owner(self, link: Link) -> Kind:
        """The kind of those sides."""
        return self.sides.kind(self.owners(link)[0])

    def flat(self, slot: int, at: tuple[int, int]) -> int:
        """Index of a slot of a cell into the flat populations."""
        return (slot * (self.ny + 2) + at[1]) * (self.nx + 2) + at[0]

    def length(self, side: str) -> int:
        """Cells along a side."""
        return self.ny if side in ("left", "right") else self.nx

    def place(self, side: str, link: Link) -> int:
        """Number, from 0, of the link's cell along a side."""
        return (link.y if side in ("left", "right") else link.x) - 1

    def partner(self, link: Link) -> tuple[int, float]:
        """Flat inner slot of a link that no pressure side owns, and what the motion of walls adds."""
        x, y, out, to = link.x, link.y, link.out, link.to
        back = int(OPPOSITE[out])
        kind = self.owner(link)
        at = (
            (to[0] - 1) % self.nx + 1 if link.across and self.sides.kind(link.across) == "periodic" else to[0],
            (to[1] - 1) % self.ny + 1 if link.along and self.sides.kind(link.along) == "periodic" else to[1],
        )
        if kind == "periodic":
            return self.flat(out, at), 0.0
        if kind == "slip" and len(self.owners(link)) == 1:
            if self.owners(link) == (link.along,):
                return self.flat(direction(CX[out], -CY[out]), (at[0], y)), 0.0
            return self.flat(direction(-CX[out], CY[out]), (x, at[1])), 0.0
        added = 0.0
        closed = len(link.sides) == 2 and {self.sides.kind(side) for side in link.sides} <= {"wall", "slip"}
        if kind == "wall" and not closed:
            speed_x = self.sides.speed(link.along) if link.along else 0.0
            speed_y = self.sides.speed(link.across) if link.across else 0.0
            added = float(6 * WEIGHTS[back] * (CX[back] * speed_x + CY[back] * speed_y))
        return self.flat(back, (x, y)), added


@kernel
def fill_halo(flat, halo, inner, added):
    """After an even step: halo slots get what comes back in.  Overwrites flat populations at ``halo``."""
    for k in range(halo.shape[0]):
        flat[halo[k]] = flat[inner[k]] + added[k]


@kernel
def empty_halo(flat, halo, inner, added):
    """After an odd step: what went out becomes what comes in.  Overwrites flat populations at ``inner``."""
    for k in range(halo.shape[0]):
        flat[inner[k]] = flat[halo[k]] + added[k]
