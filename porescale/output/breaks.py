"""Bonds that broke: breaks.csv."""

import math
from pathlib import Path

import numpy as np

from porescale.common.core.atomic import write_text
from porescale.common.evidence.files import csv_text
from porescale.common.record.open_run import Run
from porescale.output.frame_clouds import BONDS
from porescale.scene.bodies.bonds import KINDS

TABLE = "breaks.csv"
COLUMNS = ("time (s)", "x (m)", "y (m)", "strength (N/m)", "body ()", "other body ()")


def write_breaks(run: Run, folder: Path) -> list[Path]:
    """Write breaks.csv, a row a bond that broke until the last snapshot, by time; [] where a run has no bonds.

    time (s) : at which the bond broke
    x (m) : where it broke
    y (m) : where it broke
    strength (N/m) : tension at which it breaks
    body () : the one body, by kind and number
    other body () : the other body
    """
    if not len(run) or BONDS not in (clouds := run.snapshot(-1, cells=()).clouds):
        return []
    data = {name: np.asarray(values)[::2] for name, values in clouds[BONDS].data.items()}
    gone = np.flatnonzero(data["whole"] == 0)
    gone = gone[np.argsort(data["broken_time"][gone], kind="stable")]
    rows = []
    for k in gone.tolist():
        x, y = (float(value) for value in data["broken_place"][k, :2])
        names = [f"{KINDS[int(data[f'{it}_kind'][k])]} {int(data[f'{it}_number'][k])}" for it in ("first", "second")]
        row = (float(data["broken_time"][k]), x, y, float(data["back_tension"][k]))
        assert not math.isnan(row[0])
        rows.append([*map(repr, row), *names])
    path = folder / TABLE
    write_text(path, csv_text(COLUMNS, rows))
    return [path]
