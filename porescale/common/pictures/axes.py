"""A snapshot drawn into axes of matplotlib, to scale: for notebooks and plots of the user's own."""

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from porescale.common.core.types import AnyArray
from porescale.common.pictures.arrows import arrows
from porescale.common.pictures.layout import along, draw_bar, fit_ticks, kinds_of, scaled
from porescale.common.pictures.look import (
    PAPER,
    PLATE,
    RIM,
    WALL,
    Look,
    Survey,
    length_unit,
    magnitude,
    rgb,
    survey,
    time_text,
)
from porescale.common.pictures.repeated import discs_again, shifts
from porescale.common.pictures.shapes import CRACK
from porescale.common.record.model import Cloud, Grid, Snapshot

WIDTH = 8.0
"""Of a figure that is made for the axes, inches."""
NARROW = 0.8
"""Width over height of a view below which title and time stand in two lines."""


def size_of(look: Look) -> tuple[float, float]:
    """Width and height (inches) of a figure that suits the view of a look."""
    left, right, bottom, top = look.view or (0.0, 1.0, 0.0, 1.0)
    return WIDTH, float(np.clip((WIDTH - 2.0) * (top - bottom) / (right - left) + 1.0, 2.0, 12.0))


def draw(snapshot: Snapshot, look: Look, axes: Axes, *, bar: bool = True) -> Axes:
    """Draw a snapshot as its ``look`` says into ``axes``, whose limits, labels and title are set; returns them.

    bar : a colour bar, or a legend of kinds, beside them.
    """
    found = survey([snapshot], look)
    _, unit = length_unit(found.view, look.plain)
    axes.set_xlabel(along("x", unit))
    axes.set_ylabel(along("y", unit))
    left, right, bottom, top = found.view
    time = time_text(snapshot.time, found.longest, look.plain)
    if right - left < NARROW * (top - bottom):
        axes.set_title(f"{look.title}\n{time}" if look.title else time, loc="left", parse_math=False)
    else:
        axes.set_title(look.title, loc="left", parse_math=False)
        axes.set_title(time, loc="right")
    draw_inside(snapshot, found, axes)
    root = axes.get_figure(root=True)
    if root is not None and root.get_layout_engine() is not None:
        root.draw_without_rendering()  # how large the axes are
    if bar:
        _keys(found, axes)
    fit_ticks(axes.figure, [axes])
    return axes


def draw_inside(snapshot: Snapshot, found: Survey, axes: Axes) -> None:
    """Draw a snapshot to scale into ``axes``, in the units of their labels."""
    look = found.look
    factor, _ = length_unit(found.view, look.plain)
    left, right, bottom, top = scaled(found.view, factor)
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    _field(snapshot, found, axes, factor)
    cloud, shapes = look.drawn(snapshot), look.shaped(snapshot)
    if cloud is not None and len(cloud.position):
        _points(cloud, found, axes, factor)
    if shapes is not None and len(shapes.position):
        _shapes(shapes, found, axes, factor)
    pointing = arrows(snapshot, found) * factor
    if len(pointing):
        axes.add_collection(
            PolyCollection(list(pointing), facecolors=PAPER, edgecolors=RIM, linewidths=0.4), autolim=False
        )
    if len(lines := look.lines_at(snapshot)):
        axes.add_collection(LineCollection(list(np.array(lines) * factor), colors=WALL, linewidths=2.0), autolim=False)
    if len(marks := look.marks_at(snapshot)):
        axes.add_collection(LineCollection(list(np.array(marks) * factor), colors=CRACK, linewidths=1.5), autolim=False)


def _field(snapshot: Snapshot, found: Survey, axes: Axes, factor: float) -> None:
    """Cells of a grid, and what is solid in them."""
    grid, look = found.look.painted(snapshot), found.look
    if grid is None or found.field is None:
        return
    place: dict[str, Any] = {
        "extent": [edge * factor for edge in grid.extent],
        "origin": "lower",
        "aspect": "equal",
        "interpolation": "bilinear",
        "interpolation_stage": "data",
    }
    values = magnitude(grid.cells[look.field], 2)
    axes.imshow(values, cmap=found.field.map_name, vmin=found.field.low, vmax=found.field.high, **place)
    if look.walls in grid.cells:
        axes.imshow(walls(grid, look), **place)


