"""Where errors are known to be larger than the stated uncertainty, it is said, however many vectors are valid."""

import warnings

import numpy as np
import pytest

from porescale.common.core.errors import PorescaleWarning
from porescale.piv import Camera, measure, pair
from porescale.piv.estimate.understated import diameter
from porescale.piv.images import flows

SIZE = (192, 192)
FLOW = flows.uniform(3.3, -1.7)


def said(window: int = 16, **camera: float) -> tuple[str, float]:
    """What is said of a pair, and its errors over its uncertainties."""
    made = pair(FLOW, Camera(SIZE, **camera), 1)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        field = measure(made.first, made.second, window=window)
    assert field.valid.mean() > 0.9
    off = np.array([field.u - 3.3, field.v + 1.7])[:, field.valid]
    ratio = np.sqrt(np.mean(off**2) / np.mean(field.uncertainty[field.valid] ** 2))
    return "; ".join(str(it.message) for it in found if issubclass(it.category, PorescaleWarning)), float(ratio)


@pytest.mark.parametrize(
    ("camera", "words"),
    [
        ({"diameter": 1.6}, "particle images are 1.6 px wide: errors are larger than stated"),
        ({"diameter": 2.0}, "particle images are 2.0 px wide"),
        ({"density": 0.003}, "tracers are seen in a window of 16 px: errors are larger than stated"),
        ({"noise": 22.0, "background": 100.0, "peak": 100.0}, "pictures correlate by 0.4"),
    ],
)
def test_errors_larger_than_stated_are_said(camera, words):
    found, ratio = said(**camera)
    assert words in found
    assert "--" not in found
    assert ratio > 1.0


@pytest.mark.parametrize("camera", [{}, {"diameter": 4.0}, {"density": 0.02}, {"density": 0.1}, {"noise": 10.0}])
def test_pictures_whose_uncertainty_holds_are_not_doubted(camera):  # the check that must fail
    assert said(**camera)[0] == ""


@pytest.mark.parametrize("noise", [0.0, 25.0])
@pytest.mark.parametrize("wide", [1.6, 2.0, 2.8, 4.0])
def test_the_diameter_is_that_of_the_particle_images_whatever_the_noise(wide, noise):
    made = pair(FLOW, Camera((256, 256), diameter=wide, noise=noise, background=80.0), 0)
    solid = np.zeros((256, 256), bool)
    # At 1.6 px the value along diagonals is 0.128 of the variance.  65 thousand pixels give each to (1 + n)/256 of it,
    # n the noise's variance over the tracers', 1.7 here: 1.5 % of the diameter without noise, 4.6 % with; three times
    # that.
    near = 0.05 if noise == 0 else 0.14
    assert diameter(made.first, solid) == pytest.approx(wide, rel=near)
    solid[100:150, 40:120] = True
    lit = np.where(solid, 200, made.first)
    assert diameter(lit, solid) == pytest.approx(wide, rel=near)
    assert np.isnan(diameter(np.zeros((64, 64)), np.zeros((64, 64), bool)))
