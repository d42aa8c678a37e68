"""A number that a run is about, taken from the columns of its tables: rows of expected.toml and of studies.

A row names a ``column`` (with its unit) and where to read it:

at : "end", "max", "min", a time in s (interpolated), or a table with first_below, first_above or last_above and a
    value: the time in s at which the column falls or rises to it for the first time, or is above it for the last; as
    a share of where it goes with share_of = "fall" (1 at the start, 0 at the end) or "peak" (of its largest value);
    with quantile, what that share of the rows does not exceed; with mean_from, max_from, rms_from, period_from,
    change_from the mean, the largest value, the rms about the mean, the mean period (s) about the mean, the last value
    less the first from a time on.
minus : another column to take away;  where : {column: value} of the rows to look at, at the table's last time;
integral : true for the integral of the column over time up to each row, by straight lines between rows: the volume that
a discharge has passed.
"""

import sys
from collections.abc import Callable, Mapping
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.record.columns import TIME

Columns = Mapping[str, NDArray[Any]]

WHERE = ("end", "max", "min")
"""Words for the place where a number is read."""
SHARES = ("fall", "peak")
"""What a column may be a share of."""


def measured(columns: Columns, row: Mapping[str, Any]) -> float:
    """The number that ``row`` describes; nan beyond the end of the run and where it is never above, infinity where it
    never falls so low or rises so high.

    Whole steps end a little off the prescribed time: the last row stands for less than half a row more.

    Raises KeyError where the table has no such column, ValueError where ``at`` is none of the above.
    """
    time, values, at = columns[TIME], columns[row["column"]], row["at"]
    if "minus" in row:
        values = values - columns[row["minus"]]
    if "where" in row:
        meant = time == time.max()
        for name, value in row["where"].items():
            meant &= columns[name] == value
        time, values = time[meant], values[meant]
    if row.get("integral"):
        values = np.append(0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(time)))
    if isinstance(at, Mapping):
        return _found(time, values, at)
    if at == "end":
        return float(values[-1])
    if at in ("max", "min"):
        return float(getattr(np, at)(values))
    if isinstance(at, str):
        raise ValueError(f"at = {at!r} is not one of end, max, min, a time or a table")
    return float(np.interp(at, time, values, right=np.nan if _beyond(time, at) else values[-1]))


def _beyond(time: NDArray[Any], at: float) -> bool:
    """Whether ``at`` (s) lies beyond the last of the rows at ``time`` (n,) s by half a row and more."""
    times = np.unique(time)
    return bool(at > times[-1] and at >= times[-1] + (0.5 * (times[-1] - times[-2]) if len(times) > 1 else 0.0))


def _found(time: NDArray[Any], values: NDArray[Any], at: Mapping[str, Any]) -> float:
    """Where to read a quantity, as given by a table of trade.toml or expected.toml."""
    for name, of in LATE.items():
        if name in at:
            late = time >= at[name]
            return of(time[late], values[late]) if late.any() else float("nan")
    if "quantile" in at:
        return float(np.quantile(values, at["quantile"]))
    share = at.get("share_of")
    if share == "fall":
        values = (values - values[-1]) / (values[0] - values[-1])
    elif share == "peak":
        values = values / values.max()
    elif share is not None:
        raise ValueError(f"share_of = {share!r} is neither fall nor peak")
    if "first_below" in at:
        return float(min(time[values <= at["first_below"]], default=np.inf))
    if "first_above" in at:
        return float(min(time[values >= at["first_above"]], default=np.inf))
    if "last_above" in at:
        return float(max(time[values > at["last_above"]], default=np.nan))
    raise ValueError(f"at = {dict(at)!r} holds no known key")


def _period(time: NDArray[Any], values: NDArray[Any]) -> float:
    """Mean time between upward crossings of the mean; infinite with fewer than two."""
    swing = values - values.mean()
    rising = np.flatnonzero((swing[:-1] < 0) & (swing[1:] >= 0))
    zero = time[rising] - swing[rising] * np.diff(time)[rising] / np.diff(swing)[rising]
    return float(np.diff(zero).mean()) if len(zero) > 1 else float("inf")


LATE: dict[str, Callable[[NDArray[Any], NDArray[Any]], float]] = {
    "mean_from": lambda time, values: float(values.mean()),
    "max_from": lambda time, values: float(values.max()),
    "rms_from": lambda time, values: float(values.std()),
    "period_from": _period,
    "change_from": lambda time, values: float(values[-1] - values[0]),
}
"""What is taken of the rows from a time on, by key."""


def wrong(row: Mapping[str, Any]) -> str:
    """Fault in what a row says to read and to expect, "" if there is none; a table may still lack its columns."""
    for key in ("name", "column", "minus", "unit", "file"):
        if not isinstance(row.get(key, ""), str):
            return f"{key} is not text"
    if not isinstance(row.get("where", {}), Mapping):
        return "where is not a table"
    if not isinstance(row.get("integral", False), bool):
        return "integral is neither true nor false"
    if row.get("integral") and "where" in row:
        return "integral is over time, and where leaves rows of one time"
    for key in ("value", "tolerance"):
        if key in row and not _is_number(row[key]):
            return f"{key} is not a number"
    if row.get("tolerance", 0) < 0:
        return "tolerance is below 0"
    at = row["at"]
    if isinstance(at, str):
        return "" if at in WHERE else f"at is not one of {', '.join(WHERE)}, a time or a table"
    if not isinstance(at, Mapping):
        return "" if _is_number(at) else "at is not a time"
    falls = ("first_below", "first_above", "last_above")
    known = (*LATE, "quantile", *falls)
    chosen = [key for key in at if key != "share_of"]
    if len(chosen) != 1 or chosen[0] not in known:
        return f"at has not one of {', '.join(known)}"
    if not _is_number(at[chosen[0]]) or (chosen[0] == "quantile" and not 0 <= at["quantile"] <= 1):
        return f"at.{chosen[0]} is out of range"
    if "share_of" in at and (chosen[0] not in falls or at["share_of"] not in SHARES):
        return f"at.share_of is not one of {', '.join(SHARES)}, with {' or '.join(falls)}"
    return ""


def title(row: Mapping[str, Any]) -> str:
    """The name of a number with its unit."""
    name, unit = str(row["name"]), str(row.get("unit", ""))
    return name if not unit or name.endswith(")") else f"{name} ({unit})"


def _is_number(value: object) -> bool:
    # A whole number may be too large for a float, which isfinite does not bear.
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def curve(columns: Columns, row: Mapping[str, Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Places and values (n,) of a curve at the time nearest to ``at``, or the last; nan beyond the run's end, as of
    `measured`.

    Where the table has a row for each place, ``along`` names the column of places;  where it has a row for each time
    and a column for each place, ``column`` is their common name with a * in it, and places are counted.  Raises
    KeyError where the table has no such columns.
    """
    time = columns[TIME]
    at = time.max() if row["at"] == "end" else float(row["at"])
    nearest = time == time[np.abs(time - at).argmin()]
    known = np.nan if _beyond(time, at) else 1.0
    if row.get("along"):
        along, values = columns[row["along"]][nearest], columns[row["column"]][nearest]
        order = np.argsort(along, kind="stable")
        return along[order], known * values[order]
    names = [name for name in columns if fnmatchcase(name, row["column"])]
    if not names:
        raise KeyError(row["column"])
    values = known * np.array([columns[name][nearest][-1] for name in names])
    return np.arange(len(values), dtype=float), values
