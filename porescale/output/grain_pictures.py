"""Pictures of what holds grains together: force chains, contact numbers and rattlers, the rose of contacts."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from porescale.builders.parts.grain_instruments import CONTACTS, FIELDS
from porescale.common.core.atomic import whole
from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import Look, length_unit, time_text
from porescale.common.pictures.picture import paint_last
from porescale.common.pictures.repeated import again, discs_again
from porescale.common.record.model import Cloud, Snapshot
from porescale.dem.prepare.compaction import write_packing
from porescale.output.frame_clouds import FRAMES
from porescale.output.frame_pictures import draw_frames
from porescale.output.grain_lines import write_lines

if TYPE_CHECKING:
    from porescale.common.record.open_run import Run


SHOWN = ("solid_fraction", "density", "velocity", "strain_rate_shear", "stress_mean", "stress_shear",
         "kinetic_stress_mean")  # fmt: skip
"""Fields that get a picture, as grains_<name>.png."""
THICKEST = 0.45
"""Width of the line of a force of the 99th percentile, over the mean diameter."""
MOST = 6
"""Contact numbers from here on share a colour."""
COLOURS = ("#ffffff", "#f2e6c2", "#f0c987", "#e39a5c", "#c96a4a", "#8f3f4e", "#4d2a4f")
BINS = 36


def write_grain_pictures(run: Run, folder: Path, look: Look) -> list[Path]:
    """Pictures of the last snapshot: grains_<field>.png of coarse-grained fields, chains.png, coordination.png and
    rose.png where contacts were recorded, with chains.vtp, their lines for ParaView; and packing.csv, the grains as
    they lie, to start another run from."""
    last = run.snapshot(-1)
    made: list[Path] = []
    if "grains" in last.clouds:
        grains = last.clouds["grains"]
        made = [folder / "packing.csv"]
        write_packing(made[0], grains.position, np.asarray(grains.data["radius"], float))
    if FIELDS in last.grids:
        for name in (it for it in SHOWN if it in last.grids[FIELDS].cells):
            label = "speed of the grains" if name == "velocity" else ""
            changed = replace(look, grid=FIELDS, field=name, label=label, cloud="", streamlines=False, walls="")
            made.append(paint_last(folder, f"grains_{name}", changed))
    if CONTACTS in last.clouds:
        made.append(folder / "chains.vtp")
        write_chains(made[-1], last)
        for name, figure in (
            ("chains", chains(last, look)), ("coordination", numbers(last, look)), ("rose", rose_of(last, look)),
        ):  # fmt: skip
            made.append(folder / f"{name}.png")
            with whole(made[-1]) as beside:
                FigureCanvasAgg(figure).print_png(str(beside))
    return made


def write_chains(path: Path, snapshot: Snapshot) -> None:
    """Contacts that carry as lines between centres, with their forces (N/m) and whether they slide."""
    contacts = snapshot.clouds[CONTACTS]
    loaded = np.asarray(contacts.data["normal_force"], float) > 0.0
    names = "normal_force", "tangential_force", "sliding"
    data = {name: np.asarray(contacts.data[name])[loaded] for name in names}
    data["sliding"] = data["sliding"].astype(bool)
    write_lines(path, branches(all_points(snapshot), contacts)[loaded], data)


def chains(snapshot: Snapshot, look: Look) -> Figure:
    """Discs, and a line along every contact's branch, as wide as its normal force is large; sliding ones lighter."""
    grains, contacts = all_points(snapshot), snapshot.clouds[CONTACTS]
    title = f"{look.title}: normal forces, {time_text(snapshot.time, snapshot.time)}"
    figure, axes, factor, points = _stage(look, title)
    if "grains" in snapshot.clouds:
        _discs(axes, snapshot.clouds["grains"], look, "#efe9dc", "#b5ab98", 0.4)
    if FRAMES in snapshot.clouds:
        draw_frames(axes, snapshot.clouds[FRAMES], look, "#efe9dc", "#b5ab98")
    force = np.asarray(contacts.data["normal_force"], float)
    loaded = force > 0.0
    if loaded.any():
        lines = branches(grains, contacts)[loaded]
        which, shift = again(lines.min(axis=1), lines.max(axis=1), look)
        lines = (lines[which] + shift[:, None]) * factor
        strongest = float(np.percentile(force[loaded], 99))
        thickest = THICKEST * 2.0 * _mean_radius(snapshot) * points
        width = np.minimum(force[loaded][which] / strongest, 2.0) * thickest
        colours = np.where(np.asarray(contacts.data["sliding"], bool)[loaded][which], "#e2893b", "#8c1c2f")
        axes.add_collection(LineCollection(list(lines), linewidths=width, colors=colours.tolist(), capstyle="round"))
        shown = [Patch(color="#8c1c2f", label="sticking"), Patch(color="#e2893b", label="sliding")]
        axes.legend(handles=shown, loc="upper right", fontsize=8, framealpha=0.8,
                    title=f"full width: {strongest:.3g} N/m", title_fontsize=8)  # fmt: skip
    return figure


