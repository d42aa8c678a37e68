"""Beside each row on soil and water a twin that must fail."""

from dataclasses import replace
from functools import partialmethod

import numpy as np
import pytest

from continuum_sph.seepage import PressureFace, Resistance, exchange, pores
from continuum_sph.validation.seepage import consolidation, infiltration, open_water, permeameter, saturated_box
from continuum_sph.validation.seepage.consolidation import LAYER, realised_modulus
from tests.validation.tolerances import tolerance


@pytest.mark.slow
def test_layers_of_full_density_consolidate_too_fast(monkeypatch):
    # Eq. 46 as printed, drag n ρ_f g/k between layers of full density: strong drag still makes soil press its water
    # out, but with the conductivity k/n.
    monkeypatch.setattr(pores, "mix_fluxes", lambda *_: None)
    monkeypatch.setattr(pores, "share_forces", lambda *_: None)
    monkeypatch.setattr(Resistance, "factor", LAYER.porosity / (1.0 - LAYER.porosity))
    middle, worst = consolidation.consolidation.__wrapped__(LAYER, (0.05,))
    assert worst > 10.0 * tolerance("continuum.consolidation")
    assert middle[0] == pytest.approx(np.exp(-(np.pi**2) * 0.05 / LAYER.porosity), abs=0.1)


@pytest.mark.slow
def test_a_layer_does_not_consolidate_at_the_rate_of_the_printed_modulus():
    # B of eq. 43 over M in plane strain is 0.53: T_v counted with it runs at half the speed.
    middle, _ = consolidation.consolidation.__wrapped__(LAYER, (0.05,))
    assert abs(middle[0] - np.exp(-(np.pi**2) * 0.05 * 0.53)) > tolerance("continuum.consolidation")


@pytest.mark.slow
def test_the_printed_area_modulus_is_not_the_stiffness_of_a_column():
    found = realised_modulus(LAYER) / (LAYER.stiffness / 1.4)
    assert abs(found - 1.0) > tolerance("continuum.consolidation_modulus")


@pytest.mark.slow
def test_soft_water_holds_its_pressure_longer():
    stiff = np.exp(-(np.pi**2) * 0.1)
    assert consolidation.soft_decay(1.0) - stiff > tolerance("continuum.consolidation_with_compressible_water")


@pytest.mark.slow
def test_drag_on_the_water_alone_moves_the_box():
    def spoil(both):
        both.water.skeleton.v -= 0.25 * both.next_step * both.water.borne / both.water.skeleton.mass[:, None]

    assert saturated_box.momentum_drift(spoil) > tolerance("continuum.momentum_of_layers")


@pytest.mark.slow
def test_error_of_the_modulus_falls_with_resolution():
    coarse, fine = (abs(realised_modulus(replace(LAYER, rows=rows)) / LAYER.modulus - 1.0) for rows in (10, 20))
    assert fine < coarse


@pytest.mark.slow
def test_water_that_does_not_feel_the_grains_flows_too_fast(monkeypatch):
    # A layer of full density under the printed drag has the conductivity k/n.
    monkeypatch.setattr(pores, "mix_fluxes", lambda *_: None)
    monkeypatch.setattr(pores, "share_forces", lambda *_: None)
    monkeypatch.setattr(Resistance, "factor", LAYER.porosity / (1.0 - LAYER.porosity))
    found = permeameter.darcy.__wrapped__(1e-3, steps=400)
    assert found - 1.0 > 10.0 * tolerance("continuum.permeameter")


@pytest.mark.slow
def test_soil_starts_to_move_when_it_boils():
    _, before, boiling = permeameter.boiling()
    assert boiling > 5.0 * before


@pytest.mark.slow
def test_soil_that_feels_no_drag_does_not_boil_at_the_critical_gradient(monkeypatch):
    monkeypatch.setattr(pores, "apply_reaction", lambda *_: None)
    found, _, _ = permeameter.boiling(replace(permeameter.BOILING, cover=0.035))
    assert abs(found - 1.0) > tolerance("continuum.boiling_gradient")


