"""How a run is painted: what is shown, in which colours, over which range.  No physics."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from dataclasses import field as default

import matplotlib
import numpy as np
from matplotlib.colors import to_rgb
from scipy.spatial import cKDTree

from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud, Grid, Snapshot

Line = tuple[tuple[float, float], tuple[float, float]]
Lines = Sequence[Line] | Callable[[Snapshot], Sequence[Line]]
Limits = tuple[float, float]
View = tuple[float, float, float, float]

SEQUENTIAL, DIVERGING, SECOND = "viridis", "RdBu_r", "magma"
GRAIN, RIM, WALL, PLATE, PAPER = "#ece3cf", "#3b352b", "#565a61", "#c3c8d0", "#ffffff"
SHIFT = 4
"""OpenCV coordinates in sixteenths of a pixel."""
ONE = 1 << SHIFT
SHARE = 99.5
"""Colours end at this percentile of all values: one outlier must not darken a film."""

SAME = 1e-6
"""Values that differ by this share of them are the same: a few of the smallest steps of the single precision in which
snapshots are stored."""
MARKED = -1
"""The kind of a look that stands for its marks, which are of no point."""
PREFIXES = ((1e-8, 1e9, "n"), (1e-5, 1e6, "µ"), (1e-1, 1e3, "m"), (1e4, 1.0, ""), (1e7, 1e-3, "k"), (1e10, 1e-6, "M"))
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Look:
    """What a picture shows.

    grid, field : cell array to paint, vectors by their length; shown if the snapshot has it;
    cloud : points to draw (None: the first cloud there is, "": none): discs to scale when they carry a
    "radius", dots otherwise;  colour : array of the cloud that colours it (None: plain discs; dots by speed
    when they have one); kinds : value of ``colour`` -> (label, colour), for whole numbers such as materials, MARKED for
    the marks;
    limits, cloud_limits : range of the colours (None: from the values, robustly);
    shapes : a second cloud, whose lines and polygons are drawn, coloured as the first;  marks : lines drawn on top in
    red, a function of the snapshot, such as cracks;  held : so many discs, the last of the cloud, are held or driven,
    and grey as walls are;  walls : cell array holding a solid fraction, painted grey;  lines : segments
    ((x, y), (x, y)) m, or a function of the snapshot;  arrows : velocity arrows across the picture, 0 none, of the
    grid, or of dots;  streamlines : an extra still with them; dot : radius of a dot, m (None: about half the particles'
    spacing);  view : (left, right, bottom, top), m, and box, all that there is, where the view is not that (None: the
    view);  period : of a box periodic in x, in y, m, 0 where it is not: what reaches over a side is seen at the other,
    too;  size : long side, pixels;  plain : places and times are numbers
    without units;  density : kg/m³ of the fluid, round_off : share of a length a step, by which velocities and
    pressures are known to be round-off;  title, label (of the field), colour_map, cloud_map.
    """

    grid: str = "fields"
    field: str = "velocity"
    cloud: str | None = None
    colour: str | None = None
    kinds: Mapping[int, tuple[str, str]] = default(default_factory=dict)
    limits: Limits | None = None
    cloud_limits: Limits | None = None
    shapes: str = ""
    marks: Callable[[Snapshot], Sequence[Line]] | None = None
    held: int = 0
    walls: str = ""
    lines: Lines = ()
    arrows: int = 0
    streamlines: bool = False
    dot: float | None = None
    view: View | None = None
    box: View | None = None
    period: tuple[float, float] = (0.0, 0.0)
    size: int = 1000
    title: str = ""
    plain: bool = False
    label: str = ""
    colour_map: str = ""
    cloud_map: str = ""
    density: float = 0.0
    round_off: float = 1e-12

    @property
    def whole(self) -> View | None:
        """The box, m; None where it is not known."""
        return self.box or self.view

    @property
    def cells(self) -> tuple[str, ...]:
        """The cell arrays that a picture needs."""
        return tuple(name for name in (self.field, self.walls, "velocity" if self.arrows else "") if name)

    def painted(self, snapshot: Snapshot) -> Grid | None:
        """The grid to paint, if the snapshot has it."""
        grid = snapshot.grids.get(self.grid)
        return grid if grid is not None and self.field in grid.cells else None

    def lines_at(self, snapshot: Snapshot) -> Sequence[Line]:
        """The segments of a snapshot."""
        return self.lines(snapshot) if callable(self.lines) else self.lines

    def marks_at(self, snapshot: Snapshot) -> Sequence[Line]:
        """The marks of a snapshot."""
        return self.marks(snapshot) if self.marks is not None else ()

    def drawn(self, snapshot: Snapshot) -> Cloud | None:
        """The cloud to draw, if the snapshot has it."""
        if self.cloud is None:
            return next(iter(snapshot.clouds.values()), None)
        return snapshot.clouds.get(self.cloud)

    def shaped(self, snapshot: Snapshot) -> Cloud | None:
        """The cloud of lines and polygons, if the snapshot has it."""
        return snapshot.clouds.get(self.shapes) if self.shapes else None

    def colouring(self, cloud: Cloud) -> str:
        """The array that colours a cloud, "" when it is plain."""
        if self.colour is not None:
            return self.colour if self.colour in cloud.data else ""
        return "velocity" if "velocity" in cloud.data and "radius" not in cloud.data else ""


@dataclass(frozen=True)
class Scale:
    """Colours of a range of values: 256 RGB rows, the range, and how it is labelled.

    uniform : the value, where all are the same but for round-off; None where they are not.
    """

    table: AnyArray
    low: float
    high: float
    label: str
    factor: float
    map_name: str
    uniform: float | None = None

    def colours(self, values: AnyArray) -> AnyArray:
        """RGB of values, (..., 3) uint8; what is not a number is white."""
        nowhere = np.isnan(values)
        place = np.where(nowhere, self.low, values) if nowhere.any() else values
        place = np.clip(place, self.low, self.high)
        place -= self.low
        place *= 255.0 / (self.high - self.low)
        painted = np.take(self.table, place.astype(np.uint8), axis=0)
        painted[nowhere] = 255
        return painted


def magnitude(values: AnyArray, axes: int) -> AnyArray:
    """Length of vectors, scalars as they are, floating; a scalar has ``axes``: 2 in a grid, 1 in a cloud."""
    if values.ndim > axes:
        length: AnyArray = np.sqrt(np.einsum("...i,...i->...", values, values))
        return length
    return values if values.dtype.kind == "f" else values.astype(np.float64)


def colour_table(map_name: str) -> AnyArray:
    """The 256 RGB rows, uint8, of a colour map of matplotlib."""
    table: AnyArray = (matplotlib.colormaps[map_name](np.arange(256) / 255.0)[:, :3] * 255 + 0.5).astype(np.uint8)
    return table


def scale(
    name: str, units: str, sample: AnyArray, limits: Limits | None, map_name: str, label: str, noise: float = 0.0
) -> Scale:
    """The scale for values like ``sample``: from zero for lengths of vectors and other positive values,
    symmetric and diverging where both signs matter; of one colour where they differ by round-off alone.

    noise : values so small are round-off, in the units of the sample.
    """
    sample = sample[np.isfinite(sample)]
    least, most = (sample.min(), sample.max()) if sample.size else (0.0, 1.0)
    low, high = np.percentile(sample, [100 - SHARE, SHARE]) if sample.size else (0.0, 1.0)
    uniform = None
    if limits is None and most - least <= max(noise, SAME * max(abs(least), abs(most))):
        uniform = 0.0 if max(abs(least), abs(most)) <= noise else float(0.5 * (least + most))
        low, high, map_name = min(0.0, 2 * uniform), max(0.0, 2 * uniform) or float(not uniform), SEQUENTIAL
    elif high - low <= max(noise, SAME * max(abs(low), abs(high))):
        low, high = least, most  # what differs is in few places
    signed = low < 0 < high and min(-low, high) > 0.05 * max(-low, high)
    if limits is not None:
        low, high = limits
        signed = low < 0 < high
    elif signed:
        high = max(-low, high)
        low = -high
    elif 0 <= low < 0.5 * high:
        low = 0.0
    if not high > low:
        high = low + (abs(low) or 1.0) * 1e-3
    chosen = map_name or (DIVERGING if signed else SEQUENTIAL)
    factor, prefixed = _prefix(units, max(abs(low), abs(high)) if uniform is None else abs(uniform))
    shown = label or ("speed" if name == "velocity" else name.replace("_", " "))
    text = f"{shown} ({prefixed})" if prefixed else shown
    label = text if uniform is None else f"{text}, uniform"
    return Scale(colour_table(chosen), float(low), float(high), label, factor, chosen, uniform)


def round_off(snapshot: Snapshot, look: Look, length: float) -> dict[str, float]:
    """Unit -> size of values that are round-off: a ``length`` (m, of a cell or particle) a step, and the pressure of
    waves as fast, times the look's share.  Empty before the first step."""
    if not snapshot.step or not snapshot.time:
        return {}
    speed = length * snapshot.step / snapshot.time
    share = look.round_off
    return {"m/s": share * speed, "Pa": share * look.density * speed**2, "1/s": share * speed / length,
            "m": share * length}  # fmt: skip


