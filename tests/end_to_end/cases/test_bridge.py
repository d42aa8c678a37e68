"""The case from grains to the continuum: how both scales are compared, and the command that does it."""

import json
import math
from types import ModuleType

import numpy as np
import pytest
from scipy import stats

from porescale.output.case import expected
from tests.reference.folders import CASES, script

SETTLED = np.array([1.0, 1.1, 0.9, 1.05, 0.95, 1.0, 1.02, 0.98])
"""Eight packings, of mean 1."""


@pytest.fixture(scope="module")
def case() -> ModuleType:
    """The case's script as a module."""
    return script("micro_to_macro")


def compared(case: ModuleType, soil: list[float], grains=SETTLED, given=0.0):
    """A quantity of soil of 10, 20 and 40 rows beside that of grains."""
    return case.Compared("way", "m", np.asarray(grains), (10, 20, 40), np.array(soil), given)


def test_a_difference_is_inside_the_bars_where_packings_material_and_spacing_leave_it_open(case):
    own = float(stats.t.interval(0.95, 7, scale=stats.sem(SETTLED))[1])
    assert compared(case, [1.0, 1.0, 1.0]).bar == pytest.approx(own)
    assert compared(case, [1.0, 1.0, 1.0 + 0.9 * own]).spacing == pytest.approx(
        0.9 * own
    )  # twice as fine: half is left
    assert compared(case, [9.0, 1.0 + 0.9 * own, 1.0 + 0.9 * own]).inside
    assert compared(case, [1.0, 1.2, 1.2], given=0.2).inside
    # checks that must fail: a difference beyond the bar, and one of so few packings that there is none
    assert not compared(case, [9.0, 1.0 + 1.1 * own, 1.0 + 1.1 * own]).inside
    assert not compared(case, [1.0, 1.0, 1.0], grains=[1.0, 1.0]).inside
    assert math.isnan(compared(case, [1.0, 1.0, 1.0], grains=[1.0, 1.0]).bar)


def test_an_error_of_first_order_is_what_the_spacing_is_said_to_leave(case):
    soil = [1.0 + 0.4 * 10 / rows for rows in (10, 20, 40)]
    assert compared(case, soil).spacing == pytest.approx(soil[-1] - 1.0)
    second = [1.0 + 0.4 * (10 / rows) ** 2 for rows in (10, 20, 40)]  # the twin: of second order too much is said
    assert compared(case, second).spacing == pytest.approx(3.0 * (second[-1] - 1.0))


def test_k_follows_the_porosity_as_its_packings_say_and_the_interval_holds_it(case):
    rng = np.random.default_rng(1)
    n, at, held = np.linspace(0.19, 0.20, 6), np.array([0.18]), 0
    for _ in range(1000):
        k, half = case.power(n, 4e-9 * np.exp(4.0 * (n - 0.19) + rng.normal(0.0, 0.01, 6)), at)
        held += abs(math.log(k[0] / (4e-9 * math.exp(-0.04)))) <= half
    # of 1000 intervals at 95 % that hold the truth: 950, with a deviation of 7
    assert abs(held - 950) < 4 * 7
    off = case.power(n, 4e-9 * np.exp(4.0 * (n - 0.19)), at)[0][0] / 4e-9  # the twin: k is not that of its specimens
    assert off == pytest.approx(math.exp(-0.04)) != pytest.approx(1.0, abs=0.01)


def test_the_front_is_where_the_mass_says_and_a_single_grain_does_not_move_it(case):
    x = np.linspace(0.0, 1.0, 1001)
    fall = case.Fall(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.column_stack((x, x)), np.ones(1001))
    assert fall.front() == pytest.approx(0.95, abs=1e-3)  # a body's own share: 1/1001
    assert fall.when(0.25) == pytest.approx(0.25)
    assert math.isnan(fall.when(2.0))
    far = np.where(x < 1.0, x, 50.0)
    rolled = case.Fall(fall.times, fall.centre, np.column_stack((far, x)), fall.mass)
    assert rolled.front() == pytest.approx(fall.front(), abs=1e-9)
    assert far.mean() - x.mean() > 0.04  # the twin: the centre of mass does move


def test_the_command_compares_and_writes_its_table_on_a_tiny_set_up(case):
    numbers, figure, lines = case.measure(0, 3, (3, 6), 0.05)
    assert numbers["flow through grains over Darcy's"] is None
    assert numbers["mass of the column of soil over that of grains"] == pytest.approx(1.0, abs=0.03)
    assert len(lines) == 2 + 2 * len(case.SEEN)
    assert all(line.count("|") == len(case.HEAD) + 1 for line in lines)
    assert len(figure.axes) == 9
    # too short to go a centimetre: no time, and so no agreement
    late = [line for line in lines if line.startswith("| time")]
    assert late
    assert all(line.endswith("| no |") for line in late)


def test_the_record_holds_the_front_with_friction_that_grows_which_soil_without_goes_beyond():
    folder = CASES / "micro_to_macro"
    numbers = json.loads((folder / "recorded.json").read_text(encoding="utf-8"))["numbers"]
    name = "front of soil that grows with the rate over that of grains"
    (row,) = [it for it in expected(folder) if it["name"] == name]
    assert abs(numbers[name] - row["value"]) < row["tolerance"]
    slow = numbers["front of fallen soil"] / numbers["front of fallen grains"]
    assert slow - row["value"] > 2 * row["tolerance"]  # the check that must fail
