"""What every kind of side of the box provides.

A kind is one file of this folder with its row in the register, ``BOUNDARY``, an object of a class derived from
``Boundary``; choose.py finds it.  Most kinds consist only of a partner: the slot inside the box that a link which
leaves it is paired with, and what is added on the way (sides.py says how that steps).  A kind that needs more, such as
the collided populations of a whole cell, settles its links itself (``own_links``).
"""

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import DTypeLike, NDArray


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


class OwnLinks(Protocol):
    """Links that a kind of side settles itself at the end of each step."""

    def close(self, flat: NDArray[np.floating], parity: int, force: tuple[Any, Any]) -> None:
        """After the sweep of a step of that parity: overwrite the halo slots of the links (even) or their inner slots
        (odd) in the flat populations;  force: body force density, two numbers or (ny, nx) each."""

    def state(self) -> dict[str, Any]:
        """The quantities of these links that can change between steps, for a checkpoint."""

    def restore(self, state: dict[str, Any]) -> None:
        """Overwrite these quantities with those of ``state``."""


class Boundary(Protocol):
    """The contract of a kind of side; classes derive from it and inherit what is given here.

    name : in scenes;  purpose : one line;  order : place in lists;  precedence : a link through a corner of two sides
    belongs to the kind with the lower one.

    Which numbers of a scene it takes, of "speed", "velocity", "profile" and "pressure":  numbers;  those it must have:
    required.

    What follows from it:  passes : fluid comes in or goes out;  periodic : it is joined to the opposite side, which
    must be of the same kind;  mirrors : it reverses the velocity across it and leaves the one along it;
    prescribes_velocity : its links add 6 w c . u of the side's velocity;  settles : it settles its links itself;
    movable : in a dry scene it may also move, at a velocity or under a stress or force.
    A kind with none of these holds the fluid and stops it; grains pass through a periodic one alone.
    """

    name: str
    purpose: str
    order: int = 100
    precedence: int = 100
    numbers: tuple[str, ...] = ()
    required: tuple[str, ...] = ()
    passes: bool = False
    periodic: bool = False
    mirrors: bool = False
    prescribes_velocity: bool = False
    settles: bool = False
    movable: bool = False

    @property
    def closed(self) -> bool:
        """Whether no fluid crosses a side of this kind."""
        return not (self.passes or self.periodic)

    @property
    def no_slip(self) -> bool:
        """Whether the fluid has the velocity of a side of this kind there, and does not cross it."""
        return self.closed and not self.mirrors

    def partner(self, bounds: Any, link: Link) -> tuple[int, float]:
        """Flat inner slot of a link that this kind owns, and what is added to it on the way in: half-way bounce-back
        at rest unless a kind says otherwise;  bounds: ``Bounds`` of sides.py.  Not called where ``settles``."""
        slot: int = bounds.bounced(link)
        return slot, 0.0

    def own_links(self, bounds: Any, dtype: DTypeLike) -> OwnLinks | None:
        """All links that this kind owns, where ``settles``: it then has no partners."""
        return None
