"""Pictures of a run: one snapshot with axes, colour bar, time and title; several times in one; streamlines.

Axes and text are matplotlib's, drawn once for a film; what changes from frame to frame is painted by OpenCV.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray
from porescale.common.pictures.canvas import Canvas
from porescale.common.pictures.look import Look, Scale, Survey, View, length_unit, survey, time_text
from porescale.common.record.model import Snapshot
from porescale.common.record.open_run import Run, open_run

DPI = 100
LEFT, RIGHT, TOP, BOTTOM, BAR = 70, 18, 44, 58, 92
"""Margins around the inside of a picture 1000 pixels wide, and the room of one colour bar."""
CALM = 0.01
"""Share of the colours' range below which no streamline is drawn: they would follow round-off."""
SURVEYED = 24
"""At most so many snapshots are looked at for the colours' range."""

FINER = 3
"""Panels of a montage are drawn this much finer and averaged: small discs stay round."""


class Painter:
    """Paints snapshots that share a survey, each as (height, width, 3) uint8 RGB with even sides."""

    def __init__(self, found: Survey) -> None:
        self.survey = found
        self.unit = found.look.size / 1000
        left, right, bottom, top = found.view
        self.scales = [scale for scale in (found.field, found.cloud) if scale is not None]
        aside = RIGHT + BAR * (len(self.scales) + bool(found.look.kinds))
        free = np.array([found.look.size - (LEFT + aside) * self.unit, found.look.size - (TOP + BOTTOM) * self.unit])
        per_metre = (free / [right - left, top - bottom]).min()
        self.width = max(48, round((right - left) * per_metre))
        self.height = max(48, round((top - bottom) * per_metre))
        self.x = round(LEFT * self.unit)
        self.y = round(TOP * self.unit)
        self.full = (_even(self.x + self.width + aside * self.unit), _even(self.y + self.height + BOTTOM * self.unit))
        self.canvas = Canvas(found, self.width, self.height)
        self.background = self._background()

    def paint(self, snapshot: Snapshot, over_field: AnyArray | None = None) -> AnyArray:
        """The whole picture; ``over_field`` as in :meth:`Canvas.draw`."""
        image = self.background.copy()
        inside = image[self.y : self.y + self.height, self.x : self.x + self.width]
        inside[:] = self.canvas.draw(snapshot, over_field)
        corners = (self.x - 1, self.y - 1), (self.x + self.width, self.y + self.height)
        cv2.rectangle(image, *corners, (40, 40, 40), 1)  # the axes' frame, over the edge of the inside
        label = _text(time_text(snapshot.time, self.survey.longest, self.survey.look.plain), 11 * self.unit)
        tall, wide = label.shape[:2]
        bottom, right = self.y - round(3 * self.unit), max(self.x + self.width, wide)
        image[bottom - tall : bottom, right - wide : right] = label
        return image

    def _background(self) -> AnyArray:
        """Axes, title and bars without the inside."""
        full_x, full_y = self.full
        figure = Figure((full_x / DPI, full_y / DPI), dpi=DPI)
        axes = _place(figure, self.full, self.x, self.y, self.width, self.height)
        font = 10 * self.unit
        _dress(axes, self.survey, font)
        fits = max(0, int((self.width / self.unit - 110) / 8.0))
        title = self.survey.look.title
        if len(title) > fits:
            title = title[: fits - 1] + "…" if fits > 8 else ""
        axes.set_title(title, loc="left", fontsize=11 * self.unit, pad=8 * self.unit * 72 / DPI)
        at = self.x + self.width + 18 * self.unit
        for scale in self.scales:
            _bar(figure, scale, (self.full, at, self.y, 16 * self.unit, self.height), font)
            at += BAR * self.unit
        if self.survey.look.kinds:
            _legend(figure, self.survey.look, ((at - 8 * self.unit) / full_x, 1 - self.y / full_y), font)
        return _pixels(figure)

    def streamlines(self, snapshot: Snapshot) -> AnyArray:
        """The picture with streamlines under the points, where anything moves: vortices can be seen."""
        grid = self.survey.look.painted(snapshot)
        if grid is None or self.survey.field is None or grid.cells[self.survey.look.field].ndim != 3:
            return self.paint(snapshot)
        velocity = grid.cells[self.survey.look.field].astype(float)
        velocity[np.hypot(velocity[..., 0], velocity[..., 1]) < CALM * self.survey.field.high] = np.nan
        (ny, nx), (left, _, bottom, _) = grid.shape, grid.extent
        x = left + (np.arange(nx) + 0.5) * grid.spacing[0]
        y = bottom + (np.arange(ny) + 0.5) * grid.spacing[1]
        figure = Figure((self.width / DPI, self.height / DPI), dpi=DPI, facecolor="none")
        axes = figure.add_axes((0, 0, 1, 1))
        lines: dict[str, Any] = {
            "color": "white",
            "linewidth": 0.9 * self.unit,
            "arrowsize": 0.8 * self.unit,
            "density": 1.8,
        }
        axes.streamplot(x, y, velocity[..., 0], velocity[..., 1], **lines)
        axes.set(xlim=self.survey.view[:2], ylim=self.survey.view[2:])
        axes.axis("off")
        return self.paint(snapshot, _pixels(figure, alpha=True))


