"""Cases that are scripts: errors and core-seconds of what they varied, in the files that `study trade` writes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from porescale.common.core.machine import machine, peak_bytes
from porescale.common.core.version import VERSION
from porescale.common.studies import trade_files
from porescale.common.studies.parameter_table import Point
from porescale.common.studies.trade import front, of_errors


@dataclass(frozen=True)
class Tried:
    """A point that a script measured.

    knob, label : what was varied, and to what;  settings : what makes the point, "key=value";  errors : of each repeat
    by quantity, shares, every repeat with the same quantities;  core_seconds : of all that was measured;  count : of
    what, pictures or steps.
    """

    knob: str
    label: str
    settings: tuple[str, ...]
    errors: Sequence[Mapping[str, float]]
    core_seconds: float
    count: int


def trade(folder: Path, command: str, tried: Sequence[Tried]) -> None:
    """Write front.json, trade.csv, trade.md and trade.png of ``tried`` into ``folder``.

    Core-seconds are those of one of the ``count``, memory is the most that the script has taken so far.  command : that
    measures them.
    """
    points = []
    for one in tried:
        names = list(one.errors[0])
        table = np.array([[each[name] for name in names] for each in one.errors])
        spent = one.core_seconds / one.count
        costs = (spent, spent, float(peak_bytes()), 1, 1.0, 0.0, spent)  # one of the count is the unit of time
        label = f"{one.knob} {one.label}"
        named = (one.knob, label, Point(label, one.settings))
        points.append(of_errors(named, names, table, costs))
    about = {
        "command": command, "package": "porescale", "version": VERSION, "threads": 1, "machine": machine(),
        "date": datetime.now(UTC).date().isoformat(),
        "quantities": [{"name": name} for name in points[0].errors],
    }  # fmt: skip
    trade_files.write(folder, about, front(points), {})
