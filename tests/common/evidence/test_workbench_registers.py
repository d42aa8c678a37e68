"""Reports, validations, benchmarks and timing."""

import json
import math
import sys
from dataclasses import asdict
from io import StringIO

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from porescale.common.api.report import Report
from porescale.common.core.errors import InputError
from porescale.common.evidence import benchmarks, validations
from porescale.common.evidence.bandwidth import Copy, flip, flip_nine
from porescale.common.evidence.benchmarks import Benchmark, Benchmarks, Work
from porescale.common.evidence.register import choose, discovered
from porescale.common.evidence.timing import interleaved, repeated, seconds_of
from porescale.common.evidence.validations import Measured, Validations


def printed(thing) -> str:
    """What a wide terminal shows."""
    out = StringIO()
    Console(file=out, width=250).print(thing)
    return out.getvalue()


def test_a_report_keeps_order_and_says_everything() -> None:
    report = Report("column")
    report.row("loose", True)
    report.heading("fluid")
    report.row("τ", 0.8, "", "0.5 to 1")
    report.heading("grains")
    report.row("count", 7)
    report.heading("fluid")  # going on with it
    report.row("spacing", 0.0003, "m")
    report.warn("[red]Mach 0.2 is high")
    table = report.as_dict()
    assert json.loads(json.dumps(table)) == table
    assert list(table["groups"]) == ["", "grains", "fluid"]
    assert table["groups"]["fluid"][0] == {"name": "τ", "value": 0.8, "unit": "", "note": "0.5 to 1"}
    out = StringIO()
    report.show(Console(file=out, width=100))
    words = ("column", "fluid", "τ", "0.8", "0.5 to 1", "count", "7", "0.0003", "yes", "[red]Mach 0.2")
    assert all(word in out.getvalue() for word in words)


def register() -> Validations:
    """One of each kind."""
    made = Validations()
    hertz = {"source": "Hertz", "because": "two digits"}
    good = Measured(np.array([1.0, 2.0]), [1.0, 2.1], np.float64(0.05))
    made.row("lbm.good", source="Poiseuille", because="second order", tolerance=0.1)(lambda: good)
    made.row("lbm.edge", source="exact", because="round-off", tolerance=0.0)(lambda: Measured(1.0, 1.0, 0.0))
    made.row("dem.off", tolerance=0.1, slow=True, **hertz)(lambda: Measured(1.0, 2.0, 1.0))

    @made.row("dem.broken", tolerance=0.1, **hertz)
    def _() -> Measured:
        raise ZeroDivisionError("no\ngrains")

    made.row("dem.nan", tolerance=math.inf, **hertz)(lambda: Measured(1.0, math.nan, math.nan))
    made.row("dem.negative", tolerance=0.1, **hertz)(lambda: Measured(1.0, 0.0, -1.0))
    return made


def test_a_validation_passes_only_within_its_tolerance() -> None:
    rows = {row.name: row for row in register().run(slow=True)}
    assert {name for name, row in rows.items() if row.passed} == {"lbm.good", "lbm.edge"}
    assert "ZeroDivisionError: no grains" in rows["dem.broken"].because
    assert rows["lbm.good"].because == "second order"
    assert "distance" in rows["dem.negative"].because  # a signed error would pass any tolerance


def test_rows_have_exactly_the_promised_keys_and_valid_json() -> None:
    keys = ["name", "source", "reference", "measured", "error", "tolerance", "because", "seconds", "passed"]
    for row in register().run(slow=True):
        assert list(row.as_dict()) == keys
        json.dumps(row.as_dict(), allow_nan=False)
    assert register()["lbm.good"].run().as_dict()["reference"] == [1.0, 2.0]
    assert register()["dem.nan"].run().as_dict()["measured"] is None


def test_slow_rows_run_by_name_or_on_demand() -> None:
    made = register()
    assert "dem.off" not in [item.name for item in made.chosen()]
    assert "dem.off" not in [item.name for item in made.chosen(["dem"])]
    assert [item.name for item in made.chosen(["dem.off"])] == ["dem.off"]
    assert [item.name for item in made.chosen(slow=True)] == [item.name for item in made]


