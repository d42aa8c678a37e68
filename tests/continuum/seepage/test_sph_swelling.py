"""Soil that yields in full pores keeps its effective stress, where its damping is bounded."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.seepage.mixture import GRAINS, POROSITY, ROOM, SOIL
from continuum_sph.seepage.pores import PoreFlow
from continuum_sph.seepage.swelling import SWELLING, YIELDING, add_swelling
from continuum_sph.validation.seepage import levee, wet_slopes
from continuum_sph.validation.tanks import level_ground, tank_scene

ACROSS, SPACING = 12, 0.05


def soaked(**numerics):
    """A tank of full ground, built."""
    ground = {"saturated": True, "permeability": 1e-3, "body": [level_ground(ACROSS * SPACING, 0.4)]}
    ground["numerics"] = numerics
    return Simulation(tank_scene(ACROSS * SPACING, 0.4, SPACING, 0.1, soil=ground, water={"sound_speed": 60.0}))


def test_pores_swell_as_soil_does_in_place_of_what_its_mean_velocity_has():
    """Soil whose mean velocity has the gradient A, and that swells by T: what is added is -ρ/n (T - tr A), of all of
    it where it yields, exact inside, where the corrected gradient is."""
    flow = soaked(damping_of="bounded").flow.water
    layer, pores, motion = flow.layer, flow.pores, flow.motion
    x = layer.x[: layer.fluid]
    inside = (np.abs(x[:, 0] - 0.5 * ACROSS * SPACING) < 2 * SPACING) & (np.abs(x[:, 1] - 0.2) < 1.1 * SPACING)
    motion[:, 0], motion[:, 1] = 0.3 * x[:, 0] + 0.5 * x[:, 1], -0.1 * x[:, 0] + 0.2 * x[:, 1]
    motion[:, SWELLING], motion[:, YIELDING] = 0.7, 0.5

    def added():
        rate = np.zeros(layer.fluid)
        add_swelling(
            layer.fluid, layer.record, flow.near(flow.law.smoothing.kind), flow.gradients.matrix, layer.mass, pores,
            motion, layer.v, 1.0, rate, None,
        )  # fmt: skip
        return rate

    assert (pores[SOIL, : layer.fluid] / pores[ROOM, : layer.fluid])[inside].min() > 0.9
    wanted = -0.5 * 1000.0 / pores[POROSITY, : layer.fluid] * (0.7 - 0.5)
    np.testing.assert_allclose(added()[inside], wanted[inside], rtol=2e-3)  # ρ of water under its weight: to 0.1 %
    motion[:, YIELDING] = 0.0  # the check that must fail
    assert not added().any()


def test_without_bounded_damping_nothing_of_it_is_built():
    plain, bounded = soaked().flow.water, soaked(damping_of="bounded").flow.water
    assert (plain.skeleton.swelling, plain.motion.size) == (None, 0)
    assert bounded.skeleton.swelling.shape == (bounded.skeleton.count, 2)
    assert len(bounded.motion) == bounded.layer.fluid
    assert (plain.pores[GRAINS] == bounded.pores[GRAINS]).all()


def friction(rows, seeping):
    given = wet_slopes.SEEPING if seeping else wet_slopes.STILL
    return wet_slopes.friction(replace(given, rows=rows, bounded=True))


@pytest.mark.slow
def test_wet_layers_slide_by_their_friction(monkeypatch):
    """`continuum.soil_slides_wet_with_bounded_damping`, 20 rows of its 20, 40 and 80."""
    for seeping in (False, True):
        assert friction(20, seeping) == pytest.approx(0.5, rel=0.5 * wet_slopes.WITHIN)
    wet_slopes.slides.cache_clear()
    monkeypatch.setattr(PoreFlow, "swell", lambda flow, swelling: None)  # the check that must fail
    assert friction(20, True) < 0.5 * (1.0 - wet_slopes.WITHIN)
    wet_slopes.slides.cache_clear()


def gone(rows):
    """When (s after it is let go) toe, middle and crest of a full levee have gone, with bounded damping."""
    return levee.gone.__wrapped__(replace(levee.QUICK, rows=rows, bounded=True))


@pytest.mark.slow
def test_a_full_levee_goes_from_its_toe_up_with_few_rows(monkeypatch):
    """8 and 16 rows: toe, middle and crest in turn, the toe alike."""
    coarse, fine = gone(8), gone(16)
    assert np.isfinite(coarse).all()
    assert list(coarse) == sorted(coarse)
    assert list(fine) == sorted(fine)
    # The slide has a few rows more or less about a toe a quarter of the height high: half a row of two.
    assert coarse[0] == pytest.approx(fine[0], rel=0.25)
    monkeypatch.setattr(PoreFlow, "swell", lambda flow, swelling: None)  # the check that must fail
    stuck = gone(8)
    assert np.isnan(stuck[1:]).all()
