"""A sheet pile, and its exit gradient i_E: how steep the flow is where it comes out of the ground beside it.

The head over that of the water above it vanishes at the surface of the ground, no water passes the sheet, and at its
tip, z = s, the head has a root: in z = y + ix, y the depth, x the distance from the sheet, it is a sum of

    Re s arcsin(z/s),   Re z √(1 - z²/s²),   …

(the first is that of ground without a base, with h/π s in place of 1).  i_E is the sum of the factors of these two that
least squares give the particles beside the pile, over what its thickness adds (`sheet_flow.thickness_at_exit`).  The
soil there has lost its weight at i = i_c.

Open water and the two uppermost rows of bare ground have heads that go up and down from row to row, at rest too, by up
to 0.2 spacings: the row under a free surface lacks partners.  So the head of open water is its mean by the weight
1 - cos(2πz/4), z the height in spacings above the blurred row: a zig-zag falls out of a mean over 4 rows with it.  Bare
ground is fitted below its second row.

With fewer than LEAST rows beside the sheet, LEAST_BARE of bare ground, there are fewer than two rows between the
surface and the tip, and where ground reaches a lid without a face no water comes out: no number then.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.face import FaceSection
from continuum_sph.scene.pile import SheetPileSection
from continuum_sph.scene.soil import SoilSection
from continuum_sph.seepage import PoreFlow
from continuum_sph.seepage.sheet_flow import thickness_at_exit
from continuum_sph.seepage.sheet_pile import Pile
from porescale.common.core.types import Floats
from porescale.common.record.part import Part

NAME = "exit gradient ()"
"""Column of series.csv in a scene with a pile."""
LEAST = 4.0
"""Spacings that a sheet must reach into the ground for an exit gradient."""
LEAST_BARE = 5.0
"""The same where no water stands on the ground."""
NEAR_TIP = 0.75  # of its depth: how deep the fit goes
WIDE = 2.0  # spacings beside the pile, whose particles are fitted
OPEN = 4.0  # spacings beside it, and above the blurred one over the ground, whose water gives h0
BLURRED = 1.0  # spacings about the surface of the ground, in which kernels round off the bend of the head
BARE = 2.0  # spacings below the surface of bare ground, in which heads zig-zag


def sheet_pile(section: SheetPileSection, spacing: float) -> Pile:
    """The pile of a section, of particles of a ``spacing`` (m)."""
    return Pile(section.column(spacing), section.tip, section.lower_end(spacing), spacing, section.faces == "hold")


def ground_at(section: SoilSection, x: float) -> float:
    """Height (m) of the ground's surface at ``x`` (m) at the start; minus infinity where there is none."""
    return float(np.max([body.top(np.array([x])) for body in section.body]))


class ExitGradientPart(Part):
    """The exit gradient beside a ``pile`` in a ``flow`` of water whose weight is ρ g (N/m³) > 0.

    given : heads (m) over the ground on its left and right at a time (s), None: as found;  lid : height of a closed
    lid, m.
    """

    def __init__(
        self,
        pile: Pile,
        flow: PoreFlow,
        weight: float,
        given: Callable[[float], tuple[float | None, float | None]],
        lid: float = np.inf,
    ) -> None:
        self.pile, self.flow, self.weight, self.given, self.lid = pile, flow, weight, given, lid

    def row(self) -> dict[str, float]:
        """The column of the exit gradient i_E at the sheet pile.

        exit gradient () : hydraulic gradient upwards where water leaves the ground beside the pile; nan where fewer
            than four rows of particles lie beside it, five where no water stands on the ground, and where the ground
            reaches a lid without a face
        """
        return {NAME: exit_gradient(self.pile, self.flow, self.weight, self.given(self.flow.time), self.lid)}


def steepness(z: NDArray[np.complex128], head: Floats, buried: float) -> float:
    """i of ``head`` (n,) m over that at the surface, at z = y + ix (n,) m beside a sheet that is ``buried`` so deep, m;
    no number from fewer than four."""
    if len(z) < 4:
        return float("nan")
    terms = np.column_stack((buried * np.arcsin(z / buried), z * np.sqrt(1.0 - (z / buried) ** 2))).real
    return float(np.linalg.lstsq(terms, head)[0].sum())


