"""A wall: half-way bounce-back, which may slide along itself (Ladd 1994).

A sliding wall adds 6 w_i c_i . u.  Its motion ends at a corner with another side that holds the fluid: the corner link
adds nothing.  A lid drags 6 w u = u/6 less fluid past each section than its cells' velocities say; leaving its motion
out of both corner links makes good for that, as a source in one corner and a sink in the other.  With it in, a cavity's
flow is u/6 short, a first-order error (measured: extrema at Re 100, 32 cells, 7 instead of 1 %).
"""

from typing import Any

from porescale.lbm.boundary.law import Boundary, Link
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS


class Wall(Boundary):
    """Half-way bounce-back at a wall that may slide along itself with ``speed``, lattice units."""

    name = "wall"
    purpose = "holds the fluid and stops it, or drags it along"
    order, precedence = 0, 1
    numbers = ("speed",)
    movable = True

    def partner(self, bounds: Any, link: Link) -> tuple[int, float]:
        """The reversed link, and 6 w c . u."""
        added = 0.0
        if not (len(link.sides) == 2 and all(bounds.sides.boundary(side).closed for side in link.sides)):
            back = int(OPPOSITE[link.out])
            speed_x = bounds.sides.speed(link.along) if link.along else 0.0
            speed_y = bounds.sides.speed(link.across) if link.across else 0.0
            added = float(6 * WEIGHTS[back] * (CX[back] * speed_x + CY[back] * speed_y))
        return bounds.bounced(link), added


BOUNDARY = Wall()
