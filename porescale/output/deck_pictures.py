"""Pictures of a deck of DEMseg: forces in its contacts, and the numbers of its bodies, by which decks control them."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from scipy.spatial import cKDTree

from porescale.common.core.atomic import whole
from porescale.common.core.types import AnyArray, Floats
from porescale.common.pictures.look import View
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.open_run import Run

PRESSED, PULLED, OUTLINE = "#8c1c2f", "#2a6f97", "#8d8573"
THICKEST = 6.0
"""Width of the line of the 99th percentile of all forces, points."""
NOISE = 1e-9
"""Net force of contacts and bonds, over their sizes, that is none: round-off of places over that of overlaps."""
LEAST, MOST = 2.0, 9.0
"""Size of the numbers of bodies, points."""


def write_deck_pictures(run: Run, folder: Path, view: View) -> list[Path]:
    """contacts.png and numbers.png of the last snapshot."""
    last, made = run.snapshot(-1, cells=()), []
    for name, figure in (("contacts", contact_forces(last, view)), ("numbers", body_numbers(last, view))):
        made.append(folder / f"{name}.png")
        with whole(made[-1]) as beside:
            FigureCanvasAgg(figure).print_png(str(beside))
    return made


def contact_forces(shot: Snapshot, view: View) -> Figure:
    """Lines between the centres of bodies that touch, as wide as their normal force is large."""
    figure, axes = _stage(shot, view, f"normal forces at {shot.time:.4g}")
    if "contacts" not in shot.clouds or not len(shot.clouds["contacts"].position):
        return figure
    force, ways = forces_of_pairs(shot.clouds["contacts"])
    strongest = float(np.percentile(np.abs(force), 99)) or 1.0
    width = THICKEST * np.minimum(np.abs(force) / strongest, 2.0)
    colours = np.where(force > 0.0, PRESSED, PULLED).tolist()
    axes.add_collection(LineCollection(list(ways), linewidths=width, colors=colours, capstyle="round"))
    shown = [Patch(color=PRESSED, label="pressed"), Patch(color=PULLED, label="pulled")]
    axes.legend(handles=shown, loc="upper right", fontsize=8, title=f"full width: {strongest:.3g}", title_fontsize=8)
    return figure


def forces_of_pairs(cloud: Cloud) -> tuple[Floats, Floats]:
    """Normal force (m,) of each pair of bodies, of contacts and bonds together, and the ends (m, 2, 2) of its line;
    0 where they cancel to NOISE.  Contacts with sides of the domain have no bonds and stay apart."""
    force, start = np.asarray(cloud["normal_force"], float), np.asarray(cloud["start"], float)[:, :2]
    body, other = np.asarray(cloud["body"], int), np.asarray(cloud["other"], int)
    row = np.where(other > 0, 0, np.arange(1, len(other) + 1))
    key = np.column_stack((np.minimum(body, other), np.maximum(body, other), row))
    _, first, same = np.unique(key, axis=0, return_index=True, return_inverse=True)
    net, all_of_it = (np.bincount(same.reshape(-1), values, len(first)) for values in (force, np.abs(force)))
    net = np.where(np.abs(net) > NOISE * all_of_it, net, 0.0)
    return net.astype(float), np.stack((start, start + np.asarray(cloud["branch"], float)[:, :2]), axis=1)[first]


def body_numbers(shot: Snapshot, view: View) -> Figure:
    """Bodies with their numbers, those of in_bc.dat, in the middle of their points."""
    figure, axes = _stage(shot, view, f"numbers at {shot.time:.4g}")
    places = places_of_bodies(shot)
    size = _size(places, view)
    for number, (x, y) in places.items():
        axes.text(x, y, str(number), ha="center", va="center", fontsize=size, clip_on=True)
    return figure


def places_of_bodies(shot: Snapshot) -> dict[int, tuple[float, float]]:
    """Mean place of the points of each body, by its number."""
    clouds = [shot.clouds[name] for name in ("grains", "ends") if name in shot.clouds]
    body = np.concatenate([np.asarray(cloud["body"], int) for cloud in clouds])
    at = np.concatenate([np.asarray(cloud.position, float)[:, :2] for cloud in clouds])
    return {int(k): (float(at[body == k, 0].mean()), float(at[body == k, 1].mean())) for k in np.unique(body)}


def _size(places: dict[int, tuple[float, float]], view: View) -> float:
    """Size of numbers that fits between neighbours, points: a digit is as wide as 0.6 of it."""
    if len(places) < 2:
        return MOST
    at = np.array(list(places.values()))
    apart = float(np.median(cKDTree(at).query(at, 2)[0][:, 1]))
    points = 72.0 * 8.0 / max(view[1] - view[0], view[3] - view[2])
    return float(np.clip(apart * points / (0.7 * len(str(max(places)))), LEAST, MOST))


def _stage(shot: Snapshot, view: View, title: str) -> tuple[Figure, Axes]:
    """A figure to scale with the outlines of all bodies."""
    left, right, bottom, top = view
    longest = max(right - left, top - bottom)
    figure = Figure((8.0 * (right - left) / longest + 1.0, 8.0 * (top - bottom) / longest + 1.0), layout="constrained")
    axes = figure.add_subplot()
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", title=title)
    if "grains" in shot.clouds:
        grains = shot.clouds["grains"]
        size = 2.0 * np.asarray(grains["radius"], float)
        axes.add_collection(EllipseCollection(
            size, size, np.zeros(len(size)), units="x", offsets=np.asarray(grains.position)[:, :2],
            transOffset=axes.transData, facecolors="none", edgecolors=OUTLINE, linewidths=0.6,
        ))  # fmt: skip
    if "ends" in shot.clouds:
        axes.add_collection(LineCollection(_sides(shot), colors=OUTLINE, linewidths=0.8))
    return figure, axes


def _sides(shot: Snapshot) -> list[AnyArray]:
    """Segments, and the closed outlines of polygons."""
    ends = shot.clouds["ends"]
    at = np.asarray(ends.position, float)[:, :2]
    found = [] if ends.lines is None else list(at[np.asarray(ends.lines)])
    if ends.polygons is not None:
        offsets, corners = ends.polygons
        for k in range(len(offsets) - 1):
            own = corners[offsets[k] : offsets[k + 1]]
            found.append(at[np.append(own, own[:1])])
    return found
