"""The map of stability, the limits drawn from it, and what is said of a run that went beyond sense."""

import json
import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from porescale.benchmarks import stability_psm as stability
from porescale.builders.checks.limits import SOUND_WARN
from porescale.common.core.errors import Unstable
from porescale.common.evidence.stability import STABLE, UNSTABLE, Row, holds_up_to
from porescale.coupling import limits, step
from porescale.coupling.divergence_cause import Circumstances, likely_cause
from porescale.coupling.divergence_check import DivergenceCheck, worst_cell
from porescale.coupling.immersed import LAYER
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import fitting_weights
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.validation.coupling.setups import immersed
from tests.reference.folders import ROOT

MAP = ROOT / "docs" / "stability" / "stability.json"
CALM = Circumstances("trt", False, 0.8, 0.01, 0.01, "odd-SC1", "B2", 2.5, 16.0)


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    return [Row(**row) for row in json.loads(MAP.read_text())["rows"]]


def test_every_pair_of_solid_operator_and_weight_is_in_the_map(rows):
    laws = stability.variants(False)
    tried = set(SOLID_OPERATORS)
    assert {law["solid_operator"] for law in laws.values()} == tried
    assert {law["weighting"] for law in laws.values()} == {it for name in tried for it in fitting_weights(name)}
    assert {row.law for row in rows if row.flow.startswith("coupling.")} == set(laws)


@pytest.mark.parametrize("lid", [False, True])
@pytest.mark.parametrize("eddies", [False, True])
@pytest.mark.parametrize("operator", list(limits.IN_THE_OPEN))
def test_limits_of_the_cell_reynolds_number_are_those_of_the_map(rows, operator, eddies, lid):
    law = ("trt 3/16" if operator == "trt" else operator) + (" + eddies" if eddies else "")
    flow = "lbm.cavity" if lid else "lbm.shear"
    found, _ = holds_up_to([it for it in rows if (it.flow, it.law) == (flow, law)], "cell Reynolds number")
    limit = limits.cell_reynolds(operator, eddies=eddies, lid=lid)
    assert 0.95 * found < limit <= found  # rounded down to two digits, which is 5 % at most from 20 on


def test_an_operator_that_was_not_tried_gets_the_least_limit():
    assert limits.cell_reynolds("new", eddies=False) == min(limits.IN_THE_OPEN.values())


@pytest.mark.parametrize("law", list(limits.LIGHTEST))
def test_light_discs_hold_from_the_density_ratio_of_the_map_on(rows, law):
    fall = [row for row in rows if (row.flow, row.law) == ("coupling.fall", law)]
    # Shot at 10 cells: below tau - 1/2 of 0.005 speed is the matter, not weight.
    shot = [row for row in rows if (row.flow, row.law) == ("coupling.fly", law) and row.x >= 0.005]
    failed = {(row.y, row.x) for row in fall if row.verdict == UNSTABLE}
    failed |= {(10.0, row.y) for row in shot if row.verdict == UNSTABLE}
    for cells in {row.y for row in fall}:
        least = limits.lightest(cells, *law.split())
        ratios = {row.x for row in fall if row.y == cells}
        assert not {x for x in ratios if x >= least and (cells, x) in failed}
        lighter = [x for x in ratios if x < least]
        # An array in little viscosity, which the map does not have, asks for more where cells turn populations back.
        assert not lighter or (cells, max(lighter)) in failed or law.split()[0] in limits.TURNING_BACK
    right = {row.y for row in fall if all(it.verdict != STABLE for it in fall if it.y == row.y)}
    assert min(right) == limits.CELLS_RIGHT[law]


def test_check_warns_of_swings_from_where_the_map_is_no_longer_right(rows):
    swung = [row for row in rows if (row.flow, row.law) == ("coupling.sound", "exact-wall wall")]
    wrong = {row.x for row in swung if row.verdict == STABLE}
    assert max(row.x for row in swung if row.x < min(wrong)) == SOUND_WARN
    # The check that must fail: B1, whose walls stand up to half a cell in the fluid, is right at none of them.
    assert all(row.error > 0.05 for row in rows if row.flow == "coupling.sound" and "B1" in row.law and row.x <= 1)


