"""Profiles along the lines of a scene at every snapshot of its run: lines.csv."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.core.atomic import write_text
from porescale.common.evidence.files import csv_text
from porescale.lbm.boundary.choose import boundaries
from porescale.output.sample import Sampler, along

if TYPE_CHECKING:
    from porescale.common.record.open_run import Run

COLUMNS = (
    "time (s)", "line ()", "distance (m)", "x (m)", "y (m)", "velocity x (m/s)", "velocity y (m/s)", "pressure (Pa)",
    "solid fraction ()",
)  # fmt: skip
LAMBDA = "hydraulic radius ratio ()"
"""Column of lambda."""


def write_lines(run: Run, folder: Path) -> list[Path]:
    """Write lines.csv, a row a point: of every line in its turn, of every snapshot; [] if the scene has no line.

    time (s) : of the snapshot
    line () : number of the line in the scene, from 0
    distance (m) : along the line, from its start
    x (m) : of the point
    y (m) : of the point
    velocity x (m/s) : of the fluid there
    velocity y (m/s) : of the fluid there
    pressure (Pa) : there, with its hydrostatic part
    solid fraction () : of the cell there
    hydraulic radius ratio () : where the grains have one
    """
    lines = run.card["scene"].get("line") or []
    if not lines:
        return []
    table = profiles(run, lines)
    path = folder / "lines.csv"
    write_text(path, csv_text(list(table), [list(map(repr, row)) for row in zip(*table.values(), strict=True)]))
    return [path]


def profiles(run: Run, lines: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """Columns of lines.csv for ``lines``, tables as [[line]] has them, at every snapshot.

    Lines are numbered from 0 in their order.  Velocity is interpolated, that of the solid in it, at a wall that of the
    wall; pressure over the fluid share of cells: nan inside of grains.
    """
    scene: dict[str, Any] = run.card["scene"]
    grid = run.snapshot(0).grids["fields"]
    ny, nx = grid.shape
    kinds = (boundaries().get(scene["domain"][side]["kind"]) for side in ("left", "bottom"))  # None: since gone
    periodic_x, periodic_y = (kind is not None and kind.periodic for kind in kinds)
    known_x, known_y = known_at_sides(scene["domain"])
    ratio = (scene.get("grains") or {}).get("hydraulic_radius_ratio")
    samplers = [
        Sampler(along(line["start"], line["end"], line["points"]), (nx, ny), grid.spacing[0], (periodic_x, periodic_y))
        for line in lines
    ]
    rows: list[list[Any]] = []
    for snapshot in run.snapshots():
        cells = snapshot.grids["fields"].cells
        solid = cells.get("solid_fraction", np.zeros((ny, nx)))
        for number, at in enumerate(samplers):
            x, y = at.points.T
            columns = (
                np.hypot(x - x[0], y - y[0]), x, y, at.to_sides(cells["velocity"][..., 0], known_x, solid),
                at.to_sides(cells["velocity"][..., 1], known_y, solid),
                at.in_fluid(cells["pressure"], solid), at.of(solid),
            )  # fmt: skip
            for row in np.stack(columns, axis=1).tolist():
                rows.append([float(snapshot.time), number, *row, *([ratio] if ratio else [])])
    names = [*COLUMNS, LAMBDA] if ratio else COLUMNS
    return {name: list(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}


def known_at_sides(domain: Mapping[str, Mapping[str, Any]]) -> tuple[list[float | None], list[float | None]]:
    """Velocity x and y (m/s) of the fluid at the left, right, bottom and top side: that of a wall, 0 across a line
    of symmetry; None where it is that beside it.  ``domain``: tables of the sides as [domain] has them."""
    x: list[float | None] = []
    y: list[float | None] = []
    for name, (across, along_it) in {"left": (x, y), "right": (x, y), "bottom": (y, x), "top": (y, x)}.items():
        kind = boundaries().get(domain[name]["kind"])  # None: since gone
        across.append(0.0 if kind is not None and kind.closed else None)
        along_it.append(domain[name].get("speed") or 0.0 if kind is not None and kind.no_slip else None)
    return x, y