def resolved(buried: float, spacing: float, *, bare: bool = False) -> bool:
    """Whether a sheet that is ``buried`` so deep (m) has rows enough of a ``spacing`` (m) beside it, in ``bare`` ground
    or under water."""
    return buried > ((LEAST_BARE if bare else LEAST) - 0.5) * spacing


def closed(top: float, lid: float, spacing: float) -> bool:
    """Whether ground up to ``top`` (m) ends at a closed lid at a height ``lid``, m."""
    return top > lid - 0.5 * spacing


def open_head(above: Floats, head: Floats) -> float | None:
    """Mean ``head`` (n,) m of open water ``above`` (n,) the blurred row over the ground, in spacings, without zig-zags;
    None where there is none within OPEN."""
    weight = np.where((above > 0.0) & (above < OPEN), 1.0 - np.cos(2.0 * np.pi * above / OPEN), 0.0)
    total = float(weight.sum())
    return float(weight @ head) / total if total > 0.0 else None


def beside(
    pile: Pile,
    water: Floats,
    head: Floats,
    soil: Floats,
    given: tuple[float | None, float | None] = (None, None),
    lid: float = np.inf,
) -> float:
    """i_E where water rises beside a ``pile``: the larger of its two sides; no number where the ground is gone or
    closed, or the sheet not deep enough in it.

    water (n, 2) m, head (n,) m: of the water's particles, p/(ρ g) + y;  soil (s, 2) m;  given: head (m) over the ground
    on its left and right, None: as found;  lid : height of a closed lid, m.
    """
    spacing, found = pile.spacing, [float("nan")]
    for side, known in zip((-1.0, 1.0), given, strict=True):
        away, off = side * (water[:, 0] - pile.x) / spacing - 0.5, side * (soil[:, 0] - pile.x) / spacing - 0.5
        ground = soil[(off > 0.0) & (off < WIDE), 1]
        if not ground.size:
            continue
        top = float(ground.max()) + 0.5 * spacing
        depth, buried = top - water[:, 1], top - pile.tip
        if not resolved(buried, spacing):
            continue
        beside_it = (away > 0.0) & (away < OPEN)
        level, blurred = known, BLURRED
        if level is None:
            level = open_head(-depth[beside_it] / spacing - BLURRED, head[beside_it])
        if level is None:  # bare ground
            level, blurred = top, BARE
            if closed(top, lid, spacing) or not resolved(buried, spacing, bare=True):
                return float("nan")
        near = (away > 0.0) & (away < WIDE) & (depth > blurred * spacing) & (depth < NEAR_TIP * buried)
        steep = steepness(depth[near] + 1j * spacing * away[near], head[near] - level, buried)
        found.append(steep / thickness_at_exit(min(1.0, buried / top), top / spacing))
    return float(np.fmax.reduce(found))


def exit_gradient(
    pile: Pile, flow: PoreFlow, weight: float, given: tuple[float | None, float | None], lid: float
) -> float:
    """i_E beside a ``pile`` in the ``flow`` of water whose weight is ρ g (N/m³) > 0;  given, lid: as in `beside`."""
    layer, n = flow.layer, flow.layer.fluid
    there = (layer.mass[:n] > 0.0) & (layer.material[:n] == 0)
    x = layer.x[:n][there]
    return beside(pile, x, layer.pressure[:n][there] / weight + x[:, 1], flow.skeleton.x, given, lid)


def given_heads(
    faces: Sequence[FaceSection], x: float, size: tuple[float, float], spacing: float, time: float = np.inf
) -> tuple[float | None, float | None]:
    """Heads (m) of the nearest faces of the lid on the left and right of a pile at ``x``, m; None where there is none
    within `OPEN` spacings (m) of it.  size : of the tank, m;  time s, left out: in the end."""
    lid, near = [(*it.reach(size), float(it.heads(np.array(time)))) for it in faces if it.side == "lid"], OPEN * spacing
    left = max(((end, head) for start, end, head in lid if start < x < end + near), default=None)
    right = min(((start, head) for start, end, head in lid if start - near < x < end), default=None)
    return left[1] if left else None, right[1] if right else None
