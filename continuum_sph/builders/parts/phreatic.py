"""The phreatic line: heights of the water's surface across the tank, in soil too, as a file and as a line in pictures.

phreatic.csv has a column for each strip, PITCH spacings apart; heights are those of `instruments.surface_height`.  Two
more say how far it has come in the soil beside the open water, and how much it sags.
"""

from collections.abc import Callable, Mapping

import numpy as np

from continuum_sph.builders.parts.instruments import MeasuredWater, surface_height
from continuum_sph.scene.instruments import LevelSection
from porescale.common.core.types import Floats
from porescale.common.pictures.look import Line
from porescale.common.record.model import Snapshot

NAME = "phreatic"
PITCH = 2.0  # spacings between strips, twice as broad: those of the spacing itself hold too few particles in pores
MOST = 200  # strips
FIRST = "surface at "  # of a column's name, before x
END, SAG = "wetted to (m)", "sag of the line ()"


def places(width: float, spacing: float) -> Floats:
    """Middles of the strips in a tank of a ``width``, (k,) m."""
    count = min(MOST, max(1, int(width / (PITCH * spacing))))
    middles: Floats = np.linspace(0.0, width, count, endpoint=False)
    middles += 0.5 * width / count
    return middles


def phreatic_row(cloud: MeasuredWater, soil: Floats) -> dict[str, float]:
    """A row of phreatic.csv: heights (m) of the water's surface now, 0 where there is none;  soil (n, 2) m: its
    particles.

    surface at X m (m) : height of the water's surface at X, in soil too; 0 where there is no water
    wetted to (m) : x of the last strip of the line that starts where the leftmost open water meets soil; 0 without one
    sag of the line () : mean height of the chord of that line over it, as a share of the chord's fall; 0 without one
    """
    x = places(cloud.width, cloud.spacing)
    breadth = max(2.0 * PITCH * cloud.spacing, cloud.width / len(x))
    strips = (LevelSection(name="", x=float(at), breadth=breadth) for at in x)
    row = {f"{FIRST}{strip.x:.6g} m (m)": surface_height(strip, cloud) for strip in strips}
    ground = top(soil, x, cloud.spacing) + 0.5 * cloud.spacing
    end, sag = sagging(*wetting_line(x, np.array(list(row.values())), ground))
    return row | {END: end, SAG: sag}


def wetting_line(x: Floats, heights: Floats, ground: Floats) -> tuple[Floats, Floats]:
    """Places and heights (m, m) of the line from where the leftmost open water meets soil to the last strip that it
    reaches there.

    x, heights, ground (k,) m : middles of strips, the water's surface and the ground's there.  It starts where surface
    and ground cross.  Empty without open water on the left of wet soil.
    """
    wet = heights > 0.0
    within = wet & (heights < ground)
    edges = np.flatnonzero(within[1:] & wet[:-1] & ~within[:-1])
    if not edges.size:
        return np.zeros(0), np.zeros(0)
    first = int(edges[0]) + 1
    beyond = np.flatnonzero(~within[first:])
    last = first + int(beyond[0]) if beyond.size else len(x)
    over, under = heights[first - 1] - ground[first - 1], ground[first] - heights[first]
    part = over / (over + under) if np.isfinite(over) else 0.5  # of the way between both strips
    start = x[first - 1] + part * (x[first] - x[first - 1])
    level = heights[first - 1] + part * (heights[first] - heights[first - 1])
    return np.concatenate(([start], x[first:last])), np.concatenate(([level], heights[first:last]))


def sagging(x: Floats, line: Floats) -> tuple[float, float]:
    """(last place, m;  sag) of a ``line`` (k,) m at places ``x`` (k,) m: the mean height of its chord over it, as a
    share of the chord's fall; both 0 of fewer than 4 points, with which it has hardly begun.

    0 is a straight line, 1/6 the wave of a dam that breaks (Ritter 1892), -1/6 a parabola that stands upright at its
    foot, -0.049 the exact solution of Boussinesq's equation for water that enters dry ground (Barenblatt 1952).
    """
    if len(x) < 4 or line[0] <= line[-1]:
        return 0.0, 0.0
    below = 0.5 * (line[0] + line[-1]) - np.trapezoid(line, x) / (x[-1] - x[0])
    return float(x[-1]), float(below / (line[0] - line[-1]))


def line_of(table: Mapping[str, Floats], spacing: float) -> Callable[[Snapshot], list[Line]]:
    """What draws the rows of phreatic.csv into snapshots: the surface of the water as far as it lies in soil, or within
    a ``spacing`` (m) over it."""
    names = [name for name in table if name.startswith(FIRST)]
    x = np.array([float(name.removeprefix(FIRST).split()[0]) for name in names])

    def line(snapshot: Snapshot) -> list[Line]:
        """Segments ((x, y), (x, y)), m, of the row nearest in time."""
        times = table.get("time (s)", np.zeros(0))
        if len(x) < 2 or not len(times):
            return []
        row = int(np.abs(times - snapshot.time).argmin())
        heights = np.array([table[name][row] for name in names])
        within = (heights > 0.0) & (heights < top(snapshot.clouds["soil"].position, x, spacing) + spacing)
        both = np.flatnonzero(within[:-1] & within[1:])
        return [((float(x[k]), float(heights[k])), (float(x[k + 1]), float(heights[k + 1]))) for k in both]

    return line


def top(soil: Floats, x: Floats, spacing: float) -> Floats:
    """Height (m) of the highest particle of ``soil`` (n, 2) m within a ``spacing`` of each of ``x`` (k,) m; below all
    numbers where there is none."""
    found = np.full(len(x), -np.inf)
    for k, at in enumerate(x):
        near = np.abs(soil[:, 0] - at) < spacing
        found[k] = soil[near, 1].max(initial=-np.inf)
    return found
