"""Whether a checkpoint can be gone on with, checked before a model is built for it, and before one takes it up.

Checksums say that a file holds what was written, not that this is a valid state.  What a model restores goes through
kernels, which do not look whether an index is one: a state is therefore checked by itself first, then beside the state
of the model that is to take it up.
"""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.record.checkpoint import read_checkpoint

State = Mapping[str, Any]

CHECKPOINT = "checkpoint.h5"
PARTS: tuple[tuple[str, type | tuple[type, ...]], ...] = (
    ("state", dict), ("record", dict), ("schedules", dict), ("step", int), ("time", (int, float)),
    ("seconds", (int, float)),
)  # fmt: skip
"""Entries of a checkpoint and their types."""
AS_LONG = {
    "carried": "partner", "corner_memory": "corner", "near_memory": "near", "back": "ends", "whole": "ends",
    "broken": "ends", "withheld": "held",
}  # fmt: skip
"""Arrays that have a row for every one of another beside them: of pairs, of segments that touch, of bonds, of
discs that are held."""
GROWING = frozenset({"partner", "corner", "near", "ends", "held", "book_start", *AS_LONG})
"""Arrays that have other lengths at other times."""
NOT_YET = frozenset({"broken"})
"""Arrays in which no number means that something has not happened."""
NUMBERS = (bool, int, float, np.number, np.bool_)


def check_state(folder: Path) -> None:
    """InputError unless the checkpoint in ``folder`` is one, and of a state that is valid by itself."""
    content = read_checkpoint(folder / CHECKPOINT)
    for name, kind in PARTS:
        if not isinstance(content.get(name), kind):
            raise misfit(folder, "holds no state of a run", f"{name} is not there" if name not in content else name)
    found = senseless(content["state"])
    if found:
        raise misfit(folder, "holds an invalid state", found)


def misfit(folder: Path, problem: str, reason: object) -> InputError:
    """What to raise about the checkpoint in ``folder``."""
    short = " ".join(str(reason).split())[:120]
    repair = "start the run anew, or take the checkpoint from a backup"
    return InputError(Fault("checkpoint", str(folder / CHECKPOINT), f"{problem} ({short})", repair=repair))


def senseless(state: State) -> str:
    """What of a state cannot be, whatever model it is of; "" if nothing: numbers that are none, rows that are missing,
    and indices of what is not there."""
    for place, part in tables(state):
        for found in (_no_numbers(part), _rows(part), _partners(part), _bodies(part), _rule(part)):
            if found:
                return f"{place}{found}"
    return ""


def other(own: Any, given: Any, place: str = "") -> str:
    """Where the ``given`` state is of another shape or kind than that of a model, its ``own``; "" where it is nowhere.

    Numpy fills an array with a smaller one, or with numbers of another kind, without a word.  What only one of them has
    is left to the model: older states have less.
    """
    if isinstance(own, dict):
        if not isinstance(given, Mapping):
            return f"{place}: {type(given).__name__} in place of a table"
        keys: Collection[str] = own.keys() & given.keys()
        found = (other(own[key], given[key], f"{place}.{key}" if place else key) for key in sorted(keys))
        return next(filter(None, found), "")
    if isinstance(own, np.ndarray):
        return f"{place}: {_array(own, given, place)}" if _array(own, given, place) else ""
    if isinstance(own, NUMBERS) and not isinstance(given, NUMBERS):
        return f"{place}: {type(given).__name__} in place of a number"
    if isinstance(own, list | tuple) and not (isinstance(given, list | tuple) and len(own) == len(given)):
        return f"{place}: not {len(own)} entries"
    return ""


def _array(own: np.ndarray[Any, Any], given: Any, place: str) -> str:
    """How an array is another; "" if it is none.  One of no rows may get some, and one of `GROWING` others."""
    if not isinstance(given, np.ndarray):
        return f"{type(given).__name__} in place of an array"
    free = own.ndim and (place.rpartition(".")[2] in GROWING or not own.shape[0])
    if own.ndim != given.ndim or own.shape[bool(free) :] != given.shape[bool(free) :]:
        return f"{given.shape} in place of {own.shape}"
    return "" if own.dtype == given.dtype else f"{given.dtype} in place of {own.dtype}"


