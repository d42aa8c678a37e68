"""The validation of fluxes through sections holds, and would not with what fluid alone would read."""

from porescale.coupling.psm import SaturatedCells
from porescale.validation.coupling.sections import fluxes, spread
from tests.validation.tolerances import tolerance


def test_moments_before_collision_flow_unequally(monkeypatch):
    def before_collision(wet, fluid, *motion):
        rho, ux, uy = fluid.fields()
        return rho, rho * ux, rho * uy

    monkeypatch.setattr(SaturatedCells, "flow", before_collision)
    flux, _ = fluxes("exact-wall", steps=2000)
    assert spread(flux) > 1e6 * tolerance("coupling.sections_exact_wall")
