"""The surface of a pile, found from the discs of a picture and from what is solid in it.  Pixels."""

import numpy as np

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.piv.fields.surface import of_grains, of_solids
from porescale.piv.images import flows

VALIDATIONS = Validations()


def pile(step: float) -> tuple[list[float], list[float]]:
    """Areas below the surface of a disc beside three that stand as a triangle, from discs and from a picture of them.

    step : px of columns.  Radius 40 px; exact: r^2 (2 + pi/2) under a disc, as much under the outer halves of the
    lower two, and r^2 (2 + 2 3^(1/2) + pi/2) under the one on top.  A fifth disc flies.
    """
    r = 40.0
    x = np.array([60.0, 160.0, 240.0, 200.0, 330.0])
    y = np.array([r, r, r, r + np.sqrt(3) * r, 300.0])
    discs = flows.Discs(x, y, np.full(5, r))
    columns: Floats = 20.0 + step * (np.arange(round(360 / step), dtype=float) + 0.5)
    rows: Floats = 399.5 - np.arange(400, dtype=float)
    solid = discs.inside(*np.meshgrid(columns, rows))
    found = [of_grains(discs, columns), of_solids(columns, rows, solid)]
    exact = r * r * (2 * (2 + np.pi / 2) + 2 + 2 * np.sqrt(3) + np.pi / 2)
    return [float(it.height.sum() * step) for it in found], [float(exact)] * 2


@VALIDATIONS.row(
    "piv.surface_of_a_pile",
    source="areas below circles: a disc, and three in a triangle, from their outlines and from a picture",
    because="columns of 1 px by mid-points, rows of 1 px in the picture: half a pixel in 280 columns, all one way at"
    " worst, 140 px^2 of 23 000",
    tolerance=0.006,
)
def surface() -> Measured:
    """Areas below a pile of discs, px²; the error is the largest relative one."""
    found, exact = pile(1.0)
    return Measured.relative(exact, found)
