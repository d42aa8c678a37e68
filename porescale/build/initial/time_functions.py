"""Numbers that change with time, as the kernels take them."""

from __future__ import annotations

from porescale.dem.motion.control import Control, Moved, Placed, Pushed
from porescale.dem.motion.time_function import Constant, Schedule, Sine, Table
from porescale.scene.time_function import Component, Course


def schedule_of(course: Course) -> Schedule:
    """A number over time."""
    if course.times:
        return Table(course.times, course.values)
    if course.amplitude:
        return Sine(course.amplitude, course.frequency, course.phase, course.mean)
    return Constant(course.mean)


def schedule_or_zero(course: Course | None) -> Schedule:
    """The same, zero where there is none."""
    return schedule_of(course) if course else 0.0


def control_of(component: Component) -> Control | None:
    """How one component of a body moves; None: free."""
    if component.velocity:
        return Moved(schedule_of(component.velocity))
    if component.displacement:
        return Placed(schedule_of(component.displacement))
    return Pushed(schedule_of(component.force)) if component.force else None