def _prefix(units: str, largest: float) -> tuple[float, str]:
    """Factor and unit that give handy numbers: a prefix where the unit takes one, else a power of ten."""
    unit = "" if units in ("1", "-") else units
    if not largest or (1e-1 <= largest < 1e4):
        return 1.0, unit
    if unit in ("m/s", "m", "Pa", "N", "J") and 1e-11 <= largest < PREFIXES[-1][0]:
        return next((factor, prefix + unit) for bound, factor, prefix in PREFIXES if largest < bound)
    if 1e-2 <= largest < 1e-1:
        return 1.0, unit
    power = math.floor(math.log10(largest))
    return 10.0**-power, f"10{str(power).translate(RAISED)} {unit}".rstrip()


def rgb(colour: str) -> tuple[int, int, int]:
    """A matplotlib colour as three bytes."""
    red, green, blue = (round(255 * part) for part in to_rgb(colour))
    return red, green, blue


def length_unit(view: View, plain: bool = False) -> tuple[float, str]:
    """Factor and unit for the axes; plain: none."""
    if plain:
        return 1.0, ""
    longest = max(view[1] - view[0], view[3] - view[2])
    if longest < 0.02:
        return 1e3, "mm"
    return (1e2, "cm") if longest < 5 else (1.0, "m")


