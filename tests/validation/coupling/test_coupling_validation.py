"""The validations of fluid and grains hold, and their tolerances are tight enough to catch the error next door."""

import numpy as np
import pytest

from porescale.validation.coupling import conservation, setups, single_disc, towed
from porescale.validation.coupling.conservation import FALL
from porescale.validation.coupling.single_disc import RATIOS, TIMES
from tests.reference.coupling import psm as twin
from tests.validation.tolerances import tolerance

# Laplace transform inverted by an independent code: v/((s - 1) g a²/nu) at nu t/a² = 0.05, 0.1, 0.2, 0.5
TABLE = {
    1.5: (0.01541, 0.02781, 0.04838, 0.09345),
    2.5: (0.01180, 0.02182, 0.03913, 0.07941),
    7.8: (0.005247, 0.01014, 0.01929, 0.04353),
}


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_inverse_transform_gives_the_published_table(ratio):
    found = [single_disc.exact_release(ratio, time) for time in TIMES]
    assert found == pytest.approx(TABLE[ratio], rel=5e-4)  # four digits


def test_the_inverse_transform_knows_what_it_can():
    # 1/(p + 1) <-> exp(-t), and sqrt(p)^-1 <-> 1/sqrt(pi t), which has a cut along the negative axis
    for time in (0.05, 0.5, 5.0):
        assert single_disc.inverse_laplace(lambda p: 1 / (p + 1), time) == pytest.approx(np.exp(-time), rel=1e-9)
        assert single_disc.inverse_laplace(lambda p: p**-0.5, time) == pytest.approx((np.pi * time) ** -0.5, rel=1e-9)


def test_early_and_late_the_spinning_disc_obeys_its_limits():
    # s p + 4 sqrt(p) for large p: 1 - 8/s sqrt(t/pi), next term of order t: (8 + 2)/s + 16/s²;  at rest in the end.
    for ratio in (0.5, 2.5):
        t = 1e-6
        assert single_disc.exact_spin_down(ratio, t) == pytest.approx(1 - 8 / ratio * np.sqrt(t / np.pi), abs=100 * t)
        assert abs(single_disc.exact_spin_down(ratio, 1e3)) < 1e-3


def test_a_disc_whose_hydraulic_radius_is_smaller_settles_faster():
    assert abs(single_disc.settling_disc(ratio=0.9) - 0.0555) > tolerance("coupling.settling_disc")


@pytest.mark.parametrize("ratio", [1.5, 2.5])
def test_without_the_inner_mass_a_disc_starts_too_slowly(ratio):
    # 14 to 25 %, as an independent code of the method found
    found = single_disc.release(ratio, TIMES[:2], width=8.0, inner_mass=False)
    short = 1 - np.divide(found, [single_disc.exact_release(ratio, time) for time in TIMES[:2]])
    assert np.all((short > 0.14) & (short < 0.25))
    assert short.min() > 3 * tolerance("coupling.release_from_rest")


def test_without_the_inner_inertia_a_disc_spins_on_too_long():
    found = single_disc.spin_down(2.5, TIMES, inner_mass=False)
    too_long = np.divide(found, [single_disc.exact_spin_down(2.5, time) for time in TIMES]) - 1
    assert too_long.max() > 3 * tolerance("coupling.spin_down")


@pytest.mark.parametrize(("ratio", "diameter", "tau"), [(0.3, 20.0, 0.56), (0.5, 10.0, 0.6), (0.8, 10.0, 0.6)])
def test_light_discs_are_stable(ratio, diameter, tau):
    # 7 %: 4 % as in the row, and a wall four diameters off adds 2 (a/W)² = 3 %
    found = single_disc.release(ratio, (0.5,), diameter=diameter, width=8.0, relaxation_time=tau)
    assert found[0] == pytest.approx(single_disc.exact_release(ratio, 0.5), rel=0.07)


def test_a_grain_that_goes_a_little_faster_feels_it():
    assert max(conservation.loads_on_neutral(2, extra=1e-12)) > 10 * tolerance("coupling.neutral_grains_feel_no_force")


def test_neutral_grains_at_rest_in_shared_cells_feel_nothing_at_all():
    place, radius = [(10.3, 12.2), (18.3, 12.4), (14.2, 19.1)], [4.0, 4.1, 3.9]
    coupled = setups.immersed((30, 28), place, radius, 1.0)
    setups.without_inner_mass(coupled)
    coupled.grains.set_law(setups.LAW.with_friction(0.0))
    for _ in range(20):
        coupled.saturated.advance(coupled.fluid, np.array(place), np.zeros((3, 2)), np.zeros(3))
    assert not coupled.saturated.force.any()
    assert not coupled.saturated.torque.any()


