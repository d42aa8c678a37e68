"""A scene before it runs: its initial state to scale, everything that it has labelled, and a lens on the resolution."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle

from porescale.common.core.types import AnyArray
from porescale.common.pictures.axes import draw_inside, walls
from porescale.common.pictures.layout import DPI, along, fit_ticks, kinds_of, pixels, scaled, tick_sizes
from porescale.common.pictures.look import Look, Survey, View, length_unit, survey
from porescale.common.record.model import Snapshot

FONT = 10.0
LINE, WIDTH, HEIGHT, LENS, MARGIN, PAD = 0.23, 6.4, 7.0, 2.3, 0.75, 0.35
"""Inches: a line of text, the picture at the most, the lens, the margins for ticks, and between parts."""
LYING = 1.8
"""Width over height of a box from which labels stand below it instead of beside it."""
WATER = "#e3eef7"
COLOURS = {"side": "#33373d", "open": "#1f6fb2", "moves": "#b8560f", "measures": "#7b2f8a"}
"""Of what bounds, lets through or supplies, moves, and measures."""
MAGNIFIED = 1.6
"""Side of the lens in diameters of its grain, or LATTICE cells where there is none."""
LATTICE = 8
Points = Sequence[tuple[float, float]]


@dataclass(frozen=True)
class Feature:
    """Something in a scene that is drawn and labelled.

    kind : of COLOURS;  label : in a few words, with numbers;  path : points joined by a line;  area : corners of what
    is shaded;  marks : points by themselves;  course : points that something passes, from its start to its end;
    dashed : the line is;  at : where the label's leader ends (None: in the middle of the first of these that there is).
    Lengths in m.
    """

    kind: str
    label: str
    path: Points = ()
    area: Points = ()
    marks: Points = ()
    course: Points = ()
    dashed: bool = False
    at: tuple[float, float] | None = None

    @property
    def anchor(self) -> tuple[float, float]:
        """Where the label points to."""
        if self.at is not None:
            return self.at
        points = np.array(self.marks[:1] or self.path or self.area or self.course, float)
        if self.area and not (self.marks or self.path):
            low, high = points.min(axis=0), points.max(axis=0)
            return float(0.5 * (low[0] + high[0])), float(0.5 * (low[1] + high[1]))
        middle = points[(len(points) - 1) // 2 : len(points) // 2 + 1].mean(axis=0)
        return float(middle[0]), float(middle[1])


@dataclass(frozen=True)
class Lens:
    """What the lens magnifies.

    spacing : of the lattice or particles, m;  centre, diameter : of the grain in it, m, 0 without one;  text : what it
    shows;  lattice : whether lines of cells are drawn.
    """

    spacing: float
    centre: tuple[float, float]
    diameter: float
    text: str
    lattice: bool = True

    @property
    def view(self) -> View:
        """The square that is magnified."""
        half = (
            max(MAGNIFIED * self.diameter / 2 * 1.2, 2 * self.spacing) if self.diameter else LATTICE / 2 * self.spacing
        )
        (x, y) = self.centre
        return x - half, x + half, y - half, y + half


@dataclass(frozen=True)
class Initial:
    """What the picture of a scene shows: its look, features and lens."""

    look: Look
    features: Sequence[Feature]
    lens: Lens | None = None


def initial_figure(snapshot: Snapshot, shown: Initial) -> Figure:
    """The picture: the state to scale, labels beside it (below a wide box) with a line to what each names, the lens."""
    found = survey([snapshot], replace(shown.look, field="", arrows=0))
    found.view = _with_room(found.view)
    place = _Place(found, shown)
    figure = Figure((place.width, place.height), dpi=DPI)
    axes = place.axes(figure, place.box)
    factor, unit = length_unit(found.view, shown.look.plain)
    _state(snapshot, found, axes, factor)
    axes.tick_params(**tick_sizes(FONT))
    axes.set_xlabel(along("x", unit), fontsize=FONT)
    axes.set_ylabel(along("y", unit), fontsize=FONT)
    axes.spines[:].set_visible(False)
    if place.lying:  # leaders go down from the box
        axes.xaxis.tick_top()
        axes.xaxis.set_label_position("top")
    for feature in shown.features:
        _draw(axes, feature, factor)
    place.labels(figure)
    for row, line in enumerate(place.title):
        down = 1 - (0.25 + row * LINE) / place.height
        figure.text(0.15 / place.width, down, line, fontsize=1.1 * FONT, parse_math=False)
    if shown.lens is not None:
        _magnified(axes, place.axes(figure, place.lens), snapshot, found, shown.lens)
    if found.kinds:
        x, y, _, _ = place.legend
        corner = x / place.width, 1 - y / place.height
        figure.legend(handles=kinds_of(found), loc="upper left", bbox_to_anchor=corner, fontsize=FONT,
                      frameon=False, borderpad=0, borderaxespad=0)  # fmt: skip
    fit_ticks(figure, [axes])
    return figure


def initial_pixels(snapshot: Snapshot, shown: Initial) -> AnyArray:
    """`initial_figure` as (height, width, 3) uint8 RGB."""
    return pixels(initial_figure(snapshot, shown))


def _with_room(view: View) -> View:
    """The view with a little around it, so that lines on its sides are seen whole."""
    more = 0.012 * max(view[1] - view[0], view[3] - view[2])
    return view[0] - more, view[1] + more, view[2] - more, view[3] + more


def _state(snapshot: Snapshot, found: Survey, axes: Axes, factor: float) -> None:
    """Fluid as a pale ground, solids of its cells grey, discs, dots and bodies."""
    grid = snapshot.grids.get(found.look.grid)
    if grid is not None:
        left, right, bottom, top = scaled(grid.extent, factor)
        axes.add_patch(Rectangle((left, bottom), right - left, top - bottom, facecolor=WATER, zorder=0))
        if found.look.walls in grid.cells:
            grey = walls(grid, found.look, 0.7)
            axes.imshow(grey, extent=(left, right, bottom, top), origin="lower", interpolation="nearest", zorder=0.5)
    draw_inside(snapshot, found, axes)


def _draw(axes: Axes, feature: Feature, factor: float) -> None:
    """Lines, areas, marks and courses of a feature."""
    colour = COLOURS[feature.kind]
    style = "--" if feature.dashed else "-"
    if feature.area:
        corners = np.array(feature.area) * factor
        axes.add_patch(Polygon(corners, facecolor=colour, alpha=0.13, zorder=2.5))
        axes.add_patch(Polygon(corners, fill=False, edgecolor=colour, linestyle=style, linewidth=1.2, zorder=2.6))
    if feature.path:
        wide = 2.4 if feature.kind in ("side", "open") else 1.6
        axes.plot(*(np.array(feature.path) * factor).T, style, color=colour, linewidth=wide, zorder=3, clip_on=False)
    if feature.marks:
        axes.plot(*(np.array(feature.marks) * factor).T, "x", color=colour, markersize=6, markeredgewidth=1.6, zorder=4)
    if len(feature.course) > 1 and np.ptp(np.array(feature.course)):
        way = np.array(feature.course) * factor
        axes.plot(*way.T, "-", color=colour, linewidth=1.2, zorder=3.5, clip_on=True)
        before = way[np.hypot(*(way - way[-1]).T) > 1e-9 * np.ptp(way)]  # it may stand still at the end
        axes.annotate("", way[-1], before[-1], arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.2}, zorder=3.6,
                      annotation_clip=True)  # fmt: skip


def _magnified(main: Axes, lens: Axes, snapshot: Snapshot, found: Survey, what: Lens) -> None:
    """One grain with the lines of the lattice over it, and where it is."""
    seen = replace(found, view=what.view)
    factor, _ = length_unit(what.view, found.look.plain)
    _state(snapshot, seen, lens, factor)
    left, right, bottom, top = scaled(what.view, factor)
    lens.set(xticks=(), yticks=(), xlim=(left, right), ylim=(bottom, top))
    lens.spines[:].set_linewidth(1.2)
    if what.lattice:
        step = what.spacing
        columns = np.arange(np.ceil(what.view[0] / step - 1e-6), what.view[1] / step + 1e-6) * step * factor
        rows = np.arange(np.ceil(what.view[2] / step - 1e-6), what.view[3] / step + 1e-6) * step * factor
        lines = [[(x, bottom), (x, top)] for x in columns] + [[(left, y), (right, y)] for y in rows]
        lens.add_collection(LineCollection(lines, colors="black", linewidths=0.4, alpha=0.55, zorder=5), autolim=False)
    lens.set_title(what.text, fontsize=0.95 * FONT, loc="left", pad=4)
    left, right, bottom, top = scaled(what.view, length_unit(found.view, found.look.plain)[0])
    main.add_patch(Rectangle((left, bottom), right - left, top - bottom, fill=False, linewidth=0.8, zorder=6))


class _Place:
    """Where picture, labels, lens and legend stand, in inches from the upper left corner: (x, y, width, height)."""

    def __init__(self, found: Survey, shown: Initial) -> None:
        left, right, bottom, top = found.view
        aspect = (right - left) / (top - bottom)
        self.features = [it for it in shown.features if it.label]
        self.view, self.lying = found.view, aspect >= LYING
        high = min(HEIGHT, WIDTH / aspect) if not self.lying else (1.6 * WIDTH) / aspect
        high, wide = max(high, 0.5), max(high * aspect, 0.5)
        longest = max([len(it.label) for it in self.features], default=0) * 0.079 + 0.2
        self.title = wrap(found.look.title, 60 if aspect < 0.5 else 90)
        head = 0.3 + LINE * len(self.title) + 0.45 * self.lying
        lens = LENS if shown.lens is not None else 0.0
        titled = max(lens, len(shown.lens.text) * 0.085) if shown.lens is not None else 0.0
        legend = LINE * len(found.kinds)
        if self.lying:
            self.box = (MARGIN, head, wide, high)
            self.rows, depth = self._flags(wide)
            low = head + high + 0.2 + depth * LINE + PAD
            self.lens, self.legend = (MARGIN, low + LINE, lens, lens), (MARGIN + titled + PAD, low, 0.0, 0.0)
            self.width = MARGIN + wide + PAD + max(self.overhang - wide, 0.0)
            self.height = low + max(lens + LINE + PAD if lens else 0.0, legend) + 0.1
            return
        tall = max(high, LINE * 1.1 * len(self.features))
        self.box = (MARGIN, head + 0.5 * (tall - high), wide, high)
        self.column = MARGIN + wide + 0.45
        aside = self.column + longest
        self.lens = (aside, head + LINE, lens, lens)
        self.legend = (aside, head + (lens + 2 * LINE if lens else 0.0), 0.0, 0.0)
        widest = max([len(it) for it in self.title], default=0) * 0.09 + 0.2
        kinds = 2.0 if found.kinds else 0.0
        self.width = max(aside + max(titled, kinds) + PAD, widest)
        self.height = head + max(tall, lens + legend + 3 * LINE if lens else legend) + 0.65
        self.spread = head, tall

    def axes(self, figure: Figure, box: tuple[float, float, float, float]) -> Axes:
        """New axes in a box."""
        x, y, width, height = box
        where = x / self.width, 1 - (y + height) / self.height, width / self.width, height / self.height
        return figure.add_axes(where)

    def _at(self, point: tuple[float, float]) -> tuple[float, float]:
        """Inches of a point (m) of the scene, within the picture."""
        left, right, bottom, top = self.view
        x, y, width, height = self.box
        across = min(max((point[0] - left) / (right - left), 0.0), 1.0)
        up = min(max((point[1] - bottom) / (top - bottom), 0.0), 1.0)
        return x + across * width, y + (1 - up) * height

    def _flags(self, wide: float) -> tuple[dict[int, int], int]:
        """Row below the box of each label, so that no label lies upon another or upon a leader; and how many rows.

        A label begins at its leader and goes to the right; those whose leaders it would reach stand higher.
        """
        order = sorted(range(len(self.features)), key=lambda k: -self._at(self.features[k].anchor)[0])
        rows: dict[int, int] = {}
        self.overhang = wide
        for k in order:
            x = self._at(self.features[k].anchor)[0]
            end = x + len(self.features[k].label) * 0.079 + 0.2
            self.overhang = max(self.overhang, end - MARGIN)
            under = [rows[j] for j in rows if self._at(self.features[j].anchor)[0] < end]
            rows[k] = 1 + max(under, default=-1)
        return rows, 1 + max(rows.values(), default=-1)

    def labels(self, figure: Figure) -> None:
        """Labels, each with a thin line to what it names."""
        targets = self._flag_places() if self.lying else self._column_places()
        for k, (x, y) in targets.items():
            feature = self.features[k]
            anchor = self._at(feature.anchor)
            colour = COLOURS[feature.kind]
            how: dict[str, Any] = {"fontsize": FONT, "color": colour, "va": "center", "parse_math": False}
            figure.text(x / self.width, 1 - y / self.height, feature.label, **how)
            ends = [(anchor[0], anchor[1]), (x - 0.05, y)]
            if self.lying:
                ends = [(anchor[0], anchor[1]), (anchor[0], y), (x - 0.03, y)]
            line = np.array([(at / self.width, 1 - up / self.height) for at, up in ends])
            figure.add_artist(_leader(line, colour))
            figure.add_artist(_leader(line[:1], colour))

    def _flag_places(self) -> dict[int, tuple[float, float]]:
        low = self.box[1] + self.box[3] + 0.2
        return {k: (self._at(self.features[k].anchor)[0] + 0.12, low + (row + 0.5) * LINE)
                for k, row in self.rows.items()}  # fmt: skip

    def _column_places(self) -> dict[int, tuple[float, float]]:
        """Labels in a column, as near the height of what they name as they go without lying upon each other."""
        order = sorted(range(len(self.features)), key=lambda k: self._at(self.features[k].anchor)[::-1])
        head, tall = self.spread
        wanted, step = [self._at(self.features[k].anchor)[1] for k in order], 1.1 * LINE
        placed: list[float] = []
        for y in wanted:
            placed.append(max(y, placed[-1] + step if placed else head + 0.5 * step))
        limit = head + tall - 0.5 * step
        for k in range(len(placed) - 1, -1, -1):
            placed[k] = min(placed[k], limit)
            limit = placed[k] - step
        return {k: (self.column, y) for k, y in zip(order, placed, strict=True)}


def _leader(line: AnyArray, colour: str) -> Line2D:
    """A thin line, or a dot where it is one point."""
    dot = len(line) == 1
    return Line2D(line[:, 0], line[:, 1], color=colour, linewidth=0.6, marker="o" if dot else "", markersize=2.6)