def tables(state: State, place: str = "") -> Iterator[tuple[str, State]]:
    """A state and all tables in it, each with where it is: "", or names with a dot after each."""
    yield place, state
    for key, value in state.items():
        if isinstance(value, Mapping):
            yield from tables(value, f"{place}{key}.")


def _no_numbers(part: State) -> str:
    """Text that names the first value with nan in it; "" where there is none."""
    for name, value in part.items():
        kind = value.dtype.kind if isinstance(value, np.ndarray) else "f" if isinstance(value, float) else ""
        if kind == "f" and name not in NOT_YET and np.isnan(value).any():
            return f"{name}: no number in it"
    return ""


def _rows(part: State) -> str:
    """What has not as many rows as what it belongs to."""
    for name, beside in AS_LONG.items():
        one, two = part.get(name), part.get(beside)
        if isinstance(one, np.ndarray) and isinstance(two, np.ndarray) and one.shape[:1] != two.shape[:1]:
            return f"{name}: {one.shape[:1]} rows for {two.shape[:1]} of {beside}"
    return ""


def _partners(part: State) -> str:
    """What is wrong with a list of neighbours: those of point i are ``partner[start[i] : start[i + 1]]``."""
    if "start" not in part or "partner" not in part:
        return ""
    start, partner = part["start"], part["partner"]
    for name, rows in (("start", start), ("partner", partner)):
        if not _integers(rows, 1):
            return f"{name}: no row of whole numbers"
    if not len(start) or start[0] != 0 or start[-1] != len(partner) or (np.diff(start) < 0).any():
        return f"start: does not rise from 0 to {len(partner)}"
    return _beyond("partner", partner, len(start) - 1)


def _bodies(part: State) -> str:
    """What is wrong with the indices that segments and bonds of a system of discs have; or its list of neighbours is of
    another number of discs."""
    discs = part.get("discs")
    position = discs.get("position") if isinstance(discs, Mapping) else None
    if not isinstance(position, np.ndarray):
        return ""
    count = len(position)
    inner = {name: value for name in ("pairs", "segments", "bonds") if isinstance(value := part.get(name), Mapping)}
    start = inner.get("pairs", {}).get("start")
    if isinstance(start, np.ndarray) and start.shape != (count + 1,):
        return f"pairs.start: {len(start)} for {count} discs"
    rows = part.get("held")
    if isinstance(rows, np.ndarray) and rows.shape not in ((0, 3), (count, 3)):
        return f"held: {rows.shape} for none or all of {count} discs"
    for table, name, width in (("segments", "corner", 2), ("segments", "near", 2), ("bonds", "ends", 3)):
        rows = inner.get(table, {}).get(name)
        if rows is None:
            continue
        if not _integers(rows, 2) or rows.shape[1] != width:
            return f"{table}.{name}: no rows of {width} whole numbers"
        # The second of a pair is a disc, or a segment, of which there may be more or fewer than discs.
        both = name == "corner"
        found = _beyond(f"{table}.{name}", rows if both else rows[:, 0], count)
        if found or (rows < 0).any():
            return found or f"{table}.{name}: below zero"
        if table == "bonds" and ((rows[:, 2] > 1).any() or (rows[rows[:, 2] == 0, 1] >= count).any()):
            return f"bonds.ends: none of {count} discs"
    return ""


def _rule(part: State) -> str:
    """Which of the rules that limit steps is none."""
    limited, rule = part.get("limited"), part.get("rule")
    if isinstance(limited, list | tuple) and isinstance(rule, int) and not 0 <= rule < len(limited):
        return f"rule: {rule} of {len(limited)}"
    return ""


def _integers(rows: Any, dimensions: int) -> bool:
    return isinstance(rows, np.ndarray) and rows.ndim == dimensions and rows.dtype.kind in "iu"


def _beyond(name: str, rows: np.ndarray[Any, Any], count: int) -> str:
    """Text that names the first index outside 0 to ``count`` - 1; "" where there is none."""
    wrong = (rows < 0) | (rows >= count)
    return f"{name}: {int(rows[wrong][0])} is none of {count}" if wrong.any() else ""
