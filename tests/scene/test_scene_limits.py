"""``check`` warns where the map of stability ends: just inside it is silent, just outside it says so, with a repair."""

import json
import math
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.derive import derive
from porescale.common.evidence.stability import RIGHT, Row
from porescale.coupling import limits
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.validation.coupling.arrays import SQUARE, square
from tests.reference.folders import ROOT
from tests.reference.scenes import column, grain, table, warned, water

MAP = ROOT / "docs" / "stability" / "stability.json"
SIDES = {"domain__left": {"kind": "velocity", "velocity": [0.1, 0.0]}, "domain__right": "pressure"}
H = 0.0002


def flow(viscosity: float, **changes: Any) -> Scene:
    """Water at 0.1 m/s through 60 x 40 cells of 0.2 mm."""
    return water(**{**SIDES, "fluid__body_force": None, "fluid__viscosity": viscosity, **changes})


def alone(density: float, cells: float, **changes: Any) -> Scene:
    """One grain of so many cells at rest in water."""
    one = {"density": density, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.004, 0.004, cells * H)]}
    return column(**{"grains": one, "gate": None, "gravity": [0, 0], **changes})


@pytest.mark.parametrize("lid", [False, True])
@pytest.mark.parametrize("smagorinsky", [None, 0.1])
@pytest.mark.parametrize("operator", ["trt", "mrt", "bgk", "central"])
def test_a_cell_reynolds_number_is_warned_of_where_the_operator_is_not_known_to_hold(operator, smagorinsky, lid):
    holds = limits.cell_reynolds(operator, eddies=smagorinsky is not None, lid=lid)
    more: dict[str, Any] = {"fluid__operator": operator, "fluid__smagorinsky": smagorinsky}
    more |= {"domain__top": {"kind": "wall", "speed": 0.01}} if lid else {}
    at = 0.1 * H / holds
    assert not warned(flow(1.001 * at, **more), "cell Reynolds")
    (line,) = warned(flow(0.99 * at, **more), "cell Reynolds")
    assert f"{operator!r}" in line
    assert f"is known to hold up to {holds:g}; a spacing of " in line


@pytest.mark.parametrize(("smagorinsky", "repair"), [(None, "operator = 'central'"), (0.1, "")])
def test_the_repairs_of_a_cell_reynolds_number_repair_it(smagorinsky, repair):
    scene = flow(0.1 * H / 6000 if smagorinsky else 0.1 * H / 60, fluid__smagorinsky=smagorinsky)
    (line,) = warned(scene, "cell Reynolds")
    assert line.endswith(f", or take {repair}" if repair else "keeps below it")
    spacing = float(line.partition("a spacing of ")[2].partition(" m")[0])
    finer = table(water_table(), fluid__spacing=spacing, fluid__viscosity=scene.fluid.viscosity)
    assert 0.1 * finer["fluid"]["spacing"] / scene.fluid.viscosity < limits.cell_reynolds(
        "trt", eddies=bool(smagorinsky)
    )
    if repair:
        assert not warned(flow(0.1 * H / 60, fluid__operator="central"), "cell Reynolds")


def water_table() -> dict[str, Any]:
    return table(grains=None, contact=None, gate=None)


@pytest.mark.parametrize("law", [("exact-wall", "wall"), ("odd-SC1", "B2"), ("odd-SC1", "B1")])
@pytest.mark.parametrize("cells", [3.0, 5.0, 10.0, 16.0])
def test_light_grains_are_warned_of_below_what_their_size_bears(law, cells):
    least = limits.lightest(cells, *law)
    laws = {"fluid__solid_operator": law[0], "fluid__weighting": law[1]}
    assert not warned(alone(1000 * least * 1.001, cells, **laws), "density ratio")
    (line,) = warned(alone(1000 * least * 0.999, cells, **laws), "density ratio")
    if min(limits.lightest(size, *law) for size in (5.0, 10.0, 16.0)) < least:
        finer = float(line.partition("a spacing of ")[2].partition(" m")[0])
        assert limits.lightest(cells * H / finer * 1.05, *law) < least  # two digits of the spacing
    else:
        assert "gives them" in line or line.endswith("take heavier ones")


@pytest.mark.parametrize(("law", "right"), [(("exact-wall", "wall"), 3.0), (("odd-SC1", "B2"), 10.0)])
def test_grains_of_too_few_cells_are_warned_of(law, right):
    laws = {"fluid__solid_operator": law[0], "fluid__weighting": law[1]}
    assert not warned(alone(2500, right * 1.001, **laws), "off by a tenth")
    (line,) = warned(alone(2500, right * 0.99, **laws), "off by a tenth")
    assert f"below {right:g} the drag is off by a tenth or more; a spacing of " in line


def test_a_bed_needs_more_cells_than_a_single_grain():
    # Five cells for a solid fraction up to 0.4 as the fluid sees it, 15 up to 0.6; 0.7 λ² of it here.
    loose = {"grains__packing__diameter": 0.0016, "grains__hydraulic_radius_ratio": 0.7}  # 5.6 cells, 0.34
    assert not warned(column(**loose), "off by a tenth")
    (line,) = warned(column(grains__packing__diameter=0.0016), "off by a tenth")  # 6.4 cells, 0.45
    assert line.startswith(
        "6.4 cells per diameter in a bed of solid fraction 0.45: below 15 the drag is off by a tenth"
    )
    (line,) = warned(column(grains__hydraulic_radius_ratio=1.0), "off by a tenth")
    assert "at any resolution tried" in line


