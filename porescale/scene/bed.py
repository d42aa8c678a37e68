"""The permeability of a run's bed at its first and its last snapshot: permeability.csv."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.runs.atomic import write_bytes
from porescale.scene.permeability import Measured, gebart, kozeny_carman, measure

if TYPE_CHECKING:
    from porescale.runs.open_run import Run


def write_permeability(run: Run, folder: Path) -> list[Path]:
    """Measure the bed and write permeability.csv, a row a snapshot; [] if the scene does not ask for it.

    Raises InputError where the window holds no grain.  Takes seconds: flow through the bed is driven until steady.
    """
    scene: dict[str, Any] = run.card["scene"]
    section = scene.get("permeability")
    if not section:
        return []
    ratio = scene["grains"]["hydraulic_radius_ratio"]
    rows = []
    for k in sorted({0, len(run) - 1}):
        snapshot = run.snapshot(k, cells=("velocity",))
        spacing = section["spacing"] or snapshot.grids["fields"].spacing[0]
        rows.append(row(snapshot.time, ratio, measure_window(scene, snapshot.clouds["grains"], spacing)))
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(rows[0])
    table.writerows([repr(value) for value in it.values()] for it in rows)
    path = folder / "permeability.csv"
    write_bytes(path, text.getvalue().encode())
    return [path]


def measure_window(scene: dict[str, Any], grains: Any, spacing: float) -> Measured:
    """The permeability of the window that a scene (as on a card) names, or of its packing's rectangle."""
    domain, window = scene["domain"], scene["permeability"]["window"] or scene["grains"]["packing"]
    lower = window["left"], window["bottom"]
    upper = lower[0] + window["width"], lower[1] + window["height"]
    size = domain["width"], domain["height"]
    periodic = tuple(
        domain[side]["kind"] == "periodic" and upper[axis] - lower[axis] > size[axis] - 0.5 * spacing
        for axis, side in enumerate(("left", "bottom"))
    )
    return measure(
        grains.position, grains.data["hydraulic_radius"], lower, upper, spacing,
        direction=scene["permeability"]["direction"], periodic=(periodic[0], periodic[1]),
    )  # fmt: skip


def row(time: float, ratio: float, found: Measured) -> dict[str, float]:
    """The columns of a measurement, SI, with what regular arrays and beds of this solid fraction have."""
    c, square = found.solid_fraction, (0.5 * found.diameter) ** 2
    return {
        "time (s)": float(time),
        "permeability (m²)": found.permeability,
        "permeability over hydraulic diameter² ()": found.relative,
        "hydraulic radius ratio ()": float(ratio),
        "hydraulic solid fraction ()": c,
        "cells per hydraulic diameter ()": found.cells,
        "Gebart, square array (m²)": gebart(c) * square,
        "Gebart, hexagonal array (m²)": gebart(c, hexagonal=True) * square,
        "Kozeny-Carman (m²)": kozeny_carman(c) * square,
        "steady ()": float(found.steady),
    }
