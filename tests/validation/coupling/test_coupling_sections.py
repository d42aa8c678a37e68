"""As much flows through every section, but for what is stored between; not with what fluid alone would read."""

import numpy as np
import pytest

from porescale.coupling.psm import SaturatedCells
from porescale.validation.coupling import sections
from porescale.validation.coupling.sections import MOVING, STANDING, fluxes, imbalance, spread
from tests.validation.tolerances import tolerance

OPERATORS = ("exact-wall", "SC1", "SC2", "SC3")
SEALED = [{"x": 4.1e-3, "y": y, "diameter": 3.5e-3} for y in (0.6e-3, 4.1e-3)]
"""Two discs that touch each other's image and close the way."""
SETTLED = {0.51: 28000, 1.5: 9100}
"""Steps, whole periods, after which a flow changes by less than the tolerance; viscous memory goes as 1/(tau - 1/2)."""


def before_collision(wet, fluid, *motion):
    """What fluid alone would read: first moments, and half of the force."""
    rho, ux, uy = fluid.fields()
    return rho, rho * ux, rho * uy


def test_moments_before_collision_flow_unequally(monkeypatch):
    monkeypatch.setattr(SaturatedCells, "flow", before_collision)
    flux, _ = fluxes("exact-wall", steps=2000)
    assert spread(flux) > 1e6 * tolerance("coupling.sections_exact_wall")
    assert imbalance("SC1", before=2000, steps=5) > 1e6 * tolerance("coupling.sections_SC1")
    assert imbalance("SC2", discs=MOVING, before=700, steps=700) > 1e3 * tolerance("coupling.sections_of_moving_discs")


def test_fluxes_of_what_drifts_differ_by_what_is_stored_alone():  # the twin: without what is stored
    flux, solid = fluxes("SC1", steps=2000)
    assert spread(flux) > 1e3 * tolerance("coupling.sections_SC1")
    assert solid == [0.0] * len(solid)


def test_fields_in_covered_cells_carry_what_sections_do():
    simulation = sections._built("exact-wall", 0.8, STANDING)
    simulation.advance(4000)
    mass = (simulation.field("density") * simulation.field("velocity_x")).sum(axis=0) * sections.SPACING / 1000
    assert mass == pytest.approx(np.mean(sections._fluxes(simulation)[0]), rel=1e-12, abs=0.0)  # of 14 sums of one


@pytest.mark.slow
@pytest.mark.parametrize("relaxation_time", SETTLED)
@pytest.mark.parametrize("operator", OPERATORS)
def test_sections_agree_at_any_relaxation_time(operator, relaxation_time):
    before = SETTLED[relaxation_time]
    assert imbalance(operator, relaxation_time, before=before) < 1e-10
    assert imbalance(operator, relaxation_time, MOVING, before, 700) < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("operator", OPERATORS)
def test_sections_of_what_leaks_through_a_sealed_array_agree(operator):
    # Pressure within the discs that shut the way comes to rest in thousands of steps.
    assert imbalance(operator, discs=SEALED, before=24000) < 1e-10
