"""The fluid converges at second order between any two resolutions, at small and large viscosity."""

import pytest

from porescale.validation.lbm import channels as lab


@pytest.mark.parametrize("viscosity", [0.02, 0.05])
def test_vortices_converge_at_second_order(viscosity):
    # Diffusive scaling: all errors go with h².  With the start's own relaxation, tau²/steps = tau² k² nu of the result,
    # the coarse pair may be off by that: 0.03 at 16 cells.
    errors = [lab.taylor_green(cells, viscosity=viscosity) for cells in (16, 32, 64)]
    assert lab.order(errors[:2]) == pytest.approx(2, abs=0.1)
    assert lab.order(errors[1:]) == pytest.approx(2, abs=0.1)
