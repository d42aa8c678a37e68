"""The pile's surface over time, from the snapshots of a run: profile.csv."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from porescale.common.core.atomic import write_text
from porescale.common.core.types import Reals
from porescale.common.evidence.files import csv_text
from porescale.common.record.vtkhdf import read_array

if TYPE_CHECKING:
    from porescale.common.record.open_run import Run

BIN_WIDTH = 2.0
"""Width of a bin in mean diameters: narrower ones show single grains, not a surface."""


def write_surface(run: Run, folder: Path) -> Path:
    """Write profile.csv: a row per snapshot, a column per bin with the height of the surface there, m.

    time (s) : of the snapshot
    height at x = X m (m) : of the surface of the pile over the bin about X, two mean diameters wide
    """
    width = run.card["scene"]["domain"]["width"]
    frames = run.frames("grains")
    diameter = 2 * float(np.mean(read_array(frames[0], "radius")))
    count = max(1, round(width / (BIN_WIDTH * diameter)))
    edges = np.linspace(0.0, width, count + 1)
    header, rows = ["time (s)", *(f"height at x = {x:.5g} m (m)" for x in 0.5 * (edges[1:] + edges[:-1]))], []
    for frame in frames:
        found = surface(read_array(frame, "position")[:, :2], read_array(frame, "radius"), edges)
        rows.append([repr(frame.time), *map(repr, found.tolist())])
    path = folder / "profile.csv"
    write_text(path, csv_text(header, rows))
    return path


def surface(position: Reals, radius: Reals, edges: Reals) -> Reals:
    """Height of the pile's surface in bins between ``edges`` (b + 1,) m: top of the highest disc reaching in, (b,) m.

    Discs are taken at their true shape: over a bin, the highest point of the disc within it.
    """
    height = np.zeros(len(edges) - 1)
    x, y = position.T
    first = np.maximum(np.searchsorted(edges, x - radius, side="right") - 1, 0)
    last = np.minimum(np.searchsorted(edges, x + radius, side="left"), len(height))
    for further in range(int(np.max(last - first, initial=0))):  # the n-th bin that each disc reaches into
        own = first + further < last
        b, r = (first + further)[own], radius[own]
        off = np.clip(x[own], edges[b], edges[b + 1]) - x[own]
        np.maximum.at(height, b, y[own] + np.sqrt(np.maximum(r * r - off * off, 0.0)))
    return height
