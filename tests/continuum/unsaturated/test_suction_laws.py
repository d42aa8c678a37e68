"""Retention and relative permeability."""

import numpy as np
import pytest

from continuum_sph.unsaturated import VanGenuchten
from continuum_sph.unsaturated.conductivity import relative_permeability
from continuum_sph.unsaturated.retention import effective_saturation, pressure_and_slope
from continuum_sph.unsaturated.richards import unity
from continuum_sph.water.smoothing import RATIO, WENDLAND
from porescale.common.core.errors import InputError

WEIGHT, STIFF = 9806.65, 6.25e5
SOILS = [(5.0, 3.0, 0.1), (14.5, 2.68, 0.1), (1.5, 1.4, 0.0), (3.0, 7.0, 0.2)]  # alpha, n, S_r


def soil(alpha, n, residual):
    return VanGenuchten(alpha, n, residual, WEIGHT, STIFF)


@pytest.mark.parametrize("given", SOILS)
def test_pressure_and_filling_undo_each_other(given):
    law = soil(*given)
    for pressure in (-2e4, -3e3, -100.0, 0.0, 50.0, 5e4):
        filling = float(law.filling(np.array([pressure]))[0])
        found, _ = pressure_and_slope(filling, law.numbers)
        # 1 - S_e near full pores loses digits, which ψ = (...)^(1/n) makes its n-th root of: 1e-16^(1/7) at worst,
        # there the straight line with K_w takes over, whose error is eps K_w
        assert found == pytest.approx(pressure, rel=1e-6, abs=1e-6 * WEIGHT)


@pytest.mark.parametrize("given", SOILS)
def test_pressure_and_its_slope_are_continuous_and_never_stiffer_than_water(given):
    law = soil(*given)
    numbers = law.numbers
    for end in (numbers.wet, numbers.dry):
        one, two = pressure_and_slope(end - 1e-9, numbers), pressure_and_slope(end + 1e-9, numbers)
        assert two[0] - one[0] == pytest.approx(2e-9 * STIFF, rel=0.05)
    filling = np.linspace(0.0, 1.2, 5001)
    found = np.array([pressure_and_slope(at, numbers) for at in filling])
    assert (np.diff(found[:, 0]) > 0.0).all()
    assert found[:, 1].max() <= STIFF * (1.0 + 1e-6)
    middle = np.flatnonzero((filling > numbers.dry + 1e-3) & (filling < numbers.wet - 1e-3))
    slope = np.gradient(found[:, 0], filling)
    np.testing.assert_allclose(slope[middle], found[middle, 1], rtol=0.02)


def test_full_pores_have_hardly_a_pressure_and_ends_lie_close_to_the_curves():
    law = soil(*SOILS[0])
    pressure, _ = pressure_and_slope(1.0, law.numbers)
    assert -0.05 * WEIGHT / law.alpha < pressure < 0.0
    assert 1.0 - law.numbers.wet < 1e-3
    assert law.numbers.dry - law.residual < 0.02


def test_half_of_mualem_by_hand():
    # n = 2: m = 1/2, S_e = 0.5: [1 - (1 - 0.25)^0.5]² √0.5
    assert relative_permeability(0.5, 0.5, 0.5) == pytest.approx(0.5**0.5 * (1.0 - 0.75**0.5) ** 2, rel=1e-14)
    assert relative_permeability(1.0, 0.5, 0.5) == 1.0
    assert relative_permeability(0.0, 0.5, 0.5) == 0.0


def test_effective_saturation_stays_between_none_and_one():
    numbers = soil(*SOILS[0]).numbers
    assert [effective_saturation(at, numbers) for at in (0.0, 0.1, 0.55, 1.0, 1.1)] == pytest.approx([0, 0, 0.5, 1, 1])


def test_water_softer_than_its_suction_is_refused():
    with pytest.raises(InputError, match=r"sound_speed"):
        _ = VanGenuchten(0.01, 1.2, 0.0, WEIGHT, 1e4).numbers


def test_the_lattice_sum_of_second_derivatives_is_what_the_kernel_lacks():
    # 1.97/2 of M on the lattice of Wendland's kernel with `RATIO` spacings (`water.shifting`)
    assert 1.0 / unity(WENDLAND, RATIO) == pytest.approx(1.97 / 2.0, rel=0.01)
    assert unity(WENDLAND, 4.0) == pytest.approx(1.0, abs=1e-3)
