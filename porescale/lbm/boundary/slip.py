"""Free slip: a link comes back mirrored and keeps its velocity along the side.

A flat surface of water, a line of symmetry.
At a corner between two such sides the link is reversed.
"""

from typing import Any

from porescale.lbm.boundary.law import Boundary, Link
from porescale.lbm.lattice import CX, CY, direction


class Slip(Boundary):
    """Free slip, by specular reflection of the populations."""

    name = "slip"
    purpose = "holds the fluid and lets it slide: a flat surface of water, a line of symmetry"
    order, precedence = 1, 3
    mirrors = True

    def partner(self, bounds: Any, link: Link) -> tuple[int, float]:
        """The mirrored link of the cell beside."""
        owners = bounds.owners(link)
        if len(owners) > 1:
            return bounds.bounced(link), 0.0
        x, y = bounds.beyond(link)
        cx, cy = int(CX[link.out]), int(CY[link.out])
        if owners == (link.along,):
            return bounds.flat(direction(cx, -cy), (x, link.y)), 0.0
        return bounds.flat(direction(-cx, cy), (link.x, y)), 0.0


BOUNDARY = Slip()