def time_text(time: float, longest: float, plain: bool = False) -> str:
    """A time label with as many digits all through a film that lasts ``longest`` seconds; plain: without unit."""
    factor, unit = (1.0, "") if plain else (1e3, "ms") if 0 < longest < 0.1 else (1.0, "s")
    digits = max(0, 2 - math.floor(math.log10(longest * factor))) if longest > 0 else 2
    return f"t = {time * factor:.{digits}f} {unit}".rstrip()


@dataclass
class Survey:
    """Properties of all snapshots that are needed before the first is painted.

    fastest : speed, m/s, that an arrow of full length has;  kinds : those of the look that they have, for the legend.
    """

    look: Look
    field: Scale | None = None
    cloud: Scale | None = None
    view: View = (0.0, 1.0, 0.0, 1.0)
    dot: float = 0.0
    longest: float = 0.0
    fastest: float = 0.0
    kinds: Mapping[int, tuple[str, str]] = default(default_factory=dict)

    def colours(self, cloud: Cloud) -> AnyArray:
        """Colours of points, (n, 3) uint8: of the values, of the kinds, of discs that are held, or of a plain grain."""
        name, count = self.look.colouring(cloud), len(cloud.position)
        painted = np.full((count, 3), rgb(GRAIN), np.uint8)
        if name and self.look.kinds:
            for kind, (_, colour) in self.look.kinds.items():
                painted[np.asarray(cloud.data[name]) == kind] = rgb(colour)
        elif name and self.cloud is not None:
            painted = self.cloud.colours(magnitude(cloud.data[name], 1))
        if self.look.held and "radius" in cloud.data and cloud.lines is None:
            painted[max(0, count - self.look.held) :] = rgb(PLATE)
        return painted


