"""Sides of the tank that water passes at a given head: the faces of a scene, and what flows through them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.face import FaceSection
from continuum_sph.seepage import PoreFlow, PressureFace
from continuum_sph.seepage.pressure_face import flux_before, in_columns
from continuum_sph.seepage.sheet_pile import FREE, CutPairList
from continuum_sph.water.state import VX, VY
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of

FARTHEST = 0.5
"""Spacings by which water may pass a face: no more particles come in."""


def pressure_face(
    section: FaceSection, x: Floats, walls: NDArray[np.int64], size: tuple[float, float], weight: float
) -> PressureFace:
    """The face of a section in a tank of a ``size`` (width, height), m.

    x (n, 2) m: all particles;  walls : numbers of the wall particles of the tank;  weight : ρ g, N/m³.
    """
    axis, (at, inward), (start, end) = section.axis, section.across(size), section.reach(size)
    along, beyond = x[walls, axis], (x[walls, 1 - axis] - at) * inward
    own = (beyond < 0.0) & (along > max(start, 0.0)) & (along < min(end, size[axis]))
    point, normal = ((0.0, at), (0.0, inward)) if axis == 0 else ((at, 0.0), (inward, 0.0))
    columns = in_columns(walls[own], x, normal)
    face = PressureFace(columns, point, normal, np.zeros(columns.shape))
    face.hydrostatic(x, section.table[0][1], weight)
    return face


def enclosing(
    sections: Sequence[FaceSection], x: Floats, walls: NDArray[np.int64], size: tuple[float, float], *, full: bool
) -> NDArray[np.int64]:
    """Numbers of the ``walls`` (k,) of a tank of a ``size`` (m) near which water has no surface, so that they continue
    its pressure below zero, too: those in corners beside faces, and, in a tank that is ``full`` (`stays_full`), those
    over the lid.

    Where the pressure under a lid is less than what the rows behind it lie higher, walls that do not pull push the
    water out of the ground: with the lower head as high as the lid 10 and 4 % more left it than was there (20 and 40
    rows).  x (n, 2) m: all particles.
    """
    places = x[walls]
    rows = (places[:, 1] > size[1]) & full
    faces = np.zeros(len(walls), np.bool_)
    for it in sections:
        axis, (at, inward), (start, end) = it.axis, it.across(size), it.reach(size)
        along, behind = places[:, axis], (places[:, 1 - axis] - at) * inward < 0.0
        rows |= behind & (((along < 0.0) & (start <= 0.0)) | ((along > size[axis]) & (end >= size[axis])))
        faces |= behind & (along > max(start, 0.0)) & (along < min(end, size[axis]))
    return walls[rows & ~faces]


def beyond(along: Floats, columns: Floats) -> Floats:
    """How far (m) places ``along`` (n,) m a side lie beyond the ends of a face with wall particles at ``columns`` m."""
    found: Floats = np.maximum(columns.min() - along, along - columns.max())
    return found


class FacePart(Part):
    """What flows through the faces of a scene, and their heads, which may change.

    sections : of the faces of ``flow``, in its order;  flow : of the water;  spacing : of its particles, m;
    weight : ρ g, N/m³.
    """

    def __init__(self, sections: Sequence[FaceSection], flow: PoreFlow, spacing: float, weight: float) -> None:
        self.names, self.weight = names_of(sections, "face"), weight
        self.rising = [(face, it) for face, it in zip(flow.faces, sections, strict=True) if len(it.table) > 1]
        self.faces, self.flow, self.spacing = flow.faces, flow, spacing
        self.outer = [face.columns[self._depth(face, flow.home) < spacing] for face in self.faces]
        taken = np.concatenate([face.columns.ravel() for face in self.faces])
        of_tank = np.arange(flow.layer.fluid, flow.layer.count)
        if isinstance(flow.pairs, CutPairList):  # a pile's particles are seen from its sides alone
            of_tank = of_tank[flow.pairs.side[of_tank] == FREE]
        walls = np.setdiff1d(of_tank, taken)
        self.past = [self._past(it.axis, face, walls) for it, face in zip(sections, self.faces, strict=True)]

    def _past(self, axis: int, face: PressureFace, walls: NDArray[np.int64]) -> NDArray[np.int64]:
        """Those of ``walls`` (k,) that go on in the row of a ``face`` along its ``axis`` where it ends amid a side, as
        far as a kernel reaches, and are nearer to it than to others: what passes an end spreads along the side, beside
        walls that know of no flow."""
        home, reach = self.flow.home, self.flow.law.smoothing.support
        depth = (np.array(face.point) - home[walls]) @ np.array(face.normal)
        along = home[walls, axis]
        inside = (along > self.flow.lower[axis]) & (along < self.flow.upper[axis])
        off = beyond(along, home[face.columns[:, 0], axis])
        own = inside & (depth > 0.0) & (depth < self.spacing) & (off < reach)
        for its in self.faces:
            if (its.point, its.normal) == (face.point, face.normal):
                own &= off <= beyond(along, home[its.columns[:, 0], axis])
        found: NDArray[np.int64] = walls[own]
        return found

    @staticmethod
    def _depth(face: PressureFace, x: Floats) -> Floats:
        """Depths (m, layers), m, behind the face of its wall particles at ``x`` (n, 2) m."""
        depth: Floats = (np.array(face.point) - x[face.columns]) @ np.array(face.normal)
        return depth

    def passed(self, face: PressureFace) -> float:
        """The farthest way (m) that water has gone through a ``face``."""
        layer, home = self.flow.layer.x, self.flow.home
        return float(np.abs(self._depth(face, layer) - self._depth(face, home)).max())

    def before(self) -> None:
        """Set the heads that change to those at the end of the next step."""
        for face, section in self.rising:
            end = np.array(self.flow.time + self.flow.next_step)
            face.hydrostatic(self.flow.layer.x, float(section.heads(end)), self.weight)

    def check(self) -> None:
        """Raise Unstable when more water has passed a face than is there to pass it."""
        for name, face in zip(self.names, self.faces, strict=True):
            way = self.passed(face)
            if way > FARTHEST * self.spacing:
                raise Unstable(
                    name, "distance that water has moved through the face", way, "m", self.flow.step, self.flow.time,
                    f"no more than {FARTHEST:g} spacings of it are there, and flow is 1 % off after half of them, and "
                    "up to 15 % in the end: end sooner, or use a reservoir",
                )  # fmt: skip

    def row(self) -> dict[str, float]:
        """Flow through each face.

        NAME flow in (m2/s) : flow of water through the face into the tank; less than zero where it leaves
        """
        layer, found = self.flow.layer, {}
        near = self.flow.near(self.flow.law.smoothing.kind)
        for name, face, rows, past in zip(self.names, self.faces, self.outer, self.past, strict=True):
            beside = np.zeros(len(past))
            flux_before(past, near, layer.x, layer.record, *face.normal, beside)
            own = layer.record[rows, VX : VY + 1] @ np.array(face.normal)
            found[f"{name} flow in (m2/s)"] = float((own.sum() + beside.sum()) * self.spacing)
        return found
