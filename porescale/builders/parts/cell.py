"""The strained cell of a dry scene: its strain, and its columns of series.csv."""

import math

import numpy as np

from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.core.types import Floats
from porescale.common.record.part import Part
from porescale.dem.bodies.rigid import areas


class CellPart(Part):
    """Reads the cell, which is a part of the grains' state."""

    def __init__(self, system: System) -> None:
        assert system.grains
        self.grains = system.grains

    def row(self) -> Row:
        """Columns of the series: strain (logarithms of the stretch of the edges; shear), the stress of the last step
        (compression positive, shear of the sign of the strain that it drives), and the cell.

        strain xx () : logarithm of the stretch of the cell's width, > 0 longer
        strain yy () : logarithm of the stretch of its height, > 0 taller
        strain xy () : shear of the cell since the start
        stress xx (Pa) : of the last step, compression > 0
        stress yy (Pa) : of the last step, compression > 0
        shear stress (Pa) : of the last step, of the sign of the strain that it drives
        cell width (m) : of the periodic cell now
        cell height (m) : of the periodic cell now
        cell tilt (m) : how far the upper edge has moved along the lower one
        solid fraction () : area of the grains over that of the cell; overlaps count twice
        """
        grains = self.grains
        (width, _), (tilt, height) = grains.steering.edges()
        xx, xy, yy = grains.steering.cell_pressure()
        return {
            "strain xx ()": math.log(width / grains.box.period[0]),
            "strain yy ()": math.log(height / grains.box.period[1]), "strain xy ()": grains.steering.shear(),
            "stress xx (Pa)": float(xx), "stress yy (Pa)": float(yy), "shear stress (Pa)": -float(xy),
            "cell width (m)": width, "cell height (m)": height, "cell tilt (m)": tilt,
            "solid fraction ()": float(areas(grains).sum()) / (width * height),
        }  # fmt: skip

    def seen(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m of the discs within width and height of the cell; velocities (n, 2) with the cell's."""
        steering, discs = self.grains.steering, self.grains.discs
        (width, _), (tilt, height) = steering.edges()
        position = discs.position.copy()
        turns = np.floor(position[:, 1] / height)
        position -= turns[:, None] * np.array([tilt, height])
        position[:, 0] -= width * np.floor(position[:, 0] / width)
        return position, discs.velocity + position @ steering.gradient().T
