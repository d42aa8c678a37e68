"""Numbers that change with time, as the kernels take them."""

from porescale.dem.motion.control import Control, Moved, Placed, Pushed
from porescale.dem.motion.time_function import Schedule, Sine, Table
from porescale.scene.time_function import Component, TimeFunction


def schedule_of(function: TimeFunction) -> Schedule:
    """The schedule of a function of time."""
    if function.times:
        return Table(function.times, function.values)
    if function.amplitude:
        return Sine(function.amplitude, function.frequency, function.phase, function.mean)
    return function.mean


def schedule_or_zero(function: TimeFunction | None) -> Schedule:
    """The schedule of a function of time, zero where there is none."""
    return schedule_of(function) if function else 0.0


def control_of(component: Component) -> Control | None:
    """How one component of a body moves; None: free."""
    if component.velocity:
        return Moved(schedule_of(component.velocity))
    if component.displacement:
        return Placed(schedule_of(component.displacement))
    return Pushed(schedule_of(component.force)) if component.force else None
