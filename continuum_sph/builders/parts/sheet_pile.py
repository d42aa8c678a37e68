"""A sheet pile, and its exit gradient i_E: how steep the flow is where it comes out of the ground beside it.

Along the pile the head is odd in depth below the surface of the ground, so its first terms are h0 + i d + c d³, down
to some way before the tip, where it has a root; h0 is that of the open water above, or of the ground itself where it
is dry.  i is what least squares fits to the particles beside the pile.  The soil there has lost its weight at i = i_c.
"""

import numpy as np

from continuum_sph.scene.pile import SheetPileSection
from continuum_sph.seepage import PoreFlow
from continuum_sph.seepage.sheet_pile import Pile
from porescale.common.core.types import Floats
from porescale.common.record.part import Part

NAME = "exit gradient ()"
"""Column of series.csv in a scene with a pile."""
SHARE, ROWS = 0.6, 3.0
"""How deep the fit goes: share of the sheet's depth, and spacings at least."""
WIDE = 2.0  # spacings beside the pile, whose particles are fitted
OPEN = 4.0  # spacings beside it and above the ground, whose water gives h0
BLURRED = 1.0  # spacings about the surface of the ground, in which kernels round off the bend of the head


def sheet_pile(section: SheetPileSection, spacing: float) -> Pile:
    """The pile of a section, of particles of a ``spacing`` (m)."""
    return Pile(section.column(spacing), section.lower_end(spacing), spacing, section.faces == "hold")


class ExitGradientPart(Part):
    """The exit gradient beside a ``pile`` in a ``flow`` of water whose weight is ρ g (N/m³) > 0."""

    def __init__(self, pile: Pile, flow: PoreFlow, weight: float) -> None:
        self.pile, self.flow, self.weight = pile, flow, weight

    def row(self) -> dict[str, float]:
        """The column of the exit gradient i_E at the sheet pile.

        exit gradient () : hydraulic gradient upwards where water leaves the ground beside the pile
        """
        return {NAME: exit_gradient(self.pile, self.flow, self.weight)}


def reach(buried: float, spacing: float) -> float:
    """How deep (m) the fit goes beside a sheet that is ``buried`` so deep (m)."""
    return max(ROWS * spacing, SHARE * buried)


def steepness(depth: Floats, head: Floats) -> float:
    """i of i d + c d³ for ``head`` (n,) m over that at the surface, at ``depth`` (n,) m; none from fewer than 2."""
    if len(depth) < 2:
        return float("nan")
    return float(np.linalg.lstsq(np.column_stack((depth, depth**3)), head)[0][0])


def beside(pile: Pile, water: Floats, head: Floats, soil: Floats) -> float:
    """i_E where water rises beside a ``pile``: the larger of its two sides; no number where the ground is gone.

    water (n, 2) m, head (n,) m: of the water's particles, p/(ρ g) + y;  soil (s, 2) m.
    """
    spacing, found = pile.spacing, [float("nan")]
    for side in (-1.0, 1.0):
        away, off = side * (water[:, 0] - pile.x) / spacing - 0.5, side * (soil[:, 0] - pile.x) / spacing - 0.5
        ground = soil[(off > 0.0) & (off < WIDE), 1]
        if not ground.size:
            continue
        top = float(ground.max()) + 0.5 * spacing
        depth = top - water[:, 1]
        # A pile ends a spacing above the sheet that it stands for.
        deepest = reach(top - pile.bottom + spacing, spacing)
        near = (away > 0.0) & (away < WIDE) & (depth > BLURRED * spacing) & (depth < deepest)
        over = (away > 0.0) & (away < OPEN) & (depth < -BLURRED * spacing) & (depth > -OPEN * spacing)
        level = float(head[over].mean()) if over.any() else top
        found.append(steepness(depth[near], head[near] - level))
    return float(np.fmax.reduce(found))


def exit_gradient(pile: Pile, flow: PoreFlow, weight: float) -> float:
    """i_E beside a ``pile`` in the ``flow`` of water whose weight is ρ g (N/m³) > 0."""
    layer, n = flow.layer, flow.layer.fluid
    there = (layer.mass[:n] > 0.0) & (layer.material[:n] == 0)
    x = layer.x[:n][there]
    return beside(pile, x, layer.pressure[:n][there] / weight + x[:, 1], flow.skeleton.x)
