"""Water kept at a level: measured by weight, put in and taken out, accounted for to the last particle."""

import numpy as np
import pytest

from continuum_sph.seepage import Reservoir, Supply, reservoir
from continuum_sph.seepage.reservoir import CLOSER, HEAP, NoneLeftError, berths, measure_strip, park_waiting
from continuum_sph.water.state import Layer
from porescale.common.neighbors import square_lattice

SPACING, ROUND = 0.1, 2.3e-16


def pool(level, *, left=0.0, right=1.0, walls=(True, False), times=(0.0,)):
    levels = np.atleast_1d(np.array(level, np.float64))
    return Reservoir("pool", left, right, 0.0, np.array(times, np.float64), levels, walls)


def supply(*pools, rows=4, spare=200):
    """A basin 2 m wide, ``rows`` deep."""
    x = square_lattice((0.0, 0.0), (2.0, rows * SPACING), SPACING)
    berth = berths(len(x) + spare, 2.0, 5.0, 0.8)
    n = len(berth)
    mass = np.where(np.arange(n) < len(x), 1000.0 * SPACING**2, 0.0)
    layer = Layer(n, np.concatenate((x, berth[len(x) :])), np.zeros((n, 2)), mass, np.full(n, 1000.0))
    return Supply(layer, pools, berth, SPACING, 1000.0, 1e6, 9.81, spare)


def test_a_lattice_in_a_strip_weighs_what_stands_there_wherever_its_columns_are():
    for shift in np.linspace(0.0, 1.0, 5):
        given = supply(pool(0.4, left=0.5, right=1.6, walls=(False, False)))
        strip, layer = given.reservoirs[0], given.layer
        layer.x[:, 0] += shift * SPACING
        layer.v[:, 1] = layer.x[:, 0] - 1.0
        where = layer.fluid, layer.x, layer.v, layer.mass, layer.material, strip.strip, 0.5
        held, highest = measure_strip(*where, strip.tops, strip.sinking)
        # the trapezoidal rule over cosine ramps of 3 spacings: its first harmonic, 1/{π (2·3)² - …} of a spacing a ramp
        assert held / (1000.0 * strip.width) == pytest.approx(0.4, abs=0.4 * 2 * 0.02 / (strip.width / SPACING))
        assert layer.x[highest, 1] == pytest.approx(0.35)
        np.testing.assert_allclose(strip.tops, 0.35)
        columns = 0.5 + (np.arange(len(strip.tops)) + 0.5) * 1.1 / len(strip.tops)
        assert (strip.sinking <= 0.0).all()
        # of a particle within three quarters of a column
        np.testing.assert_allclose(strip.sinking, np.minimum(0.0, columns - 1.0), atol=0.75 * SPACING)
        slow, sinking = np.zeros_like(strip.tops), np.ones_like(strip.tops)
        assert measure_strip.py_func(*where, slow, sinking) == (pytest.approx(held, rel=1e-14), highest)
        assert np.array_equal(slow, strip.tops)
        assert np.array_equal(sinking, strip.sinking)


def strip_at(bottom, level):
    """A strip a spacing wide that is kept at a ``level``, over a ``bottom`` (m)."""
    it = Reservoir("pool", 0.0, SPACING, bottom, np.zeros(1), np.full(1, level), (True, True))
    it.fit(SPACING, 1000.0)
    return it


def found(rows, depth, *, bottom=0.5, weight=1.0):
    """Level in rows over its bottom that a strip kept ``depth`` rows deep finds.

    rows (k,): spacings over the bottom;  weight (k,): of a particle.
    """
    it = strip_at(bottom, bottom + depth * SPACING)
    strip, line = it.strip_for(it.wanted(0.0))
    x = np.column_stack((np.full(len(rows), 0.5 * SPACING), bottom + np.asarray(rows) * SPACING))
    mass = np.full(len(rows), 1000.0 * SPACING**2) * weight
    kind, still = np.zeros(len(rows), np.int64), np.zeros_like(x)
    held, highest = measure_strip(len(rows), x, still, mass, kind, strip, 0.5, *np.zeros((2, 1)))
    assert highest == int(np.argmax(rows))
    return (line - bottom) / SPACING + held / (1000.0 * SPACING**2)


