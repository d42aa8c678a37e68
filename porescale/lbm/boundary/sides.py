"""The four sides of the box: what each is, and which slots a link that leaves the box owns.

In the in-place pattern only an odd step crosses cells, so sides act only around odd steps.  Each link that leaves the
box owns one slot in the halo and one inside.  Before the odd step the halo slot gets what must come back in; after it,
the halo slot holds what went out, and the inner slot of the same pair gets what that turns into.  So one list of
(halo, inner, added) serves every kind of side that is no more than a partner (law.py): bounce-back pairs a slot with
its reversed link (wall.py), free slip with the mirrored one (slip.py), periodic with the wrapped one (periodic.py);
what moves at a wall or comes through a velocity side adds 6 w_i c_i . u (Ladd 1994).

A link through a corner of two sides belongs to the kind with the lower precedence: velocity, wall, pressure, slip,
periodic.  Two velocities, and two densities, are averaged.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.lbm.boundary.choose import boundary
from porescale.lbm.boundary.law import Boundary, Link
from porescale.lbm.lattice import CX, CY, OPPOSITE, row_length

Kind = str
"""Name of a kind of side, see ``choose.boundaries``."""
Velocity = tuple[float, float] | NDArray[np.floating]
NAMES = ("left", "right", "bottom", "top")


@dataclass(frozen=True)
class Sides:
    """What each side is, and its numbers in lattice units; ValueError at a kind that there is none of.

    wall      half-way bounce-back; ``speed`` along itself (+x or +y)
    slip      free slip: a flat surface of water, a line of symmetry
    periodic  joined to the other side
    velocity  the fluid comes in or goes out with ``velocity``, (ux, uy) or one for each cell, (n, 2), linear between
              them; half-way bounce-back at the density 1 of rest, so that the mass that passes is the sum of the
              velocities, exactly, and two sides of equal velocity balance.  A wall that pushes (a piston of small
              stroke) is the same.
    pressure  the fluid passes at ``density``, 1 + 3 p; its velocity is that of the cells inside (pressure.py)
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
            one, other = self.boundary(low), self.boundary(high)
            if one is not other and (one.periodic or other.periodic):
                joined = (one if one.periodic else other).name
                raise ValueError(f"{low} and {high} are {joined} together or not at all")

    def kind(self, side: str) -> Kind:
        """What the side called left, right, bottom or top is."""
        kind: Kind = getattr(self, side)
        return kind

    def speed(self, side: str) -> float:
        """Speed of a side along itself; 0 unless its kind has one."""
        return float(getattr(self, f"{side}_speed")) if "speed" in self.boundary(side).numbers else 0.0

    def boundary(self, side: str) -> Boundary:
        """The kind of that side, with all that follows from it."""
        return boundary(self.kind(side))

    @property
    def periodic(self) -> tuple[bool, bool]:
        """Whether the box is periodic along x and y."""
        return self.boundary("left").periodic, self.boundary("bottom").periodic


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
        """The side or sides that a link belongs to: those of the kind with the lowest precedence."""
        kinds = [self.sides.boundary(side) for side in link.sides]
        first = min(kinds, key=lambda kind: (kind.precedence, kind.name))
        return tuple(side for side, kind in zip(link.sides, kinds, strict=True) if kind is first)

    def owner(self, link: Link) -> Boundary:
        """The kind of boundary of the sides that the link belongs to (``owners``)."""
        return self.sides.boundary(self.owners(link)[0])

    def partners(self) -> list[Link]:
        """Every link that is paired with a slot, all but those that a kind settles itself, row by row as sweeps go."""
        return sorted((link for link in self.links() if not self.owner(link).settles), key=lambda link: link.y)

    def beyond(self, link: Link) -> tuple[int, int]:
        """The cell that a link leads to, taken back into the box through periodic sides."""
        x, y = link.to
        across = bool(link.across) and self.sides.boundary(link.across).periodic
        along = bool(link.along) and self.sides.boundary(link.along).periodic
        return (x - 1) % self.nx + 1 if across else x, (y - 1) % self.ny + 1 if along else y

    def bounced(self, link: Link) -> int:
        """Flat slot of the reversed link in the link's own cell: half-way bounce-back."""
        return self.flat(int(OPPOSITE[link.out]), (link.x, link.y))

    def flat(self, slot: int, at: tuple[int, int]) -> int:
        """Index of a slot of a cell into the flat padded populations."""
        return (slot * (self.ny + 2) + at[1]) * row_length(self.nx) + at[0]

    def length(self, side: str) -> int:
        """Number of cells along a side."""
        return self.ny if side in ("left", "right") else self.nx

    def place(self, side: str, link: Link) -> int:
        """Number, from 0, of the link's cell along a side."""
        return (link.y if side in ("left", "right") else link.x) - 1
