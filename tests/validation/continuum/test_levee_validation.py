"""A saturated levee fails from its toe upwards, and one that is flat enough does not fail."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.builders.parts.soil import soil_law
from continuum_sph.scene.sections import Scene
from continuum_sph.soil import SoilFlow
from continuum_sph.soil.stress import GROWN
from continuum_sph.validation.seepage.levee import FAR, GRAINS, PARTS, QUICK, STIFFER, Levee, gone
from continuum_sph.validation.seepage.overtopping import times
from tests.validation.tolerances import tolerance

SLID = Levee(rows=8, end=3.2)
"""Until its soil has slid to the end of the land."""
STRAIN = 2.0 * (0.014 + 0.012 + 0.005)
"""Soil rests on γ'H, a strain of γ'H/M = 0.014; what slides at 2 m/s and is stopped adds ρv²/M = 0.012; each particle
strains as unevenly as it is sheared, and diffusion leaves 1/χ of that, 0.005, of either sign; twice the sum where all
meet."""


def course(given):
    """Rows of the course of a levee."""
    return np.array([row for row, _ in given.course()])


@pytest.mark.slow
def test_toe_middle_and_crest_go_one_after_the_other_however_stiff():
    for given in (QUICK, replace(QUICK, stiffness=STIFFER * QUICK.stiffness)):
        toe, middle, crest = gone(given)
        assert toe < middle < crest


@pytest.mark.slow
def test_with_the_same_diffusion_of_stress_a_stiffer_levee_goes_otherwise():  # the twin that must fail
    stiff = replace(QUICK, stiffness=STIFFER * QUICK.stiffness, diffusion=law(QUICK).diffusion)
    late = [abs(one - other) for one, other in zip(gone(QUICK), gone(stiff), strict=True)]
    assert max(late) > 2.0 * tolerance("continuum.levee_stiffness")


@pytest.mark.slow
def test_a_saturated_slope_flatter_than_its_limit_stays():  # the twin that must fail
    # Seepage along a slope takes the grains' buoyant weight γ' = 0.5 γ of soil that weighs γ: without dilatancy it
    # holds up to tan β = sin φ γ'/γ = 0.249, 1 : 4.02. One of 1 : 6 is far below.
    given = Levee(rows=8, end=2.3, land=6.0, river=6.0, pool=0.8)
    rows = course(given)
    assert rows[:, 1 : 1 + len(PARTS)].max() < 0.5 * FAR


@pytest.mark.slow
def test_with_half_as_many_rows_a_levee_is_overtopped_a_tenth_later_or_more():  # the twin that must fail
    coarse, fine = (times(rows)[-1] for rows in (8, 16))
    assert not coarse / fine <= 1.0 + tolerance("continuum.levee_times")  # with 8 not before the end, so nan


def densities(given):
    """(least, largest) density of a particle over its first, of the whole course."""
    found = [(rho.min(), rho.max()) for _, model in given.course(0.1) for rho in [model.flow.ground.soil.density]]
    least, most = np.array(found).T
    return least.min() / (GRAINS * (1.0 - given.porosity)), most.max() / (GRAINS * (1.0 - given.porosity))


@pytest.mark.slow
def test_soil_that_slides_far_keeps_its_density():
    # What pulls at soil opens it, and only diffusion closes it again: twice as much downwards.
    least, most = densities(SLID)
    assert most < 1.0 + STRAIN
    assert least > 1.0 - 2.0 * STRAIN


@pytest.mark.slow
def test_without_diffusion_of_volume_it_is_squeezed_without_end(monkeypatch):  # the twin that must fail
    push = SoilFlow.push

    def kept(self):
        push(self)
        self.soil.spread[:, GROWN] = 0.0

    monkeypatch.setattr(SoilFlow, "push", kept)
    least, most = densities(SLID)
    assert most > 1.0 + 10.0 * STRAIN
    assert least < 1.0 - 4.0 * STRAIN


def test_the_parts_lie_one_above_the_other_on_the_land_side():
    given = Levee(rows=8)
    _, top, _, toe = given.corners
    x = np.column_stack((np.linspace(top, toe, 200), np.zeros(200)))
    x[:, 1] = np.clip((toe - x[:, 0]) / (toe - given.corners[2]), 0.0, 1.0) * given.height - 0.05
    parts = given.watched(x)
    assert all(part.any() for part in parts.values())
    heights = [x[part, 1].mean() for part in parts.values()]
    assert heights == sorted(heights)
    assert not np.logical_and.reduce(list(parts.values())).any()


def law(given):
    """What its soil is damped and levelled by."""
    return soil_law(Scene.model_validate(given.table()))


def test_damping_and_what_diffusion_leaves_do_not_change_with_stiffness():
    soft, stiff = Levee(), Levee(stiffness=2e6)
    eps = float(np.finfo(float).eps)  # six roundings each
    damped = [law(it).damping * it.modulus**0.5 for it in (soft, stiff)]
    left = [it.stiffness / law(it).diffusion for it in (soft, stiff)]
    assert damped[1] == pytest.approx(damped[0], rel=12 * eps)
    assert left[1] == pytest.approx(left[0], rel=12 * eps)


def test_what_never_moved_has_no_time():
    rows = np.array([[0.0, 0.0, 0.0, 0.0, 0.0], [0.1, 0.3, 0.1, 0.0, 0.0]])
    times = Levee().times(rows)
    assert times["toe"] == pytest.approx(0.1 * FAR / 0.3)
    assert all(np.isnan(times[name]) for name in ("middle", "crest", "overtopped"))
