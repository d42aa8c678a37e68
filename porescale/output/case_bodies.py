"""Drawings of discs, polygons and segments for cases that are scripts: by piece, with broken bonds, and as a film."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from porescale.common.core.atomic import whole
from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import pieces, segments_now
from porescale.dem.forces.bonds import touched
from porescale.dem.grains import Grains

LARGEST, DUST = "#d9cbaa", "#e8e8e8"  # colours of the largest piece, and of bodies by themselves
PIECES = ("#7fb0d6", "#e0a458", "#8fbf8f", "#c98bb0", "#b8b35a", "#9a93d1", "#d98880", "#6fbcb0")
CRACK, PLATE = "#b3122b", "#3b4552"


@dataclass
class Shot:
    """Grains at a moment: position (n, 2) m, whole (m,) of the bonds."""

    position: Floats
    whole: NDArray[np.uint8]


def shot(grains: Grains) -> Shot:
    """The present state of the grains as a shot."""
    whole = np.zeros(0, np.uint8) if grains.bonds is None else grains.bonds.whole.copy()
    return Shot(grains.discs.position.copy(), whole)


def by_piece(grains: Grains, at: Shot) -> list[str]:
    """A colour for every disc, (n,): one for each piece, grey for bodies that nothing is bonded to."""
    number = pieces(grains, at.whole)
    bodies = number if not grains.steered else np.where(_first(grains), number, -1)
    alone = np.bincount(bodies[bodies >= 0], minlength=int(number.max()) + 1) == 1
    return [DUST if alone[k] else LARGEST if k == 0 else PIECES[(k - 1) % len(PIECES)] for k in number.tolist()]


def _first(grains: Grains) -> NDArray[np.bool_]:
    """Discs that stand for their bodies: free ones, and the first of each clump."""
    clumps = grains.steering.clumps
    chosen = clumps.group < 0
    chosen[clumps.member[clumps.start[:-1]]] = True
    return np.asarray(chosen)


def draw_bodies(axes: Axes, grains: Grains, at: Shot, colours: list[str] | str = LARGEST, rim: float = 0.3) -> None:
    """Discs, polygons and segments of ``grains`` at a moment; rim : width of outlines, points."""
    d = grains.discs
    shade = [colours] * d.count if isinstance(colours, str) else colours
    own = grains.segments
    free = np.ones(d.count, bool) if own is None else ~own.is_corner
    size = 2.0 * d.radius[free]
    axes.add_collection(EllipseCollection(
        size, size, np.zeros(len(size)), units="x", offsets=at.position[free], transOffset=axes.transData,
        facecolors=[shade[k] for k in np.flatnonzero(free)], edgecolors="#5a5244", linewidths=rim,
    ))  # fmt: skip
    if own is None:
        return
    c = grains.steering.clumps
    closed, rods = [], []
    for body in range(c.count):
        members = c.discs_of(body)
        sides = own.ends[own.group[own.ends[:, 0]] == body]
        if len(sides) == len(members) > 2:
            closed.append((at.position[members], shade[members[0]]))
        else:
            rods += list(at.position[sides])
    if closed:
        axes.add_collection(PolyCollection([part for part, _ in closed], facecolors=[shade for _, shade in closed],
                                           edgecolors="#5a5244", linewidths=rim))  # fmt: skip
    axes.add_collection(LineCollection(rods, colors=PLATE, linewidths=2.5))


def draw_cracks(axes: Axes, grains: Grains, at: Shot, length: float, width: float = 1.0) -> None:
    """Broken bonds whose ends are still near each other, as lines of ``length`` (m) along the crack."""
    bonds, known = grains.bonds, segments_now(grains)
    if bonds is None or known is None:
        return
    gone = (at.whole == 0) & (bonds.back > 0.0)
    ends = np.ascontiguousarray(bonds.ends[gone])
    way, far, other = np.zeros((len(ends), 2)), np.zeros((len(ends), 2)), np.zeros(len(ends), np.int64)
    touched(at.position, ends, known, grains.cell, way, far, other)
    apart = np.hypot(*way.T)
    near = apart - grains.discs.radius[ends[:, 0]] - grains.discs.radius[other] < length
    middle = (at.position[ends[:, 0]] + 0.5 * way)[near]
    along = 0.5 * length * np.column_stack((-way[:, 1], way[:, 0]))[near] / apart[near, None]
    lines = list(np.stack((middle - along, middle + along), axis=1))
    axes.add_collection(LineCollection(lines, colors=CRACK, linewidths=width))


def frame(axes: Axes, view: tuple[float, float, float, float], **more: Any) -> None:
    """Both axes to the same scale, from left to right and bottom to top (m) of ``view``, without ticks."""
    axes.set(aspect="equal", xlim=view[:2], ylim=view[2:], xticks=[], yticks=[], **more)


def pixels(figure: Figure) -> NDArray[np.uint8]:
    """The figure as an RGB image with even sides, for a film."""
    canvas = figure.canvas
    assert isinstance(canvas, FigureCanvasAgg)
    canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[:, :, :3]
    return np.ascontiguousarray(image[: image.shape[0] // 2 * 2, : image.shape[1] // 2 * 2])


def keep(figure: Figure, path: Path) -> None:
    """Write a further picture of a case beside picture.png."""
    with whole(path) as beside:
        figure.savefig(beside, format="png", dpi=100)
