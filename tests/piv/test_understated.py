"""Where errors are known to be larger than the stated uncertainty, it is said, however many vectors are valid."""

import warnings

import cv2
import numpy as np
import pytest

from porescale.common.core.errors import PorescaleWarning
from porescale.piv import Camera, measure, pair
from porescale.piv.estimate.understated import diameter, noise
from porescale.piv.images import flows

SIZE = (192, 192)
FLOW = flows.uniform(3.3, -1.7)
VORTEX = flows.lamb_oseen(SIZE, 4.0, 40.0)


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
        ({"noise": 10.0, "background": 80.0, "peak": 100.0}, "noise is 0.5"),
        ({"noise": 5.0, "background": 80.0, "peak": 50.0}, "noise is 0.5"),
        ({"noise": 10.0}, "noise is 0.2"),
    ],
)
def test_errors_larger_than_stated_are_said(camera, words):
    found, ratio = said(**camera)
    assert words in found
    assert "--" not in found
    assert ratio > 1.0


@pytest.mark.parametrize("camera", [{}, {"diameter": 4.0}, {"density": 0.02}, {"density": 0.1}, {"noise": 5.0},
                                    {"lost": 0.0}, {"lost": 0.1}])  # fmt: skip
def test_pictures_whose_uncertainty_holds_are_not_doubted(camera):  # the check that must fail
    assert said(**camera)[0] == ""


def test_a_larger_window_bears_more_noise():
    loud = {"noise": 5.0, "background": 80.0, "peak": 100.0}  # 0.25 of the contrast
    for window, doubted in ((16, True), (24, False), (32, False)):
        found, _ = said(window, **loud)
        assert ("noise is" in found) == doubted, window


def test_errors_pass_1_4_times_what_is_stated_where_the_noise_is_said_to_be_too_much():
    # Four pairs of 192 x 192 px at each side of 0.17 of the contrast, which is 20 of 100 levels: the square of the
    # factor scatters by a fifth from pair to pair, by a tenth over four, the factor by half of that.
    def factor(noise: float) -> float:
        squares = []
        for seed in range(4):
            made = pair(VORTEX, Camera(SIZE, noise=noise, peak=100.0, background=80.0), seed)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", PorescaleWarning)
                field = measure(made.first, made.second)
            off = np.array(np.meshgrid(field.x, field.y))
            exact = np.array(VORTEX.displacement(*off))
            error = (np.array([field.u, field.v]) - exact)[:, field.valid]
            squares.append((np.mean(error**2), np.mean(field.uncertainty[field.valid] ** 2)))
        return float(np.sqrt(np.divide(*np.mean(squares, axis=0))))

    assert factor(1.5) < 1.4 * 0.95
    assert factor(6.0) > 1.4 * 1.05


@pytest.mark.parametrize("wide", [2.5, 2.8, 4.0])
@pytest.mark.parametrize("level", [0.0, 3.0, 10.0, 20.0])
def test_noise_is_told_from_tracers(level, wide):
    bare = pair(FLOW, Camera((256, 256), diameter=wide, noise=0.0, background=80.0, peak=100.0), 0)
    made = pair(FLOW, Camera((256, 256), diameter=wide, noise=level, background=80.0, peak=100.0), 0)
    solid = np.zeros((256, 256), bool)
    contrast = float((bare.first.astype(float) - cv2.blur(bare.first.astype(float), (33, 33))).std())
    # The square is off by -0.004, and without noise scatters by 0.004 (six pairs of each camera).  Noise adds to the
    # products of 65 thousand pixels, over those of tracers, sqrt(2 n² + n⁴)/256, less by sqrt 2 for two directions:
    # near is 0.59 and far 0.35 of the variance at 2.5 px, which makes 2/0.59 and 1/0.35 of it, 3.1 in all, by 1 + n².
    true = (level**2 + 1 / 12) / contrast**2
    scatter = 0.004 + 3.1 / 256 * np.sqrt(2 * true + true**2) * (1 + true)
    assert noise(made.first, solid) ** 2 == pytest.approx(true, abs=0.004 + 3 * scatter)
    solid[100:150, 40:120] = True
    lit = np.where(solid, 200, made.first)
    assert noise(lit, solid) ** 2 == pytest.approx(true, abs=0.004 + 3 * scatter)
    # The check that must fail: half as much noise again, where there is any to speak of.
    assert level < 5 or 1.25 * true > 0.004 + 3 * scatter
    assert np.isnan(noise(np.zeros((64, 64)), np.zeros((64, 64), bool)))


def test_sharp_edges_that_both_pictures_have_are_no_noise():
    # Grains drawn as discs of one grey: in one picture alone their edges would look like noise.
    random = np.random.default_rng(1)
    first = np.zeros((192, 192), np.uint8)
    for x, y, r, grey in random.uniform((0, 0, 2, 60), (192, 192, 5, 255), (700, 4)):
        cv2.circle(first, (int(x), int(y)), int(r), int(grey), -1)
    second = np.roll(first, (2, 3), (0, 1))
    assert noise(first, np.zeros((192, 192), bool)) > 0.2
    with warnings.catch_warnings():
        warnings.simplefilter("error", PorescaleWarning)
        measure(first, second, window=16)


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