@pytest.mark.parametrize("above", [0.01, 0.3, 0.7])
def test_on_the_floor_of_a_tank_a_row_counts_as_a_whole(above):
    assert found([above], 3.0, bottom=0.0) == 1.0
    # over ground 1.5 rows are taken for granted, and this one is below them
    assert found([above], 3.0) == pytest.approx(1.5)


@pytest.mark.parametrize("depth", [1, 2, 3, 4, 6, 20])
def test_water_at_rest_has_its_level_at_any_depth(depth):
    assert found(np.arange(depth) + 0.5, depth) == pytest.approx(depth, abs=1e-12)  # round-off of 0.5 m


def test_what_is_below_the_line_does_not_count():
    rows, rng = np.arange(6) + 0.5, np.random.default_rng(1)
    below = rng.uniform(-5.0, 1.5, 30)  # the ramp is from 1.5 to 2.5 rows
    lie = np.concatenate((below, rows[rows > 1.5]))
    weight = np.concatenate((rng.uniform(0.1, 2.0, 30), np.ones((rows > 1.5).sum())))
    assert found(lie, 6.0, weight=weight) == pytest.approx(6.0, abs=1e-12)


def test_a_row_that_crosses_the_line_is_taken_in_as_it_comes(monkeypatch):
    def off():
        """By how many rows too much is found of water that rises by a row, (50,)."""
        return [found(np.arange(-3, 6) + 0.5 + part, 6.0) - 6.0 - part for part in np.linspace(0.0, 1.0, 50)]

    np.testing.assert_allclose(off(), 0.0, atol=1e-12)
    monkeypatch.setattr(reservoir, "HALF", 1e-9)  # the twin that must fail: rows count as a whole
    assert np.abs(off()).max() > 0.4


def test_what_has_passed_on_has_no_steps_of_whole_particles():
    # Each particle in turn becomes 4 kg/m lighter, and one of 10 is let in for what is lost.
    given = supply(pool(0.4, right=2.0, walls=(True, True)))
    layer, strip = given.layer, given.reservoirs[0]
    given.keep(0.0)
    inside = np.flatnonzero((layer.mass > 0.0) & (layer.x[:, 0] < 0.7))
    assert len(inside) == 28
    for count, i in enumerate(inside, 1):
        layer.mass[i] -= 4.0
        given.keep(0.0)
        assert given.passed(strip) == pytest.approx(4.0 * count, abs=ROUND * 1000 * count)
    assert strip.let_in == pytest.approx(110.0)  # the twin that must fail: 112 have passed


def test_the_ways_from_a_reservoir_end_halfway_to_the_next_or_after_three_spacings():
    first, second, third = (
        supply(
            pool(0.4, left=0.0, right=0.5), pool(0.4, left=0.9, right=1.2, walls=(False, False)),
            pool(0.4, left=1.2, right=1.6, walls=(False, False)),
        ).reservoirs
    )  # fmt: skip
    for it, way in ((first, (0.0, 0.2)), (second, (0.2, 0.0)), (third, (0.0, 0.3))):
        assert (it.reach.ramp_left, it.reach.ramp_right) == pytest.approx(way, abs=1e-15)
        assert (it.reach.left, it.reach.right) == pytest.approx((it.left - way[0], it.right + way[1]))
        assert it.reach[4:6] == it.strip[4:6]


def test_a_particle_on_its_way_passes_from_one_reservoir_to_the_next_by_parts():
    ends = [pool(0.4, left=0.0, right=0.4), pool(0.0, left=1.6, right=2.0, walls=(False, True))]
    given = supply(*ends)
    layer = given.layer
    layer.mass[(layer.mass > 0.0) & (layer.x[:, 0] > 1.6)] = 0.0
    given.keep(0.0)
    held = [given.passed(it) for it in ends]
    assert held == pytest.approx([0.0, 0.0], abs=1e-12)
    (mover,) = np.flatnonzero((layer.mass > 0.0) & (np.hypot(layer.x[:, 0] - 0.35, layer.x[:, 1] - 0.05) < 1e-9))
    mass, places, seen = layer.mass[mover], np.linspace(0.35, 1.61, 127), []
    for place in places:
        layer.x[mover, 0] = place
        if place > 1.6:
            given._level(ends[1], 0.0)
        seen.append([given.passed(it) for it in ends])
    into, out = np.array(seen).T
    # a cosine over 0.6 m on each side of the middle; what is drained takes no step, as it has counted as out
    part = 0.5 - 0.5 * np.cos(np.pi * np.clip((places - 0.4) / 0.6, 0.0, 1.0))
    np.testing.assert_allclose(into, mass * part, atol=1e-11)
    part = 0.5 - 0.5 * np.cos(np.pi * np.clip((places - 1.0) / 0.6, 0.0, 1.0))
    np.testing.assert_allclose(out, -mass * part, atol=1e-11)
    assert ends[1].let_out == mass  # the twin that must fail: at once
    assert np.abs(np.diff(out)).max() < 0.5 * np.pi / 0.6 * (places[1] - places[0]) * mass * 1.001