def test_light_discs_between_the_sizes_of_the_map_count_as_the_smaller():
    assert limits.lightest(12.0, "odd-SC1", "B2") == 0.2
    assert limits.lightest(2.0) == 1.0
    turned = [law for law in limits.LIGHTEST if law.split()[0] in limits.TURNING_BACK]
    others = [law for law in limits.LIGHTEST if law not in turned]
    assert limits.lightest(10.0, "SC9", "B9") == max(limits.lightest(10.0, *law.split()) for law in others)
    assert [limits.lightest(10.0, *law.split()) for law in turned] == [limits.LIGHT]


def test_free_discs_in_beds_that_do_not_overlap_hold_with_every_solid_operator(rows):
    bed = [row for row in rows if row.flow == "coupling.bed" and row.x <= stability.TOUCHING]
    assert {row.law.split()[0] for row in bed} == set(SOLID_OPERATORS)
    assert not [row for row in bed if row.verdict == UNSTABLE]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({}, "none that is known of"),
        ({"relaxation_time": 0.5001}, "near 1/2"),
        ({"relaxation_time": 0.5001, "operator": "central"}, "none that is known of"),
        ({"speed": 0.3, "relaxation_time": 1.0}, "too fast for the lattice, Mach 0.52"),
        ({"density_change": 0.45}, "too much for the sound speed"),
        ({"density_ratio": 0.05}, "density ratio 0.05 at 16 cells"),
        ({"density_ratio": 0.15, "cells_per_diameter": 10.0}, "density ratio 0.15 at 10 cells"),
        (
            {"density_ratio": 0.15, "cells_per_diameter": 10.0, "relaxation_time": 0.5001},
            "density ratio 0.15 at 10 cells",
        ),
        ({"density_change": 0.45, "relaxation_time": 0.5001}, "near 1/2"),  # 300 times beyond against 1.5
    ],
)
def test_the_cause_is_what_is_furthest_beyond_what_holds(change, said):
    assert said in likely_cause(replace(CALM, **change))


def sense(**more) -> DivergenceCheck:
    coupled = immersed((20, 16), [(10.0, 8.0)], 3.0, 2.5)
    laws = {"operator": "trt", "eddies": False, "solid_operator": "odd-SC1", **more}
    return DivergenceCheck(coupled.fluid, coupled.scales, coupled, **laws)


def test_the_cell_in_which_it_began_is_named():
    watch = sense()
    watch.check(0, 0.0)
    watch.fluid.populations[0, 1 + 4, 1 + 7] = np.nan
    with pytest.raises(Unstable, match=r"at cell \(7, 4\) at \(7.5, 4.5\) m; likely cause") as caught:
        watch.check(3, 3.0)
    assert (caught.value.quantity, caught.value.step) == ("relative density change", 3)
    for _ in range(5):  # it spreads on all sides
        watch.fluid.advance()
    with pytest.raises(Unstable, match=r"at cell \(7, 4\) "):
        watch.check(8, 8.0)


def test_what_has_a_number_is_named_by_the_largest():
    values = np.zeros((4, 6))
    values[2, 5] = 3.0
    assert worst_cell(values) == (2, 5)
    values[1, 1] = math.inf
    assert worst_cell(values) == (1, 1)


def test_a_density_without_end_is_named_without_a_warning_of_numpy():
    watch = sense()
    watch.fluid.populations[1, 5, 8] = math.inf  # of the cell (7, 4)
    with pytest.warns(RuntimeWarning, match="invalid value"):  # as its velocity is reckoned: inf/inf
        watch.fluid.fields()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(Unstable, match=r"at cell \(7, 4\) "):
            watch.check(3, 3.0)


def test_a_disc_that_is_nowhere_hides_no_fault_of_the_fluid():
    watch = sense()
    assert watch.coupled
    watch.coupled.grains.discs.position[:] = np.nan
    watch.coupled.grains.discs.velocity[:] = np.inf
    watch.check(0, 0.0)  # the fluid is well, and the speed of nothing does not count
    assert watch.last.speed == 0.0
    watch.fluid.populations[1, 5, 5] = 2.0
    with pytest.raises(Unstable, match="cell"):
        watch.check(1, 1.0)


