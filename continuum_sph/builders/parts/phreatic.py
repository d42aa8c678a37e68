"""The phreatic line: heights of the water's surface across the tank, in soil too, as a file and as a line in pictures.

phreatic.csv has a column for each strip, PITCH spacings apart; heights are those of `instruments.surface_height`.
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


def places(width: float, spacing: float) -> Floats:
    """Middles of the strips in a tank of a ``width``, (k,) m."""
    count = min(MOST, max(1, int(width / (PITCH * spacing))))
    middles: Floats = np.linspace(0.0, width, count, endpoint=False)
    middles += 0.5 * width / count
    return middles


def phreatic_row(cloud: MeasuredWater) -> dict[str, float]:
    """A row of phreatic.csv: heights (m) of the water's surface now, 0 where there is none.

    surface at X m (m) : height of the water's surface at X, in soil too; 0 where there is no water
    """
    x = places(cloud.width, cloud.spacing)
    breadth = max(2.0 * PITCH * cloud.spacing, cloud.width / len(x))
    strips = (LevelSection(name="", x=float(at), breadth=breadth) for at in x)
    return {f"{FIRST}{strip.x:.6g} m (m)": surface_height(strip, cloud) for strip in strips}


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