def test_what_two_reservoirs_pass_on_is_what_is_between_them():
    ends = [pool(0.4, left=0.0, right=0.4), pool(0.3, left=1.6, right=2.0, walls=(False, True))]
    given = supply(*ends)
    layer, rng = given.layer, np.random.default_rng(4)

    def between():
        there = layer.mass > 0.0
        share = np.clip((layer.x[there, 0] - 0.4) / 0.6, 0.0, 2.0)
        return layer.mass[there] @ (0.5 - 0.5 * np.cos(np.pi * share))

    given.keep(0.0)
    before, start = between(), sum(given.passed(it) for it in ends)
    changes = []
    for time in range(1, 20):
        there = layer.mass > 0.0
        layer.x[there] = np.clip(layer.x[there] + rng.normal(0.0, 0.05, (there.sum(), 2)), 1e-9, (2.0 - 1e-9, 4.0))
        given.keep(float(time))
        passed = sum(given.passed(it) for it in ends) - start
        changes.append(between() - before)
        assert passed == pytest.approx(changes[-1], abs=ROUND * layer.fluid * 1000.0)
    assert np.ptp(changes) > 5.0  # of a particle of 10 kg/m, many times the rounding


def test_air_in_a_strip_is_no_water():
    given = supply(pool(0.4))
    layer, strip = given.layer, given.reservoirs[0]
    air = np.flatnonzero((layer.mass > 0.0) & (layer.x[:, 1] > 0.3))
    layer.material[air] = 1
    layer.x[air, 1] += 0.2
    given.keep(0.0)
    assert strip.let_in > 0.08 * 1000.0 * strip.width
    assert strip.let_out == 0.0
    assert (layer.mass[air] > 0.0).all()


def test_what_comes_and_goes_is_accounted_for_to_round_off():
    given = supply(pool([0.7, 0.2], times=(1.0, 2.0)), pool(0.0, left=1.7, right=2.0, walls=(False, True)))
    layer, before = given.layer, given.layer.mass.sum()
    for time in np.linspace(0.0, 3.0, 31):
        given.keep(time)
        balance = sum(one.let_in - one.let_out for one in given.reservoirs)
        assert abs(layer.mass.sum() - before - balance) < ROUND * layer.fluid * before
        first, drained = given.reservoirs
        # within half a particle of 1 m or, beside the ramp of 3 spacings, 0.85 m
        assert abs(first.level - first.wanted(time)) <= 0.5 * SPACING**2 / first.width + 1e-12
        assert drained.level == 0.0
    assert first.let_in > 0.0
    assert first.let_out > 0.0
    away = layer.mass == 0.0
    assert np.array_equal(layer.x[away], given.berth[away])


def test_new_water_lies_on_the_lowest_place_under_its_depth():
    given = supply(pool(0.8))
    layer, before = given.layer, given.layer.mass > 0.0
    given.keep(0.0)
    new = (layer.mass > 0.0) & ~before
    assert new.sum() >= 32
    x = layer.x[layer.mass > 0.0]
    apart = np.hypot(*(x[:, None] - x[None]).transpose(2, 0, 1)) + np.eye(len(x))
    assert apart.min() > 0.99 * SPACING
    depth = np.maximum(0.0, 0.8 - layer.x[new, 1])
    np.testing.assert_allclose(layer.density[new], 1000.0 * (1.0 + 1000.0 * 9.81 * depth / 1e6), rtol=1e-12)