def paint(snapshot: Snapshot, look: Look | None = None, **changes: Any) -> AnyArray:
    """One snapshot as (height, width, 3) uint8 RGB.  ``changes`` are fields of :class:`Look`."""
    chosen = replace(look or Look(), **changes)
    return Painter(survey([snapshot], chosen)).paint(snapshot)


def painter_of(run: Run, look: Look) -> Painter:
    """A painter whose colours and view suit a whole run.  InputError when the run has no snapshots."""
    if not len(run):
        repair = "let it run until its first snapshot"
        raise InputError(Fault("run folder", str(run.folder), "no snapshots to paint", repair=repair))
    every = max(1, -(-len(run) // SURVEYED))
    chosen = sorted({*range(0, len(run), every), len(run) - 1})
    title = look.title or run.name
    return Painter(survey((run.snapshot(k, look.cells) for k in chosen), replace(look, title=title)))


def pictures(folder: Path | str, look: Look | None = None, **changes: Any) -> list[Path]:
    """Write montage.png, final.png and, if the look has them, streamlines.png; returns their paths."""
    run = open_run(folder)
    painter = painter_of(run, replace(look or Look(), **changes))
    cells = painter.survey.look.cells
    last = run.snapshot(-1, cells)
    made = {"final.png": painter.paint(last)}
    times = np.unique(np.linspace(0, len(run) - 1, 6).round().astype(int))
    if len(times) > 1:
        made["montage.png"] = montage(painter, [run.snapshot(int(k), cells) for k in times])
    if painter.survey.look.streamlines:
        made["streamlines.png"] = painter.streamlines(last)
    for name, image in made.items():
        write_bytes(run.folder / name, png(image))
    return [run.folder / name for name in made]


def paint_last(folder: Path | str, name: str, look: Look) -> Path:
    """Write <name>.png, the last snapshot of a run as ``look`` shows it, in colours that suit the whole run."""
    run = open_run(folder)
    painter = painter_of(run, look)
    path = run.folder / f"{name}.png"
    write_bytes(path, png(painter.paint(run.snapshot(-1, painter.survey.look.cells))))
    return path


def montage(painter: Painter, shown: Sequence[Snapshot]) -> AnyArray:
    """Several times side by side with one colour bar, (height, width, 3) uint8 RGB."""
    found = painter.survey
    aspect = painter.width / painter.height
    columns = min(range(1, len(shown) + 1), key=lambda n: abs(n * aspect / -(-len(shown) // n) - 1.4))
    rows = -(-len(shown) // columns)
    gap_x, gap_y, left, bottom, top = 16, 34, 66, 58, 62
    aside = RIGHT + BAR * (len(painter.scales) + bool(found.look.kinds))
    width = round(min(1.25 * found.look.size, 1400) - left - aside - (columns - 1) * gap_x) // columns
    height = round(width / aspect)
    full = (
        _even(left + columns * width + (columns - 1) * gap_x + aside),
        _even(top + rows * height + (rows - 1) * gap_y + bottom),
    )
    figure = Figure((full[0] / DPI, full[1] / DPI), dpi=DPI)
    canvas = Canvas(found, FINER * width, FINER * height)
    factor, _ = length_unit(found.view, found.look.plain)
    extent = _scaled(found.view, factor)
    for k, snapshot in enumerate(shown):
        row, column = divmod(k, columns)
        inside = cv2.resize(canvas.draw(snapshot), (width, height), interpolation=cv2.INTER_AREA)
        x, y = left + column * (width + gap_x), top + row * (height + gap_y)
        axes = _place(figure, full, x, y, width, height)
        axes.imshow(inside, extent=extent, aspect="auto", interpolation="nearest")
        _dress(axes, found, 9.5, x_label=k + columns >= len(shown), y_label=column == 0)
        axes.set_title(time_text(snapshot.time, found.longest, found.look.plain), loc="right", fontsize=9.5, pad=4)
    figure.text(left / full[0], 1 - 14 / full[1], found.look.title, fontsize=12, va="top", ha="left")
    at, tall = left + columns * (width + gap_x) + 2, rows * height + (rows - 1) * gap_y
    for scale in painter.scales:
        _bar(figure, scale, (full, at, top, 16, tall), 9.5)
        at += BAR
    if found.look.kinds:
        _legend(figure, found.look, ((at - 8) / full[0], 1 - top / full[1]), 9.5)
    return _pixels(figure)


def png(image: AnyArray) -> bytes:
    """An RGB image as a PNG file's content."""
    done, content = cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGB2BGR))
    assert done
    return bytes(content.tobytes())


def _place(figure: Figure, full: tuple[int, int], x: float, y: float, width: float, height: float) -> Axes:
    """Axes at pixels counted from the upper left corner."""
    return figure.add_axes((x / full[0], 1 - (y + height) / full[1], width / full[0], height / full[1]))


def _dress(axes: Axes, found: Survey, font: float, *, x_label: bool = True, y_label: bool = True) -> None:
    """Limits and labels of the axes."""
    factor, unit = length_unit(found.view, found.look.plain)
    left, right, bottom, top = _scaled(found.view, factor)
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.tick_params(labelsize=font, direction="out", labelbottom=x_label, labelleft=y_label)
    inside = axes.get_window_extent()
    axes.locator_params(axis="x", nbins=_ticks(inside.width, 90), min_n_ticks=2)
    axes.locator_params(axis="y", nbins=_ticks(inside.height, 60), min_n_ticks=2)
    if x_label:
        axes.set_xlabel(f"x ({unit})" if unit else "x", fontsize=font)
    if y_label:
        axes.set_ylabel(f"y ({unit})" if unit else "y", fontsize=font)


def _bar(figure: Figure, scale: Scale, where: tuple[tuple[int, int], float, float, float, float], font: float) -> None:
    """A colour bar at pixels; arrows at its ends: values beyond have the last colour."""
    axes = _place(figure, *where)
    norm = Normalize(scale.low * scale.factor, scale.high * scale.factor)
    extend = "max" if scale.low == 0 else "both"
    bar = figure.colorbar(ScalarMappable(norm, scale.map_name), cax=axes, extend=extend, extendfrac=0.025)
    bar.ax.tick_params(labelsize=font)
    bar.ax.locator_params(nbins=_ticks(where[4], 50))
    bar.set_label(scale.label, fontsize=font)


def _legend(figure: Figure, look: Look, corner: tuple[float, float], font: float) -> None:
    """The kinds and their colours."""
    patches = [Patch(facecolor=colour, edgecolor="none", label=label) for label, colour in look.kinds.values()]
    figure.legend(
        handles=patches, loc="upper left", bbox_to_anchor=corner, fontsize=font, frameon=False, handlelength=1.0
    )


def _text(text: str, points: float) -> AnyArray:
    """Text in the axes' font on white, as a tight RGB image."""
    figure = Figure((len(text) * points / 72, 1.6 * points / 72), dpi=DPI)
    figure.text(1.0, 0.25, text, fontsize=points, ha="right", va="baseline")
    return _pixels(figure)


def _pixels(figure: Figure, *, alpha: bool = False) -> AnyArray:
    """A figure as RGB, or RGBA."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(np.asarray(canvas.buffer_rgba())[..., : 4 if alpha else 3])


def _ticks(pixels: float, each: float) -> int:
    """How many intervals fit when each takes so many pixels."""
    return int(np.clip(pixels / each, 2, 9))


def _scaled(view: View, factor: float) -> View:
    """The view in other units."""
    left, right, bottom, top = view
    return left * factor, right * factor, bottom * factor, top * factor


def _even(pixels: float) -> int:
    """The even number at or above: films need even sides."""
    return 2 * int(np.ceil(pixels / 2))
