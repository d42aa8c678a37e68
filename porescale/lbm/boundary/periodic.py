"""Periodic: what leaves through a side comes in through the opposite one."""

from typing import Any

from porescale.lbm.boundary.law import Boundary, Link


class Periodic(Boundary):
    """A periodic side: joined to the opposite one."""

    name = "periodic"
    purpose = "joined to the opposite side"
    order, precedence = 2, 4
    periodic = True

    def partner(self, bounds: Any, link: Link) -> tuple[int, float]:
        """The same link of the cell on the other side."""
        return bounds.flat(link.out, bounds.beyond(link)), 0.0


BOUNDARY = Periodic()