@pytest.mark.parametrize("stretch", [1.0, 1.05])
def test_new_water_is_put_nearer_where_what_stands_there_is_sparse(stretch):
    given = supply(pool(0.5, right=2.0, walls=(True, True)))
    layer, before = given.layer, given.layer.mass > 0.0
    layer.x[before, 1] *= stretch
    given.keep(0.0)
    new = (layer.mass > 0.0) & ~before
    assert new.sum() == 20
    top, surface = 0.35 * stretch, 0.35 * stretch + 0.5 * SPACING
    # 0.4 m of water stand 0.4 or 0.4175 m high: 0.1 m or 0.088 m above the row below.
    np.testing.assert_allclose(layer.x[new, 1], top + SPACING * (0.4 / surface) ** CLOSER, rtol=1e-12)
    assert (stretch == 1.0) == np.allclose(layer.x[new, 1], top + SPACING)  # the twin: a spacing, however sparse


@pytest.mark.parametrize("speed", [-0.7, 0.0, 0.7])
def test_new_water_sinks_with_the_surface_that_it_is_put_on(speed):
    given = supply(pool(0.5, right=2.0, walls=(True, True)))
    layer, before = given.layer, given.layer.mass > 0.0
    layer.v[before] = 0.3, speed
    given.keep(0.0)
    new = (layer.mass > 0.0) & ~before
    assert new.sum() == 20
    for velocity in (layer.v, layer.smoothed):
        assert (velocity[:, 0][new] == 0.0).all()
        assert (velocity[:, 1][new] == min(0.0, speed)).all()


def test_water_that_splashes_over_a_strip_brings_new_water_no_nearer_than_a_heap_does():
    given = supply(pool(0.5, right=2.0, walls=(True, True)))
    layer, before = given.layer, given.layer.mass > 0.0
    layer.x[np.flatnonzero(before & (layer.x[:, 1] > 0.3))[::2], 1] += 1.0  # every second of the highest row
    strip = given.reservoirs[0]
    where = layer.fluid, layer.x, layer.v, layer.mass, layer.material, strip.strip, 0.5
    measure_strip(*where, strip.tops, strip.sinking)
    surface = strip.tops.mean() + 0.5 * SPACING
    given.keep(0.0)
    new = (layer.mass > 0.0) & ~before
    assert new.any()
    x = layer.x[layer.mass > 0.0]
    apart = np.hypot(*(x[:, None] - x[None]).transpose(2, 0, 1)) + np.eye(len(x))
    assert apart.min() > 0.99 * SPACING / (1.0 + HEAP) ** CLOSER
    # The twin that must fail: the cube of the level over the mean surface, whatever makes it.
    assert (0.4 / surface) ** CLOSER < 0.5 / (1.0 + HEAP) ** CLOSER


def test_a_surface_that_stands_over_its_level_is_not_heaped_up():
    given = supply(pool(0.4))
    layer = given.layer
    there = layer.mass > 0.0
    lowest = np.flatnonzero(there & (layer.x[:, 1] < SPACING))
    layer.x[there, 1] += 0.5 * SPACING
    layer.mass[lowest[::2]] = 0.0
    given.keep(0.0)
    assert given.reservoirs[0].let_in == 0.0
    assert given.reservoirs[0].level < 0.36


def test_water_that_waits_stays_where_it_is():
    given = supply(pool(0.4))
    layer = given.layer
    layer.x[-3:], layer.v[-3:] = 0.5, 1.0
    park_waiting.py_func(
        layer.fluid, layer.x, layer.v, layer.mass, layer.density, layer.predicted, given.berth, 1000.0
    )  # fmt: skip
    assert np.array_equal(layer.x[-3:], given.berth[-3:])
    assert not layer.v[-3:].any()


def test_a_reservoir_without_particles_left_says_so():
    with pytest.raises(NoneLeftError, match=r"pool: no particles left to bring it from .* to 0\.8 m"):
        supply(pool(0.8), spare=10).keep(0.0)


def test_berths_are_a_pitch_apart_and_over_the_floor():
    places = berths(50, 2.0, 1.0, 0.3)
    apart = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + np.eye(50)
    assert apart.min() == pytest.approx(0.3)
    assert places[:, 1].min() == pytest.approx(1.3)
