"""Sides of the tank that water passes at a given head: the faces of a scene, and what flows through them."""

from collections.abc import Sequence

import numpy as np

from continuum_sph.scene.face import FaceSection
from continuum_sph.seepage import Drain, PoreFlow
from continuum_sph.water.state import VX, VY
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats
from porescale.common.record.part import Part

FARTHEST = 0.5
"""Spacings by which water may pass a face: no more particles come in."""


def name_of(section: FaceSection, number: int) -> str:
    """Name of a face in columns and messages."""
    return section.name or f"face {number}"


def drain(section: FaceSection, walls: Floats, first: int, size: tuple[float, float], weight: float) -> Drain:
    """The face of a section in a tank of a ``size`` (width, height), m.

    walls (w, 2) m: wall particles of the tank, of which those in corners are none of a face's;  first : number of the
    first of them;  weight : ρ g, N/m³.
    """
    width, height = size
    x, y = walls.T
    beside, upright = (y > 0.0) & (y < height), (x > 0.0) & (x < width)
    mask, point, normal, along = {
        "left": (beside & (x < 0.0), (0.0, 0.0), (1.0, 0.0), y),
        "right": (beside & (x > width), (width, 0.0), (-1.0, 0.0), y),
        "floor": (upright & (y < 0.0), (0.0, 0.0), (0.0, 1.0), x),
        "lid": (upright & (y > height), (0.0, height), (0.0, -1.0), x),
    }[section.side]
    start, end = section.reach(width, height)
    own = np.flatnonzero(mask & (along > start) & (along < end))
    foot = np.clip(y[own], 0.0, height)
    return Drain(first + own, point, normal, weight * (section.head - foot))


class FacePart(Part):
    """What flows through the faces of a scene.

    sections, drains : the faces, in one order;  flow : of the water;  spacing : of its particles, m.
    """

    def __init__(self, sections: Sequence[FaceSection], flow: PoreFlow, spacing: float) -> None:
        self.names = [name_of(section, number) for number, section in enumerate(sections)]
        self.drains, self.flow, self.spacing = flow.drains, flow, spacing
        self.outer = [face.rows[self._depth(face, flow.home) < spacing] for face in self.drains]

    @staticmethod
    def _depth(face: Drain, x: Floats) -> Floats:
        """Depth (m) behind the face of its wall particles at ``x`` (n, 2) m."""
        depth: Floats = (np.array(face.point) - x[face.rows]) @ np.array(face.normal)
        return depth

    def passed(self, face: Drain) -> float:
        """The farthest way (m) that water has gone through a ``face``."""
        layer, home = self.flow.layer.x, self.flow.home
        return float(np.abs(self._depth(face, layer) - self._depth(face, home)).max())

    def check(self) -> None:
        """Raise Unstable when more water has passed a face than is there to pass it."""
        for name, face in zip(self.names, self.drains, strict=True):
            way = self.passed(face)
            if way > FARTHEST * self.spacing:
                raise Unstable(
                    name, "way of the water through it", way, "m", self.flow.step, self.flow.time,
                    f"no more than {FARTHEST:g} spacings of water are there to pass a face: end sooner, or use a "
                    "reservoir",
                )  # fmt: skip

    def row(self) -> dict[str, float]:
        """Flow through each face.

        NAME flow in (m2/s) : flow of water through the face into the tank; less than zero where it leaves
        """
        record = self.flow.layer.record
        return {
            f"{name} flow in (m2/s)": float((record[rows, VX : VY + 1] @ np.array(face.normal)).sum() * self.spacing)
            for name, face, rows in zip(self.names, self.drains, self.outer, strict=True)
        }
