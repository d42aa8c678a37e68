"""The permeability of a run's bed at its first and its last snapshot: permeability.csv."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.analysis.permeability import Measured, gebart, kozeny_carman, measure, with_images
from porescale.builders.derive import fluid_scales
from porescale.builders.initial.fluid_options import collision_options, solid_options
from porescale.builders.scene import Scene
from porescale.common.core.atomic import write_text
from porescale.common.core.errors import InputError, warn
from porescale.common.evidence.files import csv_text
from porescale.common.record.model import Cloud
from porescale.common.schema.sections import validate

if TYPE_CHECKING:
    from porescale.common.record.open_run import Run


def write_permeability(run: Run, folder: Path) -> list[Path]:
    """Measure the bed and write permeability.csv, a row a snapshot; [] if the scene has no such section.

    Warns where the bed of a snapshot cannot be measured, as without a grain in the window, and leaves its row out: a
    run that has ended is not lost by it.  Takes seconds: flow through the bed is driven until steady.
    """
    if not run.card["scene"].get("permeability"):
        return []
    scene = validate(Scene, run.card["scene"])
    ratio = (scene.grains.hydraulic_radius_ratio if scene.grains else None) or 1.0
    rows = []
    for k in sorted({0, len(run) - 1}):
        snapshot = run.snapshot(k, cells=("velocity",))
        grains = snapshot.clouds["grains"]
        try:
            found = measure_window(scene, grains)
        except InputError as error:
            warn(f"no permeability at t = {snapshot.time:g} s: {error}")
            continue
        flows = found.steady or not math.isfinite(found.permeability)  # a sealed bed would take as long again
        resolved = measure_window(scene, grains, resolved=True).permeability if flows else math.nan
        rows.append(row(snapshot.time, ratio, found, resolved))
    if not rows:
        return []
    path = folder / "permeability.csv"
    write_text(path, csv_text(rows[0], ([repr(value) for value in it.values()] for it in rows)))
    return [path]


def measure_window(scene: Scene, grains: Cloud, *, resolved: bool = False) -> Measured:
    """The permeability of the window that a scene names, or of its packing's rectangle, as its lattice has it.

    resolved : with the solid operator for narrow gaps instead, on a lattice of the same spacing.
    """
    assert scene.permeability
    assert scene.fluid
    window = scene.permeability.window or (scene.grains.packing if scene.grains else None)
    assert window  # the scene has made sure
    scales = fluid_scales(scene.fluid)
    spacing = scene.permeability.spacing or scales.spacing
    lower = window.left, window.bottom
    upper = lower[0] + window.width, lower[1] + window.height
    near = 0.5 * spacing
    box = (scene.domain.width, scene.domain.height)
    across, low, high = (1, "bottom", "top") if scene.permeability.direction == "x" else (0, "left", "right")
    walls = (
        lower[across] < near and scene.domain.sides[low].boundary.no_slip,
        upper[across] > box[across] - near and scene.domain.sides[high].boundary.no_slip,
    )
    as_run: dict[str, Any] = {} if resolved else {
        "relaxation_time": scales.relaxation_time, "laws": collision_options(scene.fluid),
        "solid_laws": solid_options(scene.fluid),
    }  # fmt: skip
    position, radius, whole = with_images(
        grains.position,
        grains.data["hydraulic_radius"],
        box,
        scene.domain.periodic,
        (window.width, window.height),
        near,
    )
    return measure(
        position, radius, lower, upper, spacing, direction=scene.permeability.direction, periodic=whole, walls=walls,
        **as_run,
    )  # fmt: skip


def row(time: float, ratio: float, found: Measured, resolved: float) -> dict[str, float]:
    """The columns of a measurement, SI, with what regular arrays and beds of this solid fraction have.

    time (s) : of the snapshot whose bed is measured
    permeability (m²) : k of Darcy's law, by a flow that is driven through the bed, as the run's lattice has it
    permeability, narrow gaps resolved (m²) : the same by the solid operator for such gaps; nan if not steady
    permeability over hydraulic diameter² () : the same without unit
    permeability over grain diameter² () : the same with d of the grains, as `permeability.wanted` has it
    hydraulic radius ratio () : radius that the fluid sees, over that of the grain; 1 where none is given
    hydraulic solid fraction () : of the radii that the fluid sees
    cells per hydraulic diameter () : resolution of the measurement
    Gebart, square array (m²) : permeability of a square array of this solid fraction
    Gebart, hexagonal array (m²) : permeability of a hexagonal array of this solid fraction
    Kozeny-Carman (m²) : permeability by that formula
    steady () : 1 if the flow came to rest, 0 if the measurement ended before
    """
    c, square = found.solid_fraction, (0.5 * found.diameter) ** 2
    return {
        "time (s)": float(time),
        "permeability (m²)": found.permeability,
        "permeability, narrow gaps resolved (m²)": resolved,
        "permeability over hydraulic diameter² ()": found.relative,
        "permeability over grain diameter² ()": float(ratio) ** 2 * found.relative,
        "hydraulic radius ratio ()": float(ratio),
        "hydraulic solid fraction ()": c,
        "cells per hydraulic diameter ()": found.cells,
        "Gebart, square array (m²)": gebart(c) * square,
        "Gebart, hexagonal array (m²)": gebart(c, hexagonal=True) * square,
        "Kozeny-Carman (m²)": kozeny_carman(c) * square,
        "steady ()": float(found.steady),
    }