def numbers(snapshot: Snapshot, look: Look) -> Figure:
    """Discs coloured by their number of loaded contacts; rattlers with a blue rim."""
    grains = snapshot.clouds.get("grains", Cloud(np.zeros((0, 2)), {
        "radius": np.zeros(0), "contact_number": np.zeros(0), "rattler": np.zeros(0)}))  # fmt: skip
    figure, axes, _, _ = _stage(look, f"{look.title}: contacts, {time_text(snapshot.time, snapshot.time)}")
    count = np.minimum(np.asarray(grains.data["contact_number"], int), MOST)
    loose = np.asarray(grains.data["rattler"], bool)
    painted = ListedColormap(COLOURS)(count)
    rims = np.where(loose, "#2f6fb0", "#3b352b")
    _discs(axes, grains, look, painted, rims, np.where(loose, 1.2, 0.4))
    if FRAMES in snapshot.clouds:
        frames = snapshot.clouds[FRAMES]
        shown = ListedColormap(COLOURS)(np.minimum(np.asarray(frames.data["contact_number"], int), MOST))
        rims = np.where(np.asarray(frames.data["rattler"], bool), "#2f6fb0", "#3b352b")
        draw_frames(axes, frames, look, shown, rims)
    handles = [
        Patch(facecolor=colour, edgecolor="#3b352b", label=f"{k}{' and more' if k == MOST else ''}")
        for k, colour in enumerate(COLOURS)
    ]
    handles.append(Patch(facecolor="none", edgecolor="#2f6fb0", label="rattler"))
    axes.legend(handles=handles, loc="upper right", fontsize=8, framealpha=0.8)
    return figure


def rose_of(snapshot: Snapshot, look: Look) -> Figure:
    """Directions of loaded contacts, and of the normal forces in them, with what the fabric tensor gives for them."""
    contacts = snapshot.clouds[CONTACTS]
    figure = Figure((6.4, 6.6), dpi=100)
    axes: Any = figure.add_subplot(projection="polar")
    force = np.asarray(contacts.data["normal_force"], float)
    normal, force = np.asarray(contacts.data["normal"], float)[force > 0.0, :2], force[force > 0.0]
    if len(force):
        angle = np.arctan2(normal[:, 1], normal[:, 0])
        both, edges = np.concatenate((angle, angle + np.pi)) % (2 * np.pi), np.linspace(0, 2 * np.pi, BINS + 1)
        step = edges[1]
        share = np.histogram(both, edges)[0] / len(both) / step
        pushed = np.histogram(both, edges, weights=np.concatenate((force, force)))[0] / (2 * force.sum()) / step
        middle = 0.5 * (edges[1:] + edges[:-1])
        axes.bar(middle, share, step, color="#d9b26a", edgecolor="#3b352b", linewidth=0.5, label="contacts")
        axes.step(np.append(middle, middle[0]), np.append(pushed, pushed[0]), where="mid", color="#8c1c2f",
                  label="normal force")  # fmt: skip
        xx, yy, xy = (normal[:, 0] ** 2).mean(), (normal[:, 1] ** 2).mean(), (normal[:, 0] * normal[:, 1]).mean()
        around, a = np.linspace(0, 2 * np.pi, 361), 2.0 * float(np.hypot(xx - yy, 2.0 * xy))
        turned = 0.5 * float(np.arctan2(2.0 * xy, xx - yy))
        fitted = (1.0 + a * np.cos(2.0 * (around - turned))) / (2.0 * np.pi)
        axes.plot(around, fitted, color="#2f6fb0", label=f"fabric: a = {a:.2f} at {np.degrees(turned):.0f}°")
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, -0.16), ncols=3, fontsize=8, frameon=False)
    axes.set_yticklabels([])
    axes.set_title(
        f"{look.title}: {len(force)} contacts, {time_text(snapshot.time, snapshot.time)}", fontsize=10, parse_math=False
    )
    return figure