def test_a_disc_at_its_own_radius_bears_less():
    load, area = towed.weighing(0.8, cells=24, radius=4.0, steps=3000)
    assert load / (np.pi * 4.0**2) - 1 > 1e3 * tolerance("coupling.disc_at_rest_in_a_body_force")
    # the printed operators hold the fluid with B F + w- B(1 - B) F/2 in a cell, and not with e F
    load, area = towed.weighing(0.8, cells=24, radius=4.0, steps=3000, method=setups.Method("odd-SC1"))
    assert 1 - load / area > 1e3 * tolerance("coupling.disc_at_rest_in_a_body_force")


def test_forcing_outside_the_fluid_share_is_felt_by_a_disc_at_rest():
    # 0.17 to 0.77 of rho g A that is not there.  The flow need not be steady, as both codes are asked at the same step;
    # after a²/nu, 90 steps, the load that is not there is within 3 % of the last.
    loads, steps = {}, 100
    for forcing in ("inside", "outside"):
        lattice = twin.SaturatedCells(18, 18, 0.8, force=(0.0, -1e-6), operator="odd-SC1", forcing=forcing)
        discs = [twin.Disc(9.3, 9.1, 3.0)]
        split = lattice.split(discs)
        lattice.split = lambda _, split=split: split  # it does not move
        for _ in range(steps):
            force, _ = lattice.step_with(discs)
        loads[forcing] = force[0, 1] / 1e-6
    found, area = towed.weighing(0.8, cells=18, radius=3.0, steps=steps, method=setups.Method("odd-SC1"))
    assert loads["inside"] == pytest.approx(found, rel=1e-6)  # the force of 1e-6 on whole populations: ten digits
    assert 0.17 < abs(loads["outside"] - found) / area < 0.77


def test_a_closed_box_that_is_filled_is_noticed():
    coupled = setups.handful(sides=("wall", "wall"), acceleration=FALL, gate=True)
    before = coupled.fluid.mass_excess()
    for _ in range(10):
        coupled.advance()
        coupled.fluid.populations[0, 5, 5] += 1e-9
    found = (coupled.fluid.mass_excess() - before) / (coupled.fluid.nx * coupled.fluid.ny)
    assert abs(found) > tolerance("coupling.mass")


def test_without_the_fluid_inside_the_momentum_book_does_not_close():
    coupled = setups.handful()
    inside = coupled.inner_mass @ coupled.inner_velocity
    first = coupled.momentum() + inside
    for _ in range(50):
        coupled.advance()
    now = coupled.momentum() + coupled.inner_mass @ coupled.inner_velocity
    size = float(np.sum(coupled.grains.discs.mass[:, None] * np.abs(coupled.grains.discs.velocity)))
    assert np.abs(now - first).max() / size > 1e9 * tolerance("coupling.momentum")


def test_weights_left_out_of_the_book_are_missed():
    coupled = setups.handful(acceleration=FALL)
    first = coupled.momentum()
    coupled.advance()
    assert np.abs(coupled.momentum() - first).max() > 1e-3


def test_slip_walls_give_no_momentum_along_themselves():
    coupled = setups.immersed(
        (40, 30), [(12.2, 10.3), (25.1, 18.4)], 4.0, [2.0, 3.0], [(0.03, 0.01), (-0.02, 0.0)], 0.01,
        sides=("periodic", "slip"),
    )  # fmt: skip
    first = coupled.momentum()
    size = float(np.sum(coupled.grains.discs.mass[:, None] * np.abs(coupled.grains.discs.velocity)))
    for _ in range(100):
        coupled.advance()
    change = np.abs(coupled.momentum() - first) / size
    assert change[0] < 500 * np.finfo(float).eps  # 500 roundings of every velocity, as in the row
    assert change[1] > 1e-3  # across them they do


def test_a_scene_that_is_a_little_less_than_its_mirror_image_is_noticed():
    assert conservation.mirror_error(FALL, 50, nudge=1e-9) > tolerance("coupling.mirror")


def test_the_scene_that_mirrors_has_contacts_of_every_kind():
    coupled = setups.handful(sides=("wall", "wall"), acceleration=FALL, gate=True)
    seen = np.zeros(3, int)
    for _ in range(500):
        coupled.advance()
        grains = coupled.grains
        seen += [np.count_nonzero(part) for part in (grains.pairs.carried, grains.wall_spring, grains.plate_spring)]
    assert seen.min() > 0, seen


def test_the_even_half_of_sc1_lets_a_spinning_disc_drift():
    # a tenth of the row's speed: faster ones run away
    density, torque = towed.spinning_disc([2000, 5000], spin=0.002, method=setups.Method("SC1"))
    bound = 10 * tolerance("coupling.spinning_disc_does_not_drift")
    assert abs(density[1] - density[0]) > bound
    assert abs(torque[1] / torque[0] - 1) > bound