def survey(snapshots: Iterable[Snapshot], look: Look) -> Survey:
    """Colour ranges, view, dot size and time format common to ``snapshots`` (read once, one at a time)."""
    found = Survey(look)
    values: list[AnyArray] = []
    points: list[AnyArray] = []
    speeds: list[AnyArray] = []
    field_units, cloud_units, coloured_by = "", "", ""
    noise: dict[str, float] = {}
    box = [math.inf, -math.inf, math.inf, -math.inf]
    kinds: set[int] = set()
    for snapshot in snapshots:
        found.longest = max(found.longest, snapshot.time)
        grid, cloud = look.painted(snapshot), look.drawn(snapshot)
        if grid is not None:
            values.append(_thin(magnitude(grid.cells[look.field], 2)))
            field_units = grid.units.get(look.field, "")
            found.view = grid.extent
            noise = round_off(snapshot, look, grid.spacing[0]) or noise
        for part in (look.shaped(snapshot), cloud):
            if part is not None and len(part.position) and look.colouring(part):
                coloured_by = look.colouring(part)
                kinds |= {int(it) for it in np.unique(part.data[coloured_by])} if look.kinds else set()
                points.append(_thin(magnitude(part.data[coloured_by], 1)))
                cloud_units = part.units.get(coloured_by, "")
        if look.arrows:
            moving = [*(it.cells for it in [grid] if it), *(it.data for it in [cloud] if it)]
            speeds += [_thin(magnitude(it["velocity"], it["velocity"].ndim - 1)) for it in moving if "velocity" in it]
        if look.kinds and len(look.marks_at(snapshot)):
            kinds.add(MARKED)
        if cloud is None or not len(cloud.position):
            continue
        if "radius" not in cloud.data and not found.dot:
            found.dot = look.dot or 0.55 * _spacing(cloud.position)
        reach = np.broadcast_to(cloud.data.get("radius", found.dot), len(cloud.position))[:, None]
        if grid is None:
            noise = round_off(snapshot, look, 2 * float(np.median(reach))) or noise
        there = np.isfinite(cloud.position).all(1)
        if not there.any():
            continue
        edges = (*(cloud.position - reach)[there].min(0), *(cloud.position + reach)[there].max(0))
        box = [min(box[0], edges[0]), max(box[1], edges[2]), min(box[2], edges[1]), max(box[3], edges[3])]
    if values:
        sample = np.concatenate(values)
        least = noise.get(field_units, 0.0)
        found.field = scale(look.field, field_units, sample, look.limits, look.colour_map, look.label, least)
    elif math.isfinite(box[0]):
        margin = 0.03 * max(box[1] - box[0], box[3] - box[2])
        found.view = (box[0] - margin, box[1] + margin, box[2] - margin, box[3] + margin)
    if points and not look.kinds:
        sample, least = np.concatenate(points), noise.get(cloud_units, 0.0)
        other = look.cloud_map or (SECOND if values else "")  # two quantities, two maps
        found.cloud = scale(coloured_by, cloud_units, sample, look.cloud_limits, other, "", least)
    if speeds and (fastest := float(np.nanpercentile(np.concatenate(speeds), SHARE))) > noise.get("m/s", 0.0):
        found.fastest = fastest
    found.view = look.view or found.view
    found.kinds = {kind: value for kind, value in look.kinds.items() if kind in kinds}
    return found


def _thin(values: AnyArray, most: int = 20000) -> AnyArray:
    """At most about ``most`` of the values, evenly spread."""
    flat = values.ravel()
    return flat[:: max(1, flat.size // most)].astype(np.float64)


def _spacing(position: AnyArray) -> float:
    """Median distance to the nearest other point, m."""
    if len(position) < 2:
        return 0.0
    nearest = cKDTree(position).query(position[:2000], k=2)[0][:, 1]
    return float(np.median(nearest))
