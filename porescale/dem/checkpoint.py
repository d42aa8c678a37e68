"""What a system of grains is now, as arrays and numbers, and back from there bit for bit."""

from typing import Any

import numpy as np

from porescale.common.core.types import Floats
from porescale.dem.discs import overwrite
from porescale.dem.forces.bonds import BondList
from porescale.dem.state import State

ARRAYS = (
    "wall_spring", "wall_load", "plates", "plate_spring", "plate_force", "external_force", "external_torque",
)  # fmt: skip
"""Arrays of every state, by the names of State."""
RECTANGLES = ("rectangles", "rectangle_spring", "rectangle_force")
"""What of the state belongs to rectangles, where there are any."""


def state_of(grains: State) -> dict[str, Any]:
    """Everything needed to go on bit for bit of ``grains`` (law, box and the number of plates are the scene's)."""
    return {
        "discs": grains.discs.state(),
        "pairs": grains.pairs.state(),
        **{name: getattr(grains, name).copy() for name in (*_names(grains), "held", "withheld")},
        **({} if grains.budget is None else {"book": grains.budget.copy(), "book_start": _start_of_budget(grains)}),
        **({} if grains.drivers is None else {"steering": grains.drivers.state(grains.walls)}),
        **({} if grains.segments is None else {"segments": grains.segments.state()}),
        **({} if grains.bonds is None else {"bonds": grains.bonds.state()}),
        **({} if grains.sleep is None else {"sleep": grains.sleep.state()}),
        "steps": grains.steps,
        "time": grains.seconds,
        "steps_of_dt": grains.steps_of_dt,
        "last_dt": grains.last_dt,
        "stale": int(grains.stale),
    }


def _names(grains: State) -> tuple[str, ...]:
    """Names of the arrays that a state of ``grains`` overwrites in place."""
    return (*ARRAYS, *RECTANGLES) if len(grains.rectangles) else ARRAYS


def _start_of_budget(grains: State) -> Floats:
    """Copy of the start of the energy budget, empty before the first step."""
    return np.zeros(0) if grains.budget_start is None else grains.budget_start.copy()


def restore(grains: State, state: dict[str, Any]) -> None:
    """Overwrite ``grains`` with the state of a system made alike; raises InputError when the numbers differ."""
    grains.discs.restore(state["discs"])
    overwrite({name: getattr(grains, name) for name in _names(grains)}, state)
    if grains.budget is not None:
        grains.budget[:] = state["book"]
        start = np.array(state["book_start"])
        grains.budget_start = start if len(start) else None
    grains.held, grains.withheld = np.array(state["held"], np.uint8), np.array(state["withheld"])
    if grains.drivers is not None:
        grains.drivers.restore(state["steering"], grains.walls, grains.pairs)
    grains.pairs.restore(state["pairs"])
    if grains.segments is not None:
        grains.segments.restore(state["segments"], grains.pairs.builds)
    known = grains.discs.count, 0 if grains.segments is None else len(grains.segments.ends)
    grains.bonds = BondList.restored(state["bonds"], *known) if "bonds" in state else None
    if grains.sleep is not None:
        grains.sleep.restore(state["sleep"])
    grains.sweeps.forget()
    grains.steps, grains.seconds = int(state["steps"]), float(state["time"])
    grains.steps_of_dt = int(state["steps_of_dt"])
    grains.last_dt, grains.stale = float(state["last_dt"]), bool(state["stale"])
    grains.static, grains.free_law, grains.plates_checked = None, None, False