@pytest.mark.parametrize("where", [np.nan, np.inf, -np.inf, 1e30, -1e30, 1e15])
@pytest.mark.parametrize("kind", ["wall", "periodic"])
def test_a_disc_that_is_nowhere_is_no_crash(where, kind):
    fluid = Fluid(20, 16, 0.8, sides=Sides(kind, kind, kind, kind))
    wet = SaturatedCells(fluid, np.array([3.0, 3.0, 3.0]))
    place = np.array([[5.0, 5.0], [where, where], [12.0, 8.0]])
    for _ in range(4):
        wet.advance(fluid, place, np.zeros((3, 2)), np.zeros(3))
    assert np.isfinite(fluid.populations[:, 1:-1, 1:-1]).all() or kind == "periodic"


def test_the_lightest_free_disc_counts():
    assert sense().last.density_ratio == pytest.approx(2.5)
    coupled = immersed((30, 16), [(8.0, 8.0), (22.0, 8.0)], [3.0, 2.0], [2.5, 0.3])
    coupled.grains.hold(1)
    watch = DivergenceCheck(coupled.fluid, coupled.scales, coupled, operator="trt", eddies=False, solid_operator="SC1")
    assert (watch.last.density_ratio, watch.last.cells_per_diameter) == (pytest.approx(2.5), 6.0)
    coupled.grains.hold(0)
    watch = DivergenceCheck(coupled.fluid, coupled.scales, coupled, operator="trt", eddies=False, solid_operator="SC1")
    assert watch.last.density_ratio is None


def test_noise_is_what_repeats_with_every_cell():
    phase = (np.arange(3000) * 0.01) % 1
    drag = 2.0 + 0.1 * np.sin(2 * np.pi * phase) + 0.3 * np.sin(0.0123 * np.arange(3000))
    # Four bins of a sine of 0.1: means 0.2/pi each, rms 0.0637, over the mean 2; the slow wave leaks what its mean over
    # a cell leaves, its square/24 (0.0123 * 100)² = 6 % of 0.3, thinned by averaging over 20 cells.
    assert stability.cell_noise(drag, phase, 100) == pytest.approx(0.1 * 2 / np.pi / 2, rel=0.1)
    assert stability.cell_noise(drag - 0.1 * np.sin(2 * np.pi * phase), phase, 100) < 0.01


def test_known_drags_of_beds_grow_with_the_solid_fraction():
    drags = [stability.known_drag(c) for c in (*stability.ARRAY_DRAG, 0.7, 0.78)]
    assert drags == sorted(drags)


def spun(radius: float, relaxation_time: float) -> float:
    """Largest spin after 100 steps, over that at first, of sixteen free discs that lie anywhere in cells."""
    rows = np.arange(4) * 6.0 + 4.0
    places = np.stack(np.meshgrid(rows, rows), axis=-1).reshape(-1, 2)
    places += np.random.default_rng(3).uniform(0.0, 1.0, places.shape)
    coupled = immersed((28, 28), places, np.full(16, radius), np.full(16, 2.5), spin=np.full(16, 0.01),
                       relaxation_time=relaxation_time, sides=("periodic", "periodic"))  # fmt: skip
    for _ in range(100):
        coupled.advance()
    return float(np.abs(coupled.grains.discs.spin).max()) / 0.01


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.5])
@pytest.mark.parametrize("relaxation_time", [0.51, 0.6, 1.0])
def test_discs_smaller_than_a_cell_do_not_spin_up(radius, relaxation_time):
    # Fluid at rest drags them: no spin is more than it was, but for what one of another stirs up, less than as much.
    assert spun(radius, relaxation_time) < 2.0


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_they_do_where_the_fluid_that_answers_has_their_own_moment_of_inertia(monkeypatch):  # the twin that must fail
    def own(grains, inside, spacing, seen, least):
        thick = np.maximum(LAYER * spacing * inside.thinness[seen], least)
        mass = grains.discs.mass / inside.mass
        inertia = grains.discs.inertia / inside.inertia
        return np.minimum(1.0, np.column_stack((mass, inertia))[seen] / thick[:, None])

    monkeypatch.setattr(step, "response_share", own)
    with pytest.raises(Unstable):
        spun(0.2, 1.0)
