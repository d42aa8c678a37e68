"""Numbers of a lattice that disagree and numbers beyond sense: what is said of them."""

from typing import Any

import pytest

from porescale import Scene, load
from porescale.builders import cost
from porescale.builders.build import build
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate
from tests.reference.folders import ROOT
from tests.reference.scenes import column, dry, refusals, table

TABLE1 = {"spacing": 1e-5, "relaxation_time": 0.8, "viscosity": 1e-4, "step": 1e-6}


def lines(**changes: Any) -> list[str]:
    """What the sections of the small column with changes, or what follows from them, are refused for."""
    return refusals(lambda: report(column(**changes)))


def test_each_repair_of_table_1_says_what_it_makes_of_the_box():
    with pytest.raises(InputError) as caught:
        load(ROOT / "cases" / "column_collapse_table1")
    said = {fault.key: fault.repair for fault in caught.value.faults}
    # 0.12 m over 1e-5 m, and over sqrt(3 nu dt/(tau - 1/2)) = 3.1623e-5 m.
    assert said["fluid.spacing"].startswith(
        "leave spacing out, or give 3.16228e-05 (3794.73 cells over domain.width, not a whole number); "
    )
    for name in ("step", "relaxation_time", "viscosity"):
        assert said[f"fluid.{name}"].endswith("(12000 cells over domain.width)")
    # The power of ten next to 3.16e-5 that is not the one printed: dt = (tau - 1/2)/3 h^2/nu = 0.1 * 1e-8/1e-4.
    assert said["fluid.spacing"].endswith(
        "a round spacing that divides the box is 0.0001 m (1200 cells over domain.width), with a step of 1e-05 s"
    )
    read = {"spacing": 1e-4, "step": 1e-5, "relaxation_time": 0.8, "viscosity": 1e-4}
    assert validate(Scene, table(grains=None, contact=None, gate=None, fluid=read)).fluid is not None


def test_numbers_that_disagree_are_said_beside_other_faults():
    said = lines(fluid=TABLE1, time__end=-1.0)
    assert len(said) == 5
    said = lines(fluid=TABLE1, domain__width=-1.0)  # without a box no word of its cells
    assert len(said) == 5
    assert not [line for line in said if "domain.width" in line and line.startswith("fluid")]


def test_a_round_spacing_is_named_only_where_one_divides_the_box():
    said = lines(fluid=TABLE1, domain__width=0.0123456789)
    assert not [line for line in said if "a round spacing" in line]


@pytest.mark.parametrize(
    ("key", "value", "allowed"),
    [
        ("fluid__spacing", 1e-10, ">= 1e-09 and <= 1000 m"),
        ("fluid__step", 1e4, ">= 1e-12 and <= 1000 s"),
        ("fluid__density", 1e6, ">= 0.001 and <= 100000 kg/m^3"),
        ("fluid__viscosity", 1e-13, ">= 1e-12 and <= 1000 m^2/s"),
        ("grains__packing__diameter", 1e-10, ">= 1e-09 and <= 1000 m"),
        ("contact__stiffness", 1e16, ">= 1e-06 and <= 1e+15 N/m"),
        ("time__end", 1e10, ">= 1e-12 and <= 1e+09 s"),
    ],
)
def test_a_slip_of_the_exponent_is_out_of_range(key, value, allowed):
    (line,) = lines(**{key: value})
    assert line.startswith(f"{key.replace('__', '.')} = {value}")
    assert f"(allowed: {allowed})" in line


def test_a_run_of_more_than_a_week_is_warned_of(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))  # no run of this machine is known
    # A step takes at least COUPLED_CALLS = 45 us: a week is no more than 7 * 86400/45e-6 = 1.3e10 steps of 4e-5 s.
    long = column(time__end=6e5, output__snapshot_interval=6e3, output__series_interval=6e2)
    assert [it for it in report(long).warnings if "more than a week" in it]
    assert not [it for it in report(column()).warnings if "week" in it]


def test_more_grains_than_the_memory_holds_are_refused_without_fluid_too(monkeypatch):
    monkeypatch.setattr(cost, "ALWAYS", 0.0)
    monkeypatch.setattr(cost, "memory_bytes", lambda: 10**4)  # 31 grains take 400 each
    assert refusals(lambda: build(dry()))[0].startswith("grains: ")


def test_contacts_that_take_a_million_steps_of_a_step_are_refused():
    said = lines(contact__stiffness=1e15, fluid__step=1e-1, fluid__viscosity=8e-9)  # and it is far too fast
    (line,) = [it for it in said if it.startswith("contact.stiffness = 1000000000000000.0 N/m: takes ")]
    assert "contact steps of" in line