def walls(grid: Grid, look: Look, opacity: float = 1.0) -> AnyArray:
    """What is solid in the cells of a grid, (ny, nx, 4): grey, as opaque as a cell is solid."""
    grey = np.zeros((*grid.shape, 4))
    grey[..., :3] = np.array(rgb(WALL)) / 255
    grey[..., 3] = opacity * np.clip(grid.cells[look.walls], 0.0, 1.0)
    return grey


def _points(cloud: Cloud, found: Survey, axes: Axes, factor: float) -> None:
    """Discs with a rim and a spoke, or dots, all to scale."""
    discs = "radius" in cloud.data
    radius = np.broadcast_to(np.asarray(cloud.data.get("radius", found.dot), float), len(cloud.position))
    which, places = discs_again(cloud, found.look)
    there = np.isfinite(places).all(axis=1)
    which, at = which[there], places[there] * factor
    size = 2.0 * radius[which] * factor
    edges = {"edgecolors": RIM, "linewidths": 0.4} if discs else {"edgecolors": "none"}
    own = found.colours(cloud)[which] / 255
    dots = EllipseCollection(
        size, size, 0.0, units="xy", offsets=at, offset_transform=axes.transData, facecolors=own, **edges
    )
    axes.add_collection(dots, autolim=False)
    if discs and "angle" in cloud.data:
        angle = np.asarray(cloud.data["angle"], float)[which]
        tip = at + 0.4 * size[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))
        axes.add_collection(
            LineCollection(list(np.stack((at, tip), axis=1)), colors=RIM, linewidths=0.4), autolim=False
        )


def _shapes(cloud: Cloud, found: Survey, axes: Axes, factor: float) -> None:
    """Polygons, and segments as wide as they are thick."""
    own = found.colours(cloud) / 255
    if "driven" in cloud.data:
        own = np.where(np.asarray(cloud.data["driven"])[:, None] != 0, np.array(rgb(PLATE)) / 255, own)
    for shift in shifts(cloud, found.look):
        _bodies(cloud, (cloud.position + shift) * factor, own, axes, factor)


def _bodies(cloud: Cloud, at: AnyArray, own: AnyArray, axes: Axes, factor: float) -> None:
    """Bodies whose points are ``at`` (n, 2), of the axes' unit, in colours ``own`` (n, 3)."""
    if cloud.polygons is not None and len(cloud.polygons[0]) > 1:
        offsets, corners = cloud.polygons
        outlines = [at[corners[first:end]] for first, end in pairwise(offsets.tolist())]
        colours = own[corners[offsets[:-1]]]
        axes.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors=RIM, linewidths=0.4), autolim=False)
    if cloud.lines is not None and len(cloud.lines):
        ends = at[cloud.lines]
        thick = np.asarray(cloud.data.get("radius", np.zeros(len(at))), float)[cloud.lines[:, 0]] * factor
        way = ends[:, 1] - ends[:, 0]
        across = np.column_stack((-way[:, 1], way[:, 0])) / np.maximum(np.hypot(*way.T), 1e-300)[:, None]
        across *= thick[:, None]
        strips = np.stack((ends[:, 0] + across, ends[:, 1] + across, ends[:, 1] - across, ends[:, 0] - across), axis=1)
        colours = own[cloud.lines[:, 0]]
        axes.add_collection(
            PolyCollection(list(strips), facecolors=colours, edgecolors=RIM, linewidths=0.6), autolim=False
        )


def _keys(found: Survey, axes: Axes) -> None:
    """A colour bar for what is coloured, and the kinds with their colours."""
    for k, scale in enumerate(it for it in (found.field, found.cloud) if it is not None):
        beside = axes.inset_axes((1.02 + 0.2 * k, 0.0, 0.025, 1.0))
        draw_bar(axes.figure, scale, beside, float(axes.xaxis.label.get_fontsize()))
    if found.kinds:
        kinds = kinds_of(found)
        axes.legend(handles=kinds, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, handlelength=1.0)
