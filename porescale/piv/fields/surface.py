"""The free surface of a pile: how high it stands over every column, from grains or from a picture's solids."""

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from porescale.common.core.types import Floats
from porescale.piv.fields.field import Field
from porescale.piv.images.flows import Discs

TOUCH = 0.1
"""Mean diameters that a grain of the pile may be away from the next, or from the floor: one further off flies."""


class Surface(NamedTuple):
    """height (n,) above ``floor`` at columns x (n,): 0 where nothing lies, nan in side walls; as a field's x."""

    x: Floats
    height: Floats
    floor: float


class Difference(NamedTuple):
    """One surface less another, over the columns of both: rms, largest (absolute) and mean, in their unit; highest : of
    the reference.
    """

    rms: float
    largest: float
    mean: float
    highest: float


def of_grains(grains: Discs, x: Floats) -> Surface:
    """The upper rim of the pile at columns x: grains held together, and by the floor, with gaps below TOUCH diameters.

    grains : one at least, y up;  the floor is where the lowest grain stands.
    """
    height = np.zeros(len(x))
    floor = float((grains.y - grains.radius).min())
    resting = _resting(grains, floor)
    for a, b, r in zip(grains.x[resting], grains.y[resting], grains.radius[resting], strict=True):
        over = np.abs(x - a) < r
        rim = b + np.sqrt(r * r - (x[over] - a) ** 2) - floor
        height[over] = np.maximum(height[over], rim)
    return Surface(x, height, floor)


def _resting(grains: Discs, floor: float) -> NDArray[np.bool_]:
    """Grains that a chain of touching ones joins to the floor."""
    count = len(grains.x)
    gap = TOUCH * 2 * float(grains.radius.mean())
    places = np.column_stack([grains.x, grains.y])
    pairs = cKDTree(places).query_pairs(2 * float(grains.radius.max()) + gap, output_type="ndarray")
    one, two = pairs[:, 0], pairs[:, 1]
    apart = np.hypot(*(places[one] - places[two]).T) - grains.radius[one] - grains.radius[two]
    one, two = one[apart < gap], two[apart < gap]
    low = np.nonzero(grains.y - grains.radius - floor < gap)[0]
    ends = np.r_[one, low], np.r_[two, np.full(len(low), count)]  # the floor is one more body
    links = coo_matrix((np.ones(len(ends[0])), ends), shape=(count + 1, count + 1))
    _, label = connected_components(links, directed=False)
    return np.asarray(label[:count] == label[count])


def of_solids(x: Floats, y: Floats, solid: NDArray[np.bool_]) -> Surface:
    """The top, in each column, of the bodies that a gap of one cell at most parts from the lowest solid of all.

    solid (ny, nx), rows from the top down, y (ny,) rising or falling; rows are as high as they are apart, so that a
    height is accurate to half of that.  Columns that are solid as far as there are rows are walls.
    """
    rows = solid[::-1]  # from the floor up
    down = float(y[-1] - y[-2]) if len(y) > 1 else 1.0
    step = abs(down)
    first = int(rows.any(1).argmax())
    walls = rows[first:].all(0)
    free = (rows & ~walls).astype(np.uint8)
    near = cv2.morphologyEx(free, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8), borderType=cv2.BORDER_CONSTANT)
    _, label = cv2.connectedComponents(near, connectivity=8)
    lowest = np.unique(label[first : first + 2])
    pile = (free > 0) & np.isin(label, lowest[lowest > 0])
    top = rows.shape[0] - pile[::-1].argmax(0)
    height = np.where(pile.any(0), (top - first) * step, 0.0)
    height[walls] = np.nan
    return Surface(np.asarray(x, float), height, float(y[len(y) - 1 - first]) + 0.5 * down)


def of_field(field: Field) -> Surface | None:
    """The surface of what a field has solid; None where it has none."""
    return of_solids(field.x, field.y, field.solid) if field.solid.any() else None


def difference(reference: Surface, other: Surface) -> Difference | None:
    """``other`` less ``reference`` at the latter's columns, as far as both reach; None where none are shared.

    Heights count each from its own floor.
    """
    known = np.isfinite(other.height)
    if not known.any():
        return None
    x = other.x[known]
    both = (reference.x >= x.min()) & (reference.x <= x.max()) & np.isfinite(reference.height)
    if not both.any():
        return None
    off = np.interp(reference.x[both], x, other.height[known]) - reference.height[both]
    return Difference(
        float(np.sqrt(np.mean(off**2))),
        float(np.abs(off).max()),
        float(off.mean()),
        float(reference.height[both].max()),
    )