@pytest.mark.parametrize("law", list(limits.BED_RIGHT))
def test_beds_are_right_where_the_map_says(law):
    rows = [Row(**row) for row in json.loads(MAP.read_text())["rows"]]
    bed = [row for row in rows if (row.flow, row.law) == ("coupling.bed", law) and row.x < 0.75]  # apart, not touching
    sizes = sorted({row.y for row in bed})

    def right_from(fraction: float) -> float:
        """Fewest cells from which on the map is right at that solid fraction."""
        wrong = [row.y for row in bed if row.x == fraction and row.verdict != RIGHT]
        return next((size for size in sizes if size > max(wrong, default=0.0)), float("inf"))

    assert sizes == [5.0, 10.0, 15.0]
    for fraction in sorted({row.x for row in bed}):
        assert limits.cells_in_bed(fraction, *law.split()) >= right_from(fraction)
    for most, cells in limits.BED_RIGHT[law]:
        assert right_from(most) == cells


def test_relaxation_times_are_right_where_the_map_says():
    rows = [Row(**row) for row in json.loads(MAP.read_text())["rows"] if row["flow"] == "lbm.shear"]
    most = SOLID_OPERATORS["exact-wall"].longest_relaxation_time
    assert all(row.verdict == RIGHT for row in rows if row.x == most - 0.5)
    assert min(row.x for row in rows if row.x > most - 0.5 and row.verdict != RIGHT) + 0.5 == 5.0
    # nu = (tau - 1/2)/3 h²/dt
    at = (most - 0.5) / 3 * H**2 / 4e-5
    assert not warned(alone(2500, 10.0, fluid__viscosity=0.999 * at), "relaxation time")
    assert "shorten the step" in warned(alone(2500, 10.0, fluid__viscosity=1.01 * at), "relaxation time")[0]


def test_resolution_is_judged_by_the_smallest_grain():
    # mean 0.8 mm, λ = 0.8, cells of 0.1 mm: 6.4 of the mean, 6.4 (1 - spread) of the smallest
    def said(spread):
        given = column(fluid__spacing=1e-4, fluid__step=1e-5, grains__packing__size_spread=spread)
        return warned(given, "of the smallest grain")

    (line,) = said(0.9)
    assert line.startswith("0.64 cells per hydraulic diameter of the smallest grain (6.4 of the mean): below 3")
    assert "a spacing of 2.1e-05 m" in line
    assert said(0.5) == []  # 3.2
    assert len(said(0.6)) == 1  # 2.6


def soft(**contact: Any) -> Scene:
    """Soft dry grains that collapse into a wide box."""
    packing = {"left": 0, "width": 0.01, "height": 0.03, "diameter": 0.001, "packing_fraction": 0.6, "settle": False}
    law = {"stiffness": 1e4, "tangential_stiffness": 5e3, "restitution": 0.5, "friction": 0.5}
    return Scene(
        domain={"width": 0.06, "height": 0.06},
        time={"end": 0.3},
        output={"snapshot_interval": 0.3, "series_interval": 0.3},
        grains={"density": 2500, "packing": packing},
        contact=law | contact,
    )


def test_the_contact_step_that_is_chosen_allows_the_speed_to_expect():
    made = derive(soft())
    assert made.contact_step is not None
    assert made.diameters is not None
    assert made.speed == pytest.approx((2 * 9.81 * 0.03) ** 0.5, rel=1e-2)
    assert made.contact_step * made.speed == pytest.approx(0.8 * 0.1 * made.diameters[0] / 2)
    assert not warned(soft(), "contact.step")
    stiff = {"stiffness": 1e6, "tangential_stiffness": 5e5}  # there contacts decide, not the speed
    assert derive(soft(**stiff)).contact_step == derive(soft(**stiff).with_({"gravity": [0, 0]})).contact_step


def test_a_contact_step_too_long_for_the_speed_to_expect_is_warned_of():
    made = derive(soft())
    assert made.contact_step is not None
    assert not warned(soft(step=1.24 * made.contact_step), "contact.step")
    (line,) = warned(soft(step=1.26 * made.contact_step), "contact.step")
    assert line.endswith(f"where a run stops; {made.contact_step:.2g} s is safe")


def array(fraction, cells, **changes):
    """A disc of a periodic square array, ``cells`` a period."""
    side = cells * H
    held = [{"x": side / 2, "y": side / 2, "diameter": 2 * side * math.sqrt(fraction / math.pi)}]
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
    return {
        "grains": None, "contact": None, "gate": None, "gravity": [0, 0], "disc": held, "fluid__body_force": [1, 0],
        "domain": {"width": side, "height": side, **sides}, **changes,
    }  # fmt: skip


@pytest.mark.parametrize(("fraction", "cells", "gap", "percent"), [(0.6, 11, "1.4", 28), (0.5, 13, "2.6", 5)])
def test_narrow_gaps_between_held_discs_are_said_with_what_the_drag_is_off(fraction, cells, gap, percent):
    (line,) = warned(column(**array(fraction, cells)), "apart")
    assert line.startswith(f"held discs stand {gap} cells apart")
    assert f" {percent} % too small" in line
    assert "'narrow-wall', mends it" in line
    # What is said is what is: the worst of these relaxation times, as the mean over places (its digits are printed).
    worst = max(1 - square((fraction,), (tau,), np.inf, count=2).measured[0] / SQUARE[fraction] for tau in (0.55, 1.0))
    assert 100 * worst == pytest.approx(percent, abs=0.1 * percent)
    # The twins: with the operator for them, and with the wider gaps of a looser array, nothing is said.
    assert not warned(column(**array(fraction, cells, fluid__solid_operator="narrow-wall")), "apart")
    assert not warned(column(**array(0.3, 16)), "apart")


def test_a_narrower_gap_than_was_measured_is_at_least_as_far_off_and_touching_discs_have_none():
    (line,) = warned(column(**array(0.7, 11)), "apart")
    assert "at least 28 %" in line
    assert not warned(column(**array(math.pi / 4, 11)), "apart")
