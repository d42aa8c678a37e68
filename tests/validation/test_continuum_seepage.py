"""Beside each row on soil and water a twin that must fail."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.scene import verify_seepage
from continuum_sph.scene.trials_seepage import realised_modulus
from continuum_sph.scene.validations import VALIDATIONS
from continuum_sph.scene.verify_seepage import LAYER
from continuum_sph.seepage import pores


def tolerance(name):
    return VALIDATIONS[name].tolerance


@pytest.mark.slow
def test_water_that_does_not_feel_the_grains_does_not_consolidate(monkeypatch):
    # Eq. 46 as printed: layers of full density, no pore volume balance.  The soil swings under its load as if dry.
    monkeypatch.setattr(pores, "blend", lambda *_: None)
    monkeypatch.setattr(pores, "part_forces", lambda *_: None)
    _, worst = verify_seepage.consolidation.__wrapped__(LAYER, (0.01, 0.05))
    assert worst > 10.0 * tolerance("continuum.consolidation")


@pytest.mark.slow
def test_a_layer_does_not_consolidate_at_the_rate_of_the_printed_modulus():
    # B of eq. 43 over M in plane strain is 0.53: T_v counted with it runs at half the speed.
    middle, _ = verify_seepage.consolidation.__wrapped__(LAYER, (0.05,))
    assert abs(middle[0] - np.exp(-(np.pi**2) * 0.05 * 0.53)) > tolerance("continuum.consolidation")


@pytest.mark.slow
def test_the_printed_area_modulus_is_not_the_stiffness_of_a_column():
    found = realised_modulus(LAYER) / (LAYER.stiffness / 1.4)
    assert abs(found - 1.0) > tolerance("continuum.consolidation_modulus")


@pytest.mark.slow
def test_soft_water_holds_its_pressure_longer():
    stiff = np.exp(-(np.pi**2) * 0.1)
    assert verify_seepage.soft_decay(1.0) - stiff > tolerance("continuum.consolidation_with_compressible_water")


@pytest.mark.slow
def test_drag_on_the_water_alone_moves_the_box():
    def spoil(both):
        both.water.skeleton.v -= 0.25 * both.next_step * both.water.borne / both.water.skeleton.mass[:, None]

    assert verify_seepage.momentum_drift(spoil) > tolerance("continuum.momentum_of_layers")


@pytest.mark.slow
def test_error_of_the_modulus_falls_with_resolution():
    coarse, fine = (abs(realised_modulus(replace(LAYER, rows=rows)) / LAYER.modulus - 1.0) for rows in (10, 20))
    assert fine < coarse