def test_unknown_names_suggest_the_nearest() -> None:
    with pytest.raises(InputError, match=r"no such validation; did you mean 'lbm\.good'"):
        register().run(["lbm.god"])
    with pytest.raises(InputError, match="did you mean 'dem'"):
        register().run(["den"])
    with pytest.raises(InputError, match="no such benchmark"):
        Benchmarks().run(["lbm"])


def test_registers_join_and_refuse_twins_and_rows_without_a_reason() -> None:
    joined, other = Validations(), register()
    joined.include(other)
    assert len(list(joined)) == len(list(other))
    with pytest.raises(AssertionError):
        joined.include(other)
    with pytest.raises(AssertionError):
        joined.row("lbm.good", source="x", because="y", tolerance=0)(lambda: Measured(1.0, 1.0, 0.0))
    with pytest.raises(AssertionError):
        Validations().row("a", source="x", because="", tolerance=0)


FILE = """
from porescale.common.evidence.benchmarks import Benchmarks, Work
BENCHMARKS = Benchmarks()

@BENCHMARKS.row("NAME")
def _(size, threads, dtype):
    return Work(lambda: None, 1.0, "toys/s", 1)
"""


def test_a_file_in_the_folder_adds_its_rows(tmp_path, monkeypatch):
    folder = tmp_path / "rates_of_toys" / "more"
    folder.mkdir(parents=True)
    for place, name in ((folder, "late"), (folder.parent, "early")):
        (place / "__init__.py").write_text("")
        (place / f"{name}.py").write_text(FILE.replace("NAME", name))
    (folder / "helper.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    joined = discovered("rates_of_toys", "BENCHMARKS")
    assert isinstance(joined(), Benchmarks)
    assert [row.name for row in joined()] == ["early", "late"]
    (folder / "helper.py").write_text(FILE.replace("NAME", "late"))  # a second row of that name
    monkeypatch.delitem(sys.modules, "rates_of_toys.more.helper")
    with pytest.raises(AssertionError, match="two rows named late"):
        joined()


def test_validation_table_shows_verdicts() -> None:
    text = printed(validations.table(register().run(slow=True)))
    assert text.count("FAIL") == 4
    assert "second order" in text


NAMES = st.lists(st.sampled_from(["a", "a.b", "a.c", "b", "b.a", "ab"]), unique=True)


@given(NAMES, st.data())
def test_choosing_keeps_the_order_and_takes_whole_rooms(known: list[str], data) -> None:
    asked = data.draw(st.lists(st.sampled_from(known), unique=True)) if known else []
    found = choose(asked, known, "row")
    assert found == [name for name in known if name in found]
    assert set(asked) <= set(found)
    assert all(not asked or any(name == it or name.startswith(it + ".") for it in asked) for name in found)


class Clock:
    """A clock that only moves when work is done: the laws below then hold exactly."""

    now = 0.0

    def work(self, seconds: float):
        def call() -> None:
            self.now += seconds

        return call


@pytest.fixture
def clock(monkeypatch) -> Clock:
    made = Clock()
    monkeypatch.setattr("porescale.common.evidence.timing.time.perf_counter", lambda: made.now)
    return made


def test_calls_are_repeated_for_a_while_and_a_few_times_at_least(clock: Clock) -> None:
    assert repeated(lambda: seconds_of(clock.work(0.25)), 2.0) == [0.25] * 8
    assert repeated(lambda: seconds_of(clock.work(4.0)), 2.0) == [4.0] * 5  # a median needs a few


def test_one_disturbed_call_does_not_change_a_rate(clock: Clock) -> None:
    lengths = iter([9.0, 1.0, 1.0, 50.0, 1.0, 1.0])  # the first is the warm-up
    made = Benchmarks([Benchmark("a", lambda *_: Work(lambda: clock.work(next(lengths))(), 10.0, "toys/s", 1))])
    (row,) = made.run(threads=1, min_seconds=0.0)
    assert (row.rate, row.seconds) == (10.0, 1.0)


def test_what_is_compared_is_timed_in_turns(clock: Clock) -> None:
    order: list[str] = []

    def timed(name: str, seconds: float):
        return lambda: (order.append(name), clock.work(seconds)())

    ratio = interleaved(timed("a", 0.5), timed("b", 1.5), rounds=4)
    assert "".join(order) == "ab" + "abbaabba"  # after one each to warm up
    assert ratio == 3.0


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_the_copy_kernel_touches_every_number_in_place(dtype: str, compiled: bool) -> None:
    values = np.arange(12, dtype=dtype).reshape(3, 4)
    (flip if compiled else flip.py_func)(values, values.dtype.type(1))
    assert values.dtype == dtype
    np.testing.assert_array_equal(values, 1 - np.arange(12).reshape(3, 4))


@pytest.mark.parametrize("compiled", [True, False])
def test_the_copy_in_nine_streams_touches_every_number_in_place(compiled: bool) -> None:
    values = np.arange(9 * 2 * 3, dtype=float).reshape(9, 2, 3)
    (flip_nine if compiled else flip_nine.py_func)(values, 1.0)
    np.testing.assert_array_equal(values, 1 - np.arange(9 * 2 * 3).reshape(9, 2, 3))


def test_no_share_of_the_bandwidth_exceeds_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Work that copies nothing and claims a terabyte: faster than any copy, it is its own ceiling."""
    made = Benchmarks([Benchmark("much", lambda *_: Work(lambda: None, 1.0, "cells/s", 3, 1e12, memory=2**16))])
    (row,) = made.run(threads=1, min_seconds=0.0)
    assert row.share_of_bandwidth is not None
    assert 0 < row.share_of_bandwidth <= 1


def test_bandwidth_counts_read_and_write() -> None:
    copy = Copy(1, "float32", 2**16)
    assert copy.bytes == 2 * copy.values.nbytes
    assert 2**16 - 9 * 64 * 16 * 4 < copy.values.nbytes <= 2**16  # parts of whole lines
    copy.seconds()
    assert (copy.values == 0.25).all()  # once in each form


def test_a_benchmark_is_held_against_its_plain_work_in_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    works = [
        Work(lambda: None, 30.0, "cells/s", 3),
        Work(lambda: None, 20.0, "cells/s", 3, variant="plain", yardstick=True),
    ]
    made = Benchmarks([Benchmark("wet", lambda *_: works)])
    # A call of the plain work takes a quarter of the other's time, for two thirds of its updates.
    monkeypatch.setattr(benchmarks, "interleaved", lambda a, b: 0.25)
    assert [row.name for row in made.run(threads=1, min_seconds=0.0)] == ["wet", "wet.plain"]
    assert made.remarks == ["wet: 0.38 of the rate of wet.plain, in turns"]


def test_benchmark_rows_have_exactly_the_promised_keys() -> None:
    made = Benchmarks([Benchmark("plain", lambda size, *_: Work(lambda: None, 10.0, "discs/s", size or 3))])

    @made.row("streams")
    def _(size: int | None, threads: int, dtype: str) -> list[Work]:
        copy = Copy(threads, dtype)
        return [Work(copy.seconds, copy.values.size, "cells/s", copy.values.size, 2 * copy.values.itemsize, "all")]

    rows = list(made.run(threads=1, dtype="float32", min_seconds=0.0))
    keys = ["name", "size", "threads", "dtype", "rate", "unit", "seconds", "bytes", "share_of_bandwidth", "device"]
    assert all(list(asdict(row)) == keys for row in rows)
    plain, streams = rows
    assert (plain.name, plain.size, plain.threads, plain.dtype) == ("plain", 3, 1, "float32")
    assert plain.share_of_bandwidth is None
    assert plain.rate == 10.0 / plain.seconds
    assert streams.name == "streams.all"
    assert 0 < streams.share_of_bandwidth <= 1
    assert "streams.all" in printed(benchmarks.table(rows))
    assert made.remarks == []
    with pytest.raises(InputError, match="--size = 0"):
        made.run(size=0)