@pytest.mark.slow
def test_ground_goes_on_rising_over_the_critical_gradient_hovers_at_it_and_stands_below():
    """Under i_c alone nothing accelerates it: what the face is uncertain by, 0.25 spacings, gives k i_c/20 and less."""
    for part in permeameter.LIFTS:
        _, halfway, end = permeameter.lift(part)
        assert end > 1.3 * halfway > 0.0
    slow = permeameter.BOILING.permeability * permeameter.BOILING.critical
    assert 0.0 < permeameter.lift(1.0001)[2] < slow < permeameter.lift(1.05)[2]
    assert abs(permeameter.lift(0.98)[2]) < 0.05 * slow


@pytest.mark.slow
def test_a_face_that_stands_back_by_a_fiftieth_of_a_spacing_loses_what_lifts_the_ground(monkeypatch):
    arrange = PressureFace.arrange

    def stand_back(face, *given, share):
        arrange(face, *given)
        face.whole *= 1.0 - share  # of the push goes with that share of a spacing

    monkeypatch.setattr(PressureFace, "arrange", partialmethod(stand_back, share=0.02))
    permeameter.lift.cache_clear()
    assert permeameter.push_error(1.2) < -3.0 * tolerance("continuum.ground_lifted_by_a_face")
    permeameter.lift.cache_clear()
    # As far as particles did that drifted with the mean of the water: it stays on its floor
    monkeypatch.setattr(PressureFace, "arrange", partialmethod(stand_back, share=0.06))
    assert permeameter.lift.__wrapped__(1.1)[2] < 1e-4


@pytest.mark.slow
def test_drag_in_explicit_steps_makes_energy_out_of_nothing(monkeypatch):
    # 1 - e^(-κT) → κT: unstable for T beyond 2/κ.
    monkeypatch.setattr(exchange, "relaxation", lambda times: times)
    monkeypatch.setattr(exchange, "drag", exchange.drag.py_func)
    monkeypatch.setattr(exchange, "sharpened", exchange.sharpened.py_func)
    monkeypatch.setattr(pores, "apply_drag", exchange.apply_drag.py_func)
    with pytest.raises(ValueError, match="position"):
        saturated_box.growth_of_energy.__wrapped__(1e-7)


@pytest.mark.slow
def test_water_sinks_faster_through_the_printed_drag(monkeypatch):
    # Drag n ρ_f g/k of eq. 46 per volume of water: n² ρ_f g/k of the whole, and 1/n of that per volume of pores.
    monkeypatch.setattr(Resistance, "factor", LAYER.porosity / (1.0 - LAYER.porosity))
    found = infiltration.way_of_the_front()
    assert abs(found - 1.0) > 3.0 * tolerance("continuum.infiltration")


def test_the_front_is_that_of_a_constant_head_at_first():
    given = infiltration.SINKING
    # of first order in z/h0: (2/3) a z/h0 of the depth, z = 1e-4
    early = given.time(1e-4)
    assert (2.0 * given.permeability * given.standing * early / given.porosity) ** 0.5 == pytest.approx(1e-4, rel=1e-3)
    assert given.time(given.front(0.5)) == pytest.approx(0.5, rel=1e-9)


@pytest.mark.slow
def test_a_front_that_slips_is_faster_than_one_over_ground_may_be():  # the twin that must fail
    slips = open_water.front_speed(12, "slip") / open_water.front_speed(12, "stick")
    assert slips > 1.0 + 3.0 * tolerance("continuum.front_over_ground")


@pytest.mark.slow
def test_water_that_has_the_gradients_of_ground_shrinks(monkeypatch):
    depth, askew = open_water.stirred(0.025)
    assert abs(depth) < tolerance("continuum.stirred_water_over_ground")
    assert abs(askew) < 0.5 * 0.025 * 2.0**0.5  # in the mean a level is known to half a spacing, each of two
    monkeypatch.setattr(pores, "open_gradients", lambda *_: None)
    depth, _ = open_water.stirred(0.025)
    assert depth < -tolerance("continuum.stirred_water_over_ground")
