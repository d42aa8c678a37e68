"""Columns in which water rises, sinks and drains."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.unsaturated.richards import (
    CONTENT,
    FROM_WATER,
    PRESSURE,
    TO_AIR,
    Y,
    flow_rates,
    pair_weights,
    update_state,
)
from continuum_sph.validation.unsaturated import columns
from continuum_sph.validation.unsaturated.columns import COLUMNS, DRAINING, RISING, SINKING, Soaking, error, held
from porescale.common.compiled.jit import set_threads
from porescale.common.core.constants import GRAVITY

COARSE = replace(RISING, rows=10)
FULL = Soaking(rows=8, dry=0.0, below=0.2, above=0.9)  # water passes it downwards


def test_water_at_rest_under_its_fringe_stays():
    run = Soaking(rows=10, below=0.1).build()
    water = run.water
    heights = water.state[:, 1].copy()
    water.fill(1000.0 * GRAVITY * (0.1 - heights))
    water.update(water.content)
    np.testing.assert_allclose(run.heads, 0.1, atol=1e-9)  # p(w) undoes w(p) to 1e-8 of a fringe of 0.2 m
    before = water.content[:, CONTENT].copy()
    run.advance(60.0)
    np.testing.assert_allclose(run.heads, 0.1, atol=1e-9)
    np.testing.assert_allclose(water.content[:, CONTENT], before, rtol=1e-8)


def test_water_that_comes_and_goes_is_counted_to_the_last_bit_but_round_off():
    for given in (COARSE, replace(SINKING, rows=10), replace(DRAINING, rows=10)):
        run = given.build()
        before = run.water.content[:, CONTENT].sum()
        run.advance(20.0)
        now, came, went = run.water.content[:, [CONTENT, FROM_WATER, TO_AIR]].sum(axis=0)
        assert abs(came) > 0.01 * before
        # a sum over stages, each with a rounding of the whole
        assert now - before == pytest.approx(came - went, abs=run.stages * np.finfo(float).eps * now)


def test_full_soil_over_air_drains_through_its_face_only_where_it_is_pressed():
    run = replace(DRAINING, rows=10, below=None, height=0.6).build()  # air under it and over it
    water = run.water
    water.fill(1000.0 * GRAVITY * (0.45 - water.state[:, 1]))  # full, pressed below 0.45 m
    run.advance(5.0)
    assert water.content[:, TO_AIR].sum() > 0.0
    assert water.content[:, TO_AIR].reshape(10, -1)[5:].sum() < 1e-3 * water.content[:, TO_AIR].sum()
    assert water.state[:, PRESSURE].max() < 1000.0 * GRAVITY * 0.6


@pytest.mark.parametrize(("given", "seconds"), [(RISING, 60.0), (SINKING, 30.0), (DRAINING, 100.0)])
def test_half_the_spacing_leaves_less_error(given, seconds):
    coarse, fine = (error(replace(given, rows=rows), seconds) for rows in (10, 20))
    assert fine < 0.7 * coarse < 0.7 * 0.5 / 10
    # a front moves on within its row: 0.65 is asked of 20 to 40 rows by the slow rows


@pytest.mark.parametrize(("given", "seconds"), [(RISING, 120.0), (DRAINING, 300.0)])
def test_soil_that_lets_water_through_as_if_it_were_full_is_wrong(given, seconds):  # the twin that must fail
    given = replace(given, rows=20)
    wrong = replace(given, relative=False).build().advance(seconds)
    y, found = wrong.profile()
    at, known = given.reference(seconds)
    assert np.abs(found - np.interp(y, at, known)).mean() > 3.0 * 0.5 / 20  # of rows that allow 0.5/20
    assert error(given, seconds) < 0.5 / 20


def test_errors_that_stay_are_refused():  # the twin of the rows
    assert held((0.02, 0.01, 0.005)).error < 1.0
    assert held((0.02, 0.02, 0.02)).error > 1.0
    assert held((0.2, 0.1, 0.05)).error > 1.0


def test_the_compiled_flow_is_the_plain_one():
    run = Soaking(rows=5, below=0.1, above=0.65).build()
    water, outer = run.water, run.outside.outer
    compiled, plain = np.zeros((len(water.grains), 3)), np.zeros((len(water.grains), 3))
    state = water.state.copy()
    water.weigh(run.near, outer)
    one = water.rates(run.near, outer, compiled)
    weights = water.weight.copy(), water.outer_weight.copy()
    pair_weights.py_func(water.state, run.near, outer, water.properties.place, water.weight, water.outer_weight)
    np.testing.assert_allclose(weights[0], water.weight, rtol=1e-12)
    np.testing.assert_allclose(weights[1], water.outer_weight, rtol=1e-12)
    two = flow_rates.py_func(water.state, water.permeability, run.near, outer, *weights, water.properties, plain)
    np.testing.assert_allclose(compiled, plain, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(one, two, rtol=1e-12)
    update_state.py_func(
        water.content, water.grains, water.permeability, water.retention.numbers, water.properties, water.state
    )
    np.testing.assert_allclose(water.state, state, rtol=1e-12)


def test_flow_between_pieces_is_opposite():
    run = Soaking(rows=10).build()  # closed below, air above
    water = run.water
    rng = np.random.default_rng(1)
    water.fill(-2000.0 * (1.0 + rng.random(len(water.grains))))
    water.update(water.content)
    rate = np.zeros((len(water.grains), 3))
    water.weigh(run.near, run.outside.outer)
    water.rates(run.near, run.outside.outer, rate)
    assert abs(rate[:, CONTENT].sum()) < 1e-12 * np.abs(rate[:, CONTENT]).sum()


@pytest.mark.slow
def test_one_thread_and_many_give_the_same_water():
    ends = []
    for threads in (1, 2):
        set_threads(threads)
        ends.append(COARSE.build().advance(10.0).water.content.copy())
    assert np.array_equal(*ends)


@pytest.mark.slow
@pytest.mark.parametrize("row", [columns.rise_row, columns.infiltration_row, columns.drainage_row])
def test_rows_hold(row):
    assert row().error <= 1.0


@pytest.mark.parametrize("ratio", [10.0, 100.0])
def test_flow_across_pieces_is_that_of_their_resistances_one_after_the_other(ratio):
    given = replace(FULL, rows=8)
    run = given.build()
    upper = run.water.state[:, Y] > 0.5 * given.height
    run.water.permeability[upper] *= ratio
    run.advance(20.0)  # D = k K_w/(n ρ g) is 0.16 m²/s: steady after 2 s
    before = run.water.content.copy()
    run.advance(1.0)
    taken = run.water.content[:, FROM_WATER] - before[:, FROM_WATER]
    through = [float(taken[rows].sum()) for rows in (~upper, upper)]
    half = 0.5 * given.height / given.permeability
    exact = 1000.0 * COLUMNS * given.spacing * (0.9 - 0.2) / (half + half / ratio)
    assert through[1] == pytest.approx(-through[0], rel=1e-6)
    # ends and boundary are known to a share of one of 8 rows: 1.6 % short of it, with the arithmetic mean of k 12 % and
    # 37 % beyond
    assert through[1] == pytest.approx(exact, rel=0.025)
