"""The fluid's validations hold, and their tolerances are tight enough to catch the error next door."""

import numpy as np
import pytest

from porescale.lbm.boundary import velocity
from porescale.validation.lbm import cavity, operators, own_forces
from porescale.validation.lbm import channels as lab
from porescale.validation.lbm import open_sides as opened
from porescale.validation.lbm.channels import HEIGHT, OTHER_MAGIC, VISCOSITIES
from tests.validation.tolerances import tolerance

EPS = np.finfo(float).eps


@pytest.mark.parametrize("viscosity", [0.01, 1 / 6, 1.0])
@pytest.mark.parametrize("height", [1, 2, 5])
def test_walls_sit_midway_at_magic_3_16(height, viscosity):
    # At magic 3/16 the parabola solves the discrete equations exactly; what is left is round-off, nine roundings a
    # step over H²/(pi² nu) steps of viscous memory, eps H²/nu, and over the halves' own memory, 3 tau steps.
    found, parabola = lab.poiseuille(height, viscosity)
    assert np.abs(found - parabola).max() < EPS * (height**2 / viscosity + 27 * (3 * viscosity + 0.5))


def test_another_magic_misplaces_the_wall():
    found, parabola = lab.poiseuille(HEIGHT, VISCOSITIES[1], OTHER_MAGIC)
    off = np.abs(found - parabola).max() * VISCOSITIES[1] / HEIGHT**2
    assert off > 1e10 * tolerance("lbm.poiseuille_walls_midway_at_magic_3_16")


def test_the_slip_of_one_magic_is_not_that_of_another():
    found, parabola = lab.poiseuille(HEIGHT, VISCOSITIES[1], 1.001 * OTHER_MAGIC)
    lifted = (found - parabola) / ((16 / 3 - 1) / HEIGHT**2)
    assert np.abs(lifted - 1).max() > 10 * tolerance("lbm.poiseuille_slip_at_another_magic")


def test_a_lid_that_moves_a_little_faster_is_told_apart():
    found, line = lab.couette(HEIGHT, VISCOSITIES[1], OTHER_MAGIC, speed=1e-3)
    faster = np.abs(found - (1 + 1e-9) * line).max() * VISCOSITIES[1] / HEIGHT**2
    assert faster > 10 * tolerance("lbm.couette")


def test_a_lid_at_the_last_cells_centre_would_be_told_apart():
    # A full-way wall stands half a cell further in: the profile is y/(H - 1/2), off by 1/(2 H) at the lid.
    found, line = lab.couette(HEIGHT, VISCOSITIES[1], OTHER_MAGIC)
    assert np.abs(found - line * HEIGHT / (HEIGHT - 0.5)).max() > 0.4 / HEIGHT


def test_a_wall_that_starts_to_move_is_felt_wrongly_at_long_relaxation_times():
    # Found: 0.8 % at 5, 17 % at 10; a tenth of H²/nu is 60 and 28 steps there.
    for time, least in ((5.0, 2), (10.0, 30)):
        found, exact = lab.begun_couette(time)
        assert np.abs(found - exact).max() > least * tolerance("lbm.begun_couette")


def test_at_a_fixed_mach_number_vortices_do_not_converge_at_second_order():
    # Compressibility and the lattice's cubic Galilean defect are of order u², which no finer grid makes smaller when
    # the velocity in lattice units stays.
    errors = [lab.taylor_green(cells, speed=1.6 * cells / 16, drift=0.8 * cells / 16) for cells in (16, 32, 64)]
    assert abs(lab.order(errors) - 2) > 5 * tolerance("lbm.taylor_green_order")


def test_a_pressure_channel_longer_by_half_a_cell_is_told_apart():
    found, parabola = opened.pressure_channel(10, 20, 1 / 6, 1e-4)
    off = np.abs(found * 20 / 20.5 - parabola[:, None]).max()
    assert off > 100 * tolerance("lbm.poiseuille_between_pressures")


def test_central_moments_shift_the_walls_of_a_pressure_channel():
    # Their magic parameter is (tau - 1/2)/2 = 1/4 at tau 1: the walls move by (16/12 - 1)/H² of the peak, 0.0033.
    found, parabola = opened.pressure_channel(10, 20, 1 / 6, 1e-4, "central")
    off = np.abs(found[:, 10] - parabola).max()
    assert off == pytest.approx((16 / 12 - 1) / 10**2, rel=0.01)
    assert off > 30 * tolerance("lbm.poiseuille_between_pressures")


def test_an_inlet_that_gives_a_diagonal_its_own_cells_velocity_slides_along_itself(monkeypatch):
    # By 1/2 du/dy, 2/n of the peak beside a wall: first order, where means of two cells leave second.
    def alone(bounds, side, link):
        own = bounds.place(side, link)
        return (own, own), 1.0

    monkeypatch.setattr(velocity, "_joined", alone)
    errors = [opened.inlet(n) for n in (8, 16)]
    assert np.log2(errors[0] / errors[1]) < 1
    assert 16**2 * errors[1] > 2 * tolerance("lbm.parabola_from_an_inlet")


