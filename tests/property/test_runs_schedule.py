"""Events lie where they should, whatever the interval and the step."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porescale.common.core.errors import InputError
from porescale.common.record.schedule import Schedule, positive

POSITIVE = st.floats(1e-6, 1e3)


@given(st.floats(1e-6, 1e-2), st.floats(1.0, 500.0), st.integers(0, 5000))
def test_the_next_event_is_the_first_due_step_and_near_its_time(dt, steps, start):
    interval = steps * dt
    schedule = Schedule(interval, dt)
    following = schedule.following(start)
    assert following > start
    assert schedule.due(following, following * dt)
    assert not any(schedule.due(step, step * dt) for step in range(start + 1, following))
    # Rounding to a whole step displaces an event by half a step, and never accumulates (eps for the division).
    events = following * dt / interval
    assert abs(events - round(events)) * interval <= 0.5 * dt * (1 + 1e-9) + 1e-12 * following * dt


@given(st.floats(1e-3, 1.0), st.lists(st.floats(1e-4, 0.3), min_size=1, max_size=60))
def test_with_a_varying_step_each_event_falls_on_the_first_step_at_or_after_it(interval, lengths):
    schedule, time, last = Schedule(interval, None), 0.0, 0
    assert schedule.due(0, 0.0)
    for step, length in enumerate(lengths, 1):
        time += length
        passed = math.floor(time / interval + 1e-9)
        assert schedule.due(step, time) == (passed > last)
        last = passed


def test_an_interval_below_a_step_means_every_step():
    schedule = Schedule(1e-9, 1e-3)
    assert [schedule.following(step) for step in range(3)] == [1, 2, 3]


def test_an_endless_interval_means_the_start_only():
    for dt in (1e-3, None):
        schedule = Schedule(math.inf, dt)
        assert schedule.due(0, 0.0)
        assert not schedule.due(10**6, 1e3)
    assert Schedule(math.inf, 1e-3).following(0) > 10**15


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_times_that_make_no_sense_are_named(value):
    with pytest.raises(InputError, match="duration"):
        positive("duration", value)
