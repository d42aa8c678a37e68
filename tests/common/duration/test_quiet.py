"""Seconds of a quiet machine: clocks of spans that shared their core with others, and how busy a machine is."""

import os
import threading

import pytest

from porescale.common.duration import quiet
from porescale.common.duration.quiet import Moment, load_now, moment, quiet_seconds, share


@pytest.mark.parametrize(
    ("wall", "on", "waited", "seconds"),
    [
        (10.0, 10.0, 0.0, 10.0),  # alone
        (40.0, 10.0, 30.0, 10.0),  # one of four on its core
        (40.0, 10.0, 10.0, 20.0),  # half of a core; half of what it waits for besides is the load of others, too
        (10.0, 0.0, 0.0, 10.0),  # never on a core that the system counted: nothing is known of the load
    ],
)
def test_the_load_is_taken_out(wall, on, waited, seconds):
    since = Moment(5.0, 2.0, 1.0)
    assert quiet_seconds(since, Moment(5.0 + wall, 2.0 + on, 1.0 + waited)) == pytest.approx(seconds, rel=1e-12)


def test_compiling_is_no_part_of_it():
    # 8 of 20 s compiled; a third of a core: 12 s of the rest are 4 s.
    assert quiet_seconds(Moment(0.0, 0.0, 0.0, 1.0), Moment(20.0, 5.0, 10.0, 9.0)) == pytest.approx(4.0, rel=1e-12)


def test_what_the_system_counts_is_read_and_what_it_does_not_count_is_the_wall_clock(tmp_path, monkeypatch):
    file = tmp_path / "schedstat"
    monkeypatch.setattr(quiet, "SCHEDSTAT", file)
    one = moment()
    assert share(one, moment()) == 1.0
    file.write_text("3000000000 1500000000 77\n")
    assert quiet.scheduled() == pytest.approx((3.0, 1.5), rel=1e-12)
    file.write_text("spoiled")
    assert quiet.scheduled() == (1.0, 0.0)


def test_a_thread_counts_for_itself():
    seen = []

    def other():
        seen.append(quiet.scheduled())

    sum(range(100_000))
    thread = threading.Thread(target=other)
    thread.start()
    thread.join()
    assert seen[0][0] < quiet.scheduled()[0]  # the twin: this one has been at work for longer


def test_a_busy_machine_is_one_on_which_others_want_its_cores(monkeypatch):
    monkeypatch.setattr(quiet, "cores", lambda: 2)
    for load, factor in ((0.0, 1.0), (1.0, 1.0), (3.0, 2.0), (5.0, 3.0)):
        monkeypatch.setattr(os, "getloadavg", lambda load=load: (load, 9.0, 9.0), raising=False)
        assert load_now() == factor
    monkeypatch.delattr(os, "getloadavg")
    assert load_now() == 1.0