def test_the_error_of_an_inlet_falls_at_second_order():
    # 1.66: corner links, the larger part, are one cell each, whose rings fall off as 1/r: a logarithm of n off.
    assert np.log2(opened.inlet(8) / opened.inlet(16)) > 1.66


def test_an_inlet_that_keeps_what_convection_adds_is_told_apart(monkeypatch):
    monkeypatch.setattr(velocity, "_turned", lambda bounds, side, link: [])
    assert 8**2 * opened.inlet(8, 0.003, 0.03, memories=2) > 3 * tolerance("lbm.parabola_from_a_fast_inlet")


def test_a_plug_that_leaves_a_millionth_slower_is_told_apart():
    gained, _ = opened.plug(20, 10, 0.05, 0.05 * (1 - 1e-6), 1000)
    assert abs(gained) > 10 * tolerance("lbm.plug_balances")


def test_a_cavity_at_another_reynolds_number_is_told_apart():
    run = cavity.cavity(64, 130, "trt")
    u, found = cavity.read(run.u, cavity.GHIA_U[100])
    assert np.abs(found - u).max() > tolerance("lbm.cavity_100")
    run = cavity.cavity(64, 300, "trt")
    u, found = cavity.read(run.u, cavity.GHIA_U[400])
    assert np.abs(found - u).max() > tolerance("lbm.cavity_400")


@pytest.mark.slow
def test_a_cavity_of_half_the_cells_misses_the_extrema():
    found = cavity.extrema(cavity.cavity(64, 1000, "trt"))
    worst = max(abs(a - b) for a, b in zip(found, cavity.EXTREMA_1000, strict=True))
    assert worst > tolerance("lbm.cavity_1000")


@pytest.mark.parametrize("operator", ["trt", "mrt", "bgk"])
def test_other_operators_feel_the_frame_that_central_moments_do_not(operator):
    off = operators.wave_viscosity(operator, 0.2) / operators.wave_viscosity(operator, 0.0) - 1
    assert abs(off) > 50 * tolerance("lbm.viscosity_in_a_moving_frame")


def test_central_moments_do_not_have_the_cubic_defect():
    off = operators.wave_viscosity("central", 0.2) / operators.wave_viscosity("central", 0.0) - (1 - 3 * 0.2**2)
    assert abs(off) > 10 * tolerance("lbm.viscosity_of_a_second_order_equilibrium_in_a_moving_frame")


def test_another_smagorinsky_constant_is_told_apart():
    _, exact = operators.eddy_channel("trt", smagorinsky=2.0)
    found, _ = operators.eddy_channel("trt", smagorinsky=1.95)
    assert np.abs(found - exact).max() / exact.max() > 3 * tolerance("lbm.eddy_viscosity_in_a_channel")


@pytest.mark.parametrize(("operator", "speed"), [("trt", 0.05), ("mrt", 0.05), ("bgk", operators.SPEEDS[1])])
def test_other_operators_blow_up_in_thin_shear_layers(operator, speed):
    energy = operators.shear_layers(operator, speed=speed)
    assert not np.all(np.diff(energy, prepend=1.0) <= 0)


def test_an_operator_of_first_order_would_be_told_apart():
    # At a fixed Mach number the Galilean defect does not converge, whatever the operator.
    errors = [lab.taylor_green(n, speed=0.1 * n, drift=0.05 * n, operator="mrt") for n in (16, 32, 64)]
    assert abs(lab.order(errors) - 2) > 5 * tolerance("lbm.taylor_green_order_of_each_operator")


def test_a_thousandth_more_force_of_every_cell_is_told_apart():
    # The error is 1.6e-3, of one sign, and the tolerance little more.
    bound = tolerance("lbm.kolmogorov_flow")
    assert abs((1 + own_forces.kolmogorov(32)) * 0.999 - 1) > bound


def test_the_error_of_a_wave_under_a_force_is_that_of_its_magic_parameter():
    # 2/3 (magic - 1/4) (k h)²: none of second order at 1/4, where the order is four.
    k = 2 * np.pi / 32
    for magic in (1 / 12, 1 / 8, 3 / 16):
        assert own_forces.kolmogorov(32, magic) == pytest.approx(2 / 3 * (magic - 1 / 4) * k**2, rel=0.2 * k**2)
    errors = [own_forces.kolmogorov(cells, 1 / 4) for cells in own_forces.STEADY]
    assert abs(lab.order(errors) - 2) > 10 * tolerance("lbm.kolmogorov_flow_order")


def test_a_channel_that_swings_a_thousandth_of_a_radian_late_is_told_apart():
    assert own_forces.swinging(64, late=0.001) > 1.2 * tolerance("lbm.womersley_channel")


def test_a_flow_that_is_late_at_every_resolution_has_no_order():
    # Late by a share of the period: an error that no finer lattice makes smaller.
    errors = [own_forces.swinging(cells, late=0.01) for cells in own_forces.SWINGING]
    assert abs(lab.order(errors) - 2) > 5 * tolerance("lbm.womersley_channel_order")
