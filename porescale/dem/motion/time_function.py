"""Numbers prescribed over time: constant, wave, table.

One row of numbers each, so that kernels read them; tables lie one after the other in an array of points.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats

MEAN, AMPLITUDE, PULSATION, PHASE, FIRST, LAST = range(6)
"""Columns of a schedule's row: value and amplitude, rad/s, rad;  first and last + 1 of its points, both 0: none."""
COLUMNS = 6


@dataclass(frozen=True)
class Sine:
    """mean + amplitude sin(2 pi frequency t + phase);  frequency in Hz, phase in rad."""

    amplitude: float
    frequency: float
    phase: float = 0.0
    mean: float = 0.0


@dataclass(frozen=True)
class Table:
    """Straight lines through (times, values), constant before the first and after the last;  times in s, ascending."""

    times: Sequence[float]
    values: Sequence[float]


Schedule = Sine | Table | float
"""A time function; a plain number is constant."""


def schedule_rows(schedules: Sequence[Schedule]) -> tuple[Floats, Floats]:
    """Rows (q, COLUMNS) and points (p, 2) of ``schedules``; raises InputError at a number or table that is not finite
    or not ascending."""
    rows, points = [], np.zeros((0, 2))
    for one in schedules:
        if isinstance(one, Sine):
            row = [one.mean, one.amplitude, 2.0 * math.pi * one.frequency, one.phase, 0.0, 0.0]
        elif not isinstance(one, Table):
            row = [float(one), 0.0, 0.0, 0.0, 0.0, 0.0]
        else:
            times, values = np.asarray(one.times, float), np.asarray(one.values, float)
            if times.ndim != 1 or times.shape != values.shape or not len(times) or not np.all(np.diff(times) > 0.0):
                raise InputError(Fault("schedule.times", str(one.times), "must ascend, one for each value", "s"))
            row = [0.0, 0.0, 0.0, 0.0, float(len(points)), float(len(points) + len(times))]
            points = np.concatenate((points, np.column_stack((times, values))))
        rows.append(row)
    table = np.array(rows, float).reshape(-1, COLUMNS)
    if not (np.all(np.isfinite(table)) and np.all(np.isfinite(points))):
        raise InputError(Fault("schedule", problem="holds a number that is not finite"))
    return table, points


@kernel
def value_at(schedules, points, which, time):
    """Value of row ``which`` of schedules (q, COLUMNS) with points (p, 2) at ``time`` (s)."""
    first, last = int(schedules[which, FIRST]), int(schedules[which, LAST])
    if first < last:
        if time <= points[first, 0]:
            return points[first, 1]
        if time >= points[last - 1, 0]:
            return points[last - 1, 1]
        low, high = first, last - 1
        while high - low > 1:
            middle = (low + high) // 2
            if points[middle, 0] <= time:
                low = middle
            else:
                high = middle
        share = (time - points[low, 0]) / (points[high, 0] - points[low, 0])
        return points[low, 1] + share * (points[high, 1] - points[low, 1])
    value = schedules[which, MEAN]
    if schedules[which, AMPLITUDE] != 0.0:
        value += schedules[which, AMPLITUDE] * np.sin(schedules[which, PULSATION] * time + schedules[which, PHASE])
    return value
