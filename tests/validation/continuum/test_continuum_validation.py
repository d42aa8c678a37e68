"""The rows of `continuum-sph verify`, and beside each a twin that must fail."""

import numpy as np
import pytest

from continuum_sph.validation.water import channels, dam_break, flows, fluids, hydrostatics, kernels, momentum, sound
from continuum_sph.water import step
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import WENDLAND, kernel_slope, kernel_value
from continuum_sph.water.state import VISCOUS, P
from tests.validation.tolerances import tolerance


def test_a_kernel_of_one_dimension_does_not_integrate_to_one():
    q = (np.arange(2000) + 0.5) / 1000
    line = sum(2.0 * kernel_value(WENDLAND, v, 1.0) / 1000 for v in q)
    assert abs(line - 1.0) > tolerance("continuum.kernel_integral")


def test_a_slope_that_is_not_divided_by_the_distance_is_not_the_kernels():
    error = kernels.slope_error(lambda kind, q, h: q * kernel_slope(kind, q, h))
    assert error > tolerance("continuum.kernel_slope")


def test_water_between_walls_without_pressure_does_not_stay_at_rest(monkeypatch):
    load_walls = step.load_walls

    def powerless(fluid, near, x, v, mass, record, *rest):
        load_walls(fluid, near, x, v, mass, record, *rest)
        record[fluid:, P] = 0.0

    monkeypatch.setattr(step, "load_walls", powerless)
    _, speed = hydrostatics.hydrostatic.__wrapped__(0.2)
    assert speed > tolerance("continuum.water_stays_at_rest")


def test_water_does_not_weigh_as_on_the_moon():
    error, _ = hydrostatics.hydrostatic(1.0, gravity_assumed=1.62)
    assert error > tolerance("continuum.hydrostatic_pressure")


@pytest.mark.parametrize("kind", ["poiseuille", "couette"])
def test_a_tenth_more_viscosity_is_told_apart(kind):
    wrong = channels.channel_error(kind, 20, viscosity_assumed=1.1e-6)
    assert wrong > tolerance(f"continuum.{kind}_start_up")


def test_plain_sums_as_printed_miss_the_flow_between_plates_by_the_lattices_error(monkeypatch):
    row = tolerance("continuum.poiseuille_start_up")
    assert channels.channel_error("poiseuille", 20, corrected=False) < row
    monkeypatch.setattr(Law, "lattice", 1.0)
    printed = channels.channel_error("poiseuille", 20, corrected=False)
    assert printed > 2.0 * row
    assert printed > kernels.LATTICE  # of the viscosity, and so of the speed


def test_sound_over_plain_sums_as_printed_is_late_by_the_lattices_error(monkeypatch):
    monkeypatch.setattr(Law, "lattice", 1.0)
    assert sound.sound_period(32)[0] / 0.1 - 1.0 > 1.5 * tolerance("continuum.sound_period")


def test_sound_is_of_second_order():
    # Halving the spacing takes three quarters of the error, where plain sums as printed keep 1.7 % of it.
    coarse, fine = (sound.sound_period(n)[0] / 0.1 - 1.0 for n in (16, 32))
    assert fine == pytest.approx(0.25 * coarse, rel=0.05)


def test_channel_walls_are_of_second_order():
    # Halving the spacing takes three quarters of the error.
    coarse, fine = (channels.channel_error("poiseuille", n) for n in (10, 20))
    assert fine == pytest.approx(0.25 * coarse, rel=0.3)


def test_vortices_without_shifting_die_of_gaps():
    assert flows.vortex_error(30, shifting=0.0, end=0.2) > 3.0 * tolerance("continuum.taylor_green_decay")


def test_vortices_without_corrected_gradients_fade_too_fast():
    assert flows.vortex_error(30, corrected=False, end=0.2) > 2.0 * tolerance("continuum.taylor_green_decay")


@pytest.mark.slow
def test_water_at_rest_that_is_shifted_all_the_same_sinks(monkeypatch):
    monkeypatch.setattr(step, "QUIET", 0.0)
    assert flows.sunk(20.0) > 1.2 * tolerance("continuum.shifted_water_keeps_its_volume")


