"""The layer with inertia that consolidation is compared with: against Terzaghi's series where that holds."""

import math
from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.validation.seepage.biot_column import differences
from continuum_sph.validation.seepage.consolidation import LAYER, middles, with_inertia
from continuum_sph.validation.seepage.setups import GRAINS, WATER
from porescale.common.core.constants import GRAVITY

SLOW = replace(LAYER, permeability=1e-5, ratio=1e4)  # inertia and stiffness of water are nothing
CUT = np.pi**2 / 12 / 100**2  # relative error of the second difference of a sine over 100 cells
NEXT = (0.5 * np.pi / 100) ** 2 / 2  # the middle lies between two cells, half a step from either


def series(factor, slower=1.0):
    return math.exp(-(np.pi**2) * factor / slower)


@pytest.mark.parametrize("factor", [0.01, 0.1, 0.3])
def test_a_layer_that_drains_slowly_does_as_terzaghi_says(factor):
    # c_v falls by 1e-4 with the ratio, the start spreads over the layer in no time.
    (found,) = middles(SLOW, (factor,))
    spread = np.pi**2 * factor * (CUT + 1e-4)
    assert found == pytest.approx(series(factor), rel=spread + NEXT + 1e-5)


@pytest.mark.parametrize("ratio", [1.0, 4.0])
def test_soft_water_slows_it_by_its_storage(ratio):
    (found,) = middles(replace(SLOW, ratio=ratio), (0.1,))
    assert found == pytest.approx(series(0.1, 1.0 + 1.0 / ratio), rel=np.pi**2 * 0.1 * CUT + NEXT + 1e-5)


def test_a_layer_that_is_stopped_has_more_pressure_at_its_base():
    # Water and soil come down together with k u0 π/(ρ_w g H), ever slower at the rate π² c_v/H²: the base stops them.
    heights, (found,) = with_inertia(replace(LAYER, ratio=1e4), (0.01,))
    whole = (1.0 - LAYER.porosity) * GRAINS + LAYER.porosity * WATER
    most = np.pi**3 * whole * LAYER.permeability**2 * LAYER.modulus / (WATER * GRAVITY * LAYER.height) ** 2
    more = found - LAYER.excess(heights, 0.01)
    assert 0.6 * most < more.max() < most  # the push is largest at the base, which drains
    assert heights[more.argmax()] < 0.5 * LAYER.height


def test_slopes_at_faces_and_in_cells_are_those_of_a_line():
    slopes, inside = differences(8, 2.0)
    at_faces = slopes @ (0.125 + 0.25 * np.arange(8))
    np.testing.assert_allclose(at_faces[:-1], 1.0)  # a line through zero at the base
    np.testing.assert_allclose(inside @ (0.25 * np.arange(9)), 1.0)
