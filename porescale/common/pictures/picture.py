"""Pictures of a run: one snapshot with axes, colour bar, time and title; several times in one; streamlines.

Axes and text are matplotlib's, drawn once for a film; what changes from frame to frame is painted by OpenCV.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from matplotlib.figure import Figure

from porescale.common.core.atomic import write_bytes
from porescale.common.core.picked import every_so_many, spread
from porescale.common.core.types import AnyArray
from porescale.common.pictures.canvas import Canvas
from porescale.common.pictures.layout import DPI, Style, pixels, screen, stage
from porescale.common.pictures.look import Look, Survey, survey, time_text
from porescale.common.record.model import Snapshot
from porescale.common.record.open_run import Run, open_run

CALM = 0.01
"""Share of the colours' range below which no streamline is drawn: they would follow round-off."""
SURVEYED = 24
"""At most so many snapshots are looked at for the colours' range."""

TIMES = 6
"""Panels of a montage."""
WIDER = 1.25
"""How much longer a montage may be than a picture of one time."""
FINER = 3
"""Panels of a montage are drawn this much finer and averaged: small discs stay round."""


class Sheet:
    """Paints snapshots beside each other with one survey, each sheet as (height, width, 3) uint8 RGB with even sides.

    boxes : (x, y, width, height) of the inside of each panel, pixels;  names : above each, "" for none, with the time.
    """

    def __init__(self, found: Survey, names: Sequence[str], style: Style) -> None:
        self.survey, self.dpi = found, style.dpi
        longest = time_text(-found.longest, found.longest, found.look.plain)
        self.names = [f"{name}, " if name else "" for name in names]
        made = stage(found, [name + longest for name in self.names], style, blank=True)
        self.full, self.boxes, self.font = made.full, made.boxes, made.font
        self.canvas = Canvas(found, *made.boxes[0][2:])
        self.background = pixels(made.figure)

    def paint(self, shown: Sequence[Snapshot], over_field: AnyArray | None = None) -> AnyArray:
        """The whole picture of a snapshot for each panel; ``over_field`` as in :meth:`Canvas.draw`."""
        image = self.background.copy()
        for snapshot, name, (x, y, width, height) in zip(shown, self.names, self.boxes, strict=True):
            image[y : y + height, x : x + width] = self.canvas.draw(snapshot, over_field)
            _frame(image, (x, y, width, height))  # the axes' frame, over the edge of the inside
            text = name + time_text(snapshot.time, self.survey.longest, self.survey.look.plain)
            label = _text(text, self.font, self.dpi)
            tall, wide = label.shape[:2]
            lift = 2 if wide <= width else round(0.5 * self.font * self.dpi / 72)  # above a tick's label beside it
            bottom, right = y - lift, max(x + width, wide)
            np.minimum(part := image[bottom - tall : bottom, right - wide : right], label, out=part)
        return image


class Painter:
    """Paints snapshots that share a survey, each as (height, width, 3) uint8 RGB with even sides."""

    def __init__(self, found: Survey) -> None:
        self.survey, self.sheet = found, Sheet(found, [""], screen(found.look.size))
        (self.x, self.y, self.width, self.height), self.canvas = self.sheet.boxes[0], self.sheet.canvas

    def paint(self, snapshot: Snapshot, over_field: AnyArray | None = None) -> AnyArray:
        """The whole picture; ``over_field`` as in :meth:`Canvas.draw`."""
        return self.sheet.paint([snapshot], over_field)

    def streamlines(self, snapshot: Snapshot) -> AnyArray:
        """The picture with streamlines under the points, where anything moves: vortices can be seen."""
        grid = self.survey.look.painted(snapshot)
        if grid is None or self.survey.field is None or grid.cells[self.survey.look.field].ndim != 3:
            return self.paint(snapshot)
        if min(grid.shape) < 2:  # a line of cells has no lines beside each other
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
            "linewidth": 0.9 * (self.survey.look.size / 1000),
            "arrowsize": 0.8 * (self.survey.look.size / 1000),
            "density": 1.8,
        }
        axes.streamplot(x, y, velocity[..., 0], velocity[..., 1], **lines)
        axes.set(xlim=self.survey.view[:2], ylim=self.survey.view[2:])
        axes.axis("off")
        return self.paint(snapshot, pixels(figure, alpha=True))


def paint(snapshot: Snapshot, look: Look | None = None, **changes: Any) -> AnyArray:
    """One snapshot as (height, width, 3) uint8 RGB.  ``changes`` are fields of :class:`Look`."""
    chosen = replace(look or Look(), **changes)
    return Painter(survey([snapshot], chosen)).paint(snapshot)


def painter_of(run: Run, look: Look) -> Painter:
    """A painter whose colours and view suit a whole run.  InputError when the run has no snapshots."""
    run.require_snapshots()
    title = look.title or run.name
    return Painter(survey(run.snapshots(look.cells, surveyed(run)), replace(look, title=title)))


def surveyed(run: Run) -> list[int]:
    """Numbers of the snapshots that colours are taken from."""
    return every_so_many(len(run), max(1, -(-len(run) // SURVEYED)))


def pictures(run: Run, painter: Painter) -> list[Path]:
    """Write montage.png, final.png and, if the look has them, streamlines.png; returns their paths."""
    cells = painter.survey.look.cells
    last = run.snapshot(-1, cells)
    made = {"final.png": painter.paint(last)}
    if len(run) > 1:
        made["montage.png"] = montage(painter, list(run.snapshots(cells, spread(len(run), TIMES))))
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
    times = [time_text(it.time, found.longest, found.look.plain) for it in shown]
    made = stage(found, times, screen(found.look.size, WIDER))
    image = pixels(made.figure)
    width, height = made.boxes[0][2:]
    canvas = Canvas(found, FINER * width, FINER * height)
    for snapshot, (x, y, _, _) in zip(shown, made.boxes, strict=True):
        finer = canvas.draw(snapshot)
        image[y : y + height, x : x + width] = cv2.resize(finer, (width, height), interpolation=cv2.INTER_AREA)
        _frame(image, (x, y, width, height))
    return image


def _frame(image: AnyArray, box: tuple[int, int, int, int]) -> None:
    """The line around the inside of a panel."""
    x, y, width, height = box
    cv2.rectangle(image, (x - 1, y - 1), (x + width, y + height), (40, 40, 40), 1)


def png(image: AnyArray) -> bytes:
    """An RGB image as a PNG file's content."""
    done, content = cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGB2BGR))
    assert done
    return bytes(content.tobytes())


def _text(text: str, points: float, dpi: int) -> AnyArray:
    """Text in the axes' font on white, as a tight RGB image."""
    figure = Figure((0.75 * len(text) * points / 72, 1.6 * points / 72), dpi=dpi)
    figure.text(1.0, 0.25, text, fontsize=points, ha="right", va="baseline", parse_math=False)
    return pixels(figure)