@pytest.mark.slow
def test_heat_counted_as_flow_is_energy_that_grows():
    growth, _ = flows.energy_growth(0.6, heat_kept=True)
    assert growth > 5.0 * tolerance("continuum.energy_never_grows")


@pytest.mark.slow
def test_a_book_without_its_heat_does_not_close(monkeypatch):
    monkeypatch.setattr(step, "kick", lambda *arguments: _kick_without_heat(*arguments))
    _, drift = flows.energy_growth(0.6)
    assert drift > 5.0 * tolerance("continuum.energy_balance")


@pytest.mark.slow
def test_a_book_of_speeds_at_mid_step_does_not_close_over_an_impact(monkeypatch):
    rates = step.rates  # the last argument is half a step
    monkeypatch.setattr(step, "rates", lambda *arguments: rates(*arguments[:-1], 0.0))
    _, drift = flows.energy_growth(1.2)
    assert drift > tolerance("continuum.energy_balance_over_an_impact")


def _kick_without_heat(v, acceleration, density, rate, material, length, lengths, table, power, *rest, kick=step.kick):
    if power is not None:
        power[:, VISCOUS] = 0.0
    return kick(v, acceleration, density, rate, material, length, lengths, table, power, *rest)


@pytest.mark.slow
def test_a_tenth_more_tension_is_told_apart():
    jump = fluids.jump(20, seconds=0.3, tension=1.1 * fluids.TENSION)
    assert abs(jump - 1.0) > 2.0 * tolerance("continuum.young_laplace")


def test_a_tenth_less_tension_draws_a_stretched_drop_back_too_weakly():
    found, exact = fluids.restoring(50, tension=0.9 * fluids.TENSION)
    assert abs(found / exact - 1.0) > tolerance("continuum.drop_restoring_force")


@pytest.mark.slow
def test_a_fifth_less_tension_swings_a_drop_too_slowly():
    assert fluids.period(32, 0.8 * fluids.TENSION) - 1.0 > tolerance("continuum.drop_period")


@pytest.mark.slow
def test_a_bubble_of_five_particles_in_its_radius_rises_too_fast():
    rise, *_ = fluids.rising(0.05, 0.9)
    assert rise / fluids.RISE - 1.0 > tolerance("continuum.rising_bubble")


def test_coarse_waves_are_slower_than_the_tolerance():
    period, _ = sound.sound_period(8)
    assert abs(period / 0.1 - 1.0) > tolerance("continuum.sound_period")


def test_sound_grows_without_extrapolated_density():
    _, amplitude = sound.sound_period(32, extrapolated=False)
    assert amplitude > 1.0 + tolerance("continuum.sound_neither_grows_nor_fades")


def test_a_pushed_particle_changes_momentum():
    assert momentum.momentum_drift(20, force=1e-9) > tolerance("continuum.momentum")


@pytest.mark.slow
def test_a_front_a_quarter_slower_or_faster_does_not_pass():
    front = dam_break.computed_front(20)
    for series in dam_break.published_fronts().values():
        for factor in (0.75, 1.33):
            ratio, _ = dam_break.front_against(front * [factor, 1.0], series)
            assert abs(ratio - 1.0) > tolerance("continuum.front_speed_of_a_collapsing_column")
            place = dam_break.front_since(front * [factor, 1.0], series)
            assert place > tolerance("continuum.front_of_a_collapsing_column")


@pytest.mark.slow
def test_a_front_two_hundredths_faster_or_that_of_an_experiment_is_not_that_of_the_release():
    allowed, (depth, *_) = tolerance("continuum.front_of_a_released_column"), dam_break.DEPTHS
    front = dam_break.computed_front(round(1.0 / depth))
    assert dam_break.behind_release(front * [1.0 / 1.02, 1.0], depth) > allowed
    assert dam_break.behind_release(front * [1.0 / 0.98, 1.0], depth) > allowed
    for series in dam_break.published_fronts().values():
        assert dam_break.behind_release(series, depth) > 10.0 * allowed


def test_published_fronts_are_read_whole():
    fronts = dam_break.published_fronts()
    assert [len(series) for series in fronts.values()] == [10, 15, 7]
    assert all(np.all(np.diff(series, axis=0) > 0.0) for series in fronts.values())