def all_points(snapshot: Snapshot) -> Cloud:
    """Discs, then the corners of bodies of segments, as contacts number them."""
    parts = [snapshot.clouds[name] for name in ("grains", FRAMES) if name in snapshot.clouds]
    radius = np.concatenate([np.asarray(part.data["radius"], float) for part in parts])
    return Cloud(np.concatenate([part.position for part in parts]), {"radius": radius})


def branches(grains: Cloud, contacts: Cloud) -> AnyArray:
    """Ends (c, 2, 2) m of the ways between centres of discs that touch, or from one to a surface, beside their points:
    of images of discs where those are nearer."""
    normal = np.asarray(contacts.data["normal"], float)[:, :2]
    radius, overlap = np.asarray(grains.data["radius"], float), np.asarray(contacts.data["overlap"], float)
    first, second = contacts.data["first"], contacts.data["second"]
    mean = radius[first] - overlap * np.where(second >= 0, 0.5, 1.0)  # to the chord between discs of equal size
    start = contacts.position - mean[:, None] * normal
    length = radius[first] - overlap + np.where(second >= 0, radius[second], 0.0)
    return np.stack((start, start + length[:, None] * normal), axis=1)


def _mean_radius(snapshot: Snapshot) -> float:
    """Mean radius of discs, m, or a fifth of the mean side of polygons where there are none."""
    if "grains" in snapshot.clouds:
        return float(np.mean(snapshot.clouds["grains"].data["radius"]))
    frames = snapshot.clouds[FRAMES]
    offsets, corners = frames.polygons or (np.zeros(1, int), np.zeros(0, int))
    at = frames.position[corners]
    sides = [np.hypot(*np.diff(at[a:b], axis=0).T) for a, b in itertools.pairwise(offsets)]
    return 0.2 * float(np.mean(np.concatenate(sides))) if sides else float(np.mean(frames.data["radius"]))


def _stage(look: Look, title: str) -> tuple[Figure, Axes, float, float]:
    """A figure with the box to scale: axes, factor of lengths to its unit, and points of print per metre."""
    assert look.view
    left, right, bottom, top = look.view
    longest = max(right - left, top - bottom)
    wide, high = 8.0 * (right - left) / longest, 8.0 * (top - bottom) / longest
    full = max(wide, 3.0) + 1.1, high + 1.1
    figure = Figure(full, dpi=100)
    axes = figure.add_axes((0.8 / full[0], 0.55 / full[1], wide / full[0], high / full[1]))
    factor, unit = length_unit(look.view)
    axes.set(xlim=(left * factor, right * factor), ylim=(bottom * factor, top * factor))
    axes.set_xlabel(f"x ({unit})")
    axes.set_ylabel(f"y ({unit})")
    axes.set_title(title, loc="left", fontsize=10, parse_math=False)
    return figure, axes, factor, 72.0 * wide / (right - left)


def _discs(axes: Axes, grains: Cloud, look: Look, colours: Any, rims: Any, widths: Any) -> None:
    """All discs as circles to scale; ``colours``, ``rims``, ``widths``: one for all, or one of each."""
    assert look.view
    factor, _ = length_unit(look.view)
    which, places = discs_again(grains, look)
    size = 2.0 * factor * np.asarray(grains.data["radius"], float)[which]
    own = (it if isinstance(it, str | float) else np.asarray(it)[which] for it in (colours, rims, widths))
    shown = dict(zip(("facecolors", "edgecolors", "linewidths"), own, strict=True))
    axes.add_collection(
        EllipseCollection(
            size,
            size,
            np.zeros_like(size),
            units="x",
            offsets=factor * places,
            offset_transform=axes.transData,
            **shown,
        )
    )
