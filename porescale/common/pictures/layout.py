"""Where panels, colour bars, titles and ticks of a figure go, at any aspect, without one text over another.

Lengths are dots of the figure, whose rows count from its top; a film paints the inside of panels by the dot.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Patch
from matplotlib.textpath import text_to_path
from matplotlib.ticker import FixedLocator, MaxNLocator, ScalarFormatter

from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import Scale, Survey, View, length_unit

MM, DPI = 1 / 25.4, 100
LEFT, RIGHT, BOTTOM = 5.1, 1.4, 4.2
"""Room of ticks and labels around panels, in heights of the font."""
ASIDE, BELOW, LINE = 6.8, 4.9, 1.55
"""Room of an upright and of a lying colour bar and of a line of text, likewise."""
GAP = 1.8
"""Between panels."""
LEAST = 24
"""Dots that a panel measures at the least."""
TITLE_LINES = 3
HINTED = 1.07
"""By how much small letters may be wider than their outlines, which are moved to whole dots."""


@dataclass(frozen=True)
class Style:
    """What a figure is for.

    width, height : inches that it may take at the most;  font : points;  dpi;  lettered : panels have letters, where
    there are several;  scale_bar : a bar of a round length above the first;  titled : it has a title.
    """

    width: float
    height: float
    font: float
    dpi: int = DPI
    lettered: bool = False
    scale_bar: bool = False
    titled: bool = True


STYLES = {
    "paper": Style(174 * MM, 230 * MM, 8.0, 300, lettered=True, scale_bar=True, titled=False),
    "talk": Style(40 / 3, 7.5, 17.0, 144),
}
"""A page of a journal, whose caption says what the title would, and a slide of 16 : 9."""
COLUMN = 85 * MM
"""Inches of a column of a journal, for one panel."""


def screen(size: float, wider: float = 1.0) -> Style:
    """The style of pictures ``size`` pixels long, with text that grows with it; ``wider`` : than that."""
    return Style(wider * size / 100, wider * size / 100, 10.0 * size / 1000)


@dataclass
class Stage:
    """A figure with its panels, of which nothing but the inside is missing.

    boxes : (x, y, width, height) of the inside of each panel, whole dots, y from the top;  font : points.
    """

    figure: Figure
    boxes: list[tuple[int, int, int, int]]
    panels: list[Axes] = field(default_factory=list)
    font: float = 10.0

    @property
    def full(self) -> tuple[int, int]:
        """Width and height, dots."""
        width, height = self.figure.get_size_inches() * self.figure.dpi
        return round(width), round(height)

    def axes(self, x: float, y: float, width: float, height: float) -> Axes:
        """New axes at dots counted from the upper left corner."""
        full_x, full_y = self.full
        return self.figure.add_axes((x / full_x, 1 - (y + height) / full_y, width / full_x, height / full_y))

    def text(self, x: float, y: float, text: str, **how: Any) -> None:
        """Text whose baseline is at dots counted from the upper left corner; a $ in it is no formula."""
        full_x, full_y = self.full
        how = {"fontsize": self.font, "va": "baseline", "parse_math": False, **how}
        self.figure.text(x / full_x, 1 - y / full_y, text, **how)


def stage(found: Survey, headers: Sequence[str], style: Style, *, blank: bool = False) -> Stage:
    """A figure of one panel for each header, with ticks, headers, title, colour bars and legend.

    A single header stands right beside the title where both fit.  blank : room is left for headers, no more.
    """
    left, right, bottom, top = found.view
    plan = _Plan(found, list(headers), style, (right - left) / (top - bottom))
    made = Stage(Figure((plan.full[0] / style.dpi, plan.full[1] / style.dpi), dpi=style.dpi), plan.boxes, font=plan.own)
    for k, (x, y, width, height) in enumerate(plan.boxes):
        axes = made.axes(x, y, width, height)
        made.panels.append(axes)
        _dress(axes, found, made.font, x_label=k + plan.columns >= len(headers), y_label=k % plan.columns == 0)
        lines = [] if blank else plan.headers[k]
        for row, line in enumerate(lines):
            at = y - plan.font * (0.45 + LINE * (len(lines) - 1 - row))
            if plan.beside:
                made.text(x + width, at, line, ha="right")
            else:
                made.text(x, at, line)
    x, y, width, _ = plan.boxes[0]
    for row, line in enumerate(plan.title):
        at = y - 0.45 * plan.font if plan.beside else plan.font * (1.2 + LINE * row)
        made.text(x if plan.beside else plan.title_at, at, line, fontsize=1.05 * made.font)
    if style.scale_bar and not found.look.plain:
        _length_bar(made, found, plan)
    _keys(made, found, plan)
    fit_ticks(made.figure, made.panels)
    return made


class _Plan:
    """Sizes and places in dots: panels as large as the style lets them be."""

    def __init__(self, found: Survey, headers: list[str], style: Style, aspect: float) -> None:
        self.own, self.font = style.font, style.font * style.dpi / 72
        self.scales = [scale for scale in (found.field, found.cloud) if scale is not None]
        self.kinds = [label for label, _ in found.kinds.values()]
        self.bar_line = LINE * self.font if style.scale_bar and not found.look.plain else 0.0
        self.limit = style.width * style.dpi - 2, style.height * style.dpi - 2  # rounded up to even dots
        text = found.look.title if style.titled else ""
        self.headers, self.title, self.beside, self.upright = [[it] for it in headers], [text] * bool(text), False, True
        longest = max([self.width_of(it.label) for it in self.scales], default=0.0)
        for _ in range(4):  # lines of text need room, which takes it from the panels, and so on
            self._solve(len(headers), aspect)
            columns, rows, width, height = self.columns, self.rows, self.width, self.height
            tall = rows * height + (rows - 1) * (GAP * self.font + self.above)
            self.upright = self.upright and longest < tall and len(self.kinds) * LINE * self.font < tall
            room = width + (GAP - 0.6) * self.font if columns > 1 else width + RIGHT * self.font
            self.title_at = min(self.left, 0.6 * self.font)
            fits = self.width_of(text) * 1.05 + self.width_of(headers[0]) + 2 * self.font < width
            self.beside = len(headers) == 1 and bool(text) and fits
            self.headers = [self._wrapped(it, room) if it else [] for it in headers]
            wide = self.left + columns * width + (columns - 1) * GAP * self.font + self.aside - self.title_at
            self.title = self._wrapped(text, wide / 1.08)[:TITLE_LINES] if text else []
        self._place(len(headers))

    def width_of(self, text: str) -> float:
        """Dots of a line of text."""
        size = FontProperties(size=self.own)
        wide, _, _ = text_to_path.get_text_width_height_descent(text, size, False)
        return HINTED * float(wide) * self.font / self.own

    def _wrapped(self, text: str, room: float) -> list[str]:
        """``text`` in lines no wider than ``room``, words whole where they fit."""
        lines = [""]
        for word in text.split(" "):
            longer = f"{lines[-1]} {word}".strip()
            if self.width_of(longer) <= room:
                lines[-1] = longer
                continue
            lines += [""] * bool(lines[-1])
            while self.width_of(word) > room and len(word) > 1:  # one word, or a language without blanks
                begins = [word[:n] for n in range(1, len(word))]
                fits = max(1, bisect_right(begins, room, key=self.width_of))
                lines[-1:], word = [word[:fits], ""], word[fits:]
            lines[-1] = word
        return lines

    @property
    def above(self) -> float:
        """Room of headers above each row of panels."""
        return max(len(lines) for lines in self.headers) * LINE * self.font + 0.3 * self.font

    @property
    def aside(self) -> float:
        """Room right of the panels."""
        keys = max([self.width_of(it) for it in self.kinds], default=0.0) + 3.4 * self.font if self.kinds else 0.0
        wide = len(self.scales) * ASIDE * self.font + keys if self.upright else 0.0
        return wide + RIGHT * self.font

    @property
    def below(self) -> float:
        """Room under the panels' axes."""
        legend = (1 + len(self.kinds)) * LINE * self.font if self.kinds else 0.0
        return 0.0 if self.upright else len(self.scales) * BELOW * self.font + legend

    def _solve(self, count: int, aspect: float) -> None:
        """Columns of panels, and how large they are, so that they are the largest."""
        gap, self.left = GAP * self.font, LEFT * self.font
        titles = 0.0 if self.beside else len(self.title) * LINE * self.font
        self.head = titles + self.bar_line + 0.5 * self.font
        best = (0.0, 0)
        for columns in range(1, count + 1):
            rows = -(-count // columns)
            wide = (self.limit[0] - self.left - self.aside - (columns - 1) * gap) / columns
            high = self.limit[1] - self.head - self.below - BOTTOM * self.font - rows * self.above - (rows - 1) * gap
            best = max(best, (min(wide, high / rows * aspect), -columns))
        self.columns = -best[1]
        self.rows = -(-count // self.columns)
        self.width = max(LEAST, round(best[0]))
        self.height = max(LEAST, round(best[0] / aspect))

    def _place(self, count: int) -> None:
        """Boxes of the panels, and the whole."""
        gap, self.boxes = GAP * self.font, []
        for k in range(count):
            row, column = divmod(k, self.columns)
            x = self.left + column * (self.width + gap)
            y = self.head + self.above + row * (self.height + gap + self.above)
            self.boxes.append((round(x), round(y), self.width, self.height))
        x, y, width, height = (max(box[k] for box in self.boxes) for k in range(4))
        widest = max([self.width_of(it) * 1.08 for it in self.title], default=0.0) + self.title_at
        self.foot = y + height + BOTTOM * self.font
        self.full = even(max(x + width + self.aside, widest)), even(self.foot + self.below)


def _dress(axes: Axes, found: Survey, font: float, *, x_label: bool, y_label: bool) -> None:
    """Limits and labels of a panel."""
    factor, unit = length_unit(found.view, found.look.plain)
    left, right, bottom, top = scaled(found.view, factor)
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.tick_params(**tick_sizes(font), direction="out", labelbottom=x_label, labelleft=y_label)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(ScalarFormatter(useOffset=False))
    if x_label:
        axes.set_xlabel(along("x", unit), fontsize=font, labelpad=0.4 * font)
    if y_label:
        axes.set_ylabel(along("y", unit), fontsize=font, labelpad=0.4 * font)


def along(axis: str, unit: str) -> str:
    """What stands at an axis, "x" or "y": with its unit, where places have one."""
    return f"{axis} ({unit})" if unit else axis


def tick_sizes(font: float) -> dict[str, Any]:
    """Ticks that grow with the font, points: labels of both axes stay apart in the corner."""
    return {"labelsize": font, "length": 0.35 * font, "pad": 0.32 * font, "width": 0.08 * font}


def _length_bar(made: Stage, found: Survey, plan: _Plan) -> None:
    """A bar of a round length, at most a third of the first panel, above it on the right."""
    left, right = found.view[:2]
    factor, unit = length_unit(found.view)
    x, y, width, _ = plan.boxes[0]
    size = round_length((right - left) * factor / 3)
    dots = size / factor / (right - left) * width
    text, at = f"{size:g} {unit}", y - plan.above - 0.35 * plan.font
    start = max(x, x + width - dots - plan.width_of(text) - 0.5 * plan.font)
    bar = made.axes(start, at - 0.5 * plan.font, dots, 0.24 * plan.font)
    bar.set(xticks=(), yticks=(), facecolor="black", label="scale bar")
    made.text(start + dots + 0.5 * plan.font, at, text)


def round_length(most: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is no more than ``most``."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(it for it in (power, 2 * power, 5 * power) if it <= most * (1 + 1e-12)))


def _keys(made: Stage, found: Survey, plan: _Plan) -> None:
    """Colour bars and the legend of kinds, right of the panels or below them."""
    font = plan.font
    x0, y0, _, _ = plan.boxes[0]
    right, low = (max(box[k] + box[k + 2] for box in plan.boxes) for k in (0, 1))
    patches = kinds_of(found)
    how: Any = {"handles": patches, "frameon": False, "handlelength": 1.0, "fontsize": made.font, "borderpad": 0.0,
                "borderaxespad": 0.0}  # fmt: skip
    at = right + 1.3 * font if plan.upright else plan.foot
    for scale in plan.scales:
        if plan.upright:
            axes = made.axes(at, y0, 1.15 * font, low - y0)
        else:
            axes = made.axes(x0, at + 0.4 * font, min(right - x0, 36 * font), 0.9 * font)
        draw_bar(made.figure, scale, axes, made.font, lying=not plan.upright)
        at += (ASIDE if plan.upright else BELOW) * font
    if patches:
        corner = (at, y0) if plan.upright else (x0, at + 0.3 * font)
        where = corner[0] / made.full[0], 1 - corner[1] / made.full[1]
        made.figure.legend(loc="upper left", bbox_to_anchor=where, **how)


def kinds_of(found: Survey) -> list[Patch]:
    """What a legend shows of the kinds that there are."""
    return [Patch(facecolor=colour, label=label) for label, colour in found.kinds.values()]


def draw_bar(figure: Any, scale: Scale, axes: Axes, font: float, *, lying: bool = False) -> None:
    """A colour bar in ``axes``; arrows at its ends: values beyond have the last colour.  One tick if uniform."""
    norm = Normalize(scale.low * scale.factor, scale.high * scale.factor)
    extend = "neither" if scale.uniform is not None else "max" if scale.low == 0 else "both"
    way = "horizontal" if lying else "vertical"
    mapped = ScalarMappable(norm, scale.map_name)
    bar = figure.colorbar(mapped, cax=axes, extend=extend, extendfrac=0.025, orientation=way)
    bar.ax.tick_params(**tick_sizes(font))
    bar.set_label(scale.label, fontsize=font, labelpad=0.4 * font)
    axis = bar.ax.xaxis if lying else bar.ax.yaxis
    axis.set_major_formatter(ScalarFormatter(useOffset=False))
    if scale.uniform is not None:
        bar.set_ticks([scale.uniform * scale.factor], labels=[f"{scale.uniform * scale.factor:.4g}"])
    else:
        _thin(figure, [axis], _room(axis, font))


def fit_ticks(figure: Any, panels: Sequence[Axes]) -> None:
    """Give the axes of ``panels`` as many ticks as leave their labels apart."""
    for axes in ([it.yaxis for it in panels], [it.xaxis for it in panels]):
        font = axes[0].get_ticklabels()[0].get_fontsize() if axes[0].get_ticklabels() else 10.0
        _thin(figure, axes, min(_room(axis, font) for axis in axes))


def _room(axis: Axis, font: Any) -> int:
    """Intervals between ticks that are worth a look on an axis of that length."""
    box, dpi = axis.axes.get_window_extent(), axis.axes.get_figure(root=True).dpi  # type: ignore[union-attr]
    upright = axis is axis.axes.yaxis
    return int(np.clip((box.height / 3.5 if upright else box.width / 4.5) / (font * dpi / 72), 1, 9))


def _thin(figure: Any, axes: Sequence[Axis], most: int) -> None:
    """Ticks in fewer and fewer intervals until no label lies upon another; at the last a single one."""
    canvas = figure.canvas if hasattr(figure.canvas, "get_renderer") else FigureCanvasAgg(figure.get_figure(root=True))
    for many in (*range(most, 0, -1), *range(most + 1, most + 5)):  # at the last more, where one alone says no scale
        for axis in axes:
            axis.set_major_locator(MaxNLocator(many, steps=[1, 2, 2.5, 5, 10], min_n_ticks=1))
        if min(len(_inside(axis)) for axis in axes) > 1 and not _crowded(axes, canvas.get_renderer()):
            return
    for axis in axes:
        axis.set_major_locator(MaxNLocator(1, steps=[1, 2, 2.5, 5, 10], min_n_ticks=1))
        inside = _inside(axis)
        axis.set_major_locator(FixedLocator(inside[len(inside) // 2 :][:1]))


def _inside(axis: Axis) -> list[float]:
    """Ticks that are seen."""
    low, high = sorted(axis.get_view_interval())
    slack = 1e-9 * (high - low)
    return [float(it) for it in axis.get_majorticklocs() if low - slack <= it <= high + slack]


def _crowded(axes: Sequence[Axis], renderer: Any) -> bool:
    """Whether labels of these axes touch, with half a digit between them."""
    boxes = []
    for axis in axes:
        seen = _inside(axis)
        for label, place in zip(axis.get_ticklabels(), axis.get_ticklocs(), strict=False):
            if label.get_visible() and label.get_text() and place in seen:
                boxes.append(label.get_window_extent(renderer).padded(0.16 * float(label.get_fontsize())))
    return any(one.overlaps(other) for one, other in combinations(boxes, 2))


def scaled(view: View, factor: float) -> View:
    """The view in other units."""
    left, right, bottom, top = view
    return left * factor, right * factor, bottom * factor, top * factor


def pixels(figure: Figure, *, alpha: bool = False) -> AnyArray:
    """A figure as (height, width, 3) uint8 RGB, or RGBA."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(np.asarray(canvas.buffer_rgba())[..., : 4 if alpha else 3])


def even(dots: float) -> int:
    """The even number at or above: films need even sides."""
    return 2 * int(np.ceil(dots / 2))
